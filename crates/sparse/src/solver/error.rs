//! Why a system could not be solved.

use crate::error::MatrixError;
use thiserror::Error;

/// Reason of [`SolveError::NoConvergence`] where the constant is in the null space of a part of the matrix.
pub(crate) const FLOATING: &str = "the rows of all unknowns, or of a part that is tied to no others, add up to nothing, so that \
                                   there is no solution unless the sources there balance";

fn advice(reason: &str) -> &'static str {
    if reason == FLOATING {
        "balance them, or prescribe a value"
    } else {
        "try a stronger preconditioner or the direct method"
    }
}

/// Why a system could not be solved, with what was reached.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// Matrix, right-hand side or parameters are not as they must be.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// A parameter is out of its range.
    #[error("{what} is {value}, {expected}")]
    BadParameter {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// The iteration reached its limit, or stopped getting anywhere.
    #[error(
        "{solver} reached a residual of {residual:e} after {iterations} products, not the {tolerance:e} asked for \
         ({reason}); {}",
        advice(reason)
    )]
    NoConvergence {
        /// Method and preconditioner.
        solver: String,
        /// Why it stopped.
        reason: &'static str,
        /// Smallest true relative residual.
        residual: f64,
        /// What was asked for.
        tolerance: f64,
        /// Products with the matrix.
        iterations: usize,
        /// The solution with the smallest residual.
        best: Vec<f64>,
    },
    /// A recurrence divided by (almost) zero and starting it anew did not help.
    #[error(
        "{solver} broke down after {iterations} products at a residual of {residual:e}: {what}; GMRES does not \
         break down"
    )]
    BreakDown {
        /// Method and preconditioner.
        solver: String,
        /// What vanished.
        what: &'static str,
        /// Smallest true relative residual.
        residual: f64,
        /// Products with the matrix.
        iterations: usize,
        /// The solution with the smallest residual.
        best: Vec<f64>,
    },
    /// A row without entries.
    #[error("row {row} has no entry that is not zero; the equation of this unknown is missing")]
    EmptyRow {
        /// Row.
        row: usize,
    },
    /// The matrix is singular, exactly or to working precision.
    #[error(
        "the matrix is singular to working precision (condition about {condition:e}); unknown {row} is the least \
         determined: a region without prescribed values, or a stiff one whose constant should be split off?"
    )]
    Singular {
        /// The unknown that is largest in the (near) null vector, or the column without a pivot.
        row: usize,
        /// Estimated condition number of the scaled matrix, infinite if a pivot vanished.
        condition: f64,
    },
    /// One of the extra unknowns of a bordered system is not determined.
    #[error(
        "extra unknown {extra} is not determined by the equations; is its cluster cut off from all others?"
    )]
    Undetermined {
        /// Index of the extra unknown.
        extra: usize,
    },
    /// The factorisation needs more memory than there is.
    #[error("not enough memory to factorise {n} unknowns; use an iterative method")]
    OutOfMemory {
        /// Number of unknowns.
        n: usize,
    },
}
