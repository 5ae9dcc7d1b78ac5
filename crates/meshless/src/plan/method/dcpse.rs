//! DC-PSE methods in plans.

use meshless_interfaces::dcpse::{Ghosts, ImmersedParams};

use super::Steps;
use crate::plan::effects::Survey;
use crate::scene::Scene;

/// Interaction radius in units of the spacing for operators of second order, by dimension: about 6, 26 and 57
/// neighbours, also where nodes are moved by half a spacing.
const SUPPORT: [f64; 3] = [3.1, 2.9, 2.4];

/// What every further order adds to it.
const SUPPORT_PER_ORDER: f64 = 0.5;

pub(super) fn immersed(scene: &Scene) -> ImmersedParams {
    let chosen = ImmersedParams::default();
    let order = scene.method.order.unwrap_or(chosen.order);
    ImmersedParams { order, ghosts: Ghosts::Constrained { degree: order } }
}

pub(super) fn support(dimension: usize, order: usize) -> f64 {
    SUPPORT[dimension - 1] + SUPPORT_PER_ORDER * (order.saturating_sub(2)) as f64
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
