//! The foot of a point on a shape's surface: in closed form for primitives, by iteration for level sets.

use super::evaluate::{planar, spatial};
use super::{Cylinder, Polygon, Shape};
use crate::aabb::Aabb;
use crate::newton;
use crate::projection::{Projection, ProjectionError};
use crate::surface::TriangleSurface;
use crate::vector::{axis_vector, axpy, distance, is_finite, max_abs, normalized, scale, sub};

/// How far from zero, as a length relative to the coordinates and to the reach, the level of a union, intersection or
/// difference may be at a leaf's projection for that to count as a point of the whole's surface. Projections are
/// good to a few rounding errors.
const ON_SURFACE: f64 = 1e-10;

impl<const D: usize> Shape<D> {
    /// The nearest point of the surface, if there is one within `reach` (a length).
    ///
    /// Exact for primitives. For level sets Newton's method along the gradient (bisection where that fails) finds a
    /// point of the surface, good to [`SURFACE_TOLERANCE`](crate::SURFACE_TOLERANCE), and slides it until its
    /// normal points at `x`; that is the nearest point as long as `x` is closer than the radius of curvature.
    /// Where several points are equally near (the centre of a ball) one is chosen, always the same.
    ///
    /// # Errors
    /// [`ProjectionError`] where no point is near enough, the gradient vanishes or something is not finite.
    pub fn project(&self, x: &[f64; D], reach: f64) -> Result<Projection<D>, ProjectionError> {
        if !is_finite(x) {
            return Err(ProjectionError::NotFinite { at: x.to_vec() });
        }
        let found = match self {
            Self::Box(b) => project_box(b, x),
            Self::Ball(b) => {
                let normal = self.gradient(x);
                let point = axpy(b.center(), b.radius(), &normal);
                Projection { point, normal, distance: self.level(x) }
            }
            Self::Cylinder(c) => project_cylinder(c, x),
            Self::Polygon(p) => project_polygon(p, x),
            Self::Surface(s) => project_surface(s, x),
            Self::HalfSpace(h) => {
                let distance = h.signed_distance(x);
                Projection { point: axpy(x, -distance, h.normal()), normal: *h.normal(), distance }
            }
            Self::LevelSet(f) => {
                return newton::project(&|y| f.value(y), &|y| f.gradient(y), x, reach);
            }
            Self::Union(_) | Self::Intersection(_) | Self::Difference(..) => {
                return self.project_composite(x, reach);
            }
        };
        if found.distance.abs() > reach {
            let level = self.level(x);
            return Err(ProjectionError::OutOfReach { at: x.to_vec(), reach, level });
        }
        Ok(found)
    }

    /// The nearest of the leaves' projections that lie on the surface of the whole; where none does (an edge is
    /// nearest) the iteration for level sets on the minima and maxima.
    fn project_composite(&self, x: &[f64; D], reach: f64) -> Result<Projection<D>, ProjectionError> {
        let level = self.level(x);
        let mut best: Option<Projection<D>> = None;
        for (leaf, subtracted) in self.leaves() {
            let Ok(mut p) = leaf.project(x, reach) else { continue };
            let tolerance = ON_SURFACE * (max_abs(&p.point) + p.distance.abs());
            if self.level(&p.point).abs() > tolerance * crate::vector::norm(&leaf.gradient(&p.point)).max(1.0)
            {
                continue;
            }
            if subtracted {
                p.normal = scale(-1.0, &p.normal);
            }
            p.distance = p.distance.abs() * level.signum();
            if best.is_none_or(|b| p.distance.abs() < b.distance.abs()) {
                best = Some(p);
            }
        }
        best.map_or_else(|| newton::project(&|y| self.level(y), &|y| self.gradient(y), x, reach), Ok)
    }
}

fn project_box<const D: usize>(b: &Aabb<D>, x: &[f64; D]) -> Projection<D> {
    let signed = b.signed_distance(x);
    if signed > 0.0 {
        return Projection { point: b.clamp(x), normal: b.gradient(x), distance: signed };
    }
    let (axis, upper) = b.nearest_plane(x);
    let mut point = *x;
    point[axis] = if upper { b.max[axis] } else { b.min[axis] };
    Projection { point, normal: axis_vector(axis, if upper { 1.0 } else { -1.0 }), distance: signed }
}

fn project_cylinder<const D: usize>(c: &Cylinder<D>, x: &[f64; D]) -> Projection<D> {
    let f = c.frame(x);
    let (mantle, cap) = c.parts(&f);
    let end = c.half_length().map_or(f.along, |h| h.copysign(f.along));
    // Coordinates of the foot in the plane of the axis and the point.
    let (radial, along) = match (mantle > 0.0, cap > 0.0) {
        (true, true) => (c.radius(), end),
        (false, true) => (f.radial, end),
        (true, false) => (c.radius(), f.along),
        (false, false) if mantle >= cap => (c.radius(), f.along),
        (false, false) => (f.radial, end),
    };
    let point = axpy(&axpy(c.center(), along, c.axis()), radial, &f.outward);
    let shape = Shape::Cylinder(*c);
    Projection { point, normal: shape.gradient(x), distance: shape.level(x) }
}

fn project_polygon<const D: usize>(p: &Polygon, x: &[f64; D]) -> Projection<D> {
    let nearest = p.nearest(&planar(x));
    let point: [f64; D] = std::array::from_fn(|i| nearest.point[i]);
    let edge: [f64; D] = std::array::from_fn(|i| nearest.edge_normal[i]);
    // The edge's own normal where the point projects into the edge, the direction to the point at vertices.
    let away = normalized(&sub(x, &point)).map_or(edge, |d| scale(nearest.distance.signum(), &d));
    let resolved = distance(x, &point) > 1e-6 * (max_abs(x) + max_abs(&point));
    Projection { point, normal: if resolved { away } else { edge }, distance: nearest.distance }
}

fn project_surface<const D: usize>(s: &TriangleSurface, x: &[f64; D]) -> Projection<D> {
    let nearest = s.nearest(&spatial(x));
    let point: [f64; D] = std::array::from_fn(|i| nearest.point[i]);
    let normal: [f64; D] = std::array::from_fn(|i| nearest.normal[i]);
    let resolved = distance(x, &point) > 1e-6 * (max_abs(x) + max_abs(&point));
    let away = normalized(&sub(x, &point)).filter(|_| resolved && !s.is_smooth());
    let normal = away.map_or(normal, |d| scale(nearest.distance.signum(), &d));
    Projection { point, normal, distance: nearest.distance }
}
