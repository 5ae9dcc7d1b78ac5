//! The layer below all methods: prescribed values, floating constants, the linear solver.

mod consistent;
mod floating;
mod given;
mod linear;
mod mass;
mod prepared;
mod pseudo_time;

use meshless_sparse::{SolveInfo, SolverParams, Split};

use crate::{Discretization, InterfaceFlow, InterfaceFlux, MethodError, Problem};
use floating::Floating;
pub(crate) use floating::FloatingParts;
pub use linear::{LinearSystem, linear_system};
pub use mass::{Mass, MassRows, residual};
pub use prepared::PreparedSystem;
pub use pseudo_time::{PseudoTimeParams, PseudoTimeSolution, pseudo_time};

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
    /// Values of the further unknowns of a method, in the order of [`Discretization::interface_points`].
    pub extra: Vec<f64>,
    /// What the solver says.
    pub info: SolveInfo,
    /// Constants of floating regions that were solved for beside the nodes.
    pub floating_constants: usize,
    /// Whether u is determined only up to a constant.
    pub up_to_constant: bool,
    /// The unknowns of a method that splits off constants itself.
    pub split: Option<SplitValues>,
    /// `du/dt` at the nodes; `None` in steady scenes.
    pub rates: Option<Vec<f64>>,
    /// Fluxes through interfaces, of [`Discretization::interface_fluxes`].
    pub interface_flows: Vec<InterfaceFlow>,
}

/// `w` and `C` of `u_i = sum_K sigma_K C_K + s_i w_i`: where `s` is tiny, `w` has digits that u has not.
#[derive(Debug, Clone, PartialEq)]
pub struct SplitValues {
    /// `w`, one a node.
    pub values: Vec<f64>,
    /// `C`, one a constant.
    pub constants: Vec<f64>,
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
    let solution = solve_rows(problem, discretization, params)?;
    let (values, constants) = match &solution.split {
        Some(split) => (&split.values, split.constants.as_slice()),
        None => (&solution.u, [].as_slice()),
    };
    let flow = |flux: &InterfaceFlux| flux.of(values, constants);
    let interface_flows = discretization.interface_fluxes.iter().map(flow).collect();
    Ok(SystemSolution { interface_flows, ..solution })
}

fn solve_rows<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    params: &SystemParams,
) -> Result<SystemSolution, MethodError> {
    // A face without nodes of its own is seen by the cells of inner nodes only.
    let rows = &discretization.rows;
    if let Some(constants) = &discretization.constants {
        return given::solve(problem, discretization, constants, params);
    }
    let unanchored = !problem.is_anchored() && (0..problem.cloud.len()).all(|i| rows.row_sum(i) == 0.0);
    if unanchored && rows.n() > problem.cloud.len() {
        let (method, what) = ("particle-difference-extended", "leave the constant of u undetermined");
        return Err(MethodError::Unsupported { method, what, instead: "prescribe u somewhere" });
    }
    if unanchored {
        return solve_unanchored(problem, discretization, params);
    }
    let mut known = problem.dirichlet();
    let nodes = known.len();
    known.resize(rows.n(), None);
    // Constants of floating regions are found from the nodes alone.
    let split_floating = params.split_floating && rows.n() == nodes;
    let is_known: Vec<bool> = known.iter().map(Option::is_some).collect();
    let rhs: Vec<f64> = known.iter().zip(&discretization.rhs).map(|(g, &b)| g.unwrap_or(b)).collect();
    let params = SystemParams { split_floating, ..*params };
    let prepared = PreparedSystem::new(problem, rows, &is_known, &params)?;
    let (mut u, info) = prepared.solve(&rhs)?;
    let extra = u.split_off(nodes);
    let floating_constants = prepared.floating_constants();
    Ok(SystemSolution {
        u,
        extra,
        info,
        floating_constants,
        up_to_constant: false,
        split: None,
        rates: None,
        interface_flows: Vec::new(),
    })
}

/// A pure Neumann problem: one node is pinned, and an extra unknown takes up what is not balanced.
fn solve_unanchored<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    params: &SystemParams,
) -> Result<SystemSolution, MethodError> {
    let (rows, rhs, volumes) = (&discretization.rows, &discretization.rhs, &discretization.volumes);
    let nodes: Vec<u32> = (0..rows.n() as u32).collect();
    let floating = match params.split_floating {
        true => floating::split(problem, rows, &nodes)?,
        false => None,
    };
    // The constants of floating regions have pins of their own, so that of the whole lies outside of them.
    let (split, pin) = match floating {
        Some(Floating { split, free: Some(free) }) => (split, free),
        _ => (Split::trivial(rows.n()), rows.n() / 2),
    };
    let solved = split.apply_neumann(rows, rhs, volumes, pin)?.solve(&params.solver)?;
    let (mut u, info) = (split.recover(&solved.values, &solved.extra)?, solved.info);
    let floating_constants = split.extra();
    check_balance(discretization, solved.extra[floating_constants])?;
    center(&mut u, volumes);
    Ok(SystemSolution {
        u,
        extra: Vec::new(),
        info,
        floating_constants,
        up_to_constant: true,
        split: None,
        rates: None,
        interface_flows: Vec::new(),
    })
}

/// Whether sources and fluxes balance: `lambda` times the volumes had to be added.
fn check_balance(discretization: &Discretization, lambda: f64) -> Result<(), MethodError> {
    let size: f64 = discretization.rhs.iter().map(|b| b.abs()).sum();
    let total: f64 = discretization.volumes.iter().sum();
    let defect = if size > 0.0 { (lambda * total / size).abs() } else { 0.0 };
    if defect.is_nan() || defect > COMPATIBILITY {
        return Err(MethodError::Incompatible { defect });
    }
    Ok(())
}

/// Makes the mean zero.
fn center(u: &mut [f64], volumes: &[f64]) {
    let total: f64 = volumes.iter().sum();
    let mean = u.iter().zip(volumes).map(|(u, v)| u * v).sum::<f64>() / total;
    u.iter_mut().for_each(|u| *u -= mean);
}
