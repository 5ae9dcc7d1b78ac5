//! The plain Laplace problem of `effects` with the crates wired by hand: what the facade is compared with.

use meshless::plan::Plan;
use meshless_geometry::{CloudParams, Domain, Layout, RegionMap, Spacing, generate};
use meshless_interfaces::{Condition, Field, Material, Problem, Supports, SystemParams, solve};
use meshless_neighbors::{Distance, Radius, within_radius};

use super::effects::SPACING;

/// Solves it with the method and the solver of a plan; returns the nodal values.
pub(super) fn laplace(plan: &Plan) -> Result<Vec<f64>, Box<dyn std::error::Error + Send + Sync>> {
    let domain = Domain::boxed([0.0; 2], [1.0; 2])?;
    let params = CloudParams {
        spacing: Spacing::Uniform(SPACING),
        layout: Layout::Irregular,
        seed: 1,
        max_nodes: meshless::MAX_NODES,
    };
    let cloud = generate(&domain, &params)?;
    let radius: Vec<f64> = cloud.spacing().iter().map(|s| plan.method.support * s).collect();
    let lists = within_radius(cloud.points(), Radius::PerPoint(&radius), Distance::D2)?;
    let regions = RegionMap::new(vec![None])?;
    let (labels, eta) = (vec![0; cloud.len()], vec![1.0; cloud.len()]);
    let materials = [Material::new(Field::Constant(1.0))];
    let value = |x: &[f64; 2]| Condition::Dirichlet(x[0]);
    let at_nodes = |node: &meshless_geometry::BoundaryNode<2>| {
        vec![value(&cloud.points()[node.node as usize]); node.touches.len()]
    };
    let conditions: Vec<Vec<Condition>> = cloud.boundary().iter().map(at_nodes).collect();
    let boundary = |_face, x: &[f64; 2]| Some(value(x));
    let problem = Problem {
        cloud: &cloud,
        domain: &domain,
        supports: Supports { lists: &lists, radius: &radius },
        regions: &regions,
        labels: &labels,
        materials: &materials,
        eta: &eta,
        source: None,
        conditions: &conditions,
        boundary: &boundary,
        laws: &[],
        law_rates: &[],
        slits: &[],
    };
    let discretization = plan.method.params.build().discretize(&problem)?;
    let params = SystemParams { solver: plan.solver, split_floating: false };
    Ok(solve(&problem, &discretization, &params)?.u)
}
