//! The sharp method in plans.

use meshless_interfaces::sharp::{MAX_ORDER, SharpParams};

use super::Steps;
use crate::Error;
use crate::plan::effects::Survey;
use crate::scene::Scene;

pub(super) fn params(scene: &Scene) -> SharpParams {
    let chosen = SharpParams::default();
    SharpParams {
        order: scene.method.order.unwrap_or(chosen.order),
        unsteady: scene.time.is_some(),
        ..chosen
    }
}

/// Nodes of a stencil for each harmonic polynomial of a part, in three dimensions.
const NODES_PER_POLYNOMIAL: f64 = 1.4;

/// Two orders more. In three dimensions the stencils of the higher order would take five times as long: there they are
/// as large as those of the lower one, or as its polynomials need at least.
pub(super) fn finer(params: &SharpParams, dimension: usize) -> Option<SharpParams> {
    let order = params.order + 2;
    let least = (NODES_PER_POLYNOMIAL * ((order + 1) * (order + 1)) as f64).ceil() as usize;
    let nodes = (dimension == 3).then(|| params.stencil_nodes(dimension).max(least));
    (order <= MAX_ORDER[dimension - 1]).then_some(SharpParams { order, nodes, ..*params })
}

/// Orders that a dimension does not have.
pub(super) fn check(scene: &Scene) -> Result<(), Error> {
    let highest = MAX_ORDER[scene.dimension - 1];
    if let Some(order) = scene.method.order.filter(|&order| order > highest) {
        let message = format!("the method \"sharp\" has no order {order} in {}-D", scene.dimension);
        let error = scene.error_at_boundaries(message, format!("take an order up to {highest}"));
        return Err(error.into());
    }
    Ok(())
}

pub(super) fn steps(survey: &Survey) -> Steps {
    Steps {
        stencils: true,
        no_stencils: "",
        selection: false,
        constrained: Some(survey.has_interface()),
        cells: 0.0,
        may_need_cells: false,
    }
}
