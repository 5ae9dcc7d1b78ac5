use crate::domain::{Domain, FaceId};
use crate::shape::{HalfSpace, Polygon, Shape, spatial};
use crate::surface::TriangleSurface;
use crate::vector::{axis_vector, distance, dot, norm, normalized, scale};

/// Two normals at a node that are nearer to each other than this (sine of the angle) are one.
const SAME_NORMAL: f64 = 1e-6;

/// A smooth piece of the boundary: the planes of boxes, mantles and caps of cylinders, spheres, level sets. Polygons
/// and surfaces of triangles, piecewise smooth, are a patch too; their corners and creases are treated where curves are divided.
pub(crate) struct Patch<'a, const D: usize> {
    pub(crate) face: FaceId,
    /// Whether it is a plane of the domain's outer box.
    pub(crate) on_box: bool,
    surface: Shape<D>,
    /// What else has to be zero on the patch: the shape that it is part of, and the face's whole shape.
    parents: [&'a Shape<D>; 2],
    /// 1 where the gradient of `surface` points out of the domain, -1 where it points in.
    sign: f64,
}

impl<const D: usize> Patch<'_, D> {
    pub(crate) fn level(&self, x: &[f64; D]) -> f64 {
        self.surface.level(x)
    }

    pub(crate) fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        self.surface.gradient(x)
    }

    pub(crate) fn polygon(&self) -> Option<&Polygon> {
        match &self.surface {
            Shape::Polygon(p) => Some(p),
            _ => None,
        }
    }

    pub(crate) fn triangles(&self) -> Option<&TriangleSurface> {
        match &self.surface {
            Shape::Surface(s) => Some(s),
            _ => None,
        }
    }

    /// Whether the patch has corners and edges of its own.
    pub(crate) fn is_piecewise(&self) -> bool {
        matches!(self.surface, Shape::Polygon(_) | Shape::Surface(_))
    }

    /// For a plane across an axis: the axis and the coordinate.
    pub(crate) fn axis_plane(&self) -> Option<(usize, f64)> {
        let Shape::HalfSpace(h) = &self.surface else { return None };
        let axis = h.normal().iter().position(|n| n.abs() == 1.0)?;
        Some((axis, h.offset() * h.normal()[axis]))
    }

    /// About the distance of the patch's surface, or of the shape it is part of where that is farther.
    pub(crate) fn distance(&self, x: &[f64; D]) -> f64 {
        shape_distance(&self.surface, x).max(shape_distance(self.parents[0], x))
    }

    /// Whether the point lies on the patch, to a tolerance (a length). Other faces are not looked at.
    pub(crate) fn holds(&self, x: &[f64; D], tolerance: f64) -> bool {
        shape_distance(&self.surface, x) <= tolerance
            && self.parents.iter().all(|parent| shape_distance(parent, x) <= tolerance)
    }

    /// Outward unit normal; between them at corners and creases.
    pub(crate) fn mean_normal(&self, x: &[f64; D], tolerance: f64) -> Option<[f64; D]> {
        if !self.is_piecewise() {
            return normalized(&self.gradient(x)).map(|n| scale(self.sign, &n));
        }
        let mut found = Vec::new();
        self.normals(x, tolerance, &mut found);
        normalized(&found.iter().fold([0.0; D], |sum, n| crate::vector::axpy(&sum, 1.0, n)))
    }

    /// Adds the outward normals of the patch at one of its points: several at corners and
    /// creases.
    pub(crate) fn normals(&self, x: &[f64; D], tolerance: f64, found: &mut Vec<[f64; D]>) {
        let mut add = |n: [f64; D]| {
            let n = scale(self.sign, &n);
            if !found.iter().any(|m| norm(&std::array::from_fn::<f64, D, _>(|i| m[i] - n[i])) < SAME_NORMAL) {
                found.push(n);
            }
        };
        if let Some(p) = self.polygon() {
            let at = [x[0], x[1]];
            let count = p.vertices().len();
            if let Some(i) = p.vertices().iter().position(|v| distance(v, &at) <= tolerance) {
                for edge in [(i + count - 1) % count, i] {
                    let n = p.edge_normal(edge);
                    add(std::array::from_fn(|k| n[k]));
                }
            } else {
                let n = p.nearest(&at).edge_normal;
                add(std::array::from_fn(|k| n[k]));
            }
        } else if let Some(s) = self.triangles() {
            s.normals_at(&spatial(x), tolerance, |n| add(std::array::from_fn(|k| n[k])));
        } else if let Some(n) = normalized(&self.gradient(x)) {
            add(n);
        }
    }
}

fn shape_distance<const D: usize>(shape: &Shape<D>, x: &[f64; D]) -> f64 {
    let level = shape.level(x).abs();
    if shape.is_distance() {
        return level;
    }
    let slope = norm(&shape.gradient(x));
    if slope > 0.0 { level / slope } else { level }
}

/// The patches of a domain, planes of an outer box first.
pub(crate) fn patches<const D: usize>(domain: &Domain<D>) -> Vec<Patch<'_, D>> {
    let mut found = Vec::new();
    let mut faces = domain.curved_faces();
    if domain.outer_box().is_some() {
        faces.insert(0, (FaceId(0), domain.outer(), false));
    }
    for (face, shape, hole) in faces {
        let on_box = !hole && domain.outer_box().is_some();
        for (leaf, subtracted) in shape.leaves() {
            let sign = if hole == subtracted { 1.0 } else { -1.0 };
            for (k, surface) in smooth_parts(leaf).into_iter().enumerate() {
                let face = if on_box { FaceId(k as u16) } else { face };
                found.push(Patch { face, on_box, surface, parents: [leaf, shape], sign });
            }
        }
    }
    found
}

/// The smooth surfaces that bound a shape without parts; for boxes in the order of a domain's faces.
fn smooth_parts<const D: usize>(leaf: &Shape<D>) -> Vec<Shape<D>> {
    let plane = |point: [f64; D], normal: [f64; D]| HalfSpace::new(point, normal).ok().map(Shape::HalfSpace);
    match leaf {
        Shape::Box(b) => (0..2 * D)
            .filter_map(|k| match (k / 2, k % 2) {
                (axis, 0) => plane(b.min, axis_vector(axis, -1.0)),
                (axis, _) => plane(b.max, axis_vector(axis, 1.0)),
            })
            .collect(),
        Shape::Cylinder(c) => {
            let mut parts: Vec<_> =
                Shape::cylinder(*c.center(), *c.axis(), c.radius(), None).into_iter().collect();
            if let Some(h) = c.half_length() {
                for end in [-h, h] {
                    let cap = crate::vector::axpy(c.center(), end, c.axis());
                    parts.extend(plane(cap, scale(end.signum(), c.axis())));
                }
            }
            parts
        }
        _ => vec![leaf.clone()],
    }
}

/// Whether two unit normals are independent enough for their surfaces to meet in a curve.
pub(crate) fn independent<const D: usize>(a: &[f64; D], b: &[f64; D]) -> bool {
    1.0 - dot(a, b) * dot(a, b) > SAME_NORMAL * SAME_NORMAL
}
