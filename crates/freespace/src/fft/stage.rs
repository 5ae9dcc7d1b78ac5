//! One stage of a transform: butterflies of one radix and the factors between them.
//!
//! Forward stages leave wave numbers in the order that their divisions bring about, inverse ones take them in this order and
//! leave values in their own (decimation in frequency, then in time), so that nothing is ever reordered.

use std::f64::consts::TAU;

use super::butterfly;
use super::lanes::{Lanes, Pair, Work, add, add_turned, sub, sub_turned, swapped, times};
use crate::plan::Real;

/// Divides blocks of `radix * below` numbers into `radix` blocks.
#[derive(Debug)]
pub(super) struct Stage<T> {
    pub(super) radix: usize,
    pub(super) below: usize,
    /// `exp(-2 pi i j k / n)` for place j of a block of n and k from 1 on, which runs fastest.
    pub(super) factors: Vec<[T; 2]>,
}

impl<T: Real> Stage<T> {
    pub(super) fn new(radix: usize, below: usize) -> Self {
        let n = radix * below;
        let factor = |product: usize| {
            let (sin, cos) = (-TAU * (product % n) as f64 / n as f64).sin_cos();
            [T::rounded(cos), T::rounded(sin)]
        };
        let factors = (0..below).flat_map(|j| (1..radix).map(move |k| j * k)).map(factor).collect();
        Self { radix, below, factors }
    }
}

/// Which way a stage goes.
#[derive(Clone, Copy)]
pub(super) enum Step {
    Forward,
    Inverse,
}

/// A stage for every block of `values`.
pub(super) struct Blocks<'a, T> {
    pub(super) stage: &'a Stage<T>,
    pub(super) step: Step,
    pub(super) values: &'a mut [T],
}

impl<T: Real> Work<T> for Blocks<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Stage { radix, below, ref factors } = *self.stage;
        let pairs = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        if below == 1 {
            return last(s, radix, self.step, pairs);
        }
        for block in pairs.chunks_exact_mut(radix * below) {
            match (self.step, radix) {
                (Step::Forward, 2) => forward_two(s, block, factors),
                (Step::Forward, 3) => forward_three(s, block, factors),
                (Step::Forward, 4) => forward_four(s, block, factors),
                (Step::Forward, 5) => forward_five(s, block, factors),
                (Step::Forward, _) => forward_eight(s, block, factors),
                (Step::Inverse, 2) => inverse_two(s, block, factors),
                (Step::Inverse, 3) => inverse_three(s, block, factors),
                (Step::Inverse, 4) => inverse_four(s, block, factors),
                (Step::Inverse, 5) => inverse_five(s, block, factors),
                (Step::Inverse, _) => inverse_eight(s, block, factors),
            }
        }
    }
}

/// Butterflies of neighbours, whose factors are all one.
macro_rules! whole {
    ($s:ident, $step:ident, $pairs:ident, $butterfly:ident, $radix:literal, [$($place:literal),*]) => {
        match $step {
            Step::Forward => {
                for x in $pairs.as_chunks_mut::<$radix>().0 {
                    *x = butterfly::$butterfly($s, *x);
                }
            }
            Step::Inverse => {
                for x in $pairs.as_chunks_mut::<$radix>().0 {
                    let y = butterfly::$butterfly($s, [$(swapped(x[$place])),*]);
                    *x = [$(swapped(y[$place])),*];
                }
            }
        }
    };
}

/// The last stage forward, the first one back.
#[inline(always)]
fn last<T: Real, S: Lanes<T>>(s: S, radix: usize, step: Step, pairs: &mut [Pair<S::Pack>]) {
    match radix {
        2 => whole!(s, step, pairs, two, 2, [0, 1]),
        3 => whole!(s, step, pairs, three, 3, [0, 1, 2]),
        4 => whole!(s, step, pairs, four, 4, [0, 1, 2, 3]),
        5 => whole!(s, step, pairs, five, 5, [0, 1, 2, 3, 4]),
        _ => whole!(s, step, pairs, eight, 8, [0, 1, 2, 3, 4, 5, 6, 7]),
    }
}

