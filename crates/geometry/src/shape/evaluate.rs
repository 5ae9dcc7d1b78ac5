//! Level and gradient of a shape.

use super::{Cylinder, Polygon, Shape};
use crate::surface::TriangleSurface;
use crate::vector::{axpy, distance, norm, normalized, scale, sub};

impl<const D: usize> Shape<D> {
    /// The level at `x`: negative inside, zero on the surface. The signed distance for boxes, balls, cylinders,
    /// polygons, surfaces of triangles and half-spaces.
    pub fn level(&self, x: &[f64; D]) -> f64 {
        match self {
            Self::Box(b) => b.signed_distance(x),
            Self::Ball(b) => distance(x, b.center()) - b.radius(),
            Self::Cylinder(c) => cylinder_level(c, x),
            Self::Polygon(p) => p.nearest(&planar(x)).distance,
            Self::Surface(s) => s.nearest(&spatial(x)).distance,
            Self::HalfSpace(h) => h.signed_distance(x),
            Self::LevelSet(f) => f.value(x),
            Self::Union(parts) => parts.iter().map(|s| s.level(x)).fold(f64::INFINITY, minimum),
            Self::Intersection(parts) => parts.iter().map(|s| s.level(x)).fold(f64::NEG_INFINITY, maximum),
            Self::Difference(a, b) => maximum(a.level(x), -b.level(x)),
        }
    }

    /// Gradient of the level at `x`; where it has none (edges, centres) one of its limits.
    pub fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        match self {
            Self::Box(b) => b.gradient(x),
            Self::Ball(b) => {
                normalized(&sub(x, b.center())).unwrap_or_else(|| crate::vector::axis_vector(0, 1.0))
            }
            Self::Cylinder(c) => cylinder_gradient(c, x),
            Self::Polygon(p) => polygon_gradient(p, x),
            Self::Surface(s) => surface_gradient(s, x),
            Self::HalfSpace(h) => *h.normal(),
            Self::LevelSet(f) => f.gradient(x),
            Self::Union(_) | Self::Intersection(_) | Self::Difference(..) => {
                let (leaf, subtracted) = self.active_leaf(x);
                scale(if subtracted { -1.0 } else { 1.0 }, &leaf.gradient(x))
            }
        }
    }

    /// The leaf whose level is the shape's level at `x`, and whether it enters with the opposite sign.
    pub(crate) fn active_leaf(&self, x: &[f64; D]) -> (&Self, bool) {
        match self {
            Self::Union(parts) => match extreme(parts, |s| s.level(x)) {
                Some(part) => part.active_leaf(x),
                None => (self, false),
            },
            Self::Intersection(parts) => match extreme(parts, |s| -s.level(x)) {
                Some(part) => part.active_leaf(x),
                None => (self, false),
            },
            Self::Difference(a, b) => {
                if a.level(x) >= -b.level(x) {
                    a.active_leaf(x)
                } else {
                    let (leaf, subtracted) = b.active_leaf(x);
                    (leaf, !subtracted)
                }
            }
            _ => (self, false),
        }
    }
}

/// The part with the smallest `key`; the first one of equals.
fn extreme<const D: usize>(parts: &[Shape<D>], key: impl Fn(&Shape<D>) -> f64) -> Option<&Shape<D>> {
    parts.iter().map(|s| (key(s), s)).reduce(|a, b| if b.0 < a.0 { b } else { a }).map(|(_, s)| s)
}

