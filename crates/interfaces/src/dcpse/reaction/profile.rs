//! Indicators as functions of the distance from the shapes of the regions.
//!
//! A Gaussian average of a ball's indicator is not the profile of a plane about its surface: that comes to lie nearer to the
//! center by half of `H w^2`, H the divergence of the normal. And even the profile of a plane gives a curved layer a wrong
//! resistance: a tube of flux has the cross-section `1 + H s` at the distance s, and so the resistance of a layer of width w is that
//! of the sharp interface only if the profile is moved *outwards* by half of `H w^2`.

use meshless_geometry::Shape;
use meshless_neighbors::CellList;

use super::indicator::{CUT_OFF, Share};
use crate::parallel;
use crate::{MethodError, Problem};

/// Largest curvature times width that is a curvature still, and no corner.
const RESOLVED_CURVATURE: f64 = 1.0;

/// Step of difference quotients of the normal, over the width.
const STEP: f64 = 1e-3;

/// Shares below this are none.
const NOTHING: f64 = 1e-14;

/// The share of every region near a node, and its gradient: that of the first shape, what it leaves of the second, and so on.
pub(super) fn shares<const D: usize>(
    problem: &Problem<'_, D>,
    width: f64,
) -> Result<Vec<Vec<Share<D>>>, MethodError> {
    let (points, spacing) = (problem.cloud.points(), problem.cloud.spacing());
    let largest = spacing.iter().fold(0.0_f64, |a, &b| a.max(b));
    let index = CellList::new(points, CUT_OFF * width * largest)?;
    let at = |found: &mut Vec<u32>, i: usize| {
        let (x, w) = (&points[i], width * spacing[i]);
        found.clear();
        index.within(x, CUT_OFF * w, found);
        match found.iter().all(|&j| problem.labels[j as usize] == problem.labels[i]) {
            true => Vec::new(),
            false => shares_at(problem, x, w),
        }
    };
    Ok(parallel::map_with(points.len(), Vec::new, at))
}

fn shares_at<const D: usize>(problem: &Problem<'_, D>, x: &[f64; D], w: f64) -> Vec<Share<D>> {
    let mut shares: Vec<Share<D>> = Vec::new();
    let (mut left, mut slope_left) = (1.0, [0.0; D]);
    let last = problem.regions.len() as u16 - 1;
    for region in 0..=last {
        let (inside, slope) = match problem.regions.shape(region) {
            Some(shape) => smeared(shape, x, w),
            None => (1.0, [0.0; D]),
        };
        let share = inside * left;
        if share > NOTHING {
            shares.push((region, share, std::array::from_fn(|k| slope[k] * left + inside * slope_left[k])));
        }
        slope_left = std::array::from_fn(|k| slope_left[k] * (1.0 - inside) - left * slope[k]);
        left *= 1.0 - inside;
    }
    if shares.len() > 1 { shares } else { Vec::new() }
}

/// The smeared indicator of a shape and its gradient.
fn smeared<const D: usize>(shape: &Shape<D>, x: &[f64; D], w: f64) -> (f64, [f64; D]) {
    let Ok(foot) = shape.project(x, (CUT_OFF + 1.0) * w) else {
        return (f64::from(u8::from(shape.level(x) <= 0.0)), [0.0; D]);
    };
    let curvature = divergence_of_normal(shape, &foot.point, STEP * w);
    let shift = if curvature.abs() * w <= RESOLVED_CURVATURE { 0.5 * curvature * w * w } else { 0.0 };
    let z = (foot.distance - shift) / w;
    let density = (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * w);
    (tail(z), foot.normal.map(|n| -n * density))
}

/// The divergence of the unit normals of a shape's level sets at a point; infinite where they have none.
fn divergence_of_normal<const D: usize>(shape: &Shape<D>, at: &[f64; D], step: f64) -> f64 {
    let component = |k: usize, t: f64| {
        let mut x = *at;
        x[k] += t;
        let gradient = shape.gradient(&x);
        gradient[k] / gradient.iter().map(|g| g * g).sum::<f64>().sqrt()
    };
    let sum: f64 = (0..D).map(|k| (component(k, step) - component(k, -step)) / (2.0 * step)).sum();
    if sum.is_finite() { sum } else { f64::INFINITY }
}

/// What a normal distribution has beyond z; to 1e-7 (Abramowitz and Stegun 1964, 26.2.17), which is far below what any width does.
fn tail(z: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * z.abs());
    let polynomial = [1.330_274_429, -1.821_255_978, 1.781_477_937, -0.356_563_782, 0.319_381_530]
        .into_iter()
        .fold(0.0, |sum, c| (sum + c) * t);
    let beyond = polynomial * (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    if z >= 0.0 { beyond } else { 1.0 - beyond }
}
