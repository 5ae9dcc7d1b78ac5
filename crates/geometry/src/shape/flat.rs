//! The flat faces of shapes that have no others.

use super::Shape;
use crate::vector::{axis_vector, dot};

/// A flat face of a shape without parts: a side of a box or of a polygon, the plane of a half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatFace<const D: usize> {
    /// Unit normal out of the shape that it is a face of.
    pub normal: [f64; D],
    /// Distance of its plane from the origin along the normal.
    pub offset: f64,
    /// Lower corner of the smallest box that holds it; infinite where the face is.
    pub min: [f64; D],
    /// Upper corner of that box.
    pub max: [f64; D],
}

impl<const D: usize> Shape<D> {
    /// The faces of all shapes without parts that this one is made of, whether or not other parts cover them; `None` where one of them is
    /// curved, or a surface of triangles.
    pub fn flat_faces(&self) -> Option<Vec<FlatFace<D>>> {
        let mut all = Vec::new();
        for (leaf, _) in self.leaves() {
            match leaf {
                Self::Box(b) => {
                    for axis in 0..D {
                        let (mut min, mut max) = (b.min, b.max);
                        max[axis] = b.min[axis];
                        let normal = axis_vector(axis, -1.0);
                        all.push(FlatFace { normal, offset: -b.min[axis], min: b.min, max });
                        min[axis] = b.max[axis];
                        let normal = axis_vector(axis, 1.0);
                        all.push(FlatFace { normal, offset: b.max[axis], min, max: b.max });
                    }
                }
                Self::HalfSpace(h) => {
                    let (min, max) = ([f64::NEG_INFINITY; D], [f64::INFINITY; D]);
                    all.push(FlatFace { normal: *h.normal(), offset: h.offset(), min, max });
                }
                Self::Polygon(p) => {
                    let corners = p.vertices();
                    for (k, a) in corners.iter().enumerate() {
                        let (b, n) = (&corners[(k + 1) % corners.len()], p.edge_normal(k));
                        all.push(FlatFace {
                            normal: std::array::from_fn(|i| n[i]),
                            offset: dot(&n, a),
                            min: std::array::from_fn(|i| a[i].min(b[i])),
                            max: std::array::from_fn(|i| a[i].max(b[i])),
                        });
                    }
                }
                _ => return None,
            }
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::Shape;

    #[test]
    fn boxes_half_spaces_and_polygons_have_faces_and_balls_have_none() {
        let cuboid = Shape::cuboid([0.0, 1.0, 2.0], [1.0, 3.0, 5.0]).unwrap();
        let faces = cuboid.flat_faces().unwrap();
        assert_eq!(faces.len(), 6);
        assert_eq!((faces[2].normal, faces[2].offset), ([0.0, -1.0, 0.0], -1.0));
        assert_eq!((faces[5].min, faces[5].max), ([0.0, 1.0, 5.0], [1.0, 3.0, 5.0]));
        let ball = Shape::ball([0.0; 3], 1.0).unwrap();
        assert!(cuboid.clone().difference(ball).flat_faces().is_none());
        let half = Shape::half_space([0.0, 1.0], [0.0, 2.0]).unwrap();
        let triangle = Shape::polygon(vec![[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]]).unwrap();
        let faces = Shape::intersection(vec![half, triangle]).unwrap().flat_faces().unwrap();
        assert_eq!((faces[0].normal, faces[0].offset, faces[0].max[0]), ([0.0, 1.0], 1.0, f64::INFINITY));
        // From (3, 0) to (0, 4).
        assert!((faces[2].offset - 2.4).abs() < 1e-15 && faces[2].max == [3.0, 4.0]);
    }
}
