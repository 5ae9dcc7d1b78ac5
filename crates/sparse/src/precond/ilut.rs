//! Incomplete factors with dual threshold: Y. Saad, "ILUT: a dual threshold incomplete LU factorization", Numerical
//! Linear Algebra with Applications 1 (1994) 387-402.

use super::factors::{IncompleteLu, safe_reciprocal};
use crate::csr::Csr;
use crate::error::MatrixError;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Factors that keep, in each row of `L` and of `U`, as many entries as the matrix has there plus `fill`, the largest
/// ones, and none below `drop` times the root mean square of the row. Pivots that are almost zero are replaced and
/// counted.
///
/// # Errors
/// [`MatrixError::NotSquare`].
pub fn ilut(matrix: &Csr, fill: usize, drop: f64) -> Result<IncompleteLu, MatrixError> {
    matrix.require_square()?;
    let n = matrix.nrows();
    let mut lu = IncompleteLu {
        name: format!("ILUT({fill}, {drop:e})"),
        offsets: vec![0],
        diagonal: Vec::with_capacity(n),
        indices: Vec::new(),
        values: Vec::new(),
        replaced: 0,
    };
    let mut work = Row::new(n);
    for i in 0..n {
        let (columns, values) = matrix.row(i);
        let size = (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt();
        let row_max = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        work.load(i, columns, values);
        work.eliminate(&lu, drop * size);
        let below = columns.partition_point(|&j| (j as usize) < i);
        work.keep_largest(below + fill, (columns.len() - below).saturating_sub(1) + fill, drop * size);
        lu.indices.extend(work.lower.iter().map(|e| e.0));
        lu.values.extend(work.lower.iter().map(|e| e.1));
        let (reciprocal, replaced) = safe_reciprocal(work.diagonal, row_max);
        lu.replaced += usize::from(replaced);
        lu.diagonal.push(lu.indices.len());
        lu.indices.push(i as u32);
        lu.values.push(reciprocal);
        lu.indices.extend(work.upper.iter().map(|e| e.0));
        lu.values.extend(work.upper.iter().map(|e| e.1));
        lu.offsets.push(lu.indices.len());
    }
    Ok(lu)
}

/// One row during its elimination: dense values, and which of them are there.
struct Row {
    i: usize,
    value: Vec<f64>,
    present: Vec<bool>,
    /// Columns before the diagonal that are still to be eliminated, the lowest first.
    pending: BinaryHeap<Reverse<u32>>,
    /// Columns from the diagonal on.
    right: Vec<u32>,
    lower: Vec<(u32, f64)>,
    upper: Vec<(u32, f64)>,
    diagonal: f64,
}

impl Row {
    fn new(n: usize) -> Self {
        Self {
            i: 0,
            value: vec![0.0; n],
            present: vec![false; n],
            pending: BinaryHeap::new(),
            right: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            diagonal: 0.0,
        }
    }

    fn load(&mut self, i: usize, columns: &[u32], values: &[f64]) {
        self.i = i;
        self.right.clear();
        self.lower.clear();
        self.upper.clear();
        for (&j, &a) in columns.iter().zip(values) {
            self.add(j, a);
        }
    }

    fn add(&mut self, j: u32, a: f64) {
        let place = j as usize;
        self.value[place] += a;
        if !self.present[place] {
            self.present[place] = true;
            if place < self.i {
                self.pending.push(Reverse(j));
            } else {
                self.right.push(j);
            }
        }
    }

    fn take(&mut self, j: u32) -> f64 {
        self.present[j as usize] = false;
        std::mem::take(&mut self.value[j as usize])
    }

    fn eliminate(&mut self, lu: &IncompleteLu, threshold: f64) {
        while let Some(Reverse(k)) = self.pending.pop() {
            let pivot = lu.diagonal[k as usize];
            let multiplier = self.take(k) * lu.values[pivot];
            if multiplier.abs() <= threshold {
                continue;
            }
            self.lower.push((k, multiplier));
            for place in pivot + 1..lu.offsets[k as usize + 1] {
                self.add(lu.indices[place], -multiplier * lu.values[place]);
            }
        }
    }

    /// Sorts what is left into the two factors and forgets the smallest.
    fn keep_largest(&mut self, keep_lower: usize, keep_upper: usize, threshold: f64) {
        self.diagonal = 0.0;
        for j in std::mem::take(&mut self.right) {
            let value = self.take(j);
            if j as usize == self.i {
                self.diagonal = value;
            } else if value.abs() > threshold {
                self.upper.push((j, value));
            }
        }
        truncate_to_largest(&mut self.lower, keep_lower);
        truncate_to_largest(&mut self.upper, keep_upper);
    }
}

/// The `keep` entries of largest size (of equals, those of the lowest column), sorted by column.
fn truncate_to_largest(entries: &mut Vec<(u32, f64)>, keep: usize) {
    if entries.len() > keep {
        entries.sort_unstable_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
        entries.truncate(keep);
    }
    entries.sort_unstable_by_key(|e| e.0);
}
