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

/// How far beside a point other feet of it are looked for where the nearest is none, over the reach. From half the reach the nearest
/// surface may still be the same one: that of a box which begins at the boundary, for all points nearer to the boundary than the
/// interface.
const STARTS: [f64; 2] = [0.5, 1.0];

/// Least cosine of the angle between the normals of two feet on an interface without a bend in between.
const NO_BEND: f64 = 0.7;

/// How far round a node on the boundary it is looked what is there, in spacings: far more than [`TIE`], far less than what curves.
const BESIDE: f64 = 1e-5;

/// How far inside of the domain such a place has to be, over its distance from the node: what runs along the boundary is not.
const INSIDE: f64 = 0.05;

/// Places on half an edge of the square or cube round a node, by dimension: in the plane they see wedges of 7 degrees.
const ROUND: [i32; 3] = [1, 8, 2];

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

    /// The same for a cloud of a domain. A node on its boundary that is on the surface of a region, with nothing of the region round
    /// it in the domain, belongs to what there is: a face of the domain may lie on the plane of a half-space beside it.
    pub fn labels_within(&self, domain: &Domain<D>, cloud: &Cloud<D>) -> Vec<u16> {
        let of = |(i, (x, &h)): (usize, (&[f64; D], &f64))| {
            let label = self.label(x, h);
            match self.shape(label) {
                Some(shape) if cloud.is_boundary(i) && is_on_surface(shape, x, h) => {
                    self.label_beside(domain, x, BESIDE * h, label)
                }
                _ => label,
            }
        };
        cloud.points().par_iter().zip(cloud.spacing()).enumerate().map(of).collect()
    }

    /// `label`, where the region reaches to `x` within the domain; else that of the most of what is round `x`.
    fn label_beside(&self, domain: &Domain<D>, x: &[f64; D], step: f64, label: u16) -> u16 {
        let around = directions::<D>().map(|direction| axpy(x, step, &direction));
        let inside = around.filter(|p| domain.distance_estimate(p) < -INSIDE * step);
        let mut found: Vec<(u16, usize)> = Vec::new();
        for label in inside.map(|p| self.label(&p, 0.0)) {
            match found.iter_mut().find(|(known, _)| *known == label) {
                Some((_, times)) => *times += 1,
                None => found.push((label, 1)),
            }
        }
        let most = found.iter().max_by(|a, b| a.1.cmp(&b.1).then(b.0.cmp(&a.0)));
        match most {
            Some(&(most, _)) if found.iter().all(|(known, _)| *known != label) => most,
            _ => label,
        }
    }

    /// Projects `x` onto the interface between regions `a` and `b`; the normal points from `a` to `b` and the distance
    /// is negative on the side of `a`.
    ///
    /// The interface lies on the surface of the one named first. Where other regions cover that surface at the foot
    /// of `x`, starting points half the reach away along the axes, and failing those the whole, are tried and the nearest valid foot
    /// is returned.
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
            let best = STARTS.iter().find_map(|&far| {
                let offsets = (0..D).flat_map(|i| [-far * reach, far * reach].map(|t| (i, t)));
                let others = offsets.filter_map(|(i, t)| {
                    let mut start = *x;
                    start[i] += t;
                    let p = shape.project(&start, reach).ok()?;
                    let (place, distance) = (placed(&p), crate::vector::distance(x, &p.point));
                    (distance <= reach && place < Where::Along)
                        .then_some((place, Projection { distance, ..p }))
                });
                others.min_by(|p, q| p.0.cmp(&q.0).then(p.1.distance.total_cmp(&q.1.distance)))
            });
            let bends = |p: &Projection<D>| dot(&p.normal, &found.normal) < NO_BEND;
            found = match best {
                // The interface leads on beyond the boundary.
                Some((place, p)) if nearest == Where::Beyond && (place != Where::Inside || !bends(&p)) => {
                    found
                }
                None if nearest == Where::Beyond => found,
                Some((_, mut p)) => {
                    // On another part of the surface, at the boundary, the level says nothing about the side.
                    let side = match is_on_surface(shape, x, reach) {
                        true => dot(&axpy(x, -1.0, &p.point), &p.normal),
                        false => shape.level(x),
                    };
                    p.distance = p.distance.copysign(side);
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

/// Whether a point is on the surface of a shape, up to [`TIE`].
fn is_on_surface<const D: usize>(shape: &Shape<D>, x: &[f64; D], spacing: f64) -> bool {
    shape.level(x).abs() <= TIE * spacing * norm(&shape.gradient(x))
}

/// Unit vectors to the places of a grid on the surface of a square or cube.
fn directions<const D: usize>() -> impl Iterator<Item = [f64; D]> {
    let most = ROUND[D.clamp(1, 3) - 1];
    let side = (2 * most + 1) as usize;
    (0..side.pow(D as u32)).filter_map(move |code| {
        let mut rest = code;
        let place: [i32; D] = std::array::from_fn(|_| {
            let digit = (rest % side) as i32 - most;
            rest /= side;
            digit
        });
        let outermost = place.iter().any(|c| c.abs() == most);
        let place = place.map(f64::from);
        outermost.then(|| scale(1.0 / norm(&place), &place))
    })
}