/// Loops over the places of a block, which is divided into parts `$part`: forward, a butterfly and then factors; inverse, the
/// other way round, with real and imaginary parts exchanged.
macro_rules! stage {
    ($forward:ident, $inverse:ident, $butterfly:ident, $radix:literal, [$($part:ident $place:literal),*]) => {
        #[inline(always)]
        fn $forward<T: Real, S: Lanes<T>>(s: S, block: &mut [Pair<S::Pack>], factors: &[[T; 2]]) {
            let factors = factors.as_chunks::<{ $radix - 1 }>().0;
            let below = factors.len();
            let (first, rest) = block.split_at_mut(below);
            $(let ($part, rest) = rest.split_at_mut(below);)*
            debug_assert!(rest.is_empty(), "a block has {} parts", $radix);
            for j in 0..below {
                let y = butterfly::$butterfly(s, [first[j], $($part[j]),*]);
                first[j] = y[0];
                $($part[j] = times(s, y[$place], factors[j][$place - 1]);)*
            }
        }

        #[inline(always)]
        fn $inverse<T: Real, S: Lanes<T>>(s: S, block: &mut [Pair<S::Pack>], factors: &[[T; 2]]) {
            let factors = factors.as_chunks::<{ $radix - 1 }>().0;
            let below = factors.len();
            let (first, rest) = block.split_at_mut(below);
            $(let ($part, rest) = rest.split_at_mut(below);)*
            debug_assert!(rest.is_empty(), "a block has {} parts", $radix);
            for j in 0..below {
                $(let $part = &mut $part[j];)*
                let y = butterfly::$butterfly(
                    s,
                    [swapped(first[j]), $(times(s, swapped(*$part), factors[j][$place - 1])),*],
                );
                first[j] = swapped(y[0]);
                $(*$part = swapped(y[$place]);)*
            }
        }
    };
}

stage!(forward_two, inverse_two, two, 2, [b 1]);
stage!(forward_three, inverse_three, three, 3, [b 1, c 2]);
stage!(forward_four, inverse_four, four, 4, [b 1, c 2, d 3]);
stage!(forward_five, inverse_five, five, 5, [b 1, c 2, d 3, e 4]);
stage!(forward_eight, inverse_eight, eight, 8, [b 1, c 2, d 3, e 4, f 5, g 6, h 7]);

/// The first stage forward, radix 2 or 4, of a line that is known to be zero beyond `input`, at most half of it.
pub(super) struct FromHalf<'a, T> {
    pub(super) stage: &'a Stage<T>,
    pub(super) input: &'a [T],
    pub(super) values: &'a mut [T],
}

impl<T: Real> Work<T> for FromHalf<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Stage { radix, below, ref factors } = *self.stage;
        let input = s.packs(self.input).as_chunks::<2>().0;
        let block = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        let (first, rest) = block.split_at_mut(below);
        let zero = s.splat(T::zero());
        if radix == 2 {
            let second = &mut rest[..below];
            for (((a, b), from), w) in first.iter_mut().zip(second).zip(input).zip(factors) {
                *a = *from;
                *b = times(s, *from, *w);
            }
            first[input.len().min(below)..].fill([zero; 2]);
            rest[input.len().min(below)..below].fill([zero; 2]);
            return;
        }
        let factors = &factors.as_chunks::<3>().0[..below];
        let (second, rest) = rest.split_at_mut(below);
        let (third, fourth) = rest.split_at_mut(below);
        let fourth = &mut fourth[..below];
        let (low, high) = input.split_at(below.min(input.len()));
        let high = &high[..high.len().min(below)];
        for (j, (a, b)) in low.iter().zip(high).enumerate() {
            let (a, b, w) = (*a, *b, &factors[j]);
            first[j] = add(s, a, b);
            second[j] = times(s, sub_turned(s, a, b), w[0]);
            third[j] = times(s, sub(s, a, b), w[1]);
            fourth[j] = times(s, add_turned(s, a, b), w[2]);
        }
        for (j, w) in factors.iter().enumerate().skip(high.len()) {
            let a = if j < low.len() { low[j] } else { [zero; 2] };
            first[j] = a;
            second[j] = times(s, a, w[0]);
            third[j] = times(s, a, w[1]);
            fourth[j] = times(s, a, w[2]);
        }
    }
}

