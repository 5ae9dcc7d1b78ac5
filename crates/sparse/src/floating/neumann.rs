//! Problems without any prescribed value.

use super::split::Split;
use crate::difference::DifferenceMatrix;
use crate::solver::{SolveError, SolveInfo, SolverParams};

/// Solution of a pure Neumann problem.
#[derive(Debug, Clone, PartialEq)]
pub struct NeumannSolution {
    /// `u`, which is 0 at the pinned node; any constant may be added.
    pub values: Vec<f64>,
    /// The incompatibility: what the data lack to have a solution, spread over the rows of the column given.
    pub lambda: f64,
    /// How it was solved.
    pub info: SolveInfo,
}

/// Solves `A u + lambda column = b` with `u = 0` at node `pinned`, for a matrix whose row sums are zero. With a column of
/// ones on the rows of the differential equation, `lambda` is the constant that must be taken from the source for
/// the problem to have a solution. Whether it is small enough is for the caller to decide.
///
/// # Errors
/// Those of [`Bordered::solve`](crate::Bordered::solve); [`SolveError::Undetermined`] if `column` lies in the range of `A`
/// (no incompatibility can be taken up by it).
pub fn pure_neumann(
    matrix: &DifferenceMatrix,
    rhs: &[f64],
    column: &[f64],
    pinned: usize,
    params: &SolverParams,
) -> Result<NeumannSolution, SolveError> {
    let system = Split::trivial(matrix.n()).apply_neumann(matrix, rhs, column, pinned)?;
    let solution = system.solve(params)?;
    Ok(NeumannSolution { values: solution.values, lambda: solution.extra[0], info: solution.info })
}
