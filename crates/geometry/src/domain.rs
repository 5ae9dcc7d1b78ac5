use crate::aabb::Aabb;
use crate::error::GeometryError;
use crate::projection::{Projection, ProjectionError};
use crate::quasi_random::Kronecker;
use crate::shape::Shape;
use crate::vector::{axis_vector, distance, norm, scale};

/// Sample points of [`Domain::measure_estimate`].
const MEASURE_SAMPLES: usize = 1 << 16;

/// Sample points of the check that a domain does not reach beyond its bounds.
const BOUNDS_SAMPLES: usize = 1 << 9;

/// Names of a box's faces, two an axis.
const BOX_FACES: [&str; 6] = ["left", "right", "bottom", "top", "back", "front"];

/// Index of a face of a [`Domain`], into [`Domain::faces`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FaceId(pub u16);

/// A bounded set of points with named faces: a box or another shape, less any number of holes.
#[derive(Clone, Debug)]
pub struct Domain<const D: usize> {
    outer: Shape<D>,
    bounds: Aabb<D>,
    faces: Vec<String>,
    holes: Vec<(FaceId, Shape<D>)>,
}

impl<const D: usize> Domain<D> {
    /// A box. Its faces are, in this order, `left` and `right` (lower and upper x), `bottom` and `top` (y), `back`
    /// and `front` (z), as far as there are axes.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] unless `min < max` along every axis, [`GeometryError::InvalidDomain`] in other
    /// than one to three dimensions.
    pub fn boxed(min: [f64; D], max: [f64; D]) -> Result<Self, GeometryError> {
        if D == 0 || D > 3 {
            return Err(GeometryError::domain(format!("{D} dimensions; there can be 1, 2 or 3")));
        }
        let bounds = Aabb::new(min, max)?;
        let faces = BOX_FACES[..2 * D].iter().map(ToString::to_string).collect();
        Ok(Self { outer: Shape::Box(bounds), bounds, faces, holes: Vec::new() })
    }

    /// The inside of a shape, with one face, `outer`; a box becomes [`Domain::boxed`]. Shapes without bounds of their
    /// own (level sets) need `bounds` that hold them.
    ///
    /// # Errors
    /// [`GeometryError::InvalidDomain`] where bounds are missing, the shape reaches beyond them, or it is empty.
    pub fn from_shape(shape: Shape<D>, bounds: Option<Aabb<D>>) -> Result<Self, GeometryError> {
        if let Shape::Box(b) = &shape {
            return Self::boxed(b.min, b.max);
        }
        if D == 0 || D > 3 {
            return Err(GeometryError::domain(format!("{D} dimensions; there can be 1, 2 or 3")));
        }
        let own = shape.bounds();
        let bounds = match (own, bounds) {
            (Some(a), Some(b)) => a
                .intersection(&b)
                .ok_or_else(|| GeometryError::domain("the shape lies outside of the bounds"))?,
            (Some(a), None) | (None, Some(a)) => a,
            (None, None) => {
                return Err(GeometryError::domain(
                    "a level set, half-space or endless cylinder needs bounds",
                ));
            }
        };
        Aabb::new(bounds.min, bounds.max)?;
        let domain = Self { outer: shape, bounds, faces: vec!["outer".to_owned()], holes: Vec::new() };
        if own != Some(bounds) {
            domain.check_bounds()?;
        }
        domain.check_not_empty()?;
        Ok(domain)
    }

    /// The domain without the inside of `shape`, whose surface becomes a face of this name. Holes may overlap each
    /// other and the outer surface.
    ///
    /// # Errors
    /// [`GeometryError::InvalidDomain`] for a name that is taken, and where nothing remains.
    pub fn with_hole(mut self, name: &str, shape: Shape<D>) -> Result<Self, GeometryError> {
        if self.face(name).is_some() {
            return Err(GeometryError::domain(format!("two faces are named {name:?}")));
        }
        let id =
            u16::try_from(self.faces.len()).map_err(|_| GeometryError::domain("more than 65536 faces"))?;
        self.faces.push(name.to_owned());
        self.holes.push((FaceId(id), shape));
        self.check_not_empty()?;
        Ok(self)
    }

    /// Names of the faces; a [`FaceId`] is an index into this list.
    pub fn faces(&self) -> &[String] {
        &self.faces
    }

    /// The face of this name.
    pub fn face(&self, name: &str) -> Option<FaceId> {
        self.faces.iter().position(|f| f == name).and_then(|i| u16::try_from(i).ok()).map(FaceId)
    }

    /// Negative inside, zero on the boundary. The signed distance inside of boxes, balls, cylinders and polygons
    /// without holes.
    pub fn level(&self, x: &[f64; D]) -> f64 {
        self.holes.iter().fold(self.outer.level(x), |level, (_, hole)| {
            let h = -hole.level(x);
            if h > level || h.is_nan() { h } else { level }
        })
    }

