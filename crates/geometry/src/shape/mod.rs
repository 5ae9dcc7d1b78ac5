//! Shapes: primitives with signed distances, level sets, and their unions, intersections and differences.

mod evaluate;
mod flat;
mod polygon;
mod primitives;
mod project;

use std::fmt;
use std::sync::Arc;

pub(crate) use evaluate::spatial;
pub use flat::FlatFace;
pub use polygon::Polygon;
pub use primitives::{Ball, Cylinder, HalfSpace};

use crate::aabb::Aabb;
use crate::error::GeometryError;
use crate::level_set::LevelSet;
use crate::surface::TriangleSurface;
use crate::vector::axpy;

/// A set of points, bounded by a surface.
///
/// [`Shape::level`] is negative inside and, for the primitives, the exact signed distance. Unions, intersections and
/// differences take minima and maxima of the levels of their parts.
#[derive(Clone)]
pub enum Shape<const D: usize> {
    /// An axis-aligned box.
    Box(Aabb<D>),
    /// A ball.
    Ball(Ball<D>),
    /// A circular cylinder; 3-D only.
    Cylinder(Cylinder<D>),
    /// A simple closed polygon; 2-D only.
    Polygon(Arc<Polygon>),
    /// The inside of a closed surface of triangles; 3-D only.
    Surface(Arc<TriangleSurface>),
    /// Everything behind a plane.
    HalfSpace(HalfSpace<D>),
    /// Where a function is negative.
    LevelSet(Arc<dyn LevelSet<D>>),
    /// Points of any of the parts.
    Union(Vec<Shape<D>>),
    /// Points of all of the parts.
    Intersection(Vec<Shape<D>>),
    /// Points of the first shape that are not in the second.
    Difference(Box<Shape<D>>, Box<Shape<D>>),
}

impl<const D: usize> Shape<D> {
    /// A box between two corners; see [`Aabb::new`] for the errors.
    pub fn cuboid(min: [f64; D], max: [f64; D]) -> Result<Self, GeometryError> {
        Aabb::new(min, max).map(Self::Box)
    }

    /// A ball; see [`Ball::new`] for the errors.
    pub fn ball(center: [f64; D], radius: f64) -> Result<Self, GeometryError> {
        Ball::new(center, radius).map(Self::Ball)
    }

    /// A cylinder in 3-D; see [`Cylinder::new`] for the meaning of the arguments and the errors.
    pub fn cylinder(
        center: [f64; D],
        axis: [f64; D],
        radius: f64,
        length: Option<f64>,
    ) -> Result<Self, GeometryError> {
        Cylinder::new(center, axis, radius, length).map(Self::Cylinder)
    }

    /// A polygon in 2-D; see [`Polygon::new`] for the errors, to which other dimensions than two are added.
    pub fn polygon(vertices: Vec<[f64; D]>) -> Result<Self, GeometryError> {
        if D != 2 {
            return Err(GeometryError::invalid("polygon", format!("it needs 2 dimensions, not {D}")));
        }
        Polygon::new(vertices.iter().map(|v| [v[0], v[1]]).collect()).map(|p| Self::Polygon(Arc::new(p)))
    }

    /// The inside of a closed surface of triangles in 3-D.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] in other dimensions.
    pub fn surface(surface: Arc<TriangleSurface>) -> Result<Self, GeometryError> {
        if D != 3 {
            return Err(GeometryError::invalid("surface", format!("it needs 3 dimensions, not {D}")));
        }
        Ok(Self::Surface(surface))
    }

    /// A half-space; see [`HalfSpace::new`] for the errors.
    pub fn half_space(point: [f64; D], normal: [f64; D]) -> Result<Self, GeometryError> {
        HalfSpace::new(point, normal).map(Self::HalfSpace)
    }

    /// The points where a function is negative.
    pub fn level_set(function: Arc<dyn LevelSet<D>>) -> Self {
        Self::LevelSet(function)
    }

    /// The union of at least one shape.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] for an empty list.
    pub fn union(parts: Vec<Self>) -> Result<Self, GeometryError> {
        if parts.is_empty() {
            return Err(GeometryError::invalid("union", "it has no parts"));
        }
        Ok(Self::Union(parts))
    }

    /// The intersection of at least one shape.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] for an empty list.
    pub fn intersection(parts: Vec<Self>) -> Result<Self, GeometryError> {
        if parts.is_empty() {
            return Err(GeometryError::invalid("intersection", "it has no parts"));
        }
        Ok(Self::Intersection(parts))
    }

    /// The points of `self` that are not in `other`.
    pub fn difference(self, other: Self) -> Self {
        Self::Difference(Box::new(self), Box::new(other))
    }

    /// The shapes without parts that this one is made of, left to right, each with whether it is subtracted (its
    /// inside is then outside of the whole).
    pub fn leaves(&self) -> Vec<(&Self, bool)> {
        let mut found = Vec::new();
        self.collect_leaves(false, &mut found);
        found
    }

    /// Whether the level is the signed distance everywhere.
    pub(crate) fn is_distance(&self) -> bool {
        !matches!(self, Self::LevelSet(_) | Self::Union(_) | Self::Intersection(_) | Self::Difference(..))
    }

    fn collect_leaves<'a>(&'a self, subtracted: bool, found: &mut Vec<(&'a Self, bool)>) {
        match self {
            Self::Union(parts) | Self::Intersection(parts) => {
                for part in parts {
                    part.collect_leaves(subtracted, found);
                }
            }
            Self::Difference(a, b) => {
                a.collect_leaves(subtracted, found);
                b.collect_leaves(!subtracted, found);
            }
            _ => found.push((self, subtracted)),
        }
    }

