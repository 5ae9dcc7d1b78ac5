//! Transposes, permutations, scaled rows.

use super::{Csr, for_each_row, for_each_row_of};
use crate::error::MatrixError;

impl Csr {
    /// The transpose; columns come out sorted without a sort.
    #[must_use]
    pub fn transpose(&self) -> Self {
        let mut offsets = vec![0usize; self.ncols() + 1];
        for &j in self.indices() {
            offsets[j as usize + 1] += 1;
        }
        for j in 0..self.ncols() {
            offsets[j + 1] += offsets[j];
        }
        let mut next = offsets.clone();
        let mut indices = vec![0u32; self.nnz()];
        let mut values = vec![0.0; self.nnz()];
        for i in 0..self.nrows() {
            let (columns, row) = self.row(i);
            for (&j, &a) in columns.iter().zip(row) {
                let place = next[j as usize];
                next[j as usize] += 1;
                indices[place] = i as u32;
                values[place] = a;
            }
        }
        Self::from_trusted(self.nrows(), offsets, indices, values)
    }

    /// The diagonal, 0 where no entry is stored.
    #[must_use]
    pub fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.nrows()];
        for_each_row(&mut diagonal, |i, d| *d = self.get(i, i));
        diagonal
    }

    /// The matrix in a new numbering of rows and columns alike: row `k` of the result is row `order[k]` of this one.
    ///
    /// # Errors
    /// [`MatrixError::NotSquare`], or [`MatrixError::NotAPermutation`] where `order` does not name every row once.
    pub fn permuted(&self, order: &[u32]) -> Result<Self, MatrixError> {
        self.require_square()?;
        let place = inverse_permutation(order, self.nrows())?;
        Self::from_rows(self.nrows(), self.ncols(), |k, row| {
            let (columns, values) = self.row(order[k] as usize);
            for (&j, &a) in columns.iter().zip(values) {
                row.push(place[j as usize] as usize, a);
            }
        })
    }

    /// The matrix with row `i` multiplied by `factors[i]`.
    ///
    /// # Errors
    /// [`MatrixError::Length`], and [`MatrixError::NotFinite`] where a product overflows or a factor is not finite.
    pub fn row_scaled(&self, factors: &[f64]) -> Result<Self, MatrixError> {
        MatrixError::check_length("row factors", factors.len(), self.nrows())?;
        let mut values = vec![0.0; self.nnz()];
        for_each_row_of(&self.offsets, &mut values, |i, scaled| {
            scaled.iter_mut().zip(self.row(i).1).for_each(|(s, v)| *s = v * factors[i]);
        });
        let scaled = Self::from_trusted(self.ncols, self.offsets.clone(), self.indices.clone(), values);
        scaled.require_finite()?;
        Ok(scaled)
    }

    /// The matrix with column `j` multiplied by `factors[j]`.
    ///
    /// # Errors
    /// Those of [`Csr::row_scaled`].
    pub fn columns_scaled(&self, factors: &[f64]) -> Result<Self, MatrixError> {
        MatrixError::check_length("column factors", factors.len(), self.ncols())?;
        let mut values = vec![0.0; self.nnz()];
        for_each_row_of(&self.offsets, &mut values, |i, scaled| {
            let (columns, row) = self.row(i);
            scaled.iter_mut().zip(row).zip(columns).for_each(|((s, v), &j)| *s = v * factors[j as usize]);
        });
        let scaled = Self::from_trusted(self.ncols, self.offsets.clone(), self.indices.clone(), values);
        scaled.require_finite()?;
        Ok(scaled)
    }

    /// Whether the matrix equals its transpose, entry by entry.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.nrows() == self.ncols() && *self == self.transpose()
    }

    pub(crate) fn require_square(&self) -> Result<(), MatrixError> {
        if self.nrows() == self.ncols() {
            return Ok(());
        }
        Err(MatrixError::NotSquare { nrows: self.nrows(), ncols: self.ncols() })
    }
}

/// `place` with `place[order[k]] = k`.
fn inverse_permutation(order: &[u32], n: usize) -> Result<Vec<u32>, MatrixError> {
    MatrixError::check_length("permutation", order.len(), n)?;
    let mut place = vec![u32::MAX; n];
    for (k, &i) in order.iter().enumerate() {
        match place.get_mut(i as usize) {
            Some(slot) if *slot == u32::MAX => *slot = k as u32,
            _ => return Err(MatrixError::NotAPermutation { position: k, index: i as usize }),
        }
    }
    Ok(place)
}
