//! Compressed sparse rows.

mod build;
mod multiply;
mod product;
mod transform;

pub use build::RowBuilder;
pub(crate) use build::{build_rows, joined};
pub(crate) use multiply::{LooseRows, computed_rows};
pub(crate) use product::{for_each_row, for_each_row_of};

use crate::error::MatrixError;
use sprs::CsMatViewI;

/// A sparse matrix in compressed rows, with 32-bit column indices.
///
/// Invariant, checked once by [`Csr::try_from_parts`]: offsets start at 0, do not decrease and end at the number
/// of entries; the columns of a row are below `ncols` and strictly increasing; all values are finite. Explicit
/// zeros are allowed.
#[derive(Debug, Clone, PartialEq)]
pub struct Csr {
    ncols: usize,
    offsets: Vec<usize>,
    indices: Vec<u32>,
    values: Vec<f64>,
}

impl Csr {
    /// Takes over the three arrays of a matrix of `nrows` by `ncols`, whose row `i` has its columns in
    /// `indices[offsets[i]..offsets[i + 1]]` and its entries at the same places of `values`.
    ///
    /// # Errors
    /// [`MatrixError`] names the first violation of the invariant.
    pub fn try_from_parts(
        nrows: usize,
        ncols: usize,
        offsets: Vec<usize>,
        indices: Vec<u32>,
        values: Vec<f64>,
    ) -> Result<Self, MatrixError> {
        if ncols > u32::MAX as usize || nrows > u32::MAX as usize {
            return Err(MatrixError::TooLarge { size: ncols.max(nrows) });
        }
        let ends_fit = offsets.len() == nrows + 1
            && offsets.first() == Some(&0)
            && offsets.last() == Some(&indices.len())
            && indices.len() == values.len();
        if !ends_fit {
            return Err(MatrixError::Offsets { row: nrows });
        }
        if let Some(row) = offsets.windows(2).position(|w| w[0] > w[1]) {
            return Err(MatrixError::Offsets { row });
        }
        let matrix = Self { ncols, offsets, indices, values };
        for row in 0..nrows {
            let (columns, values) = matrix.row(row);
            if let Some(&column) = columns.iter().find(|&&c| c as usize >= ncols) {
                return Err(MatrixError::ColumnOutOfRange { row, column: column as usize, ncols });
            }
            if let Some(w) = columns.windows(2).find(|w| w[0] >= w[1]) {
                return Err(MatrixError::Unsorted { row, column: w[1] as usize });
            }
            if let Some(k) = values.iter().position(|v| !v.is_finite()) {
                return Err(MatrixError::NotFinite { row, column: columns[k] as usize, value: values[k] });
            }
        }
        Ok(matrix)
    }

    /// Arrays that keep the invariant by construction.
    pub(crate) fn from_trusted(
        ncols: usize,
        offsets: Vec<usize>,
        indices: Vec<u32>,
        values: Vec<f64>,
    ) -> Self {
        debug_assert!(offsets.last() == Some(&indices.len()) && indices.len() == values.len());
        Self { ncols, offsets, indices, values }
    }

    /// Offsets, columns and values.
    pub(crate) fn into_parts(self) -> (Vec<usize>, Vec<u32>, Vec<f64>) {
        (self.offsets, self.indices, self.values)
    }

    /// The identity of `n` rows.
    #[must_use]
    pub fn identity(n: usize) -> Self {
        let indices = (0..n as u32).collect();
        Self { ncols: n, offsets: (0..=n).collect(), indices, values: vec![1.0; n] }
    }

    /// Number of rows.
    #[must_use]
    pub fn nrows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of columns.
    #[must_use]
    pub fn ncols(&self) -> usize {
        self.ncols
    }

    /// Number of stored entries.
    #[must_use]
    pub fn nnz(&self) -> usize {
        self.values.len()
    }

    /// Bytes that the three arrays occupy.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.offsets) + size_of_val(&*self.indices) + size_of_val(&*self.values)
    }

    /// Columns and values of row `i`.
    ///
    /// # Panics
    /// If `i` is not below [`Csr::nrows`], like a slice.
    #[must_use]
    #[inline]
    pub fn row(&self, i: usize) -> (&[u32], &[f64]) {
        let range = self.offsets[i]..self.offsets[i + 1];
        (&self.indices[range.clone()], &self.values[range])
    }

    /// The entry in row `i` and column `j`, 0 where none is stored.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (columns, values) = self.row(i);
        columns.binary_search(&(j as u32)).map_or(0.0, |k| values[k])
    }

    /// Where the rows start, with the number of entries at the end.
    #[must_use]
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Columns of all entries, row after row.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Values of all entries, row after row.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same matrix as `sprs` sees it, for its algebra; nothing is copied.
    #[must_use]
    pub fn as_sprs(&self) -> CsMatViewI<'_, f64, u32, usize> {
        CsMatViewI::new((self.nrows(), self.ncols), &self.offsets, &self.indices, &self.values)
    }

    /// Copies a `sprs` matrix, of either storage order.
    ///
    /// # Errors
    /// [`MatrixError::NotFinite`] and [`MatrixError::TooLarge`]; `sprs` keeps the rest of the invariant.
    pub fn from_sprs(matrix: CsMatViewI<'_, f64, u32, usize>) -> Result<Self, MatrixError> {
        let (nrows, ncols) = matrix.shape();
        let (offsets, indices, values) = matrix.to_csr().into_raw_storage();
        Self::try_from_parts(nrows, ncols, offsets, indices, values)
    }
}
