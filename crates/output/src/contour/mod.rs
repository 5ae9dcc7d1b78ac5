//! Marching squares: areas between levels and lines at levels, of a field on a grid that may end within a cell.
//!
//! A grid is first cut into convex pieces on which the field is linear or has one maximum and one minimum along the
//! border; a level then crosses the border of a piece twice or not at all. All positions are in units of the grid's
//! spacing. A point on a grid edge is always computed from the same end of the edge, so that neighbouring pieces agree
//! bit by bit, and shared edges cancel.

mod clip;
mod cuts;
mod extend;
mod lines;
mod outline;
mod pieces;
mod trace;

pub(crate) use lines::{Line, level_lines};
pub(crate) use outline::Outline;
pub(crate) use pieces::{Domain, Pieces};

use clip::{Zero, clip};

/// A loop of points: counter-clockwise around an area, clockwise around a hole.
pub(crate) type Loop = Vec<[f64; 2]>;

/// A corner of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vertex {
    pub(crate) at: [f64; 2],
    pub(crate) value: f64,
}

/// The areas between successive `levels` (ascending): the first below the first level, the last above the last.
pub(crate) fn bands(pieces: &Pieces, levels: &[f64]) -> Vec<Vec<Loop>> {
    let mut outlines: Vec<Outline> = (0..=levels.len()).map(|_| Outline::default()).collect();
    let (mut part, mut scratch) = (Vec::new(), Vec::new());
    for piece in pieces.iter() {
        let (lo, hi) = range(piece);
        // Band k lies between levels k-1 and k; a level itself belongs to the band above.
        let first = levels.partition_point(|&level| level <= lo);
        let last = levels.partition_point(|&level| level <= hi);
        for band in first..=last {
            part.clear();
            part.extend_from_slice(piece);
            if band > first {
                clip(&mut part, &mut scratch, Zero::Kept, |v| levels[band - 1] - v.value);
            }
            if band < last {
                clip(&mut part, &mut scratch, Zero::Cut, |v| v.value - levels[band]);
            }
            outlines[band].add(part.iter().map(|v| v.at));
        }
    }
    outlines.into_iter().map(Outline::loops).collect()
}

/// Lowest and highest value of a piece.
fn range(piece: &[Vertex]) -> (f64, f64) {
    piece.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v.value), hi.max(v.value)))
}

/// Area enclosed by loops, holes counted negative.
#[cfg(test)]
pub(crate) fn area(loops: &[Loop]) -> f64 {
    let twice = |points: &Loop| -> f64 {
        (0..points.len())
            .map(|k| {
                let (a, b) = (points[k], points[(k + 1) % points.len()]);
                a[0] * b[1] - a[1] * b[0]
            })
            .sum()
    };
    0.5 * loops.iter().map(twice).sum::<f64>()
}

#[cfg(test)]
mod tests;