    /// A box that holds the shape, or `None` where none is known: level sets, half-spaces and endless cylinders have
    /// none, unless an intersection bounds them.
    pub fn bounds(&self) -> Option<Aabb<D>> {
        match self {
            Self::Box(b) => Some(*b),
            Self::Ball(b) => {
                let r = [b.radius(); D];
                Some(Aabb { min: axpy(b.center(), -1.0, &r), max: axpy(b.center(), 1.0, &r) })
            }
            Self::Cylinder(c) => {
                let h = c.half_length()?;
                // Half of the extent along axis i: the caps' centres and the circles about them.
                let r: [f64; D] = std::array::from_fn(|i| {
                    h * c.axis()[i].abs() + c.radius() * (1.0 - c.axis()[i] * c.axis()[i]).max(0.0).sqrt()
                });
                Some(Aabb { min: axpy(c.center(), -1.0, &r), max: axpy(c.center(), 1.0, &r) })
            }
            Self::Surface(s) => {
                let Aabb { min, max } = s.bounds();
                Some(Aabb { min: std::array::from_fn(|i| min[i]), max: std::array::from_fn(|i| max[i]) })
            }
            Self::Polygon(p) => {
                let corner = |pick: fn(f64, f64) -> f64| -> [f64; D] {
                    std::array::from_fn(|i| p.vertices().iter().map(|v| v[i]).reduce(pick).unwrap_or(0.0))
                };
                Some(Aabb { min: corner(f64::min), max: corner(f64::max) })
            }
            Self::HalfSpace(_) | Self::LevelSet(_) => None,
            Self::Union(parts) => {
                let mut boxes = parts.iter().map(Self::bounds);
                let first = boxes.next()??;
                boxes.try_fold(first, |all, b| Some(all.union(&b?)))
            }
            Self::Intersection(parts) => {
                let mut boxes = parts.iter().filter_map(Self::bounds);
                let first = boxes.next()?;
                // Parts that do not overlap bound the empty set; any of the boxes holds that.
                Some(boxes.fold(first, |all, b| all.intersection(&b).unwrap_or(all)))
            }
            Self::Difference(a, _) => a.bounds(),
        }
    }
}

impl<const D: usize> fmt::Debug for Shape<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Box(b) => b.fmt(f),
            Self::Ball(b) => b.fmt(f),
            Self::Cylinder(c) => c.fmt(f),
            Self::Polygon(p) => p.fmt(f),
            Self::Surface(s) => write!(f, "Surface({} triangles)", s.triangles().len()),
            Self::HalfSpace(h) => h.fmt(f),
            Self::LevelSet(_) => f.write_str("LevelSet"),
            Self::Union(parts) => f.debug_tuple("Union").field(parts).finish(),
            Self::Intersection(parts) => f.debug_tuple("Intersection").field(parts).finish(),
            Self::Difference(a, b) => f.debug_tuple("Difference").field(a).field(b).finish(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contradictions_are_refused() {
        assert!(Shape::cuboid([0.0, 0.0], [1.0, 0.0]).is_err());
        assert!(Shape::cuboid([0.0, f64::NAN], [1.0, 1.0]).is_err());
        assert!(Shape::ball([0.0], 0.0).is_err());
        assert!(Shape::ball([f64::INFINITY], 1.0).is_err());
        assert!(Shape::half_space([0.0; 2], [0.0; 2]).is_err());
        assert!(Shape::cylinder([0.0; 2], [1.0; 2], 1.0, None).is_err());
        assert!(Shape::cylinder([0.0; 3], [0.0; 3], 1.0, None).is_err());
        assert!(Shape::cylinder([0.0; 3], [1.0; 3], 1.0, Some(-1.0)).is_err());
        assert!(Shape::polygon(vec![[0.0; 3], [1.0; 3], [2.0; 3]]).is_err());
        assert!(Shape::<2>::union(vec![]).is_err());
    }

    #[test]
    fn bounds_hold_the_shape_and_no_more() {
        let tilted = Shape::cylinder([1.0, 0.0, 0.0], [1.0, 1.0, 0.0], 1.0, Some(2.0)).unwrap();
        let b = tilted.bounds().unwrap();
        // Half an edge of the axis' square plus the disc seen from the side.
        let half = 2.0 * 0.5_f64.sqrt();
        for (value, expected) in [(b.max[0], 1.0 + half), (b.min[1], -half), (b.max[2], 1.0)] {
            assert!((value - expected).abs() < 1e-15);
        }
        let ball = Shape::ball([0.0, 0.0], 1.0).unwrap();
        let plane = Shape::half_space([0.0, 0.0], [1.0, 0.0]).unwrap();
        let both = Shape::intersection(vec![plane.clone(), ball.clone()]).unwrap();
        assert_eq!(both.bounds(), ball.bounds());
        assert_eq!(Shape::union(vec![plane, ball.clone()]).unwrap().bounds(), None);
        let cut = ball.clone().difference(Shape::ball([0.5, 0.0], 0.1).unwrap());
        assert_eq!(cut.bounds(), ball.bounds());
        assert_eq!(cut.leaves().iter().map(|(_, subtracted)| *subtracted).collect::<Vec<_>>(), [false, true]);
    }
}
