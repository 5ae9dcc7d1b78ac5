//! The equations that the linear solver sees.

use meshless_sparse::{Bordered, Csr, Split};

use super::{SystemParams, floating, given};
use crate::{Discretization, MethodError, Problem};

/// The equations that the linear solver gets: prescribed values eliminated, and the constants of floating regions (in a pure
/// Neumann problem also what is not balanced) as extra unknowns.
#[derive(Debug, Clone)]
pub struct LinearSystem {
    /// All equations, as [`solve`](super::solve) solves them.
    pub bordered: Bordered,
}

impl LinearSystem {
    /// The equations of the nodes alone, those of pinned nodes replaced by `w = 0`: a square matrix for other solvers. The
    /// whole needs one more solution with it for each extra unknown.
    #[must_use]
    pub fn matrix(&self) -> Csr {
        self.bordered.pinned_matrix()
    }

    /// The right-hand side that belongs to [`LinearSystem::matrix`].
    #[must_use]
    pub fn rhs(&self) -> Vec<f64> {
        self.bordered.pinned_rhs()
    }
}

/// The linear system of a discretised problem, for measurements and for other solvers.
///
/// # Errors
/// Numbers that are not finite.
pub fn linear_system<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    params: &SystemParams,
) -> Result<LinearSystem, MethodError> {
    if let Some(constants) = &discretization.constants {
        return Ok(LinearSystem { bordered: given::bordered(problem, discretization, constants)?.0 });
    }
    let mut known = problem.dirichlet();
    let nodes = known.len();
    known.resize(discretization.rows.n(), None);
    let reduced = discretization.rows.eliminate(&known, &discretization.rhs)?;
    // As in `solve`: constants of floating regions are found from the nodes alone.
    let split = match params.split_floating && known.len() == nodes {
        true => floating::split(problem, &reduced.matrix, &reduced.map)?.map(|floating| floating.split),
        false => None,
    };
    let n = reduced.matrix.n();
    let bordered = if problem.is_anchored() {
        split.unwrap_or_else(|| Split::trivial(n)).apply(&reduced.matrix, &reduced.rhs)?
    } else {
        Split::trivial(n).apply_neumann(&reduced.matrix, &reduced.rhs, &discretization.volumes, n / 2)?
    };
    Ok(LinearSystem { bordered })
}
