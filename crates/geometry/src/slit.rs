//! Slits: open polylines in the plane that end inside the domain, and what they hide.

use crate::error::GeometryError;
use crate::vector::{axpy, distance, dot, is_finite, norm, sub};

/// Shortest segment of a slit relative to its length; shorter ones have no direction.
const SHORTEST_SEGMENT: f64 = 1e-12;

/// Distance from the line of a slit, relative to its length, up to which a point counts as on it: on its left. Far above
/// the rounding of coordinates, far below any spacing.
const ON_SLIT: f64 = 1e-12;

/// An open polyline in the plane. Its left is that of a traveller from the first vertex to the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Slit<const D: usize> {
    vertices: Vec<[f64; D]>,
    /// Arc length up to every vertex.
    along: Vec<f64>,
    tips: [bool; 2],
}

/// A point of a slit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlitPoint<const D: usize> {
    /// Where it is.
    pub point: [f64; D],
    /// Unit vector along the slit, towards its last vertex.
    pub tangent: [f64; D],
    /// Unit normal, towards the left.
    pub normal: [f64; D],
    /// Arc length from the first vertex.
    pub along: f64,
}

/// The nearest point of a slit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlitFoot<const D: usize> {
    /// The foot.
    pub at: SlitPoint<D>,
    /// Distance of the point that was projected.
    pub distance: f64,
    /// Whether the line to the foot is normal to the slit there: not at its ends, and not at a bend.
    pub is_normal: bool,
}

/// What two points see of each other past a slit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight<const D: usize> {
    /// The line between them does not meet the slit.
    Clear,
    /// The line goes through the slit and ends on its other side.
    Through {
        /// Where it goes through.
        at: SlitPoint<D>,
        /// 1 towards the left of the slit, -1 towards its right.
        towards: f64,
    },
    /// The line goes through the slit more than once and ends on the same side.
    Around,
}

impl<const D: usize> Slit<D> {
    /// The slit along these vertices; `tips` says of the first and of the last one whether it is a tip inside the
    /// domain, past which points see each other, rather than a point of the boundary.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] in other than two dimensions, for fewer than two vertices, for coordinates that
    /// are not finite, and for vertices that coincide with the one before.
    pub fn new(vertices: Vec<[f64; D]>, tips: [bool; 2]) -> Result<Self, GeometryError> {
        let invalid = |reason: String| Err(GeometryError::invalid("slit", reason));
        if D != 2 {
            return invalid(format!("it needs 2 dimensions, not {D}"));
        }
        if vertices.len() < 2 {
            return invalid(format!("{} vertices, at least 2 are needed", vertices.len()));
        }
        if let Some(i) = vertices.iter().position(|v| !is_finite(v)) {
            return invalid(format!("vertex {i} is not finite"));
        }
        let mut along = vec![0.0];
        for pair in vertices.windows(2) {
            along.push(along[along.len() - 1] + distance(&pair[0], &pair[1]));
        }
        let length = along[along.len() - 1];
        if let Some(i) = along.windows(2).position(|a| a[1] - a[0] <= SHORTEST_SEGMENT * length) {
            return invalid(format!("vertices {i} and {} coincide", i + 1));
        }
        Ok(Self { vertices, along, tips })
    }

    /// The vertices in order.
    pub fn vertices(&self) -> &[[f64; D]] {
        &self.vertices
    }

    /// Whether the first and the last vertex are tips inside the domain.
    pub fn tips(&self) -> [bool; 2] {
        self.tips
    }

    /// Length along the slit.
    pub fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// Distance from its line up to which a point counts as on the left of the slit.
    pub fn tolerance(&self) -> f64 {
        ON_SLIT * self.length()
    }

    /// Length of the segment that ends at the first (`end = 0`) or the last vertex (`end = 1`).
    pub fn end_segment(&self, end: usize) -> f64 {
        let n = self.along.len();
        if end == 0 { self.along[1] } else { self.along[n - 1] - self.along[n - 2] }
    }

    /// The first (`end = 0`) or the last vertex (`end = 1`).
    pub fn end(&self, end: usize) -> SlitPoint<D> {
        let segments = self.vertices.len() - 1;
        if end == 0 { self.point(0, 0.0) } else { self.point(segments - 1, self.end_segment(1)) }
    }

