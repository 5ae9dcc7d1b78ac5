//! What comes before the solve of a scene: its linear system, and another way to solve that, for measurements.

use std::time::Instant;

use meshless_interfaces::{
    Discretization, LinearSystem, PseudoTimeParams, SystemParams, linear_system as of_problem,
    pseudo_time as step, solve,
};

use super::{Discrete, Silent};
use crate::Error;
use crate::plan::{Plan, Stage};
use crate::report::Seconds;
use crate::scene::Scene;

/// The linear system that a steady scene leads to, for measurements and for other solvers
/// ([`write_matrix_market`](meshless_sparse::write_matrix_market) hands it on).
pub fn linear_system(scene: &Scene, plan: &Plan) -> Result<LinearSystem, Error> {
    match scene.dimension {
        1 => in_dimension::<1>(scene, plan),
        2 => in_dimension::<2>(scene, plan),
        _ => in_dimension::<3>(scene, plan),
    }
}

/// What stepping to the steady state costs, beside the sparse solver of the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PseudoTimeCost {
    /// Steps until the residual was reached.
    pub steps: usize,
    /// Seconds of the steps.
    pub seconds: f64,
    /// Seconds of the sparse solver on the same rows.
    pub sparse_seconds: f64,
    /// Largest difference of the two solutions over the largest value.
    pub difference: f64,
}

/// Solves the rows of a steady scene by explicit steps to the steady state, and by the plan's solver.
pub fn pseudo_time(scene: &Scene, plan: &Plan, params: &PseudoTimeParams) -> Result<PseudoTimeCost, Error> {
    match scene.dimension {
        1 => cost_in::<1>(scene, plan, params),
        2 => cost_in::<2>(scene, plan, params),
        _ => cost_in::<3>(scene, plan, params),
    }
}

fn rows<const D: usize>(
    scene: &Scene,
    plan: &Plan,
) -> Result<(Discrete<D>, Discretization, SystemParams), Error> {
    let discrete = Discrete::<D>::build(scene, plan, &mut Silent, &mut Seconds::default())?;
    let discretization =
        plan.method.params.build().discretize(&discrete.problem()).map_err(|e| discrete.explain(scene, e))?;
    let params = SystemParams { solver: plan.solver, split_floating: plan.runs(Stage::FloatingConstants) };
    Ok((discrete, discretization, params))
}

fn in_dimension<const D: usize>(scene: &Scene, plan: &Plan) -> Result<LinearSystem, Error> {
    let (discrete, discretization, params) = rows::<D>(scene, plan)?;
    of_problem(&discrete.problem(), &discretization, &params).map_err(|e| discrete.explain(scene, e))
}

fn cost_in<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    params: &PseudoTimeParams,
) -> Result<PseudoTimeCost, Error> {
    let (discrete, discretization, system) = rows::<D>(scene, plan)?;
    let problem = discrete.problem();
    let start = Instant::now();
    let sparse = solve(&problem, &discretization, &system).map_err(|e| discrete.explain(scene, e))?;
    let sparse_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let stepped = step(&problem, &discretization, params).map_err(|e| discrete.explain(scene, e))?;
    let seconds = start.elapsed().as_secs_f64();
    let largest = sparse.u.iter().fold(f64::MIN_POSITIVE, |m, u| m.max(u.abs()));
    let difference = sparse.u.iter().zip(&stepped.u).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    Ok(PseudoTimeCost { steps: stepped.steps, seconds, sparse_seconds, difference: difference / largest })
}
