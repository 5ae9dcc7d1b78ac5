//! Corners at which the solution is singular: which there are, which the method serves, and what those cost that it does not.

use meshless_interfaces::{Corner, CornerData, Discretization, Obstacle, Problem, corners};

use super::honest::Reason;
use crate::plan::Plan;
use crate::report::CornerReport;
use crate::scene::Scene;

/// Exponents are as many times their distance from the next whole number as weak as one half way between two: where a curve is
/// given by a polygon of many sides, each corner is almost none.
const WEAK: f64 = 2.0;

/// The corners of a problem, as its method sees them.
pub(super) fn found<const D: usize>(
    plan: &Plan,
    problem: &Problem<'_, D>,
    discretization: &Discretization,
) -> Vec<Corner> {
    match &discretization.corners {
        Some(corners) => corners.clone(),
        None => corners(&CornerData::from(problem), plan.method.params.order()),
    }
}

/// As a report has them.
pub(super) fn report(corners: &[Corner]) -> Vec<CornerReport> {
    let report = |corner: &Corner| CornerReport {
        at: corner.at.clone(),
        exponent: corner.exponent,
        served: corner.obstacle.is_none(),
        why_not: corner.obstacle.map(|obstacle| Obstacle::as_str(obstacle).to_owned()),
    };
    corners.iter().map(report).collect()
}

/// The relative error that the corners leave which the method does not serve, about: `(h / L)^(2 lambda)`, the rate of every method
/// that fits polynomials there (Strang and Fix, "An analysis of the finite element method", 1973, chapter 8), with the spacing h at
/// the corner, and the distance L of the next one. The vertices at the ends of edges in space that are served leave h/L times that.
/// Corners spoil the regions around them as much as the whole.
pub(super) fn reason<const D: usize>(scene: &Scene, problem: &Problem<'_, D>, corners: &[Corner]) -> Reason {
    let points = problem.cloud.points();
    let of_corner = |corner: &Corner| {
        let squared = |i: usize| (0..D).map(|k| (points[i][k] - corner.at[k]).powi(2)).sum::<f64>();
        let nearest = (0..points.len()).min_by(|&a, &b| squared(a).total_cmp(&squared(b)))?;
        let ratio = (problem.cloud.spacing()[nearest] / corner.clear).min(1.0);
        let power = corner.exponent;
        // Two values that meet are smeared over a spacing.
        let rate = if power == 0.0 { 1.0 } else { 2.0 * power };
        let rate = if corner.obstacle.is_none() { rate + 1.0 } else { rate };
        let whole = (power - power.round().max(1.0)).abs();
        let strength = if whole == 0.0 { 1.0 } else { (WEAK * whole).min(1.0) };
        Some(strength * ratio.powf(rate))
    };
    let left = corners.iter().filter(|corner| corner.obstacle.is_some() || corner.ends).filter_map(of_corner);
    let whole = left.reduce(f64::max);
    let regions = scene.regions.iter().filter_map(|region| Some((region.name.clone(), whole?)));
    Reason { by: "corners", whole, regions: regions.collect() }
}
