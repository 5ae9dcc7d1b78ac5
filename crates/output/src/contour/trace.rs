//! Directed edges between points, joined to lines.

use std::collections::HashMap;

/// Points that are the same if they agree bit by bit, and directed edges between them.
#[derive(Debug, Default)]
pub(super) struct Edges {
    numbers: HashMap<[u64; 2], u32>,
    points: Vec<[f64; 2]>,
    edges: Vec<(u32, u32)>,
}

impl Edges {
    /// The number of a point.
    pub(super) fn number(&mut self, point: [f64; 2]) -> u32 {
        // Adding zero makes minus zero positive.
        let key = point.map(|x| (x + 0.0).to_bits());
        let next = self.points.len() as u32;
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.points.push(point);
        }
        number
    }

    /// Adds an edge, unless it has no length.
    pub(super) fn add(&mut self, from: u32, to: u32) {
        if from != to {
            self.edges.push((from, to));
        }
    }

    /// Removes pairs of edges in opposite directions.
    pub(super) fn cancel(&mut self) {
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

    /// Joins the edges to lines `(points, closed)`, each edge in one of them. Open lines lead from a point with more
    /// edges out than in to one with more in than out; what is left after them is closed. The result depends on the
    /// order in which points were numbered only.
    pub(super) fn lines(mut self) -> Vec<(Vec<[f64; 2]>, bool)> {
        let count = self.points.len();
        self.edges.sort_unstable();
        // The edges out of a point are those from next[point] to ends[point].
        let mut ends = vec![0_usize; count];
        let mut surplus = vec![0_i32; count];
        for &(from, to) in &self.edges {
            ends[from as usize] += 1;
            surplus[from as usize] += 1;
            surplus[to as usize] -= 1;
        }
        let mut next = Vec::with_capacity(count);
        let mut total = 0;
        for end in &mut ends {
            next.push(total);
            total += *end;
            *end = total;
        }
        let open_starts = (0..count).flat_map(|k| std::iter::repeat_n(k, surplus[k].max(0) as usize));
        let closed_starts = (0..count).flat_map(|k| std::iter::repeat_n(k, ends[k] - next[k]));
        let starts: Vec<usize> = open_starts.chain(closed_starts).collect();
        let mut lines = Vec::new();
        for start in starts {
            let mut points = vec![self.points[start]];
            let mut at = start;
            while next[at] < ends[at] {
                next[at] += 1;
                at = self.edges[next[at] - 1].1 as usize;
                points.push(self.points[at]);
            }
            let closed = at == start;
            if closed {
                points.pop();
            }
            if points.len() > 1 {
                lines.push((points, closed));
            }
        }
        lines
    }
}
