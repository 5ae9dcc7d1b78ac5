//! Unknowns that stay as they are on every level.

use super::aggregation::{Aggregates, NONE};
use super::strength::Graph;
use crate::difference::DifferenceMatrix;
use crate::parallel;

/// Share of the unknowns above which they are not kept: then it is the kind of matrix, not an interface.
const MOST: f64 = 0.3;

/// The rows whose other entries add up to more than `keep` diagonals, in values of which the unknowns are the parts `s`; none if
/// they are many.
pub(crate) fn rows(a: &DifferenceMatrix, s: &[f64], keep: f64) -> Vec<bool> {
    let n = a.n();
    if keep == f64::INFINITY {
        return vec![false; n];
    }
    let inverse = |i: usize| s.get(i).map_or(1.0, |s| 1.0 / s);
    let kept = parallel::map_rows(n, |i| {
        let (columns, values) = a.row(i);
        let others: f64 = columns.iter().zip(values).map(|(&j, v)| v.abs() * inverse(j as usize)).sum();
        others > keep * a.diagonal(i).abs() * inverse(i)
    });
    let count = kept.iter().filter(|k| **k).count();
    if count as f64 > MOST * n as f64 { vec![false; n] } else { kept }
}

/// The graph without the bonds of kept nodes, which are settled by being there on the next level.
pub(crate) fn without(graph: Graph, kept: &[bool]) -> Graph {
    if !kept.contains(&true) {
        return graph;
    }
    let n = graph.len();
    let (mut offsets, mut neighbors, mut strengths) = (vec![0], Vec::new(), Vec::new());
    for i in 0..n {
        let bonds = graph.of(i).filter(|&(j, _)| !kept[i] && !kept[j]);
        for (j, s) in bonds {
            neighbors.push(j as u32);
            strengths.push(s);
        }
        offsets.push(neighbors.len());
    }
    let settled = graph.settled.iter().zip(kept).map(|(s, k)| *s || *k).collect();
    Graph { offsets, neighbors, strengths, settled }
}

/// Gives every kept node an aggregate of its own, after all others; and tells which these are.
pub(crate) fn single_out(aggregates: &mut Aggregates, kept: &[bool]) -> Vec<bool> {
    let mut of_next = vec![false; aggregates.count];
    for (of, _) in aggregates.of.iter_mut().zip(kept).filter(|(_, k)| **k) {
        debug_assert_eq!(*of, NONE);
        *of = aggregates.count as u32;
        aggregates.count += 1;
        of_next.push(true);
    }
    of_next
}