/// The last stage back, of which only the beginning of the line is wanted, at most half of it.
pub(super) struct ToHalf<'a, T> {
    pub(super) stage: &'a Stage<T>,
    pub(super) values: &'a [T],
    pub(super) output: &'a mut [T],
}

impl<T: Real> Work<T> for ToHalf<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Stage { radix, below, ref factors } = *self.stage;
        let block = s.packs(self.values).as_chunks::<2>().0;
        let output = s.packs_mut(self.output).as_chunks_mut::<2>().0;
        let (first, rest) = block.split_at(below);
        if radix == 2 {
            for (((to, a), b), w) in output.iter_mut().zip(first).zip(rest).zip(factors) {
                *to = swapped(add(s, swapped(*a), times(s, swapped(*b), *w)));
            }
            return;
        }
        let factors = &factors.as_chunks::<3>().0[..below];
        let (second, rest) = rest.split_at(below);
        let (third, fourth) = rest.split_at(below);
        let fourth = &fourth[..below];
        let (low, high) = output.split_at_mut(below.min(output.len()));
        for (j, to) in low.iter_mut().enumerate() {
            let w = &factors[j];
            let (a, b) = (swapped(first[j]), times(s, swapped(second[j]), w[0]));
            let (c, d) = (times(s, swapped(third[j]), w[1]), times(s, swapped(fourth[j]), w[2]));
            *to = swapped(add(s, add(s, a, c), add(s, b, d)));
            if let Some(to) = high.get_mut(j) {
                *to = swapped(sub_turned(s, sub(s, a, c), sub(s, b, d)));
            }
        }
    }
}

/// The last stage forward, a product with real numbers and the first stage back, for blocks that fit into registers:
/// `weights` has a pack for each wave number up to the Nyquist frequency, `fold` the one that belongs to each place.
pub(super) struct Middle<'a, T> {
    pub(super) radix: usize,
    pub(super) values: &'a mut [T],
    pub(super) weights: &'a [T],
    pub(super) fold: &'a [u32],
}

/// A number times its weight, exchanged.
#[inline(always)]
fn weighed<T, S: Lanes<T>>(s: S, a: Pair<S::Pack>, weights: &[S::Pack], place: u32) -> Pair<S::Pack> {
    let weight = weights[place as usize];
    [s.mul(a[1], weight), s.mul(a[0], weight)]
}

/// Butterfly, weights, butterfly for all blocks of a radix.
macro_rules! middle {
    ($s:ident, $pairs:ident, $weights:ident, $fold:ident, $butterfly:ident, $radix:literal, [$($place:literal),*]) => {
        for (x, p) in $pairs.as_chunks_mut::<$radix>().0.iter_mut().zip($fold.as_chunks::<$radix>().0) {
            let y = butterfly::$butterfly($s, *x);
            let y = butterfly::$butterfly($s, [$(weighed($s, y[$place], $weights, p[$place])),*]);
            *x = [$(swapped(y[$place])),*];
        }
    };
}

impl<T: Real> Work<T> for Middle<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let pairs = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        let (weights, fold) = (s.packs(self.weights), self.fold);
        match self.radix {
            2 => middle!(s, pairs, weights, fold, two, 2, [0, 1]),
            3 => middle!(s, pairs, weights, fold, three, 3, [0, 1, 2]),
            4 => middle!(s, pairs, weights, fold, four, 4, [0, 1, 2, 3]),
            5 => middle!(s, pairs, weights, fold, five, 5, [0, 1, 2, 3, 4]),
            _ => middle!(s, pairs, weights, fold, eight, 8, [0, 1, 2, 3, 4, 5, 6, 7]),
        }
    }
}
