//! All equations of a bordered system as one sparse matrix.
//!
//! As `w = 0` at the pinned nodes, their columns and the elements of vectors that belong to them are free, and hold the extra
//! unknowns.

use super::bordered::Bordered;
use crate::csr::Csr;
use crate::solver::Residuals;

/// What the rows of the pinned nodes hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PinnedRows {
    /// Their equations, which determine the extra unknowns: the matrix is `[A' B'; C D]`.
    Equations,
    /// Ones on the diagonal: the matrix is `[A' B'; 0 1]`, a preconditioner's part of it.
    Identity,
}

/// The matrix whose columns are multiplied by `column(j)`, those of the extra unknowns left as they are.
pub(super) fn matrix(system: &Bordered, rows: PinnedRows, column: impl Fn(usize) -> f64) -> Csr {
    let a = system.matrix().to_csr();
    let pin_of = system.pin_of();
    let mut entries: Vec<(u32, u32, f64)> = Vec::new();
    for (&p, column) in system.pinned().iter().zip(system.columns()) {
        entries.extend(column.iter().map(|&(row, value)| (row, p, value)));
    }
    entries.sort_unstable_by_key(|e| (e.0, e.1));
    let mut offsets = vec![0];
    let (mut indices, mut values) = (Vec::with_capacity(a.nnz()), Vec::with_capacity(a.nnz()));
    let mut next = 0;
    for i in 0..a.nrows() {
        let start = next;
        while entries.get(next).is_some_and(|e| e.0 as usize == i) {
            next += 1;
        }
        if pin_of[i].is_some() && rows == PinnedRows::Identity {
            indices.push(i as u32);
            values.push(1.0);
        } else {
            let (columns, row) = a.row(i);
            let mut border = entries[start..next].iter().peekable();
            for (&j, &v) in columns.iter().zip(row).filter(|(j, _)| pin_of[**j as usize].is_none()) {
                while let Some(&&(_, p, value)) = border.peek().filter(|e| e.1 < j) {
                    push_sum(&mut indices, &mut values, offsets[i], p, value);
                    border.next();
                }
                indices.push(j);
                values.push(v * column(j as usize));
            }
            border.for_each(|&(_, p, value)| push_sum(&mut indices, &mut values, offsets[i], p, value));
        }
        offsets.push(indices.len());
    }
    Csr::from_trusted(a.nrows(), offsets, indices, values)
}

/// Appends an entry to the row that began at `start`, or adds to its last one where that is of the same column.
fn push_sum(indices: &mut Vec<u32>, values: &mut Vec<f64>, start: usize, column: u32, value: f64) {
    match (indices[start..].last(), values.last_mut()) {
        (Some(&last), Some(sum)) if last == column => *sum += value,
        _ => {
            indices.push(column);
            values.push(value);
        }
    }
}

/// Takes the extra unknowns out of the places of the pinned nodes, where `w` is zero.
pub(super) fn take_extra(system: &Bordered, x: &mut [f64]) -> Vec<f64> {
    system.pinned().iter().map(|&p| std::mem::take(&mut x[p as usize])).collect()
}

/// All equations, their rows multiplied by powers of two, with residuals formed by differences.
pub(super) struct Equations<'a> {
    pub(super) system: &'a Bordered,
    /// What the rows are multiplied by.
    pub(super) factors: &'a [f64],
    /// Whether the unknowns of the nodes are `s w` instead of `w`.
    pub(super) scaled: bool,
}

impl Equations<'_> {
    /// The unknowns and the right-hand side as [`Bordered`] has them.
    pub(super) fn unscaled(&self, x: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let mut w = x.to_vec();
        let extra = take_extra(self.system, &mut w);
        if self.scaled {
            self.system.unscale(&mut w);
        }
        // Factors are powers of two: nothing is rounded.
        let rhs = b.iter().zip(self.factors).map(|(b, f)| b / f).collect();
        (w, extra, rhs)
    }
}

impl Residuals for Equations<'_> {
    fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        let (w, extra, rhs) = self.unscaled(x, b);
        self.system.residual_into(&rhs, &w, &extra, r);
        r.iter_mut().zip(self.factors).for_each(|(r, f)| *r *= f);
    }

    fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        let (w, extra, rhs) = self.unscaled(x, b);
        self.system.backward_error(&rhs, &w, &extra)
    }
}
