//! The outline of an area that is given piece by piece.

use super::Loop;
use super::trace::Edges;

/// Collects the edges of polygons; edges that are passed in both directions cancel.
#[derive(Debug, Default)]
pub(crate) struct Outline {
    edges: Edges,
}

impl Outline {
    /// Adds a polygon, counter-clockwise.
    pub(crate) fn add(&mut self, polygon: impl Iterator<Item = [f64; 2]>) {
        let mut ends = None;
        for point in polygon {
            let number = self.edges.number(point);
            let (first, last) = ends.unwrap_or((number, number));
            self.edges.add(last, number);
            ends = Some((first, number));
        }
        if let Some((first, last)) = ends {
            self.edges.add(last, first);
        }
    }

    /// The outline as loops, without points in the middle of straight stretches. Every point has as many edges in as
    /// out, so that all lines are closed.
    pub(crate) fn loops(mut self) -> Vec<Loop> {
        self.edges.cancel();
        let loops = self.edges.lines().into_iter().map(|(points, _)| straighten(&points));
        loops.filter(|points| points.len() > 2).collect()
    }
}

/// Leaves out the points on straight stretches along the grid lines, where whole cells were joined.
fn straighten(points: &[[f64; 2]]) -> Loop {
    let count = points.len();
    let needed = |k: &usize| {
        let (a, b, c) = (points[(k + count - 1) % count], points[*k], points[(k + 1) % count]);
        !(0..2).any(|axis| a[axis] == b[axis] && b[axis] == c[axis])
    };
    (0..count).filter(needed).map(|k| points[k]).collect()
}
