//! The sharp method in plans.

use meshless_interfaces::sharp::{MAX_ORDER, SharpParams};

use super::Steps;
use crate::Error;
use crate::plan::effects::Survey;
use crate::scene::Scene;

pub(super) fn params(scene: &Scene) -> SharpParams {
    let chosen = SharpParams::default();
    SharpParams { order: scene.method.order.unwrap_or(chosen.order), ..chosen }
}

/// Orders that a dimension does not have, and scenes that change: the rows are residuals of interpolation, which have
/// no mass of a node in front of du/dt.
pub(super) fn check(scene: &Scene) -> Result<(), Error> {
    let highest = MAX_ORDER[scene.dimension - 1];
    if let Some(order) = scene.method.order.filter(|&order| order > highest) {
        let message = format!("the method \"sharp\" has no order {order} in {}-D", scene.dimension);
        let error = scene.error_at_boundaries(message, format!("take an order up to {highest}"));
        return Err(error.into());
    }
    match &scene.time {
        Some(time) => {
            let message = "the method \"sharp\" has no steps in time";
            Err(time.place.error(message, "take another method, or a steady scene").into())
        }
        None => Ok(()),
    }
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
