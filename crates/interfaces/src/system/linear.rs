//! The equations that the linear solver sees.

use meshless_sparse::{Bordered, Csr, Split};

use super::{SystemParams, floating, given};
use crate::{Discretization, MethodError, Problem};

/// A matrix with a right-hand side, as a discretisation hands them to the linear solver: prescribed values eliminated,
/// constants of floating regions split off, their pinned nodes and that of a pure Neumann problem fixed.
#[derive(Debug, Clone)]
pub struct LinearSystem {
    /// The matrix.
    pub matrix: Csr,
    /// The right-hand side.
    pub rhs: Vec<f64>,
    /// Unknowns beside the nodes: each costs one more solution with the same matrix.
    pub extra: usize,
}

impl LinearSystem {
    fn of(system: &Bordered) -> Self {
        Self { matrix: system.pinned_matrix(), rhs: system.pinned_rhs(), extra: system.extra() }
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
        return Ok(LinearSystem::of(&given::bordered(problem, discretization, constants)?.0));
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
    Ok(LinearSystem::of(&bordered))
}
