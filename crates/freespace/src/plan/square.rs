//! Values of a kernel at the offsets of a square, of which half are evaluated.

use rayon::prelude::*;

use super::separable::{Columns, Separable};
use crate::kernel::Radial;

/// Of each group of columns the numbers down to the diagonal, row behind row, so that tiles of as many rows as columns lie together; those
/// below the diagonal are those above it with rows and columns exchanged.
pub(super) struct Square {
    values: Vec<f64>,
    /// Offsets of each direction.
    n: usize,
}

/// Where the tiles of a group begin.
fn place(group: usize, width: usize) -> usize {
    group * (group + 1) / 2 * width * width
}

impl Square {
    /// From the squares of the offsets, in units of the square of the unit. The memory has room for what is done with the columns.
    pub(super) fn new(kernel: &dyn Radial, unit: f64, squares: &[f64], done: &Separable) -> Self {
        let (n, width) = (squares.len(), done.width());
        let count = n.div_ceil(width);
        let mut values = vec![0.0; done.count().max(place(count, width))];
        let (mut groups, mut rest) = (Vec::with_capacity(count), &mut values[..]);
        for group in 0..count {
            let (this, others) = std::mem::take(&mut rest).split_at_mut((group + 1) * width * width);
            groups.push(this);
            rest = others;
        }
        groups.into_par_iter().enumerate().for_each(|(group, values)| {
            let columns = &squares[group * width..n.min((group + 1) * width)];
            for (row, values) in values.chunks_exact_mut(width).enumerate() {
                // Where there is no column, and beyond the last row, some number that the kernel has a value for.
                let along = squares[row.min(n - 1)];
                values.iter_mut().zip(columns).for_each(|(value, across)| *value = along + across);
                values[columns.len()..].fill(along);
            }
            kernel.values(unit, values);
            if columns.len() < width {
                values.chunks_exact_mut(width).for_each(|row| row[columns.len()..].fill(0.0));
            }
        });
        Self { values, n }
    }
}

impl Columns for Square {
    fn fill(&self, first: usize, width: usize, out: &mut [f64]) {
        let (group, tile) = (first / width, width * width);
        for (below, out) in out[..self.n * width].chunks_mut(tile).enumerate() {
            if below <= group {
                let from = &self.values[place(group, width) + below * tile..];
                out.copy_from_slice(&from[..out.len()]);
                continue;
            }
            let from = &self.values[place(below, width) + group * tile..][..tile];
            for (row, out) in out.chunks_exact_mut(width).enumerate() {
                let column = from[row..].iter().step_by(width);
                out.iter_mut().zip(column).for_each(|(to, value)| *to = *value);
            }
        }
    }

    fn room(self) -> Vec<f64> {
        self.values
    }
}
