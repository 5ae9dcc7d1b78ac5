//! The linear system of a scene, without solving it.

use meshless_interfaces::{LinearSystem, SystemParams, linear_system as of_problem};

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

fn in_dimension<const D: usize>(scene: &Scene, plan: &Plan) -> Result<LinearSystem, Error> {
    let discrete = Discrete::<D>::build(scene, plan, &mut Silent, &mut Seconds::default())?;
    let problem = discrete.problem();
    let discretization =
        plan.method.params.build().discretize(&problem).map_err(|e| discrete.explain(scene, e))?;
    let params = SystemParams { solver: plan.solver, split_floating: plan.runs(Stage::FloatingConstants) };
    of_problem(&problem, &discretization, &params).map_err(|e| discrete.explain(scene, e))
}
