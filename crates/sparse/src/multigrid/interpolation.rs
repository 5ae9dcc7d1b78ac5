//! Prolongation and restriction as they are kept.

use crate::csr::{Csr, for_each_row};
use std::ops::Range;

/// Weights are multiples of this, or of a larger power of two in rows with weights above [`LARGEST`]: single precision holds them
/// and the sums of rows exactly.
const UNIT: f64 = 1.0 / 4_194_304.0;

/// The largest weight that is a multiple of [`UNIT`] in single precision.
const LARGEST: f64 = 4.0;

/// A sum of weights that differs from 1 by less is 1.
const ROUNDING: f64 = 1e-12;

/// Rows of weights in single precision, with the sums that they had in double precision: what is constant stays so exactly, however
/// large the entries that will multiply the differences.
#[derive(Debug, Clone)]
pub(crate) struct Interpolation {
    ncols: usize,
    offsets: Vec<u32>,
    indices: Vec<u32>,
    values: Vec<f32>,
}

impl Interpolation {
    /// The rows of a matrix, rounded.
    pub(crate) fn new(rows: Csr) -> Self {
        let ncols = rows.ncols();
        let (offsets, indices, values) = rows.into_parts();
        let mut rounded = vec![0.0; values.len()];
        for row in offsets.windows(2) {
            round(&values[row[0]..row[1]], &mut rounded[row[0]..row[1]]);
        }
        let offsets = offsets.into_iter().map(|o| o as u32).collect();
        Self { ncols, offsets, indices, values: rounded }
    }

    pub(crate) fn transposed(&self) -> Self {
        let mut offsets = vec![0; self.ncols + 1];
        self.indices.iter().for_each(|&j| offsets[j as usize + 1] += 1);
        for j in 0..self.ncols {
            offsets[j + 1] += offsets[j];
        }
        let mut next = offsets.clone();
        let (mut indices, mut values) = (vec![0; self.indices.len()], vec![0.0; self.values.len()]);
        for i in 0..self.nrows() {
            for (j, value) in self.row(i) {
                let place = next[j] as usize;
                next[j] += 1;
                (indices[place], values[place]) = (i as u32, value as f32);
            }
        }
        Self { ncols: self.nrows(), offsets, indices, values }
    }

    pub(crate) fn nrows(&self) -> usize {
        self.offsets.len() - 1
    }

    pub(crate) fn ncols(&self) -> usize {
        self.ncols
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.offsets) + size_of_val(&*self.indices) + size_of_val(&*self.values)
    }

    /// Columns and weights of row `i`.
    #[inline]
    pub(crate) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.offsets[i] as usize..self.offsets[i + 1] as usize;
        let columns = self.indices[range.clone()].iter().map(|&j| j as usize);
        columns.zip(self.values[range].iter().map(|&v| f64::from(v)))
    }

    /// The columns of row `i` that are within a range, and their weights.
    pub(crate) fn row_within(&self, i: usize, columns: Range<usize>) -> impl Iterator<Item = (usize, f64)> {
        let (start, end) = (self.offsets[i] as usize, self.offsets[i + 1] as usize);
        let before = |j: usize| start + self.indices[start..end].partition_point(|&k| (k as usize) < j);
        let range = before(columns.start)..before(columns.end);
        let values = self.values[range.clone()].iter().map(|&v| f64::from(v));
        self.indices[range].iter().map(|&j| j as usize).zip(values)
    }

    pub(crate) fn is_empty(&self, i: usize) -> bool {
        self.offsets[i] == self.offsets[i + 1]
    }

    /// `y = W x`
    pub(crate) fn mul_vec(&self, x: &[f64], y: &mut [f64]) {
        for_each_row(y, |i, y| *y = self.row_product(i, x));
    }

    /// `y += diag(units) W x`
    pub(crate) fn add_to(&self, x: &[f64], y: &mut [f64], unit: impl Fn(usize) -> f64 + Sync) {
        for_each_row(y, |i, y| *y += unit(i) * self.row_product(i, x));
    }

    #[inline]
    fn row_product(&self, i: usize, x: &[f64]) -> f64 {
        self.row(i).fold(0.0, |sum, (j, w)| sum + w * x[j])
    }

    #[cfg(test)]
    pub(crate) fn to_csr(&self) -> Csr {
        let offsets = self.offsets.iter().map(|&o| o as usize).collect();
        let values = self.values.iter().map(|&v| f64::from(v)).collect();
        Csr::from_trusted(self.ncols, offsets, self.indices.clone(), values)
    }
}

/// Rounds the weights of a row; the largest takes what the others are changed by.
fn round(row: &[f64], rounded: &mut [f32]) {
    let size = |w: f64| w.abs();
    let Some(largest) = (0..row.len()).reduce(|k, l| if size(row[l]) > size(row[k]) { l } else { k }) else {
        return;
    };
    let unit = UNIT * (size(row[largest]) / LARGEST).log2().ceil().max(0.0).exp2();
    let to_unit = |w: f64| (w / unit).round() * unit;
    let sum: f64 = row.iter().sum();
    let mut rest = if (sum - 1.0).abs() <= ROUNDING { 1.0 } else { sum };
    for (k, (w, rounded)) in row.iter().zip(&mut *rounded).enumerate() {
        if k != largest {
            *rounded = to_unit(*w) as f32;
            rest -= f64::from(*rounded);
        }
    }
    rounded[largest] = rest as f32;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_rows_are_exact_and_weights_nearly() {
        let weights =
            [vec![0.1, 0.2, 0.7], vec![1.0 / 3.0; 3], vec![1e-9, 5.5, -4.5 - 1e-9], vec![], vec![0.25]];
        let rows =
            Csr::from_rows(5, 3, |i, row| weights[i].iter().enumerate().for_each(|(j, &w)| row.push(j, w)));
        let p = Interpolation::new(rows.unwrap());
        for (i, weights) in weights.iter().enumerate() {
            let sum: f64 = p.row(i).map(|(_, w)| w).sum();
            assert_eq!(sum, [1.0, 1.0, 1.0, 0.0, 0.25][i]);
            assert!(p.row(i).zip(weights).all(|((_, w), exact)| (w - exact).abs() < 1e-6));
        }
        let (mut x, r) = (vec![1.0; 5], p.transposed());
        p.add_to(&[1.0; 3], &mut x, |i| i as f64);
        assert_eq!(x, [1.0, 2.0, 3.0, 1.0, 2.0]);
        assert_eq!((r.nrows(), r.ncols(), r.to_csr()), (3, 5, p.to_csr().transpose()));
    }
}
