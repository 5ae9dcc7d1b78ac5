//! Sparse LU: the one file that names faer.

use faer::MatMut;
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

use crate::{Csr, SolveError};

/// A sparse LU factorisation with partial pivoting, ordered by COLAMD, on one thread.
pub(crate) struct Direct {
    lu: Lu<u32, f64>,
}

impl Direct {
    pub(crate) fn new(matrix: &Csr) -> Result<Self, SolveError> {
        let singular = |detail: String| SolveError::Singular { detail };
        let pointers: Vec<u32> = matrix.offsets().iter().map(|&o| o as u32).collect();
        // Rows of A are columns of its transpose: nothing is copied but the offsets.
        let pattern = SymbolicSparseColMatRef::new_checked(
            matrix.ncols(),
            matrix.nrows(),
            &pointers,
            None,
            matrix.indices(),
        );
        let symbolic = SymbolicLu::try_new(pattern).map_err(|e| singular(format!("{e:?}")))?;
        let transpose = SparseColMatRef::new(pattern, matrix.values());
        let lu = Lu::try_new_with_symbolic(symbolic, transpose).map_err(|e| singular(format!("{e:?}")))?;
        Ok(Self { lu })
    }

    pub(crate) fn solve_in_place(&self, x: &mut [f64]) {
        let n = x.len();
        self.lu
            .solve_transpose_in_place_with_conj(faer::Conj::No, MatMut::from_column_major_slice_mut(x, n, 1));
    }
}
