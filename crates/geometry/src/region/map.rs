use rayon::prelude::*;

use crate::cloud::Cloud;
use crate::domain::Domain;
use crate::error::GeometryError;
use crate::projection::{Projection, ProjectionError};
use crate::shape::Shape;
use crate::vector::{axpy, dot, norm, scale};

/// Nodes nearer to a region's surface than this count as inside: a length relative to the node's spacing. Far above
/// the rounding of coordinates and levels, far below any distance that matters to a method.
pub const TIE: f64 = 1e-9;

/// How far from an interface the labels on its two sides are read, relative to the reach of the search.
const SIDE_STEP: f64 = 1e-4;

/// How far outside of a domain the foot on an interface may be, over the domain's diameter: rounding.
const ROUNDING: f64 = 1e-9;

/// How far outside of a domain, in units of the step beside a foot, the side is that lies beyond a boundary which the interface
/// runs along: one that meets the boundary at an angle is less far out.
const OUTSIDE: f64 = 0.9;

/// Least cosine of the angle between the normals of two feet on an interface without a bend in between.
const NO_BEND: f64 = 0.7;

/// Where the foot on an interface is, the best first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Where {
    Inside,
    /// Outside of the domain.
    Beyond,
    /// On its boundary, with one side outside; or no interface.
    Along,
}

/// The shape of a region; `None` for the background.
pub type RegionShape<const D: usize> = Option<Shape<D>>;

/// An ordered list of regions. A point belongs to the first region whose shape holds it; the last region has no shape
/// and holds the rest.
#[derive(Clone, Debug)]
pub struct RegionMap<const D: usize> {
    shapes: Vec<Shape<D>>,
}

impl<const D: usize> RegionMap<D> {
    /// The regions in order; their labels are their positions.
    ///
    /// # Errors
    /// [`GeometryError::InvalidRegions`] unless exactly the last region has no shape.
    pub fn new(regions: Vec<RegionShape<D>>) -> Result<Self, GeometryError> {
        let invalid = |reason: String| Err(GeometryError::InvalidRegions { reason });
        let n = regions.len();
        if n == 0 || n > u16::MAX as usize {
            return invalid(format!("{n} regions; there must be between 1 and 65535"));
        }
        match regions.iter().position(Option::is_none) {
            None => return invalid("the last region must have no geometry: it is the background".to_owned()),
            Some(i) if i + 1 < n => {
                return invalid(format!(
                    "region {i} has no geometry, so that those after it are never reached"
                ));
            }
            Some(_) => {}
        }
        Ok(Self { shapes: regions.into_iter().flatten().collect() })
    }

    /// Number of regions, the background included.
    pub fn len(&self) -> usize {
        self.shapes.len() + 1
    }

    /// Whether there are no regions: never.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The shape of a region, `None` for the background.
    pub fn shape(&self, label: u16) -> Option<&Shape<D>> {
        self.shapes.get(label as usize)
    }

    /// The region of a node at `x` with this spacing.
    ///
    /// A node on an interface, `|level| <= TIE * spacing * |gradient|`, counts as inside of the shape: it belongs to
    /// the region that is named first. Rounding in the coordinates or the level cannot flip it.
    pub fn label(&self, x: &[f64; D], spacing: f64) -> u16 {
        let inside = |shape: &Shape<D>| {
            let level = shape.level(x);
            level <= 0.0 || level <= TIE * spacing * norm(&shape.gradient(x))
        };
        self.shapes.iter().position(inside).unwrap_or(self.shapes.len()) as u16
    }

    /// The regions of all nodes.
    pub fn labels(&self, cloud: &Cloud<D>) -> Vec<u16> {
        cloud.points().par_iter().zip(cloud.spacing()).map(|(x, &h)| self.label(x, h)).collect()
    }

    /// Projects `x` onto the interface between regions `a` and `b`; the normal points from `a` to `b` and the distance
    /// is negative on the side of `a`.
    ///
    /// The interface lies on the surface of the one named first. Where other regions cover that surface at the foot
    /// of `x`, starting points half the reach away along the axes are tried and the nearest valid foot is returned.
    ///
    /// # Errors
    /// [`ProjectionError`] where the surface is out of reach, and [`ProjectionError::NotAnInterface`] where it does
    /// not separate these two regions near `x`.
    pub fn project(
        &self,
        a: u16,
        b: u16,
        x: &[f64; D],
        reach: f64,
    ) -> Result<Projection<D>, ProjectionError> {
        self.foot([a, b], x, reach, &|_, _| Where::Inside)
    }

    /// [`RegionMap::project`] onto what there is of the interface in a domain. The surface of a shape that ends at the domain's
    /// boundary runs along it, or beyond it: there is no interface. A foot beyond the boundary is returned only where the interface
    /// leads there without a bend.
    ///
    /// # Errors
    /// As [`RegionMap::project`].
    pub fn project_within(
        &self,
        domain: &Domain<D>,
        a: u16,
        b: u16,
        x: &[f64; D],
        reach: f64,
    ) -> Result<Projection<D>, ProjectionError> {
        let rounding = ROUNDING * domain.bounds().diameter();
        self.foot([a, b], x, reach, &|p, step| {
            if !domain.contains(&p.point, rounding) {
                return Where::Beyond;
            }
            let side = |t: f64| domain.contains(&axpy(&p.point, t, &p.normal), OUTSIDE * step);
            if side(-step) && side(step) { Where::Inside } else { Where::Along }
        })
    }

    /// The foot on the interface between two regions; `place` tells where one is that separates them, given the step to its sides.
    fn foot(
        &self,
        [a, b]: [u16; 2],
        x: &[f64; D],
        reach: f64,
        place: &dyn Fn(&Projection<D>, f64) -> Where,
    ) -> Result<Projection<D>, ProjectionError> {
        let none = || ProjectionError::NotAnInterface { at: x.to_vec(), regions: [a, b], reach };
        let shape =
            self.shape(a.min(b)).filter(|_| a != b && (a.max(b) as usize) < self.len()).ok_or_else(none)?;
        let step = SIDE_STEP * reach;
        let placed = |p: &Projection<D>| {
            let sides = [-step, step].map(|t| self.label(&axpy(&p.point, t, &p.normal), 0.0));
            if sides == [a.min(b), a.max(b)] { place(p, step) } else { Where::Along }
        };
        let mut found = shape.project(x, reach)?;
        let nearest = placed(&found);
        if nearest != Where::Inside {
            let offsets = (0..D).flat_map(|i| [-0.5 * reach, 0.5 * reach].map(|t| (i, t)));
            let others = offsets.filter_map(|(i, t)| {
                let mut start = *x;
                start[i] += t;
                let p = shape.project(&start, reach).ok()?;
                let (place, distance) = (placed(&p), crate::vector::distance(x, &p.point));
                (distance <= reach && place < Where::Along).then_some((place, Projection { distance, ..p }))
            });
            let best = others.min_by(|p, q| p.0.cmp(&q.0).then(p.1.distance.total_cmp(&q.1.distance)));
            let bends = |p: &Projection<D>| dot(&p.normal, &found.normal) < NO_BEND;
            found = match best {
                // The interface leads on beyond the boundary.
                Some((place, p)) if nearest == Where::Beyond && (place != Where::Inside || !bends(&p)) => {
                    found
                }
                None if nearest == Where::Beyond => found,
                Some((_, mut p)) => {
                    p.distance = p.distance.copysign(shape.level(x));
                    p
                }
                None => return Err(none()),
            };
        }
        if a > b {
            found.normal = scale(-1.0, &found.normal);
            found.distance = -found.distance;
        }
        Ok(found)
    }
}
