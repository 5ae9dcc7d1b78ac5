//! Between arrays, in which the parts of a complex number follow each other, and packs of lines.
//!
//! Lines that run across rows are brought into packs by exchanging two vectors, those that run along rows by exchanging rows and
//! columns of small squares. Rows must go on for a cache line beyond what counts.

use super::lanes::{Lanes, Pair, Work};
use crate::plan::Real;

/// Takes the columns of `rows` from the complex number `at` on; what there are no rows for is zero.
pub(crate) struct FromColumns<'a, T> {
    pub(crate) rows: &'a [&'a mut [T]],
    pub(crate) at: usize,
    pub(crate) values: &'a mut [T],
}

#[inline(always)]
fn zero<T: Real, S: Lanes<T>>(s: S, pairs: &mut [Pair<S::Pack>]) {
    let zero = s.splat(T::zero());
    for pair in pairs {
        *pair = [zero; 2];
    }
}

impl<T: Real> Work<T> for FromColumns<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let pairs = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        let count = self.rows.len().min(pairs.len());
        let (filled, rest) = pairs.split_at_mut(count);
        for (row, pair) in self.rows.iter().zip(filled) {
            if let [a, b, ..] = s.packs(&row[2 * self.at..]) {
                *pair = s.split([*a, *b]);
            }
        }
        zero(s, rest);
    }
}

/// Puts lines into the columns of `rows` from the complex number `at` on.
pub(crate) struct ToColumns<'a, 'b, T> {
    pub(crate) rows: &'a mut [&'b mut [T]],
    pub(crate) at: usize,
    pub(crate) values: &'a [T],
}

impl<T: Real> Work<T> for ToColumns<'_, '_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let pairs = s.packs(self.values).as_chunks::<2>().0;
        for (row, pair) in self.rows.iter_mut().zip(pairs) {
            if let [a, b, ..] = s.packs_mut(&mut row[2 * self.at..]) {
                [*a, *b] = s.join(*pair);
            }
        }
    }
}

/// Takes the first `count` complex numbers of up to as many lines as there are lanes; the rest is zero.
pub(crate) struct FromLines<'a, T> {
    pub(crate) lines: &'a [&'a [T]],
    pub(crate) count: usize,
    pub(crate) values: &'a mut [T],
}

impl<T: Real> Work<T> for FromLines<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Self { lines, count, values } = self;
        match lines {
            [a, b, c, d] if S::COUNT == 4 => {
                let pairs = s.packs_mut(values).as_chunks_mut::<2>().0;
                let [a, b, c, d] = [s.packs(a), s.packs(b), s.packs(c), s.packs(d)];
                let rows = a.iter().zip(b).zip(c).zip(d);
                for (two, (((a, b), c), d)) in pairs.chunks_mut(2).take(count.div_ceil(2)).zip(rows) {
                    let [p, q, u, v] = s.transpose([*a, *b, *c, *d]);
                    two[0] = [p, q];
                    if let Some(second) = two.get_mut(1) {
                        *second = [u, v];
                    }
                }
            }
            _ => {
                for (lane, line) in lines.iter().enumerate() {
                    let places = values.chunks_exact_mut(S::COUNT).take(2 * count);
                    places.zip(*line).for_each(|(pack, value)| pack[lane] = *value);
                }
            }
        }
        zero(s, &mut s.packs_mut(values).as_chunks_mut::<2>().0[count..]);
    }
}

/// Puts the first `count` complex numbers back into lines.
pub(crate) struct ToLines<'a, 'b, T> {
    pub(crate) lines: &'a mut [&'b mut [T]],
    pub(crate) count: usize,
    pub(crate) values: &'a [T],
}

impl<T: Real> Work<T> for ToLines<'_, '_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Self { lines, count, values } = self;
        match lines {
            [a, b, c, d] if S::COUNT == 4 => {
                let pairs = s.packs(values).as_chunks::<2>().0;
                let [a, b, c, d] = [s.packs_mut(a), s.packs_mut(b), s.packs_mut(c), s.packs_mut(d)];
                let rows = a.iter_mut().zip(b).zip(c).zip(d);
                for (two, (((a, b), c), d)) in pairs.chunks(2).take(count.div_ceil(2)).zip(rows) {
                    let (first, second) = (two[0], two[two.len() - 1]);
                    [*a, *b, *c, *d] = s.transpose_back([first[0], first[1], second[0], second[1]]);
                }
            }
            _ => {
                for (lane, line) in lines.iter_mut().enumerate() {
                    let places = values.chunks_exact(S::COUNT).take(2 * count);
                    places.zip(line.iter_mut()).for_each(|(pack, value)| *value = pack[lane]);
                }
            }
        }
    }
}
