//! The rims of cylinders: curved edges in space at which solutions are singular.
//!
//! Across an edge the leading term is that of the plane at right angles to it. Its exponent is found there; no functions serve a
//! curved edge.

use std::f64::consts::TAU;

use meshless_geometry::{Cylinder, Shape};

use super::wedge::{End, Sector, Wedge};
use super::{Corner, CornerData, Obstacle, condition_at};
use crate::Condition;

/// How far from an edge what meets there is looked at, over the length of the edge.
const BESIDE: f64 = 1e-4;

/// Directions in which it is looked; every sector that matters is much wider than the angle between two.
const DIRECTIONS: usize = 720;

/// How often the angle between two directions is halved to find a ray.
const HALVINGS: usize = 40;

/// How far from whole numbers an exponent may be for its function to count as a polynomial: rays are found by halving.
const WHOLE: f64 = 1e-5;

/// Rims that are looked at at most.
const MOST_RIMS: usize = 5_000;

/// Sides of the polygon that stands for a rim.
const SIDES: usize = 64;

/// A point of an edge: where, two directions across it, the length of the edge.
type Across = ([f64; 3], [[f64; 3]; 2], f64);

/// The rims whose solutions have a power below `order` that is no polynomial; one point of each.
pub(crate) fn rims<const D: usize>(data: &CornerData<'_, D>, order: usize) -> Vec<Corner> {
    if D != 3 {
        return Vec::new();
    }
    let mut shapes: Vec<&Shape<D>> = vec![data.domain.outer()];
    shapes.extend(data.domain.curved_faces().into_iter().map(|(_, shape, _)| shape));
    shapes.extend((0..data.regions.len() as u16).filter_map(|label| data.regions.shape(label)));
    let leaves = shapes.into_iter().flat_map(Shape::leaves).map(|(leaf, _)| leaf);
    let mut all: Vec<(Across, Vec<Vec<f64>>)> = Vec::new();
    for leaf in leaves {
        if let Shape::Cylinder(cylinder) = leaf {
            of_cylinder(cylinder, &mut all);
        }
    }
    if all.len() > MOST_RIMS {
        return Vec::new();
    }
    let mut found: Vec<Corner> = Vec::new();
    for (across, line) in all {
        let Some(exponent) = exponent(data, &across, order as f64) else { continue };
        let at = across.0.to_vec();
        if found.iter().all(|known| known.at != at) {
            let (clear, obstacle) = (0.5 * across.2, Some(Obstacle::Curved));
            found.push(Corner { at, exponent, clear, obstacle, line, tips: Vec::new() });
        }
    }
    found
}

/// The two rims of a cylinder: a point of each, and all round.
fn of_cylinder<const D: usize>(cylinder: &Cylinder<D>, all: &mut Vec<(Across, Vec<Vec<f64>>)>) {
    let Some(half) = cylinder.half_length() else { return };
    let [center, axis] =
        [cylinder.center(), cylinder.axis()].map(|x| -> [f64; 3] { std::array::from_fn(|k| x[k]) });
    // Any direction across the axis.
    let least = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs())).unwrap_or(0);
    let mut out: [f64; 3] = std::array::from_fn(|k| f64::from(u8::from(k == least)) - axis[least] * axis[k]);
    let length = out.iter().map(|x| x * x).sum::<f64>().sqrt();
    out.iter_mut().for_each(|x| *x /= length);
    let [[ax, ay, az], [ox, oy, oz]] = [axis, out];
    let aside = [ay * oz - az * oy, az * ox - ax * oz, ax * oy - ay * ox];
    for sign in [-1.0, 1.0] {
        let place = |angle: f64| -> [f64; 3] {
            let (sin, cos) = angle.sin_cos();
            let across = |k: usize| cylinder.radius() * (cos * out[k] + sin * aside[k]);
            std::array::from_fn(|k| center[k] + sign * half * axis[k] + across(k))
        };
        let line = (0..=SIDES).map(|k| place(TAU * k as f64 / SIDES as f64).to_vec()).collect();
        all.push(((place(0.0), [out, axis], cylinder.radius().min(half)), line));
    }
}

/// The smallest exponent below `most` of a power that is no polynomial.
fn exponent<const D: usize>(
    data: &CornerData<'_, D>,
    (at, [e, f], length): &Across,
    most: f64,
) -> Option<f64> {
    let step = BESIDE * length;
    let place = |angle: f64, r: f64| -> [f64; D] {
        let (sin, cos) = angle.sin_cos();
        std::array::from_fn(|k| at[k] + r * (cos * e[k] + sin * f[k]))
    };
    let label = |angle: f64| {
        let x = place(angle, step);
        data.domain.contains(&x, 0.0).then(|| data.regions.label(&x, 0.0))
    };
    let direction = |k: usize| TAU * (k as f64 + 0.5) / DIRECTIONS as f64;
    let labels: Vec<Option<u16>> = (0..DIRECTIONS).map(|k| label(direction(k))).collect();
    // The rays, each with what is on its two sides.
    let mut rays = Vec::new();
    for k in 0..DIRECTIONS {
        let (before, after) = (labels[k], labels[(k + 1) % DIRECTIONS]);
        if before != after {
            let (mut low, mut high) = (direction(k), direction(k) + TAU / DIRECTIONS as f64);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if label(middle) == before { &mut low } else { &mut high }) = middle;
            }
            rays.push((0.5 * (low + high), after));
        }
    }
    let count = rays.len();
    let outside: Vec<usize> = (0..count).filter(|&k| rays[k].1.is_none()).collect();
    let first = match outside[..] {
        [] if count > 1 => 0,
        [only] => (only + 1) % count,
        _ => return None,
    };
    let chain = count - outside.len();
    let sector = |k: usize| {
        let (here, next) = (rays[(first + k) % count], rays[(first + k + 1) % count]);
        let opening = (next.0 - here.0).rem_euclid(TAU);
        let label = here.1?;
        let x = place(here.0 + 0.5 * opening, step);
        let eta = data.materials.get(label as usize)?.diffusivity.at(&x);
        (eta > 0.0 && eta.is_finite()).then_some(Sector { opening, eta, scale: 1.0 })
    };
    let sectors: Option<Vec<Sector>> = (0..chain).map(sector).collect();
    let ends = match outside[..] {
        [] => None,
        _ => {
            let of_ray = |k: usize| end_at(data, &place(rays[(first + k) % count].0, step), step);
            Some([of_ray(0), of_ray(chain)])
        }
    };
    let exponents = Wedge { sectors: sectors?, ends }.exponents(most);
    exponents.iter().map(|e| e.0).find(|power| (power - power.round()).abs() > WHOLE)
}

/// What holds on the boundary at a point.
fn end_at<const D: usize>(data: &CornerData<'_, D>, x: &[f64; D], step: f64) -> End {
    match condition_at(data, x, step) {
        Some(Condition::Dirichlet(_)) => End::Dirichlet,
        _ => End::Flux,
    }
}
