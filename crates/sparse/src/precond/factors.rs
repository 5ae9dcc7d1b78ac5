//! Incomplete factors `L U` and the substitutions with them.

use super::Preconditioner;

/// A pivot below this part of the largest entry of its row is replaced by it. The square root of the machine's
/// precision: large enough to bound the growth of the factors, too small to matter where factors are good.
pub(crate) const PIVOT_FLOOR: f64 = 1e-8;

/// Incomplete factors: `L` has a unit diagonal and stands before the diagonal of each row, `U` from there on.
#[derive(Debug, Clone, PartialEq)]
pub struct IncompleteLu {
    pub(crate) name: String,
    pub(crate) offsets: Vec<usize>,
    /// Place of the diagonal in each row.
    pub(crate) diagonal: Vec<usize>,
    pub(crate) indices: Vec<u32>,
    /// Entries; at the diagonal, the reciprocal of the pivot.
    pub(crate) values: Vec<f64>,
    pub(crate) replaced: usize,
}

impl IncompleteLu {
    /// Number of entries of both factors.
    #[must_use]
    pub fn nnz(&self) -> usize {
        self.values.len()
    }

    /// Bytes that the factors occupy.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.offsets)
            + size_of_val(&*self.diagonal)
            + size_of_val(&*self.indices)
            + size_of_val(&*self.values)
    }
}

impl Preconditioner for IncompleteLu {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], _: &mut [f64]) {
        let n = self.diagonal.len();
        for i in 0..n {
            let lower = self.offsets[i]..self.diagonal[i];
            let entries = self.indices[lower.clone()].iter().zip(&self.values[lower]);
            z[i] = entries.fold(r[i], |sum, (&j, l)| sum - l * z[j as usize]);
        }
        for i in (0..n).rev() {
            let upper = self.diagonal[i] + 1..self.offsets[i + 1];
            let entries = self.indices[upper.clone()].iter().zip(&self.values[upper]);
            z[i] = entries.fold(z[i], |sum, (&j, u)| sum - u * z[j as usize]) * self.values[self.diagonal[i]];
        }
    }

    fn replaced_pivots(&self) -> usize {
        self.replaced
    }
}

/// The reciprocal of a pivot, replaced where it is almost zero beside `row_max > 0`; the second says whether.
pub(crate) fn safe_reciprocal(pivot: f64, row_max: f64) -> (f64, bool) {
    let floor = PIVOT_FLOOR * row_max;
    if pivot.abs() >= floor && pivot.is_finite() && floor > 0.0 {
        (1.0 / pivot, false)
    } else if floor > 0.0 {
        (1.0 / floor.copysign(if pivot < 0.0 { -1.0 } else { 1.0 }), true)
    } else {
        (1.0, true)
    }
}
