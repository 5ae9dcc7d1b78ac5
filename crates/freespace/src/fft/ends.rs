//! From lines of one direction to those of another, which are its columns: squares of numbers exchange rows and columns.

use super::lanes::{Lanes, Work};
use crate::plan::Real;

/// From packs of lines to packs of their columns.
pub(crate) struct ToColumns<'a, T> {
    /// Lines, a lane for each.
    pub(crate) values: &'a [T],
    /// For each pack of columns, where in the lines they are.
    pub(crate) places: &'a [u32],
    /// Packs of columns.
    pub(crate) columns: &'a mut [T],
    /// Numbers from one of them to the next.
    pub(crate) pitch: usize,
    /// Numbers before the lines in each.
    pub(crate) at: usize,
}

impl<T: Real> Work<T> for ToColumns<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Self { values, places, columns, pitch, at } = self;
        let lanes = S::COUNT;
        if lanes == 4 {
            let pairs = s.packs(values).as_chunks::<2>().0;
            for ([a, b, c, d], columns) in places.as_chunks::<4>().0.iter().zip(columns.chunks_mut(pitch)) {
                let (a, b) = (pairs[*a as usize], pairs[*b as usize]);
                let (c, d) = (pairs[*c as usize], pairs[*d as usize]);
                let re = s.transpose([a[0], b[0], c[0], d[0]]);
                let im = s.transpose([a[1], b[1], c[1], d[1]]);
                if let [p, q, u, v, ..] = s.packs_mut(&mut columns[at..]).as_chunks_mut::<2>().0 {
                    *p = [re[0], im[0]];
                    *q = [re[1], im[1]];
                    *u = [re[2], im[2]];
                    *v = [re[3], im[3]];
                }
            }
            return;
        }
        for (places, columns) in places.chunks_exact(lanes).zip(columns.chunks_mut(pitch)) {
            for (lane, place) in places.iter().enumerate() {
                let line = &values[2 * lanes * *place as usize..][..2 * lanes];
                let to = columns[at + lane..].iter_mut().step_by(lanes);
                let turns = line[..lanes].iter().zip(&line[lanes..]).flat_map(|(re, im)| [*re, *im]);
                to.zip(turns).for_each(|(to, value)| *to = value);
            }
        }
    }
}

/// And back.
pub(crate) struct FromColumns<'a, T> {
    pub(crate) columns: &'a [T],
    pub(crate) places: &'a [u32],
    pub(crate) pitch: usize,
    pub(crate) at: usize,
    pub(crate) values: &'a mut [T],
}

impl<T: Real> Work<T> for FromColumns<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Self { columns, places, pitch, at, values } = self;
        let lanes = S::COUNT;
        if lanes == 4 {
            let pairs = s.packs_mut(values).as_chunks_mut::<2>().0;
            for ([a, b, c, d], columns) in places.as_chunks::<4>().0.iter().zip(columns.chunks(pitch)) {
                let [p, q, u, v, ..] = s.packs(&columns[at..]).as_chunks::<2>().0 else { continue };
                let re = s.transpose([p[0], q[0], u[0], v[0]]);
                let im = s.transpose([p[1], q[1], u[1], v[1]]);
                pairs[*a as usize] = [re[0], im[0]];
                pairs[*b as usize] = [re[1], im[1]];
                pairs[*c as usize] = [re[2], im[2]];
                pairs[*d as usize] = [re[3], im[3]];
            }
            return;
        }
        for (places, columns) in places.chunks_exact(lanes).zip(columns.chunks(pitch)) {
            for (lane, place) in places.iter().enumerate() {
                let (re, im) = values[2 * lanes * *place as usize..][..2 * lanes].split_at_mut(lanes);
                let from = columns[at + lane..].chunks(2 * lanes);
                for ((re, im), from) in re.iter_mut().zip(im).zip(from) {
                    (*re, *im) = (from[0], from[lanes]);
                }
            }
        }
    }
}
