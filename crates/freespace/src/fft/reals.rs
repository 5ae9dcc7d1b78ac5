//! Real lines: as many in the real parts as in the imaginary parts of packs, since the transforms of two real lines can be told
//! apart by their symmetry.

use super::lanes::{Lanes, Pair, Work, times};
use crate::plan::Real;

/// Takes the first `count` numbers of as many lines as there are lanes, to every `stride`-th pack from `first` on.
pub(crate) struct FromReals<'a, T> {
    pub(crate) lines: &'a [&'a [T]],
    pub(crate) count: usize,
    pub(crate) values: &'a mut [T],
    pub(crate) first: usize,
    pub(crate) stride: usize,
}

impl<T: Real> Work<T> for FromReals<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Self { lines, count, values, first, stride } = self;
        let mut done = 0;
        if let [a, b, c, d] = lines
            && S::COUNT == 4
        {
            let packs = &mut s.packs_mut(values)[first..];
            let rows = s.packs(&a[..count]).iter().zip(s.packs(&b[..count]));
            let rows = rows.zip(s.packs(&c[..count])).zip(s.packs(&d[..count]));
            for (to, (((a, b), c), d)) in packs.chunks_mut(4 * stride).zip(rows) {
                let places = s.transpose([*a, *b, *c, *d]);
                to[0] = places[0];
                to[stride] = places[1];
                to[2 * stride] = places[2];
                to[3 * stride] = places[3];
                done += 4;
            }
        }
        for (lane, line) in lines.iter().enumerate() {
            for (place, value) in line[..count].iter().enumerate().skip(done) {
                values[(first + place * stride) * S::COUNT + lane] = *value;
            }
        }
    }
}

/// Puts the first `count` numbers back into up to as many lines as there are lanes.
pub(crate) struct ToReals<'a, 'b, T> {
    pub(crate) lines: &'a mut [&'b mut [T]],
    pub(crate) count: usize,
    pub(crate) values: &'a [T],
    pub(crate) first: usize,
    pub(crate) stride: usize,
}

impl<T: Real> Work<T> for ToReals<'_, '_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Self { lines, count, values, first, stride } = self;
        let mut done = 0;
        if let [a, b, c, d] = &mut lines[..]
            && S::COUNT == 4
        {
            let packs = &s.packs(values)[first..];
            let rows = s.packs_mut(&mut a[..count]).iter_mut().zip(s.packs_mut(&mut b[..count]));
            let rows = rows.zip(s.packs_mut(&mut c[..count])).zip(s.packs_mut(&mut d[..count]));
            for (from, (((a, b), c), d)) in packs.chunks(4 * stride).zip(rows) {
                [*a, *b, *c, *d] = s.transpose([from[0], from[stride], from[2 * stride], from[3 * stride]]);
                done += 4;
            }
        }
        for (lane, line) in lines.iter_mut().enumerate() {
            for (place, value) in line[..count].iter_mut().enumerate().skip(done) {
                *value = values[(first + place * stride) * S::COUNT + lane];
            }
        }
    }
}

/// Rows of a spectrum, one for each wave number, in each the packs of two groups of lines, and of as many more as there are.
pub(crate) struct Spectrum<R> {
    pub(crate) rows: R,
    /// Numbers from one row to the next.
    pub(crate) row: usize,
    /// Numbers before the lines in each row.
    pub(crate) at: usize,
}

/// Twice the spectra of the real lines, from transforms of packs: at wave number k, `z_k` and `z_-k` lie at `places[k]`.
pub(crate) struct Untangle<'a, T> {
    /// Transforms.
    pub(crate) values: &'a [T],
    /// Numbers from one to the next.
    pub(crate) pitch: usize,
    pub(crate) places: &'a [[u32; 2]],
    pub(crate) spectrum: Spectrum<&'a mut [T]>,
}

impl<T: Real> Work<T> for Untangle<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let pitch = self.pitch / (2 * S::COUNT);
        let pairs = s.packs(self.values).as_chunks::<2>().0;
        let Spectrum { rows, row, at } = self.spectrum;
        for (row, [p, q]) in rows.chunks_exact_mut(row).zip(self.places) {
            let (p, q) = (*p as usize, *q as usize);
            let row = s.packs_mut(&mut row[at..]).as_chunks_mut::<4>().0;
            for (to, pairs) in row.iter_mut().zip(pairs.chunks(pitch)) {
                let (z, w) = (pairs[p], pairs[q]);
                *to = [s.add(z[0], w[0]), s.sub(z[1], w[1]), s.add(z[1], w[1]), s.sub(w[0], z[0])];
            }
        }
    }
}

/// The inverse, times a complex factor for each wave number.
pub(crate) struct Tangle<'a, T> {
    pub(crate) values: &'a mut [T],
    pub(crate) pitch: usize,
    pub(crate) places: &'a [[u32; 2]],
    pub(crate) spectrum: Spectrum<&'a [T]>,
    pub(crate) factors: Option<&'a [[T; 2]]>,
}

impl<T: Real> Work<T> for Tangle<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let pitch = self.pitch / (2 * S::COUNT);
        let pairs = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        let Spectrum { rows, row, at } = self.spectrum;
        for (k, (row, [p, q])) in rows.chunks_exact(row).zip(self.places).enumerate() {
            let (p, q) = (*p as usize, *q as usize);
            let row = s.packs(&row[at..]).as_chunks::<4>().0;
            for (from, pairs) in row.iter().zip(pairs.chunks_mut(pitch)) {
                let (mut even, mut odd): (Pair<S::Pack>, Pair<S::Pack>) =
                    ([from[0], from[1]], [from[2], from[3]]);
                if let Some(factors) = self.factors {
                    even = times(s, even, factors[k]);
                    odd = times(s, odd, factors[k]);
                }
                // The spectrum of a real line is real at both ends, up to round-off.
                if p == q {
                    pairs[p] = [even[0], odd[0]];
                } else {
                    pairs[p] = [s.sub(even[0], odd[1]), s.add(even[1], odd[0])];
                    pairs[q] = [s.add(even[0], odd[1]), s.sub(odd[0], even[1])];
                }
            }
        }
    }
}
