//! The spacings of the next cloud, from where the last solution is worst.
//!
//! What is wrong at a node by itself, its indicator, changes u elsewhere by about `indicator * h^(D - 2)`: that is what the source changes it by
//! which the node stands for. With an error of order q it falls like `h^(q + D)`, and the error of all nodes in a unit of volume like
//! `h^q`. For an error of the whole the fewest nodes do where all of them have the same share (equidistribution; de Boor, "Good approximation by splines with
//! variable knots", 1973). Where that saves few nodes the indicators are flat, and all spacings fall alike.

use std::sync::Arc;

use crate::NodalField;
use crate::scene::{Scene, Wanted};

/// Nodes of an adapted cloud over those of one that is finer everywhere from which on nothing is saved.
const SAVES: f64 = 0.7;

/// Nodes of an adapted cloud over those of the last one at least: with fewer nothing may get better.
const MORE: f64 = 1.25;

/// How far round a node what it asks for does not grow yet, in its old spacing: nodes between it and the next one.
const BETWEEN: f64 = 0.7;

/// A spacing that is smaller than the one that there is by less than this is the same.
const SAME: f64 = 0.98;

/// Halvings on the way to the share of a node.
const HALVINGS: usize = 60;

/// The spacings that a solution asks for, for errors of the order that are to fall by a factor, each to `least` of what it is; `None` where all spacings may as well
/// fall to `uniform`, and where they fall to `uniform_least` anyway.
pub(super) fn wanted(
    scene: &Scene,
    field: &NodalField,
    (order, factor): (f64, f64),
    (least, uniform_least, uniform): (f64, f64, f64),
) -> Option<Arc<Vec<Wanted>>> {
    // A factor that the least step of an even cloud brings needs no more than that.
    if factor >= uniform_least.powf(order) {
        return None;
    }
    let indicator = field.indicator.as_ref()?;
    let dimension = field.dimension as i32;
    let shares: Vec<f64> = (indicator.iter().zip(&field.spacing))
        .map(|(own, h)| own * h.powi(dimension - 2))
        .map(|share| if share.is_finite() { share } else { 0.0 })
        .collect();
    let total: f64 = shares.iter().sum();
    let largest = shares.iter().copied().fold(0.0, f64::max);
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let power = 1.0 / (order + f64::from(dimension));
    let ratio = |share: f64, allowed: f64| {
        if share > allowed { (allowed / share).powf(power).max(least) } else { 1.0 }
    };
    let left = |allowed: f64| shares.iter().map(|&s| s * ratio(s, allowed).powf(order)).sum::<f64>();
    let (mut low, mut high) = ((1e-30 * largest).ln(), largest.ln());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if left(middle.exp()) > factor * total { &mut high } else { &mut low }) = middle;
    }
    let mut allowed = low.exp();
    let ratios = |allowed: f64| -> Vec<f64> { shares.iter().map(|&share| ratio(share, allowed)).collect() };
    let nodes = |ratios: &[f64]| ratios.iter().map(|ratio| ratio.powi(-dimension)).sum::<f64>();
    let mut chosen = ratios(allowed);
    for _ in 0..HALVINGS {
        if nodes(&chosen) >= MORE * chosen.len() as f64 {
            break;
        }
        allowed *= 0.5;
        chosen = ratios(allowed);
    }
    let (ratios, nodes) = (&chosen, nodes(&chosen));
    if nodes > SAVES * ratios.len() as f64 * uniform.powi(-dimension) {
        return None;
    }
    let given = |x: &[f64; 3]| scene.points.spacing.expr.eval(&x[..field.dimension]);
    let asked = field.points.iter().zip(&field.spacing).zip(ratios);
    let asked = asked.filter_map(|((at, h), ratio)| {
        let spacing = ratio * h;
        let is_finer = spacing < SAME * given(at);
        is_finer.then_some(Wanted { at: *at, spacing, within: BETWEEN * h })
    });
    Some(Arc::new(asked.collect()))
}
