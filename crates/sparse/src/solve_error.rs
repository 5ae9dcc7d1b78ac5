//! Why a linear system was not solved.

use thiserror::Error;

use crate::MatrixError;

/// Why a linear system was not solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SolveError {
    /// The matrix is not square, or the right-hand side has another length.
    #[error("a matrix of {rows} x {columns} and a right-hand side of {rhs}; all three must be equal")]
    Shape {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
        /// Length of the right-hand side.
        rhs: usize,
    },
    /// The matrix or what belongs to it is not as it must be.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// A row without entries.
    #[error("row {row} of the matrix is zero, so its unknown is not determined")]
    ZeroRow {
        /// The row.
        row: usize,
    },
    /// A matrix or right-hand side that is not finite.
    #[error("row {row} of the system is not finite")]
    NotFinite {
        /// The row.
        row: usize,
    },
    /// The factorisation met a singular matrix.
    #[error(
        "the matrix is singular to working precision ({detail}); is u fixed somewhere in every part of the domain?"
    )]
    Singular {
        /// What was met.
        detail: String,
    },
    /// The iteration did not reach its tolerance.
    #[error(
        "{solver} reached a relative residual of {residual:.2e} after {iterations} iterations, wanted {tolerance:.1e}; \
         try the direct solver, or a smaller system"
    )]
    NoConvergence {
        /// The solver.
        solver: String,
        /// The best relative true residual.
        residual: f64,
        /// Products with the matrix.
        iterations: usize,
        /// The tolerance.
        tolerance: f64,
    },
}
