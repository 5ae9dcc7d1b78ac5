//! How well the stencils of a method reproduce the exact solution, without solving anything.

use super::{Discrete, Silent};
use crate::Error;
use crate::norms::ErrorNorms;
use crate::plan::Plan;
use crate::report::Seconds;
use crate::scene::Scene;
use meshless_interfaces::{MethodError, RowKind};

/// Relative maximum norms of what the stencils make of the exact nodal values (Yoon and Song 2021, section 3.1 and (79)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reproduction {
    /// Smallest spacing of a node.
    pub spacing: f64,
    /// Of the gradient.
    pub gradient: f64,
    /// Of `-div(eta grad u)` at inner nodes, against the source; absolute where there is none.
    pub operator: f64,
}

/// Applies the stencils of a scene's method to its exact solution.
///
/// # Errors
/// Those of building the cloud and the stencils, and an exact solution that is not finite.
pub fn reproduce(scene: &Scene, plan: &Plan) -> Result<Reproduction, Error> {
    match scene.dimension {
        1 => reproduce_in::<1>(scene, plan),
        2 => reproduce_in::<2>(scene, plan),
        _ => reproduce_in::<3>(scene, plan),
    }
}

fn reproduce_in<const D: usize>(scene: &Scene, plan: &Plan) -> Result<Reproduction, Error> {
    let discrete = Discrete::<D>::build(scene, plan, &mut Silent, &mut Seconds::default())?;
    let (problem, exact) = (discrete.problem(), discrete.exact(scene)?);
    let method = plan.method.params.build::<D>();
    let system = method.discretize(&problem)?;
    if system.constants.is_some() || !system.interface_points.is_empty() {
        let (what, instead) = ("be applied to nodal values alone", "use a method without further unknowns");
        return Err(MethodError::Unsupported { method: "a method with other unknowns", what, instead }.into());
    }
    let found = method.gradient(&problem, &exact.values)?;
    let (mut gradient, mut operator) = (ErrorNorms::default(), ErrorNorms::default());
    for (found, exact) in found.iter().zip(&exact.gradients) {
        let size = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        gradient.add(1.0, size(&std::array::from_fn(|k| found[k] - exact[k])), size(exact));
    }
    let u = &exact.values;
    for i in (0..u.len()).filter(|&i| matches!(system.kinds[i], RowKind::Strong | RowKind::Constrained)) {
        let (columns, values) = system.rows.row(i);
        let differences = columns.iter().zip(values).filter(|(j, _)| (**j as usize) < u.len());
        let sum: f64 = differences.map(|(&j, a)| a * (u[j as usize] - u[i])).sum();
        let residual = sum + system.rows.row_sum(i) * u[i] - system.rhs[i];
        operator.add(1.0, residual / system.volumes[i], problem.source.map_or(0.0, |f| f[i]));
    }
    let spacing = discrete.cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b));
    Ok(Reproduction { spacing, gradient: gradient.linf(), operator: operator.linf() })
}
