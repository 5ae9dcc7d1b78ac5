use crate::error::GeometryError;
use crate::vector::{axpy, distance, distance_squared, dot, normalized, sub};

/// Shortest edge of a polygon, relative to its bounding box's diagonal; shorter ones are degenerate.
const SHORTEST_EDGE: f64 = 1e-12;

/// A simple closed polygon in the plane, with exact signed distance. Vertices are stored counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: Vec<[f64; 2]>,
}

/// The nearest point of a polygon's boundary.
pub(crate) struct NearestEdge {
    pub(crate) point: [f64; 2],
    /// Outward unit normal of the edge that holds the point.
    pub(crate) edge_normal: [f64; 2],
    /// Signed distance, negative inside.
    pub(crate) distance: f64,
}

impl Polygon {
    /// The polygon with these vertices, in either orientation; the last one is joined to the first.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] for fewer than three vertices, coordinates that are not finite, coinciding
    /// neighbours, and edges that cross or touch. The check is quadratic in the number of vertices.
    pub fn new(vertices: Vec<[f64; 2]>) -> Result<Self, GeometryError> {
        let invalid = |reason: String| Err(GeometryError::invalid("polygon", reason));
        let n = vertices.len();
        if n < 3 {
            return invalid(format!("{n} vertices, at least 3 are needed"));
        }
        if let Some(i) = vertices.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
            return invalid(format!("vertex {i} is not finite"));
        }
        let size = vertices.iter().map(|v| distance(v, &vertices[0])).fold(0.0, f64::max);
        for i in 0..n {
            if distance(&vertices[i], &vertices[(i + 1) % n]) <= SHORTEST_EDGE * size {
                return invalid(format!("vertices {i} and {} coincide", (i + 1) % n));
            }
        }
        for i in 0..n {
            for j in i + 1..n {
                if edges_meet(&vertices, i, j) {
                    return invalid(format!("edges {i} and {j} cross or touch"));
                }
            }
        }
        let mut polygon = Self { vertices };
        if polygon.area() < 0.0 {
            polygon.vertices.reverse();
        }
        Ok(polygon)
    }

    /// The vertices, counter-clockwise.
    pub fn vertices(&self) -> &[[f64; 2]] {
        &self.vertices
    }

    /// Enclosed area; the shoelace formula about the first vertex.
    pub fn area(&self) -> f64 {
        let o = self.vertices[0];
        self.vertices.windows(2).map(|e| 0.5 * cross(&sub(&e[0], &o), &sub(&e[1], &o))).sum()
    }

    /// Outward unit normal of the edge from vertex `i` to the next.
    pub(crate) fn edge_normal(&self, i: usize) -> [f64; 2] {
        let (a, b) = (self.vertices[i], self.vertices[(i + 1) % self.vertices.len()]);
        normalized(&[b[1] - a[1], a[0] - b[0]]).unwrap_or([0.0, 0.0])
    }

    pub(crate) fn nearest(&self, x: &[f64; 2]) -> NearestEdge {
        let n = self.vertices.len();
        let (mut best, mut edge, mut point) = (f64::INFINITY, 0, *x);
        let mut inside = false;
        for i in 0..n {
            let (a, b) = (self.vertices[i], self.vertices[(i + 1) % n]);
            let p = nearest_on_segment(x, &a, &b);
            let d = distance_squared(x, &p);
            if d < best {
                (best, edge, point) = (d, i, p);
            }
            // Crossing number of the ray towards +x.
            if (a[1] > x[1]) != (b[1] > x[1]) {
                let side = cross(&sub(&b, &a), &sub(x, &a));
                if (side > 0.0) == (b[1] > a[1]) {
                    inside = !inside;
                }
            }
        }
        let distance = if inside { -best.sqrt() } else { best.sqrt() };
        NearestEdge { point, edge_normal: self.edge_normal(edge), distance }
    }
}

fn nearest_on_segment(x: &[f64; 2], a: &[f64; 2], b: &[f64; 2]) -> [f64; 2] {
    let e = sub(b, a);
    let t = (dot(&sub(x, a), &e) / dot(&e, &e)).clamp(0.0, 1.0);
    // The ends exactly, so that a vertex is its own nearest point.
    if t == 1.0 { *b } else { axpy(a, t, &e) }
}

pub(crate) fn cross(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Whether edges `i < j` have a point in common other than the vertex neighbours share.
fn edges_meet(v: &[[f64; 2]], i: usize, j: usize) -> bool {
    let n = v.len();
    let (a, b) = (&v[i], &v[(i + 1) % n]);
    let (c, d) = (&v[j], &v[(j + 1) % n]);
    if j == i + 1 || (i == 0 && j == n - 1) {
        // Neighbours overlap only when they fold back onto each other.
        let (e, f) = (sub(b, a), sub(d, c));
        return cross(&e, &f) == 0.0 && dot(&e, &f) < 0.0;
    }
    let side = |p: &[f64; 2], q: &[f64; 2], r: &[f64; 2]| cross(&sub(q, p), &sub(r, p));
    let (s1, s2, s3, s4) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    if s1 * s2 < 0.0 && s3 * s4 < 0.0 {
        return true;
    }
    let within = |p: &[f64; 2], q: &[f64; 2], r: &[f64; 2]| {
        (0..2).all(|k| r[k] >= p[k].min(q[k]) && r[k] <= p[k].max(q[k]))
    };
    (s1 == 0.0 && within(a, b, c))
        || (s2 == 0.0 && within(a, b, d))
        || (s3 == 0.0 && within(c, d, a))
        || (s4 == 0.0 && within(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn l_shape() -> Vec<[f64; 2]> {
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]
    }

    #[test]
    fn distances_of_an_l() {
        let polygon = Polygon::new(l_shape()).unwrap();
        assert_eq!(polygon.area(), 3.0);
        let level = |x: f64, y: f64| polygon.nearest(&[x, y]).distance;
        assert_eq!(level(0.5, 0.5), -0.5);
        // Across the corner that points inwards.
        assert!((level(0.7, 0.6) + 0.5).abs() < 1e-15);
        assert_eq!(level(1.5, 1.5), 0.5);
        assert_eq!(level(3.0, -1.0), 2.0_f64.sqrt());
        assert_eq!(level(1.0, 1.0), 0.0);
        // A ray through vertices.
        assert_eq!(level(0.5, 1.0), -0.5);
        assert_eq!(level(-0.5, 1.0), 0.5);
    }

    #[test]
    fn the_orientation_does_not_matter() {
        let mut reversed = l_shape();
        reversed.reverse();
        let (a, b) = (Polygon::new(l_shape()).unwrap(), Polygon::new(reversed).unwrap());
        assert_eq!(b.area(), 3.0);
        for x in [[0.3, 0.4], [1.7, 1.2], [-1.0, 0.5]] {
            assert_eq!(a.nearest(&x).distance, b.nearest(&x).distance);
            assert_eq!(a.nearest(&x).edge_normal, b.nearest(&x).edge_normal);
        }
    }

    #[test]
    fn polygons_that_are_not_simple_are_refused() {
        let refused = |v: Vec<[f64; 2]>| Polygon::new(v).is_err();
        assert!(refused(vec![[0.0, 0.0], [1.0, 0.0]]));
        assert!(refused(vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), "crossing");
        assert!(refused(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), "coinciding");
        assert!(refused(vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]), "folded");
        assert!(refused(vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]]), "touching");
        assert!(refused(vec![[0.0, 0.0], [f64::NAN, 0.0], [1.0, 1.0]]));
        assert!(!refused(vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 1.0]]), "straight angles are fine");
    }
}
