//! The outline of an area that is given piece by piece.

use std::collections::HashMap;

use super::Loop;

/// Collects the edges of polygons; edges that are passed in both directions cancel.
#[derive(Debug, Default)]
pub(crate) struct Outline {
    numbers: HashMap<[u64; 2], u32>,
    points: Vec<[f64; 2]>,
    edges: Vec<(u32, u32)>,
}

impl Outline {
    /// Adds a polygon, counter-clockwise.
    pub(crate) fn add(&mut self, polygon: impl Iterator<Item = [f64; 2]>) {
        let mut first = None;
        let mut last: Option<u32> = None;
        for point in polygon {
            let number = self.number(point);
            first = first.or(Some(number));
            self.edge(last.replace(number), Some(number));
        }
        self.edge(last, first);
    }

    fn edge(&mut self, from: Option<u32>, to: Option<u32>) {
        if let (Some(from), Some(to)) = (from, to)
            && from != to
        {
            self.edges.push((from, to));
        }
    }

    /// The number of a point: points are the same if they agree bit by bit.
    fn number(&mut self, point: [f64; 2]) -> u32 {
        // Adding zero makes minus zero positive.
        let key = point.map(|x| (x + 0.0).to_bits());
        let next = self.points.len() as u32;
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.points.push(point);
        }
        number
    }

    /// The outline as loops, without points in the middle of straight stretches. The order depends on the order of the
    /// polygons only.
    pub(crate) fn loops(mut self) -> Vec<Loop> {
        self.cancel();
        // Every point has as many edges in as out, so that following unused edges always leads back.
        self.edges.sort_unstable();
        let mut next: Vec<usize> = Vec::with_capacity(self.points.len() + 1);
        for point in 0..=self.points.len() as u32 {
            next.push(self.edges.partition_point(|edge| edge.0 < point));
        }
        let ends = next[1..].to_vec();
        let mut loops = Vec::new();
        for start in 0..self.points.len() {
            while next[start] < ends[start] {
                let mut points = Vec::new();
                let mut at = start;
                while next[at] < ends[at] {
                    points.push(self.points[at]);
                    next[at] += 1;
                    at = self.edges[next[at] - 1].1 as usize;
                }
                loops.push(straighten(&points));
            }
        }
        loops.retain(|points| points.len() > 2);
        loops
    }

    /// Removes pairs of edges in opposite directions.
    fn cancel(&mut self) {
        let undirected = |&(a, b): &(u32, u32)| (a.min(b), a.max(b));
        self.edges.sort_unstable_by_key(undirected);
        let mut left = Vec::new();
        for same in self.edges.chunk_by(|a, b| undirected(a) == undirected(b)) {
            let (low, high) = undirected(&same[0]);
            let up = same.iter().filter(|edge| edge.0 == low).count();
            let down = same.len() - up;
            left.extend(std::iter::repeat_n((low, high), up.saturating_sub(down)));
            left.extend(std::iter::repeat_n((high, low), down.saturating_sub(up)));
        }
        self.edges = left;
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