    /// Gradient of [`Domain::level`].
    pub fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        let mut level = self.outer.level(x);
        let mut active = None;
        for (_, hole) in &self.holes {
            let h = -hole.level(x);
            if h > level {
                (level, active) = (h, Some(hole));
            }
        }
        active.map_or_else(|| self.outer.gradient(x), |hole| scale(-1.0, &hole.gradient(x)))
    }

    /// Whether `x` lies inside, on the boundary, or less than about `tol` (a length) outside.
    pub fn contains(&self, x: &[f64; D], tol: f64) -> bool {
        if matches!(self.outer, Shape::Box(_)) && !self.bounds.contains(x, tol) {
            return false;
        }
        let level = self.level(x);
        level <= 0.0 || (tol > 0.0 && level <= tol * norm(&self.gradient(x)))
    }

    /// About the distance from the boundary, negative inside: the level over the length of its gradient.
    pub(crate) fn distance_estimate(&self, x: &[f64; D]) -> f64 {
        let level = self.level(x);
        let slope = norm(&self.gradient(x));
        if slope > 0.0 { level / slope } else { level }
    }

    /// A box that holds the domain.
    pub fn bounds(&self) -> Aabb<D> {
        self.bounds
    }

    /// The outer shape, holes not cut out.
    pub fn outer(&self) -> &Shape<D> {
        &self.outer
    }

    /// The outer shape where that is a box.
    pub fn outer_box(&self) -> Option<Aabb<D>> {
        match self.outer {
            Shape::Box(b) => Some(b),
            _ => None,
        }
    }

    /// The faces that are not planes of an outer box: the face, its shape, and whether that is a hole, whose inside is
    /// outside of the domain.
    pub fn curved_faces(&self) -> Vec<(FaceId, &Shape<D>, bool)> {
        let outer = self.outer_box().is_none().then_some((FaceId(0), &self.outer, false));
        outer.into_iter().chain(self.holes.iter().map(|(id, shape)| (*id, shape, true))).collect()
    }

    /// For a plane face of an outer box: its axis and whether it is the upper one.
    pub fn box_plane(&self, face: FaceId) -> Option<(usize, bool)> {
        let index = face.0 as usize;
        (self.outer_box().is_some() && index < 2 * D).then_some((index / 2, index % 2 == 1))
    }

    /// The nearest point of a face's surface. The normal points out of the domain and the distance is negative on the
    /// domain's side. What other faces cut away is not heeded, except that planes of a box end at its edges.
    ///
    /// # Errors
    /// [`ProjectionError`] where the surface is farther away than the domain is large; see [`Shape::project`].
    ///
    /// # Panics
    /// For a face that the domain does not have.
    pub fn project_to_face(&self, face: FaceId, x: &[f64; D]) -> Result<Projection<D>, ProjectionError> {
        if let Some((axis, upper)) = self.box_plane(face) {
            let mut point = self.bounds.clamp(x);
            point[axis] = if upper { self.bounds.max[axis] } else { self.bounds.min[axis] };
            let sign = if upper { 1.0 } else { -1.0 };
            let side = sign * (x[axis] - point[axis]);
            let distance = distance(x, &point).copysign(side);
            return Ok(Projection { point, normal: axis_vector(axis, sign), distance });
        }
        let reach = self.bounds.diameter() + distance(x, &self.bounds.clamp(x));
        if let Some((_, hole)) = self.holes.iter().find(|(id, _)| *id == face) {
            let p = hole.project(x, reach)?;
            return Ok(Projection { normal: scale(-1.0, &p.normal), distance: -p.distance, ..p });
        }
        assert!(
            (face.0 as usize) < self.faces.len(),
            "face {} of a domain with {}",
            face.0,
            self.faces.len()
        );
        self.outer.project(x, reach)
    }

    /// Length, area or volume. Exact for a box and a surface of triangles without holes; otherwise the share of 65536 quasi-random points of the
    /// bounding box that lie inside: always the same, and good to about 1e-3 of the bounding box's measure.
    pub fn measure_estimate(&self) -> f64 {
        if self.outer_box().is_some() && self.holes.is_empty() {
            return self.bounds.measure();
        }
        if let (Shape::Surface(surface), true) = (&self.outer, self.holes.is_empty()) {
            return surface.volume();
        }
        let inside =
            Kronecker::new(&self.bounds).take(MEASURE_SAMPLES).filter(|x| self.level(x) <= 0.0).count();
        self.bounds.measure() * inside as f64 / MEASURE_SAMPLES as f64
    }

    fn check_not_empty(&self) -> Result<(), GeometryError> {
        if Kronecker::new(&self.bounds).take(MEASURE_SAMPLES).any(|x| self.level(&x) < 0.0) {
            return Ok(());
        }
        Err(GeometryError::domain(format!(
            "it is empty: the level is nowhere negative in the bounds {:?} to {:?}",
            self.bounds.min, self.bounds.max
        )))
    }

    /// A domain that reaches its bounds would have a boundary without a face.
    fn check_bounds(&self) -> Result<(), GeometryError> {
        let tolerance = 1e-9 * self.bounds.diameter();
        for mut x in Kronecker::new(&self.bounds).take(BOUNDS_SAMPLES) {
            for axis in 0..D {
                let inner = x[axis];
                for end in [self.bounds.min[axis], self.bounds.max[axis]] {
                    x[axis] = end;
                    if self.level(&x) < -tolerance * norm(&self.gradient(&x)).max(f64::MIN_POSITIVE) {
                        return Err(GeometryError::domain(format!(
                            "the shape reaches beyond its bounds at {x:?}"
                        )));
                    }
                }
                x[axis] = inner;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn plate() -> Domain<2> {
        Domain::boxed([0.0, 0.0], [2.0, 1.0])
            .unwrap()
            .with_hole("rod", Shape::ball([0.5, 0.5], 0.25).unwrap())
            .unwrap()
    }

    #[test]
    fn faces_and_holes() {
        let d = plate();
        assert_eq!(d.faces(), ["left", "right", "bottom", "top", "rod"]);
        assert_eq!((d.face("rod"), d.face("outer")), (Some(FaceId(4)), None));
        assert_eq!(d.level(&[0.5, 0.5]), 0.25);
        assert_eq!(d.level(&[1.5, 0.25]), -0.25);
        assert_eq!(d.gradient(&[0.5, 0.875]), [0.0, 1.0]);
        assert_eq!(d.gradient(&[0.5, 0.78]), [0.0, -1.0]);
        let curved = d.curved_faces();
        assert_eq!((curved.len(), curved[0].0, curved[0].2), (1, FaceId(4), true));
        assert!(d.clone().with_hole("rod", Shape::ball([1.5, 0.5], 0.2).unwrap()).is_err());
        assert!(d.clone().with_hole("all", Shape::ball([1.0, 0.5], 2.0).unwrap()).is_err());
    }

    #[test]
    fn projections_point_out_of_the_domain() {
        let d = plate();
        let p = d.project_to_face(FaceId(4), &[0.5, 0.85]).unwrap();
        assert_eq!(p.normal, [0.0, -1.0]);
        assert!((p.distance + 0.1).abs() < 1e-15 && (p.point[1] - 0.75).abs() < 1e-15);
        let p = d.project_to_face(FaceId(1), &[1.5, 0.25]).unwrap();
        assert_eq!((p.point, p.normal, p.distance), ([2.0, 0.25], [1.0, 0.0], -0.5));
        let p = d.project_to_face(FaceId(0), &[-0.5, 0.25]).unwrap();
        assert_eq!((p.point, p.distance), ([0.0, 0.25], 0.5));
    }

    #[test]
    fn membership_has_a_tolerance_that_is_a_length() {
        let steep: Shape<2> =
            Shape::level_set(Arc::new(|x: &[f64; 2]| 1e3 * (x[0] * x[0] + x[1] * x[1] - 1.0)));
        let d = Domain::from_shape(steep, Some(Aabb::new([-2.0; 2], [2.0; 2]).unwrap())).unwrap();
        assert!(d.contains(&[1.0, 0.0], 0.0) && d.contains(&[1.01, 0.0], 0.02));
        assert!(!d.contains(&[1.01, 0.0], 0.0) && !d.contains(&[1.01, 0.0], 0.005));
    }

    #[test]
    fn measures() {
        let pi = std::f64::consts::PI;
        assert_eq!(Domain::boxed([0.0; 3], [2.0, 3.0, 4.0]).unwrap().measure_estimate(), 24.0);
        assert!((plate().measure_estimate() - (2.0 - pi / 16.0)).abs() < 2e-3);
        let ball = Domain::from_shape(Shape::ball([1.0; 3], 1.0).unwrap(), None).unwrap();
        assert!((ball.measure_estimate() - 4.0 / 3.0 * pi).abs() < 8e-3);
    }

    #[test]
    fn domains_without_bounds_or_points_are_refused() {
        let disc: Shape<2> = Shape::level_set(Arc::new(|x: &[f64; 2]| x[0] * x[0] + x[1] * x[1] - 1.0));
        assert!(Domain::from_shape(disc.clone(), None).is_err());
        let cuts = Aabb::new([-0.5; 2], [2.0; 2]).unwrap();
        assert!(Domain::from_shape(disc.clone(), Some(cuts)).is_err());
        let beside = Aabb::new([2.0; 2], [3.0; 2]).unwrap();
        assert!(Domain::from_shape(disc, Some(beside)).is_err());
        assert!(Domain::boxed([0.0; 4], [1.0; 4]).is_err());
    }
}
