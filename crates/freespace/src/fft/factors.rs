//! Products of packs of lines with factors.

use super::lanes::{Lanes, Work, times};
use crate::plan::Real;

/// A real factor, or one that is imaginary, as the product of what belongs to the place in a line and of what belongs to the
/// line.
#[derive(Clone, Copy)]
pub(crate) struct Factor<'a, T> {
    /// One for each place; one everywhere if none.
    pub(crate) along: Option<&'a [T]>,
    /// One for each lane.
    pub(crate) across: &'a [T],
    /// Whether it is times i.
    pub(crate) turned: bool,
}

/// `values = factor source`, or `values += factor source`.
pub(crate) struct Accumulate<'a, T> {
    pub(crate) source: &'a [T],
    pub(crate) factor: Factor<'a, T>,
    pub(crate) add: bool,
    pub(crate) values: &'a mut [T],
}

impl<T: Real> Work<T> for Accumulate<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Factor { along, across, turned } = self.factor;
        let (values, source) = (s.packs_mut(self.values), s.packs(self.source));
        let Some(&across) = s.packs(across).first() else { return };
        let (zero, one) = (s.splat(T::zero()), [T::one()]);
        let along = along.unwrap_or(&one);
        let pairs = values.as_chunks_mut::<2>().0.iter_mut().zip(source.as_chunks::<2>().0);
        for (place, (to, from)) in pairs.enumerate() {
            let factor = s.mul(across, s.splat(along[if along.len() > 1 { place } else { 0 }]));
            let [re, im] = if self.add { *to } else { [zero; 2] };
            *to = if turned {
                [s.mul_sub_from(from[1], factor, re), s.mul_add(from[0], factor, im)]
            } else {
                [s.mul_add(from[0], factor, re), s.mul_add(from[1], factor, im)]
            };
        }
    }
}

/// Multiplies each line by a complex factor; the real parts of these come before the imaginary ones.
pub(crate) struct Turn<'a, T> {
    pub(crate) across: &'a [T],
    pub(crate) values: &'a mut [T],
}

impl<T: Real> Work<T> for Turn<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let [re, im, ..] = *s.packs(self.across) else { return };
        for pair in s.packs_mut(self.values).as_chunks_mut::<2>().0 {
            let [a, b] = *pair;
            *pair = [s.mul_sub_from(b, im, s.mul(a, re)), s.mul_add(b, re, s.mul(a, im))];
        }
    }
}

/// Multiplies places by complex factors.
pub(crate) struct Move<'a, T> {
    pub(crate) along: &'a [[T; 2]],
    pub(crate) values: &'a mut [T],
}

impl<T: Real> Work<T> for Move<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        for (pair, w) in s.packs_mut(self.values).as_chunks_mut::<2>().0.iter_mut().zip(self.along) {
            *pair = times(s, *pair, *w);
        }
    }
}

/// Multiplies each place by the weights of its wave number.
pub(crate) struct Weigh<'a, T> {
    pub(crate) values: &'a mut [T],
    pub(crate) weights: &'a [T],
    pub(crate) fold: &'a [u32],
}

impl<T: Real> Work<T> for Weigh<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let weights = s.packs(self.weights);
        let pairs = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        for (pair, place) in pairs.iter_mut().zip(self.fold) {
            let weight = weights[*place as usize];
            *pair = [s.mul(pair[0], weight), s.mul(pair[1], weight)];
        }
    }
}
