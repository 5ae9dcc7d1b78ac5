//! Interface-immersed particle differences in plans.

use meshless_interfaces::particle_difference::{ParticleDifferenceParams, Wedge};
use meshless_stencils::Weight;

use super::Steps;
use crate::plan::effects::{Effect, Survey};
use crate::scene::{Scene, WedgeName, WeightName};

/// Exponent of the exponential weight at the radius of interaction. The paper does not give its own; with this one the
/// function falls about as steeply as the quartic one. At 4 and less errors are several times as large.
const EXPONENTIAL_DECAY: f64 = 9.0;

pub(super) fn params(scene: &Scene) -> ParticleDifferenceParams {
    let (options, chosen) = (&scene.method.options, ParticleDifferenceParams::default());
    ParticleDifferenceParams {
        degree: scene.method.order.unwrap_or(chosen.degree),
        weight: options.weight.map_or(chosen.weight, |name| match name {
            WeightName::Quartic => Weight::Quartic,
            WeightName::Exponential => Weight::Gaussian { decay: EXPONENTIAL_DECAY },
        }),
        flux_weights: options.flux_weights.unwrap_or(chosen.flux_weights),
        visibility: options.visibility.unwrap_or(chosen.visibility),
        enrichment: chosen.enrichment,
        decaying: scene.time.is_some(),
        // The second derivative at an interface would follow from the steady equation: with a du/dt it is not known.
        wedge: options.wedge.map_or(
            if scene.time.is_some() { Wedge::Varying } else { chosen.wedge },
            |name| match name {
                WedgeName::Plane => Wedge::Plane,
                WedgeName::Varying => Wedge::Varying,
                WedgeName::Quadratic => Wedge::Quadratic,
            },
        ),
    }
}

/// With the jump as an unknown there is nothing that the second derivative could be taken from.
pub(super) fn extended(scene: &Scene) -> ParticleDifferenceParams {
    let wedge = match scene.method.options.wedge {
        Some(WedgeName::Varying | WedgeName::Quadratic) => Wedge::Varying,
        _ => Wedge::Plane,
    };
    ParticleDifferenceParams { wedge, ..params(scene) }
}

pub(super) fn steps(survey: &Survey) -> Steps {
    Steps {
        stencils: true,
        no_stencils: "",
        selection: false,
        constrained: Some(survey.has_interface() || survey.has(|e| matches!(e, Effect::Slits))),
        cells: 0.0,
        may_need_cells: false,
    }
}