    /// The point at an arc length from the first vertex; `None` beyond the ends.
    pub fn at(&self, along: f64) -> Option<SlitPoint<D>> {
        if !(along >= 0.0 && along <= self.length()) {
            return None;
        }
        let segment = self.along[1..self.along.len() - 1].iter().take_while(|&&a| a <= along).count();
        Some(self.point(segment, along - self.along[segment]))
    }

    fn point(&self, segment: usize, t: f64) -> SlitPoint<D> {
        let (a, b) = (&self.vertices[segment], &self.vertices[segment + 1]);
        let tangent = sub(b, a).map(|c| c / (self.along[segment + 1] - self.along[segment]));
        let along = self.along[segment] + t;
        SlitPoint { point: axpy(a, t, &tangent), tangent, normal: left(&tangent), along }
    }

    /// The nearest point of the slit.
    pub fn nearest(&self, x: &[f64; D]) -> SlitFoot<D> {
        let mut best: Option<SlitFoot<D>> = None;
        for segment in 0..self.vertices.len() - 1 {
            let start = self.point(segment, 0.0);
            let length = self.along[segment + 1] - self.along[segment];
            let t = dot(&sub(x, &start.point), &start.tangent);
            let at = self.point(segment, t.clamp(0.0, length));
            let found = SlitFoot { at, distance: distance(x, &at.point), is_normal: t >= 0.0 && t <= length };
            if best.is_none_or(|b| found.distance < b.distance) {
                best = Some(found);
            }
        }
        // There is at least one segment.
        best.unwrap_or(SlitFoot { at: self.point(0, 0.0), distance: f64::INFINITY, is_normal: false })
    }

    /// Distance from the line through a segment, positive on the left; on the line counts as just left of it.
    fn side(&self, start: &SlitPoint<D>, x: &[f64; D]) -> f64 {
        let side = dot(&sub(x, &start.point), &start.normal);
        if side.abs() <= self.tolerance() { self.tolerance() } else { side }
    }

    /// What two points see of each other. A point on the slit counts as on its left; a line through a tip is clear.
    pub fn sight(&self, from: &[f64; D], to: &[f64; D]) -> Sight<D> {
        let mut through: Option<(f64, SlitPoint<D>, f64)> = None;
        let mut turns = false;
        let last = self.vertices.len() - 2;
        for segment in 0..=last {
            let start = self.point(segment, 0.0);
            let (before, after) = (self.side(&start, from), self.side(&start, to));
            if (before > 0.0) == (after > 0.0) {
                continue;
            }
            let path = before / (before - after);
            let t = dot(&sub(&axpy(from, path, &sub(to, from)), &start.point), &start.tangent);
            let length = self.along[segment + 1] - self.along[segment];
            let low = if segment == 0 && self.tips[0] { self.tolerance() } else { -self.tolerance() };
            let high = if segment == last && self.tips[1] { -self.tolerance() } else { self.tolerance() };
            if t < low || t > length + high {
                continue;
            }
            let towards = if after > 0.0 { 1.0 } else { -1.0 };
            let at = self.point(segment, t.clamp(0.0, length));
            match &through {
                // The same crossing again, at a vertex of two segments.
                Some((_, _, other)) if *other == towards => {}
                Some(_) => turns = !turns,
                None => through = Some((path, at, towards)),
            }
        }
        match through {
            None => Sight::Clear,
            Some(_) if turns => Sight::Around,
            Some((_, at, towards)) => Sight::Through { at, towards },
        }
    }

    /// Distance of a point from a tip, and the angle there: 0 ahead of the slit, `pi` on one side of it and `-pi` on
    /// the other; growing to the left of a traveller who leaves the slit by the tip.
    pub fn polar(&self, end: usize, x: &[f64; D]) -> [f64; 2] {
        let tip = self.end(end);
        let sign = if end == 0 { -1.0 } else { 1.0 };
        let from = sub(x, &tip.point);
        let (ahead, mut beside) = (sign * dot(&from, &tip.tangent), sign * dot(&from, &tip.normal));
        if beside.abs() <= self.tolerance() {
            // On the line counts as left of the slit.
            beside = if end == 0 { -0.0 } else { 0.0 };
        }
        [norm(&from), beside.atan2(ahead)]
    }
}

