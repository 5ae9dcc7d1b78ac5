//! Why an iteration did not converge, where that can be told.

use super::SolveError;
use super::error::FLOATING;
use crate::difference::DifferenceMatrix;
use crate::multigrid::floating_parts;

/// The error, with another reason where there is a connected part of the matrix whose rows add up to nothing.
pub(crate) fn diagnosed(mut error: SolveError, rows: &DifferenceMatrix) -> SolveError {
    if let SolveError::NoConvergence { reason, .. } = &mut error
        && !floating_parts(rows).is_empty()
    {
        *reason = FLOATING;
    }
    error
}
