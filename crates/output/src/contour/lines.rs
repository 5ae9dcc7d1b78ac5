//! Lines at a level.

use super::Pieces;
use super::clip::crossing;
use super::trace::Edges;

/// A line of points; a closed one leads from its last point to its first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) closed: bool,
}

/// The lines where the field has the value `level`.
pub(crate) fn level_lines(pieces: &Pieces, level: f64) -> Vec<Line> {
    let mut edges = Edges::default();
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
            let (from, to) = (edges.number(from), edges.number(to));
            edges.add(from, to);
        }
    }
    edges.lines().into_iter().map(|(points, closed)| Line { points, closed }).collect()
}
