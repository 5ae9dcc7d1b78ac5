//! DC-PSE methods in plans.

use meshless_interfaces::dcpse::{
    Ghosts, ImmersedParams, Interpolation, ReactionParams, ReactionSource, Sigma, Smoothing,
};

use super::Steps;
use crate::plan::effects::Survey;
use crate::scene::{GhostsName, KernelName, ReactionName, Scene, SigmaName};

/// Interaction radius in units of the spacing for operators of second order, by dimension: about 6, 26 and 57
/// neighbours, also where nodes are moved by half a spacing.
const SUPPORT: [f64; 3] = [3.1, 2.9, 2.4];

/// What every further order adds to it.
const SUPPORT_PER_ORDER: f64 = 0.5;

pub(super) fn immersed(scene: &Scene) -> ImmersedParams {
    let chosen = ImmersedParams::default();
    let order = scene.method.order.unwrap_or(chosen.order);
    let complete = |degree| Ghosts::Image(Interpolation::Complete { degree });
    let ghosts = match scene.method.options.ghosts {
        None | Some(GhostsName::Constrained) => Ghosts::Constrained { degree: order },
        Some(GhostsName::Linear) => complete(1),
        Some(GhostsName::Trilinear) => Ghosts::Image(Interpolation::Trilinear),
        Some(GhostsName::Quadratic) => complete(2),
        Some(GhostsName::Cubic) => complete(3),
    };
    ImmersedParams { order, ghosts, unsteady: scene.time.is_some() }
}

pub(super) fn reaction(scene: &Scene) -> ReactionParams {
    let options = &scene.method.options;
    // The paper's source is the gradient of its averages of labels.
    let chosen = match options.reaction {
        Some(ReactionName::Smoothed) => ReactionParams { sigma: Sigma::Harmonic, ..ReactionParams::paper() },
        _ => ReactionParams::default(),
    };
    ReactionParams {
        order: scene.method.order.unwrap_or(chosen.order),
        smoothing: options.kernel.map_or(chosen.smoothing, |name| match name {
            KernelName::Convolution => Smoothing::Convolution,
            KernelName::Diffusion => Smoothing::Diffusion,
            KernelName::Distance => Smoothing::Distance,
        }),
        width: options.width.unwrap_or(chosen.width),
        sigma: options.sigma.map_or(chosen.sigma, |name| match name {
            SigmaName::Harmonic => Sigma::Harmonic,
            SigmaName::Arithmetic => Sigma::Arithmetic,
            SigmaName::Sharp => Sigma::Sharp,
        }),
        source: options.reaction.map_or(chosen.source, |name| match name {
            ReactionName::Operator => ReactionSource::Operator,
            ReactionName::Smoothed => ReactionSource::Smoothed,
        }),
        unsteady: scene.time.is_some(),
    }
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

pub(super) fn reaction_steps() -> Steps {
    Steps {
        stencils: true,
        no_stencils: "",
        selection: false,
        constrained: None,
        cells: 0.0,
        may_need_cells: false,
    }
}
