//! The sharp method in plans.

use meshless_interfaces::sharp::{Conservation, MAX_ORDER, SharpParams};

use super::Steps;
use crate::Error;
use crate::plan::effects::Survey;
use crate::scene::{ConservationName, RegionSpec, Scene};

pub(super) fn params(scene: &Scene) -> SharpParams {
    let chosen = SharpParams::default();
    SharpParams {
        order: scene.method.order.unwrap_or(chosen.order),
        unsteady: scene.time.is_some(),
        conservation: conservation(scene),
        ..chosen
    }
}

/// Cells by region are made in the plane and in space, and balances of what is steady.
fn conservation(scene: &Scene) -> Conservation {
    match scene.method.options.conservation {
        _ if !has_balances(scene) => Conservation::None,
        None => SharpParams::default().conservation,
        Some(ConservationName::None) => Conservation::None,
        Some(ConservationName::Crossing) => Conservation::Crossing,
        Some(ConservationName::All) => Conservation::All,
    }
}

fn has_balances(scene: &Scene) -> bool {
    let moving = |r: &RegionSpec| r.reaction.is_some() || !r.velocity.is_empty();
    scene.dimension > 1 && scene.time.is_none() && !scene.regions.iter().any(moving)
}

/// Microseconds of a stencil beside its factorisation, and those of a thousand multiplications of that: about, on one core.
const STENCIL_BASE: f64 = 5.0;
const STENCIL_RATE: f64 = 2.5;

/// One degree more, on stencils half-way to those of the next order. On the line, where all polynomials without a source are
/// linear, the next order itself.
pub(super) fn finer(params: &SharpParams, dimension: usize) -> Option<SharpParams> {
    let order = params.order + 2;
    if dimension == 1 {
        return (order <= MAX_ORDER[0]).then_some(SharpParams { order, ..*params });
    }
    let [own, next] = [*params, SharpParams { order, ..*params }].map(|p| p.stencil_nodes(dimension));
    let nodes = own.midpoint(next);
    Some(SharpParams { degree: Some(params.degree() + 1), nodes: Some(nodes), ..*params })
}

fn harmonic_polynomials(degree: usize, dimension: usize) -> usize {
    match dimension {
        1 => 2,
        2 => 2 * degree + 1,
        _ => (degree + 1) * (degree + 1),
    }
}

/// The same where the diffusivity varies: what its functions take beside the system for them, and a thousand multiplications of that.
const ADAPTED_BASE: f64 = 30.0;
const ADAPTED_RATE: f64 = 1.3;

/// What a stencil takes: least squares for the polynomials of one region, those that cross an interface being few; where the
/// diffusivity `varies` its functions are solved for first.
pub(super) fn stencil_microseconds(params: &SharpParams, dimension: usize, varies: bool) -> f64 {
    let (rows, columns) = (params.stencil_nodes(dimension), harmonic_polynomials(params.degree(), dimension));
    let adapted = if varies { adapted_microseconds(params, dimension) } else { 0.0 };
    STENCIL_BASE + 2e-3 * STENCIL_RATE * (rows * columns * columns) as f64 + adapted
}

/// A system for the monomials of a source from three times as many samples, with a right-hand side for each function.
fn adapted_microseconds(params: &SharpParams, dimension: usize) -> f64 {
    let functions = harmonic_polynomials(params.degree(), dimension) as f64;
    let monomials = (1..=dimension).fold(1.0, |n, k| n * (params.source_degree() + k) as f64 / k as f64);
    let made = 3.0 * monomials.powi(2) * (monomials + functions);
    let solved = 4.0 / 3.0 * monomials.powi(3) + 2.0 * monomials.powi(2) * functions;
    ADAPTED_BASE + 1e-3 * ADAPTED_RATE * (made + solved)
}

/// Orders that a dimension does not have, and balances where there are none.
pub(super) fn check(scene: &Scene) -> Result<(), Error> {
    let highest = MAX_ORDER[scene.dimension - 1];
    if let Some(order) = scene.method.order.filter(|&order| order > highest) {
        let message = format!("the method \"sharp\" has no order {order} in {}-D", scene.dimension);
        let error = scene.error_at_boundaries(message, format!("take an order up to {highest}"));
        return Err(error.into());
    }
    let asked = scene.method.options.conservation.filter(|name| *name != ConservationName::None);
    if asked.is_some() && !has_balances(scene) {
        let message = "the method \"sharp\" has balances for steady diffusion in the plane and in space only"
            .to_owned();
        let error = scene.error_at_boundaries(message, "remove the key `conservation`".to_owned());
        return Err(error.into());
    }
    Ok(())
}

pub(super) fn steps(params: &SharpParams, survey: &Survey) -> Steps {
    Steps {
        stencils: true,
        no_stencils: "",
        selection: false,
        constrained: Some(survey.has_interface()),
        cells: 0.0,
        may_need_cells: match params.conservation {
            Conservation::None => false,
            Conservation::Crossing => survey.has_interface(),
            Conservation::All => true,
        },
    }
}