// Unlike `f64::min` and `f64::max` these keep a NaN, so that a bad level set is noticed.
fn minimum(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

fn maximum(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

pub(super) fn planar<const D: usize>(x: &[f64; D]) -> [f64; 2] {
    [x[0], x[1]]
}

/// The point in three dimensions.
pub(crate) fn spatial<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}

fn cylinder_level<const D: usize>(c: &Cylinder<D>, x: &[f64; D]) -> f64 {
    let (mantle, cap) = c.parts(&c.frame(x));
    if mantle > 0.0 && cap > 0.0 { norm(&[mantle, cap]) } else { mantle.max(cap) }
}

fn cylinder_gradient<const D: usize>(c: &Cylinder<D>, x: &[f64; D]) -> [f64; D] {
    let f = c.frame(x);
    let (mantle, cap) = c.parts(&f);
    let axial = scale(if f.along < 0.0 { -1.0 } else { 1.0 }, c.axis());
    if mantle > 0.0 && cap > 0.0 {
        let d = norm(&[mantle, cap]);
        return axpy(&scale(mantle / d, &f.outward), cap / d, &axial);
    }
    if mantle >= cap { f.outward } else { axial }
}

fn polygon_gradient<const D: usize>(p: &Polygon, x: &[f64; D]) -> [f64; D] {
    let at = planar(x);
    let nearest = p.nearest(&at);
    let away = normalized(&sub(&at, &nearest.point)).map(|d| scale(nearest.distance.signum(), &d));
    // On the polygon itself, to rounding, the direction away from it is noise.
    let on_edge = nearest.distance.abs() <= 1e3 * f64::EPSILON * (at[0].abs() + at[1].abs());
    let g = if on_edge { nearest.edge_normal } else { away.unwrap_or(nearest.edge_normal) };
    std::array::from_fn(|i| g[i])
}

fn surface_gradient<const D: usize>(s: &TriangleSurface, x: &[f64; D]) -> [f64; D] {
    let at = spatial(x);
    let nearest = s.nearest(&at);
    let away = normalized(&sub(&at, &nearest.point)).map(|d| scale(nearest.distance.signum(), &d));
    // On the surface itself, to rounding, the direction away from it is noise.
    let on_surface =
        nearest.distance.abs() <= nearest.reach.max(1e3 * f64::EPSILON * crate::vector::max_abs(&at));
    let g = if on_surface { nearest.normal } else { away.unwrap_or(nearest.normal) };
    std::array::from_fn(|i| g[i])
}

#[cfg(test)]
mod tests {
    use super::Shape;

    #[test]
    fn closed_forms() {
        let cube = Shape::cuboid([0.0; 3], [1.0, 2.0, 3.0]).unwrap();
        assert_eq!(cube.level(&[0.5, 0.5, 0.25]), -0.25);
        assert_eq!(cube.level(&[4.0, 6.0, 3.0]), 5.0);
        let rod = Shape::cylinder([0.0; 3], [0.0, 0.0, 2.0], 1.0, Some(4.0)).unwrap();
        assert_eq!(rod.level(&[0.0, 0.5, 0.0]), -0.5);
        assert_eq!(rod.level(&[0.0, 0.0, 1.75]), -0.25);
        assert_eq!(rod.level(&[0.0, 4.0, 6.0]), 5.0);
        let plane = Shape::half_space([1.0, 0.0], [2.0, 0.0]).unwrap();
        assert_eq!(plane.level(&[3.0, 7.0]), 2.0);
    }

    #[test]
    fn composites_follow_their_parts() {
        let (a, b) = (Shape::ball([0.0], 1.0).unwrap(), Shape::ball([1.0], 1.0).unwrap());
        let union = Shape::union(vec![a.clone(), b.clone()]).unwrap();
        let both = Shape::intersection(vec![a.clone(), b.clone()]).unwrap();
        let rest = a.difference(b);
        for (x, levels, gradients) in [
            ([-0.5], [-0.5, 0.5, -0.5], [-1.0, -1.0, -1.0]),
            ([0.75], [-0.75, -0.25, 0.75], [-1.0, 1.0, 1.0]),
            ([1.75], [-0.25, 0.75, 0.75], [1.0, 1.0, 1.0]),
        ] {
            let shapes = [&union, &both, &rest];
            assert_eq!(shapes.map(|s| s.level(&x)), levels, "{x:?}");
            assert_eq!(shapes.map(|s| s.gradient(&x)[0]), gradients, "{x:?}");
        }
    }

    #[test]
    fn a_bad_level_set_is_not_hidden_by_its_partners() {
        let bad = Shape::level_set(std::sync::Arc::new(|_: &[f64; 1]| f64::NAN));
        let good = Shape::ball([0.0], 1.0).unwrap();
        for parts in [vec![bad.clone(), good.clone()], vec![good.clone(), bad.clone()]] {
            assert!(Shape::union(parts.clone()).unwrap().level(&[0.0]).is_nan());
            assert!(Shape::intersection(parts).unwrap().level(&[0.0]).is_nan());
        }
        assert!(bad.project(&[0.0], 1.0).is_err());
    }
}
