//! Corners at which the solution is singular: which there are, which the method serves, and what those cost that it does not.

use meshless_interfaces::{Corner, CornerData, Discretization, Obstacle, Problem, corners};
use meshless_neighbors::CellList;

use super::honest::Reason;
use crate::plan::Plan;
use crate::report::CornerReport;
use crate::scene::Scene;

/// Exponents are as many times their distance from the next whole number as weak as one half way between two: where a curve is
/// given by a polygon of many sides, each corner is almost none.
const WEAK: f64 = 2.0;

/// Digits that places have, over the size of the domain.
const DIGITS: i32 = 12;

/// Part of what a corner leaves by its rate that is error, by dimension: the median of estimates over true errors of random problems in
/// the plane is three; in space edges spoil more (a cube on a coarse cloud).
const SHARE: [f64; 3] = [0.07, 0.07, 0.5];

/// Distance of two vertices, over that of the next one, up to which they are one: rounding.
const SAME_PLACE: f64 = 1e-6;

/// How far from a corner it is looked how much u varies, in spacings.
const BESIDE: f64 = 2.0;

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

/// As a report has them, without rounding: in a domain of this size.
pub(super) fn report(corners: &[Corner], size: f64) -> Vec<CornerReport> {
    let digits = 10.0_f64.powi((DIGITS - size.log10().ceil() as i32).clamp(-290, 290));
    let rounded = |x: &f64| (x * digits).round() / digits + 0.0;
    let report = |corner: &Corner| CornerReport {
        at: corner.at.iter().map(rounded).collect(),
        exponent: corner.exponent,
        served: corner.obstacle.is_none(),
        why_not: corner.obstacle.map(|obstacle| Obstacle::as_str(obstacle).to_owned()),
    };
    corners.iter().map(report).collect()
}

/// A place at which a corner leaves something that the method does not serve.
struct Left<'a> {
    corner: &'a Corner,
    at: &'a [f64],
    /// An end of an edge in space that is served itself.
    is_tip: bool,
}

impl Left<'_> {
    /// The power of the spacing by which what it leaves falls.
    fn rate(&self) -> f64 {
        // Two values that meet are smeared over a spacing.
        let rate = if self.corner.exponent == 0.0 { 1.0 } else { 2.0 * self.corner.exponent };
        if self.is_tip { rate + 1.0 } else { rate }
    }
}

/// Each place once: edges meet in vertices.
fn left(corners: &[Corner]) -> Vec<Left<'_>> {
    let mut all: Vec<Left<'_>> = Vec::new();
    for corner in corners {
        if corner.obstacle.is_some() {
            all.push(Left { corner, at: &corner.at, is_tip: false });
            continue;
        }
        for tip in &corner.tips {
            let apart = |known: &Left<'_>| {
                let squares = known.at.iter().zip(tip).map(|(a, b)| (a - b).powi(2));
                squares.sum::<f64>().sqrt() > SAME_PLACE * corner.clear
            };
            match all.iter_mut().filter(|known| known.is_tip).find(|known| !apart(known)) {
                Some(known) if known.corner.exponent <= corner.exponent => {}
                Some(known) => known.corner = corner,
                None => all.push(Left { corner, at: tip, is_tip: true }),
            }
        }
    }
    all
}

/// The relative error that the corners leave which the method does not serve, about: `A (h / L)^(2 lambda)`, the rate of every method
/// that fits polynomials there (Strang and Fix, "An analysis of the finite element method", 1973, chapter 8), with the spacing h at
/// the corner, the distance L of the next one, and A what the singular part has there over the size of u, from how much u varies near
/// the corner. The vertices at the ends of edges in space that are served leave h/L times that. Corners spoil the regions around them
/// as much as the whole. The share of it that becomes error was measured on random problems (`docs/corners.md`).
pub(super) fn reason<const D: usize>(
    scene: &Scene,
    problem: &Problem<'_, D>,
    u: &[f64],
    corners: &[Corner],
) -> Reason {
    let (points, spacing) = (problem.cloud.points(), problem.cloud.spacing());
    let left = left(corners);
    let widest = spacing.iter().fold(0.0_f64, |a, &b| a.max(b));
    let Some(nodes) = CellList::new(points, widest).ok().filter(|_| !left.is_empty()) else {
        return Reason { by: "corners", whole: None, regions: Vec::new() };
    };
    let size = {
        let weights = spacing.iter().map(|h| h.powi(D as i32));
        let (squares, weight) = (u.iter().zip(weights))
            .fold((0.0, 0.0), |(squares, all), (u, weight)| (squares + weight * u * u, all + weight));
        (squares / weight).sqrt()
    };
    let mut found = Vec::new();
    let mut of_place = |place: &Left<'_>| {
        let at: [f64; D] = std::array::from_fn(|k| place.at[k]);
        let nearest = nodes.nearest_one(&at)? as usize;
        let near = BESIDE * spacing[nearest];
        found.clear();
        nodes.within(&at, near, &mut found);
        let (low, high) = found
            .iter()
            .map(|&i| u[i as usize])
            .fold((u[nearest], u[nearest]), |(low, high), u| (low.min(u), high.max(u)));
        let Corner { exponent: power, clear, .. } = *place.corner;
        let singular = (high - low) / size * (clear / near).max(1.0).powf(power);
        let ratio = (spacing[nearest] / clear).min(1.0);
        let whole = (power - power.round().max(1.0)).abs();
        let strength = if whole == 0.0 { 1.0 } else { (WEAK * whole).min(1.0) };
        Some(SHARE[D - 1] * strength * singular.min(1.0) * ratio.powf(place.rate()))
    };
    // Where u vanishes nothing is known.
    let squares: f64 = left.iter().filter_map(&mut of_place).filter(|e| e.is_finite()).map(|e| e * e).sum();
    let whole = Some(squares.sqrt());
    let regions = scene.regions.iter().filter_map(|region| Some((region.name.clone(), whole?)));
    Reason { by: "corners", whole, regions: regions.collect() }
}
