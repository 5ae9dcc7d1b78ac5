//! The layer below all methods: prescribed values, floating constants, the linear solver.

mod floating;

use meshless_sparse::{SolveInfo, SolverParams, Split, pure_neumann};

use crate::{Discretization, MethodError, Problem};

/// Part of sources and fluxes that may be left over in a pure Neumann problem, relative to their size: a scene that
/// balances does so up to the discretisation error of its integrals.
const COMPATIBILITY: f64 = 0.05;

/// How to solve a discretisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SystemParams {
    /// The linear solver.
    pub solver: SolverParams,
    /// Look for floating stiff regions and split off their constants.
    pub split_floating: bool,
}

impl Default for SystemParams {
    fn default() -> Self {
        Self { solver: SolverParams::default(), split_floating: true }
    }
}

/// Nodal values and how they were found.
#[derive(Debug, Clone)]
pub struct SystemSolution {
    /// One value a node; where nothing fixes the constant, their mean weighted by the volumes is zero.
    pub u: Vec<f64>,
    /// What the solver says.
    pub info: SolveInfo,
    /// Constants of floating regions that were solved for beside the nodes.
    pub floating_constants: usize,
    /// Whether u is determined only up to a constant.
    pub up_to_constant: bool,
}

/// Solves a discretised problem.
///
/// # Errors
/// Those of the solver; and [`MethodError::Incompatible`] where nothing fixes the constant of u and sources and fluxes
/// do not balance.
pub fn solve<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    params: &SystemParams,
) -> Result<SystemSolution, MethodError> {
    if !problem.is_anchored() {
        return solve_unanchored(discretization, params);
    }
    let known = problem.dirichlet();
    let reduced = discretization.rows.eliminate(&known, &discretization.rhs)?;
    let split = match params.split_floating {
        true => floating::split(problem, &reduced.matrix, &reduced.map)?,
        false => None,
    };
    let (solution, info) = match &split {
        Some(split) => {
            let solved = split.apply(&reduced.matrix, &reduced.rhs)?.solve(&params.solver)?;
            (split.recover(&solved.values, &solved.extra)?, solved.info)
        }
        None => meshless_sparse::solve(&reduced.matrix.to_csr(), &reduced.rhs, &params.solver)?,
    };
    let u = reduced.expand(&solution, &known)?;
    let floating_constants = split.as_ref().map_or(0, Split::extra);
    Ok(SystemSolution { u, info, floating_constants, up_to_constant: false })
}

/// A pure Neumann problem: one node is pinned, and the extra unknown takes up what is not balanced.
fn solve_unanchored(
    discretization: &Discretization,
    params: &SystemParams,
) -> Result<SystemSolution, MethodError> {
    let (rows, rhs, volumes) = (&discretization.rows, &discretization.rhs, &discretization.volumes);
    let size: f64 = rhs.iter().map(|b| b.abs()).sum();
    let pin = rhs.len() / 2;
    let solved = pure_neumann(rows, rhs, volumes, pin, &params.solver)?;
    let (mut u, lambda, info) = (solved.values, solved.lambda, solved.info);
    let total: f64 = volumes.iter().sum();
    let defect = if size > 0.0 { (lambda * total / size).abs() } else { 0.0 };
    if defect.is_nan() || defect > COMPATIBILITY {
        return Err(MethodError::Incompatible { defect });
    }
    let mean = u.iter().zip(volumes).map(|(u, v)| u * v).sum::<f64>() / total;
    u.iter_mut().for_each(|u| *u -= mean);
    Ok(SystemSolution { u, info, floating_constants: 0, up_to_constant: true })
}
