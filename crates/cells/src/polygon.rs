//! The cell in two dimensions: a polygon.

use crate::body::{Measure, PLANE_TOLERANCE, Piece, Source};
use crate::root::{bracketed_root, largest_magnitude};

/// A corner, and the source of the edge that leads from it to the next corner.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: [f64; 2],
    edge: Source,
}

/// A polygon around the node, which is the origin, counter-clockwise.
#[derive(Debug, Default)]
pub(crate) struct Polygon {
    corners: Vec<Corner>,
    /// Result of the cut in progress.
    next: Vec<Corner>,
    /// For each corner its height above the cutting plane, or the value of the level set.
    heights: Vec<f64>,
}

impl Polygon {
    pub(crate) fn reset(&mut self, lo: [f64; 2], hi: [f64; 2]) {
        self.corners.clear();
        let corner = |x, y| Corner { at: [x, y], edge: Source::Start };
        self.corners.extend([
            corner(lo[0], lo[1]),
            corner(hi[0], lo[1]),
            corner(hi[0], hi[1]),
            corner(lo[0], hi[1]),
        ]);
    }

    pub(crate) fn radius(&self) -> f64 {
        self.corners.iter().map(|c| c.at[0] * c.at[0] + c.at[1] * c.at[1]).fold(0.0, f64::max).sqrt()
    }

    /// Becomes another polygon.
    pub(crate) fn assign(&mut self, other: &Self) {
        self.corners.clone_from(&other.corners);
    }

    pub(crate) fn corners(&self) -> impl Iterator<Item = [f64; 2]> {
        self.corners.iter().map(|corner| corner.at)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Keeps the part where `normal . x <= offset`, and says whether anything was cut away.
    pub(crate) fn clip(&mut self, normal: [f64; 2], offset: f64, source: Source) -> bool {
        let length = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt();
        let mut any_outside = false;
        self.heights.clear();
        for corner in &self.corners {
            let [x, y] = corner.at;
            let height = normal[0] * x + normal[1] * y - offset;
            let tolerance = PLANE_TOLERANCE * (offset.abs() + length * (x.abs() + y.abs()));
            let height = if height > tolerance { height } else { height.min(0.0) };
            any_outside |= height > 0.0;
            self.heights.push(height);
        }
        if any_outside {
            let straight = |_: [f64; 2], _: [f64; 2], start: f64, end: f64| Some(start / (start - end));
            // A straight cut always finds its crossing.
            let _ = self.split(source, straight);
        }
        any_outside
    }

    /// Keeps the part where `level` is negative; chains of inner corners are joined by chords. Returns the largest
    /// magnitude of the level set at a corner, `None` if it is not a number.
    pub(crate) fn cut(&mut self, level: impl Fn([f64; 2]) -> f64, source: Source) -> Option<f64> {
        self.heights.clear();
        self.heights.extend(self.corners.iter().map(|corner| level(corner.at)));
        let largest = largest_magnitude(&self.heights)?;
        if self.heights.iter().any(|&height| height > 0.0) {
            self.split(source, |a, b, start, end| bracketed_root(start, end, |t| level(between(a, b, t))))?;
        }
        Some(largest)
    }

    /// Drops the corners of positive height. `crossing(inside, outside, height inside, height outside)` says how far
    /// from the inner to the outer end of an edge the cut lies, as a fraction of the edge.
    fn split(
        &mut self,
        source: Source,
        crossing: impl Fn([f64; 2], [f64; 2], f64, f64) -> Option<f64>,
    ) -> Option<()> {
        self.next.clear();
        for (k, corner) in self.corners.iter().enumerate() {
            let after = if k + 1 == self.corners.len() { 0 } else { k + 1 };
            let (a, b) = (corner.at, self.corners[after].at);
            let (at_a, at_b) = (self.heights[k], self.heights[after]);
            if at_a <= 0.0 {
                self.next.push(*corner);
                if at_b > 0.0 {
                    let at = between(a, b, crossing(a, b, at_a, at_b)?);
                    self.next.push(Corner { at, edge: source });
                }
            } else if at_b <= 0.0 {
                let at = between(b, a, crossing(b, a, at_b, at_a)?);
                self.next.push(Corner { at, edge: corner.edge });
            }
        }
        std::mem::swap(&mut self.corners, &mut self.next);
        Some(())
    }

    pub(crate) fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        let mut measure = Measure { volume: 0.0, moment: [0.0; 3] };
        for (k, corner) in self.corners.iter().enumerate() {
            let (a, b) = (corner.at, self.corners[(k + 1) % self.corners.len()].at);
            let triangle = 0.5 * (a[0] * b[1] - a[1] * b[0]);
            measure.volume += triangle;
            for axis in 0..2 {
                measure.moment[axis] += triangle * (a[axis] + b[axis]) / 3.0;
            }
            pieces.push(Piece {
                source: corner.edge,
                area: [b[1] - a[1], a[0] - b[0], 0.0],
                centroid: [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.0],
            });
        }
        measure
    }
}

/// The point a fraction `t` of the way from `a` to `b`.
fn between(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}
