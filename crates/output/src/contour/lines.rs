//! Lines at a level.

use std::collections::HashMap;

use super::Pieces;
use super::clip::crossing;

/// A line of points; a closed one leads from its last point to its first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) closed: bool,
}

/// The lines where the field has the value `level`.
pub(crate) fn level_lines(pieces: &Pieces, level: f64) -> Vec<Line> {
    let mut chain = Chain::default();
    for piece in pieces.iter() {
        let mut ends = [None; 2];
        for (k, a) in piece.iter().enumerate() {
            let b = &piece[(k + 1) % piece.len()];
            let (above_a, above_b) = (a.value >= level, b.value >= level);
            if above_a != above_b {
                let at = crossing(a, b, a.value - level, b.value - level).at;
                ends[usize::from(above_b)] = Some(at);
            }
        }
        if let [Some(from), Some(to)] = ends {
            chain.add(from, to);
        }
    }
    chain.lines()
}

/// Segments that are joined where they meet: higher values lie on the same side all along.
#[derive(Default)]
struct Chain {
    numbers: HashMap<[u64; 2], usize>,
    points: Vec<[f64; 2]>,
    /// For each point the point that follows.
    next: Vec<Option<usize>>,
    has_previous: Vec<bool>,
}

impl Chain {
    fn add(&mut self, from: [f64; 2], to: [f64; 2]) {
        let (from, mut to) = (self.number(from), self.number(to));
        if from == to {
            return;
        }
        // Lines that touch in a point are told apart by doubling the point.
        let mut start = from;
        if self.next[start].is_some() {
            start = self.push(self.points[from]);
        }
        if self.has_previous[to] {
            to = self.push(self.points[to]);
        }
        self.next[start] = Some(to);
        self.has_previous[to] = true;
    }

    fn number(&mut self, point: [f64; 2]) -> usize {
        let key = point.map(|x| (x + 0.0).to_bits());
        match self.numbers.get(&key) {
            Some(&number) => number,
            None => {
                let number = self.push(point);
                self.numbers.insert(key, number);
                number
            }
        }
    }

    fn push(&mut self, point: [f64; 2]) -> usize {
        self.points.push(point);
        self.next.push(None);
        self.has_previous.push(false);
        self.points.len() - 1
    }

    /// Open lines first, from their starts; what is left are closed lines.
    fn lines(mut self) -> Vec<Line> {
        let mut lines = Vec::new();
        let starts = (0..self.points.len()).filter(|&k| !self.has_previous[k]).collect::<Vec<_>>();
        for start in starts.into_iter().chain(0..self.points.len()) {
            let mut points = Vec::new();
            let mut at = start;
            while let Some(after) = self.next[at].take() {
                points.push(self.points[at]);
                at = after;
            }
            if points.is_empty() {
                continue;
            }
            let closed = at == start;
            if !closed {
                points.push(self.points[at]);
            }
            lines.push(Line { points, closed });
        }
        lines
    }
}
