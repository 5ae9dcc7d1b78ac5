//! Incomplete LU factorisation without fill: ILU(0).
//!
//! Y. Saad, *Iterative Methods for Sparse Linear Systems*, 2nd ed., section 10.3.2 (the IKJ variant on the pattern of A).

use crate::{Csr, SolveError};

/// A pivot smaller than this, relative to the largest entry of its row, is replaced by that much.
const SMALLEST_PIVOT: f64 = 1e-10;

/// Factors L (unit diagonal) and U on the pattern of the matrix, in one array.
#[derive(Debug, Clone)]
pub(crate) struct Ilu0 {
    offsets: Vec<usize>,
    indices: Vec<u32>,
    values: Vec<f64>,
    diagonal: Vec<usize>,
}

impl Ilu0 {
    /// Factors a square matrix; a row without a diagonal entry is an error.
    pub(crate) fn new(matrix: &Csr) -> Result<Self, SolveError> {
        let n = matrix.nrows();
        let (offsets, indices) = (matrix.offsets().to_vec(), matrix.indices().to_vec());
        let mut values = matrix.values().to_vec();
        let mut diagonal = Vec::with_capacity(n);
        let mut place = vec![usize::MAX; n];
        for i in 0..n {
            let range = offsets[i]..offsets[i + 1];
            let scale = values[range.clone()].iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            range.clone().for_each(|k| place[indices[k] as usize] = k);
            for k in range.clone() {
                let j = indices[k] as usize;
                if j >= i {
                    break;
                }
                let factor = values[k] / values[diagonal[j]];
                values[k] = factor;
                for later in diagonal[j] + 1..offsets[j + 1] {
                    let target = place[indices[later] as usize];
                    if target != usize::MAX {
                        values[target] -= factor * values[later];
                    }
                }
            }
            let own = place[i];
            if own == usize::MAX {
                return Err(SolveError::ZeroRow { row: i });
            }
            if values[own].abs() < SMALLEST_PIVOT * scale {
                values[own] = SMALLEST_PIVOT * scale * if values[own] < 0.0 { -1.0 } else { 1.0 };
            }
            diagonal.push(own);
            range.for_each(|k| place[indices[k] as usize] = usize::MAX);
        }
        Ok(Self { offsets, indices, values, diagonal })
    }

    /// `x = (L U)^-1 x`
    pub(crate) fn solve_in_place(&self, x: &mut [f64]) {
        let n = self.diagonal.len();
        for i in 0..n {
            x[i] -= self.sum(self.offsets[i]..self.diagonal[i], x);
        }
        for i in (0..n).rev() {
            let sum = self.sum(self.diagonal[i] + 1..self.offsets[i + 1], x);
            x[i] = (x[i] - sum) / self.values[self.diagonal[i]];
        }
    }

    fn sum(&self, range: std::ops::Range<usize>, x: &[f64]) -> f64 {
        self.indices[range.clone()].iter().zip(&self.values[range]).map(|(&j, a)| a * x[j as usize]).sum()
    }
}
