//! Points of interfaces that carry an unknown, and interpolation between them.

use meshless_geometry::Projection;
use meshless_stencils::ConstrainedFit;

use crate::Problem;
use crate::method::InterfacePoint;
use crate::particle_difference::feet::{Feet, Foot};
use crate::particle_difference::frame::Frame;

/// Least distance of two points of an interface, over the spacing of nodes.
const SEPARATION: f64 = 0.8;

/// The same where u is prescribed: its value at a point sees an average of the jump over a support, and nothing would
/// determine a jump that changes sign from point to point within it.
const WIDE_SEPARATION: f64 = 2.5;

/// How far points are from one between which they interpolate, over their distance: two on either side along a curve.
const REACH: f64 = 2.75;

/// Cosine between normals below which two points are on different legs of a corner.
const SAME_LEG: f64 = 0.8;

/// A point of an interface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point<const D: usize> {
    pub(super) at: [f64; D],
    /// Unit normal from the first of the two regions to the second.
    pub(super) normal: [f64; D],
    /// The regions, the one named first in front.
    pub(super) between: [u16; 2],
    /// The node whose foot it is: its neighbours are those of the point.
    pub(super) node: usize,
}

/// All of them.
pub(super) struct InterfacePoints<const D: usize> {
    pub(super) list: Vec<Point<D>>,
}

/// Distance of points on the interface between two regions, over the spacing.
pub(super) fn separation<const D: usize>(problem: &Problem<'_, D>, between: &[u16; 2]) -> f64 {
    match problem.law_between(between[0], between[1]) {
        Some((jump, _)) if jump.prescribed.is_some() => WIDE_SEPARATION,
        _ => SEPARATION,
    }
}

impl<const D: usize> InterfacePoints<D> {
    /// The feet of the nodes near interfaces, in the order of the nodes, thinned to a spacing.
    pub(super) fn new(problem: &Problem<'_, D>, feet: &Feet<D>) -> Self {
        let mut list: Vec<Point<D>> = Vec::new();
        for node in 0..problem.cloud.len() {
            let own = problem.labels[node];
            for foot in feet.of(node) {
                let sign = if own < foot.beyond { 1.0 } else { -1.0 };
                let point = Point {
                    at: foot.at.point,
                    normal: foot.at.normal.map(|n| sign * n),
                    between: [own.min(foot.beyond), own.max(foot.beyond)],
                    node,
                };
                let least = separation(problem, &point.between) * problem.cloud.spacing()[node];
                if list
                    .iter()
                    .all(|p| !p.is_on(&point.between, &point.normal) || apart(p, &point.at) >= least)
                {
                    list.push(point);
                }
            }
        }
        Self { list }
    }

    /// For reports.
    pub(super) fn described(&self) -> Vec<InterfacePoint> {
        self.list
            .iter()
            .map(|p| InterfacePoint { at: p.at.to_vec(), normal: p.normal.to_vec(), between: p.between })
            .collect()
    }

    /// Adds `factor` times the jump at a point of the interface `between` two regions, as it is interpolated linearly
    /// from the points around it.
    pub(super) fn interpolate(
        &self,
        between: [u16; 2],
        at: &[f64; D],
        normal: &[f64; D],
        [separation, spacing]: [f64; 2],
        factor: f64,
        out: &mut Vec<(u32, f64)>,
    ) {
        let reach = REACH * separation * spacing;
        let near: Vec<(u32, f64)> = (0..)
            .zip(&self.list)
            .filter(|(_, p)| p.is_on(&between, normal))
            .map(|(k, p)| (k, apart(p, at)))
            .filter(|(_, distance)| *distance <= reach)
            .collect();
        let Some(nearest) = near.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)) else {
            // Farther from all points than they are from each other: on a leg of its own; the nearest of any leg.
            let any = (0..).zip(&self.list).filter(|(_, p)| p.between == between);
            let nearest = any.min_by(|a, b| apart(a.1, at).total_cmp(&apart(b.1, at)));
            out.extend(nearest.map(|(k, _)| (k, factor)));
            return;
        };
        let frame = Frame::new(normal);
        let mut fit = ConstrainedFit::default();
        fit.clear(D);
        for &(k, distance) in &near {
            let point = &self.list[k as usize];
            let row = fit.observe((1.0 - distance / (1.1 * reach)).powi(4));
            let local = frame.turn(&std::array::from_fn(|k| (point.at[k] - at[k]) / reach));
            row.copy_from_slice(&local);
            // The first coordinate is across the interface; in its place the constant.
            row[0] = 1.0;
        }
        fit.factor();
        let (mut weights, mut wanted) = (vec![0.0; near.len()], vec![0.0; D]);
        wanted[0] = 1.0;
        match fit.functional(&wanted, &mut weights, &mut []) {
            Ok(()) => out.extend(near.iter().zip(weights).map(|((k, _), w)| (*k, factor * w))),
            // Fewer points than a plane needs.
            Err(_) => out.push((nearest.0, factor)),
        }
    }
}

impl<const D: usize> Point<D> {
    /// The interface as seen from the point itself, from the first region.
    pub(super) fn foot(&self) -> Foot<D> {
        let at = Projection { point: self.at, normal: self.normal, distance: 0.0 };
        Foot { beyond: self.between[1], at }
    }

    fn is_on(&self, between: &[u16; 2], normal: &[f64; D]) -> bool {
        let parallel: f64 = (0..D).map(|k| self.normal[k] * normal[k]).sum();
        self.between == *between && parallel >= SAME_LEG
    }
}

fn apart<const D: usize>(point: &Point<D>, at: &[f64; D]) -> f64 {
    (0..D).map(|k| (point.at[k] - at[k]).powi(2)).sum::<f64>().sqrt()
}
