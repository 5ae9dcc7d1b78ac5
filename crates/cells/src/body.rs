//! The body that is clipped: an interval, a polygon or a polyhedron, with the node at the origin.

use crate::interval::Interval;
use crate::polygon::Polygon;
use crate::polyhedron::Polyhedron;
use crate::split::{Solid, heights};

/// Height above a cutting plane, relative to the sizes of the numbers that it was computed from, up to which a vertex
/// counts as lying on the plane and is kept: some ten times the round-off of the height. Regular grids have planes
/// through vertices and edges of the cell, which must not leave slivers.
pub(crate) const PLANE_TOLERANCE: f64 = 4e-15;

/// What a face of the body comes from; the order is that of the faces of the finished cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) enum Source {
    /// The bisector with the candidate at this place of the sorted list.
    Candidate(u32),
    /// A plane of the container.
    Plane(u32),
    /// A curved face of the container.
    Cut(u32),
    /// A plane that walls lie in; of the finished cell, a piece of a wall.
    Wall(u32),
    /// The box that the construction starts from.
    #[default]
    Start,
}

/// A part of the body's surface; components beyond the dimension are zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    pub(crate) source: Source,
    /// Vector area: outward normal times area.
    pub(crate) area: [f64; 3],
    pub(crate) centroid: [f64; 3],
}

/// Volume of a body, and the integral of the position over it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measure {
    pub(crate) volume: f64,
    pub(crate) moment: [f64; 3],
}

/// The body of the dimension at hand.
#[derive(Debug)]
pub(crate) enum Body<'s> {
    Interval(&'s mut Interval),
    Polygon(&'s mut Polygon),
    Polyhedron(&'s mut Polyhedron),
}

/// Copies a point into another number of dimensions; additional coordinates are zero.
pub(crate) fn resize<const D: usize, const K: usize>(x: &[f64; D]) -> [f64; K] {
    std::array::from_fn(|axis| if axis < D { x[axis] } else { 0.0 })
}

impl Body<'_> {
    /// Starts from the box from `lo` to `hi`.
    pub(crate) fn reset<const D: usize>(&mut self, lo: &[f64; D], hi: &[f64; D]) {
        match self {
            Self::Interval(body) => body.reset(lo[0], hi[0]),
            Self::Polygon(body) => body.reset(resize(lo), resize(hi)),
            Self::Polyhedron(body) => body.reset(resize(lo), resize(hi)),
        }
    }

    /// Keeps the part where `normal . x <= offset`, and says whether anything may have been cut away.
    pub(crate) fn clip<const D: usize>(&mut self, normal: &[f64; D], offset: f64, source: Source) -> bool {
        match self {
            Self::Interval(body) => {
                body.clip(normal[0], offset, source);
                true
            }
            Self::Polygon(body) => body.clip(resize(normal), offset, source),
            Self::Polyhedron(body) => body.clip(resize(normal), offset, source),
        }
    }

    /// Keeps the part where `level` is negative. Returns the largest magnitude of the level set at a vertex before the
    /// cut, `None` if the level set is not a number.
    pub(crate) fn cut<const D: usize>(
        &mut self,
        level: impl Fn(&[f64; D]) -> f64,
        source: Source,
    ) -> Option<f64> {
        match self {
            Self::Interval(body) => body.cut(|x| level(&resize(&[x])), source),
            Self::Polygon(body) => body.cut(|x| level(&resize(&x)), source),
            Self::Polyhedron(body) => body.cut(|x| level(&resize(&x)), source),
        }
    }

    /// Distance of the farthest vertex from the node.
    pub(crate) fn radius(&self) -> f64 {
        match self {
            Self::Interval(body) => body.radius(),
            Self::Polygon(body) => body.radius(),
            Self::Polyhedron(body) => body.radius(),
        }
    }

    /// The least and the largest height of a vertex above a plane.
    pub(crate) fn heights(&self, normal: &[f64; 3], offset: f64) -> [f64; 2] {
        match self {
            Self::Interval(body) => heights(&**body, normal, offset),
            Self::Polygon(body) => heights(&**body, normal, offset),
            Self::Polyhedron(body) => heights(&**body, normal, offset),
        }
    }

    /// The corners of the smallest box that holds the body.
    pub(crate) fn extent(&self) -> ([f64; 3], [f64; 3]) {
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let each = |x: [f64; 3]| {
            for k in 0..3 {
                (lo[k], hi[k]) = (lo[k].min(x[k]), hi[k].max(x[k]));
            }
        };
        match self {
            Self::Interval(body) => body.vertices(each),
            Self::Polygon(body) => body.vertices(each),
            Self::Polyhedron(body) => body.vertices(each),
        }
        (lo, hi)
    }

    pub(crate) fn is_empty(&self) -> bool {
        match self {
            Self::Interval(body) => body.is_empty(),
            Self::Polygon(body) => body.is_empty(),
            Self::Polyhedron(body) => body.is_empty(),
        }
    }

    /// Volume and first moment; appends the pieces of the surface.
    pub(crate) fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        match self {
            Self::Interval(body) => body.measure(pieces),
            Self::Polygon(body) => body.measure(pieces),
            Self::Polyhedron(body) => body.measure(pieces),
        }
    }
}
