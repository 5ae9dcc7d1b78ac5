//! Lines of the first direction: what a kernel has there.

use super::cosine::copy;
use super::separable::{Columns, triangle};
use crate::fft::{FromReals, MOST, Machine};
use crate::kernel::Radial;

/// Those of an array, the first direction running slowest.
pub(super) struct Given<'a> {
    pub(super) values: &'a [f64],
    /// Numbers from one place to the next.
    pub(super) across: usize,
}

impl Columns for Given<'_> {
    fn fill(&self, first: usize, width: usize, out: &mut [f64]) {
        let count = width.min(self.across - first);
        for (from, to) in self.values.chunks_exact(self.across).zip(out.chunks_exact_mut(width)) {
            copy(&from[first..first + count], &mut to[..count]);
            if count < width {
                to[count..].fill(0.0);
            }
        }
    }
}

/// Those of a symmetric array of two directions, of which the numbers with `x <= z` are known, in the order of [`triangle`].
pub(super) struct Half<'a> {
    pub(super) values: &'a [f64],
    /// Numbers of each direction.
    pub(super) n: usize,
    pub(super) machine: &'a Machine,
    /// At least n zeros.
    pub(super) zeros: &'a [f64],
}

impl Half<'_> {
    /// As [`Columns::fill`].
    pub(super) fn fill(&self, first: usize, width: usize, out: &mut [f64]) {
        let Self { values, n, machine, zeros } = *self;
        let end = n.min(first + width);
        // Above the diagonal numbers of columns lie together, below it those of rows.
        for (row, to) in out.chunks_exact_mut(width).enumerate().take(end) {
            let (to, beyond) = to.split_at_mut(end - first);
            if row <= first {
                copy(&values[triangle(row, first, n)..][..to.len()], to);
            } else {
                let at = |z: usize| values[triangle(row.min(z), row.max(z), n)];
                to.iter_mut().zip(first..).for_each(|(to, z)| *to = at(z));
            }
            if !beyond.is_empty() {
                beyond.fill(0.0);
            }
        }
        let (count, lanes) = (n - end, width / 2);
        if count == 0 {
            return;
        }
        let mut rows = (first..end).map(|row| &values[triangle(row, end, n)..][..count]);
        for first in 0..2 {
            let mut lines = [&zeros[..count]; MOST];
            lines[..lanes].iter_mut().zip(&mut rows).for_each(|(to, row)| *to = row);
            let (lines, values) = (&lines[..lanes], &mut out[end * width..]);
            machine.run(FromReals { lines, count, values, first, stride: 2 });
        }
    }
}

/// Values of whole squares of distances.
pub(super) struct Known<'a> {
    pub(super) table: &'a [f64],
    /// Square of the distance of each column from the axis.
    pub(super) across: &'a [usize],
}

impl Columns for Known<'_> {
    fn fill(&self, first: usize, width: usize, out: &mut [f64]) {
        let across = &self.across[first..];
        for (place, to) in out.chunks_exact_mut(width).enumerate() {
            let table = &self.table[place * place..];
            to.iter_mut().zip(across).for_each(|(to, square)| *to = table[*square]);
            if across.len() < width {
                to[across.len()..].fill(0.0);
            }
        }
    }
}

/// Values where they are wanted.
pub(super) struct Evaluated<'a, K: ?Sized> {
    pub(super) kernel: &'a K,
    pub(super) unit: f64,
    /// Squares of distances along the axis and from it, in units of the square of the unit.
    pub(super) along: &'a [f64],
    pub(super) across: &'a [f64],
}

impl<K: Radial + ?Sized> Columns for Evaluated<'_, K> {
    fn fill(&self, first: usize, width: usize, out: &mut [f64]) {
        let across = &self.across[first..];
        for (along, to) in self.along.iter().zip(out.chunks_exact_mut(width)) {
            to.iter_mut().zip(across).for_each(|(to, across)| *to = along + across);
            if across.len() < width {
                to[across.len()..].fill(*along);
            }
        }
        self.kernel.values(self.unit, out);
        if across.len() < width {
            out.chunks_exact_mut(width).for_each(|to| to[across.len()..].fill(0.0));
        }
    }
}