/// The tangent turned by a quarter to the left.
fn left<const D: usize>(tangent: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|k| match k {
        0 => -tangent[1],
        1 => tangent[0],
        _ => 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent() -> Slit<2> {
        Slit::new(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [true, true]).unwrap()
    }

    #[test]
    fn what_is_no_slit_is_refused() {
        assert!(Slit::new(vec![[0.0; 3], [1.0; 3]], [true; 2]).is_err());
        assert!(Slit::new(vec![[0.0; 2]], [true; 2]).is_err());
        assert!(Slit::new(vec![[0.0; 2], [0.0; 2]], [true; 2]).is_err());
        assert!(Slit::new(vec![[0.0; 2], [f64::NAN, 0.0]], [true; 2]).is_err());
    }

    #[test]
    fn feet_and_points() {
        let slit = bent();
        let foot = slit.nearest(&[0.4, 0.3]);
        assert_eq!((foot.at.point, foot.at.normal, foot.is_normal), ([0.4, 0.0], [0.0, 1.0], true));
        let foot = slit.nearest(&[1.3, 1.4]);
        assert_eq!((foot.at.point, foot.at.along, foot.is_normal), ([1.0, 1.0], 2.0, false));
        assert!((foot.distance - 0.5).abs() < 1e-15);
        assert_eq!(slit.at(1.5).map(|p| p.point), Some([1.0, 0.5]));
        assert_eq!(slit.at(2.5), None);
        assert_eq!((slit.end(0).point, slit.end(1).point), ([0.0, 0.0], [1.0, 1.0]));
    }

    #[test]
    fn lines_of_sight() {
        let slit = bent();
        assert_eq!(slit.sight(&[0.5, 0.1], &[0.6, 0.2]), Sight::Clear);
        assert!(matches!(slit.sight(&[0.5, -0.1], &[0.5, 0.1]), Sight::Through { towards: 1.0, .. }));
        assert!(matches!(slit.sight(&[0.9, 0.5], &[1.1, 0.5]), Sight::Through { towards: -1.0, .. }));
        // Past the tip, and through it.
        assert_eq!(slit.sight(&[-0.1, -0.1], &[-0.1, 0.1]), Sight::Clear);
        assert_eq!(slit.sight(&[0.0, -0.1], &[0.0, 0.1]), Sight::Clear);
        // From below, through both legs.
        assert_eq!(slit.sight(&[0.9, -0.1], &[1.1, 0.1]), Sight::Around);
        // On the slit counts as left of it.
        assert_eq!(slit.sight(&[0.5, 0.0], &[0.5, 0.1]), Sight::Clear);
        assert!(matches!(slit.sight(&[0.5, 0.0], &[0.5, -0.1]), Sight::Through { towards: -1.0, .. }));
        // An end on the boundary hides what is on the boundary.
        let cut = Slit::new(vec![[0.0, 0.0], [0.0, 1.0]], [false, true]).unwrap();
        assert!(matches!(cut.sight(&[-0.1, 0.0], &[0.1, 0.0]), Sight::Through { towards: -1.0, .. }));
    }

    #[test]
    fn angles_at_both_tips_jump_across_the_slit() {
        let slit = Slit::new(vec![[0.0, 0.0], [1.0, 0.0]], [true, true]).unwrap();
        let pi = std::f64::consts::PI;
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 1e-15 && (a[1] - b[1]).abs() < 1e-15;
        assert!(
            near(slit.polar(1, &[2.0, 0.0]), [1.0, 0.0]) && near(slit.polar(1, &[1.0, 1.0]), [1.0, pi / 2.0])
        );
        assert!(near(slit.polar(1, &[0.5, 0.0]), [0.5, pi]));
        assert!(
            near(slit.polar(0, &[-1.0, 0.0]), [1.0, 0.0])
                && near(slit.polar(0, &[0.0, -1.0]), [1.0, pi / 2.0])
        );
        // On the slit is on its left, which is the right of a traveller who leaves by the first vertex.
        assert!(near(slit.polar(0, &[0.5, 0.0]), [0.5, -pi]));
    }
}
