use rayon::prelude::*;

use crate::cloud::Cloud;
use crate::error::GeometryError;
use crate::projection::{Projection, ProjectionError};
use crate::shape::Shape;
use crate::vector::{axpy, norm, scale};

/// Nodes nearer to a region's surface than this count as inside: a length relative to the node's spacing. Far above
/// the rounding of coordinates and levels, far below any distance that matters to a method.
pub const TIE: f64 = 1e-9;

/// How far from an interface the labels on its two sides are read, relative to the reach of the search.
const SIDE_STEP: f64 = 1e-4;

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
        let none = || ProjectionError::NotAnInterface { at: x.to_vec(), regions: [a, b], reach };
        let shape =
            self.shape(a.min(b)).filter(|_| a != b && (a.max(b) as usize) < self.len()).ok_or_else(none)?;
        let step = SIDE_STEP * reach;
        let valid = |p: &Projection<D>| {
            let sides = [-step, step].map(|t| self.label(&axpy(&p.point, t, &p.normal), 0.0));
            sides == [a.min(b), a.max(b)]
        };
        let mut found = shape.project(x, reach)?;
        if !valid(&found) {
            let offsets = (0..D).flat_map(|i| [-0.5 * reach, 0.5 * reach].map(|t| (i, t)));
            found = offsets
                .filter_map(|(i, t)| {
                    let mut start = *x;
                    start[i] += t;
                    let p = shape.project(&start, reach).ok().filter(valid)?;
                    let distance = crate::vector::distance(x, &p.point);
                    (distance <= reach).then_some(Projection { distance, ..p })
                })
                .min_by(|p, q| p.distance.total_cmp(&q.distance))
                .ok_or_else(none)?;
            found.distance = found.distance.copysign(shape.level(x));
        }
        if a > b {
            found.normal = scale(-1.0, &found.normal);
            found.distance = -found.distance;
        }
        Ok(found)
    }
}
