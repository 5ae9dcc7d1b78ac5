//! Aggregates: the unknowns of the next level.

use super::strength::Bonds;
use crate::difference::DifferenceMatrix;
use crate::parallel;

/// In no aggregate.
pub(crate) const NONE: u32 = u32::MAX;

/// The aggregate of every node, or [`NONE`], and how many aggregates there are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Aggregates {
    pub(crate) of: Vec<u32>,
    pub(crate) count: usize,
}

/// Standard aggregation (Vaněk, Mandel and Brezina, Computing 56, 1996, algorithm 2): nodes in order found an aggregate
/// with all their strong neighbours if these are still free; what is left joins the aggregate to which it is tied most;
/// the rest founds aggregates with the free neighbours it has. Nodes whose bonds are strong one way only, or not at all,
/// join that of their largest entry, with columns measured in `units`; settled ones stay out.
pub(crate) fn standard(a: &DifferenceMatrix, units: Option<&[f64]>, graph: &impl Bonds) -> Aggregates {
    let (founded, mut count) = founded(graph);
    let join = |i: usize| {
        let tied = graph.of(i).filter(|(j, _)| founded[*j] != NONE);
        let own = Some(founded[i]).filter(|&k| k != NONE);
        own.or_else(|| tied.fold(None, stronger).map(|(j, _)| founded[j])).unwrap_or(NONE)
    };
    let mut of: Vec<u32> = parallel::map_rows(graph.len(), join);
    for i in 0..of.len() {
        if of[i] == NONE && !graph.is_alone(i) {
            of[i] = count;
            for j in graph.neighbors(i) {
                if of[j] == NONE {
                    of[j] = count;
                }
            }
            count += 1;
        }
    }
    adopt(a, units, graph, &mut of, &mut count);
    Aggregates { of, count: count as usize }
}

/// The aggregates of nodes with all their strong neighbours, and how many these are. One front goes through all nodes, in 1 to 2 % of
/// the time of a set-up: where blocks of nodes meet that are gone through side by side, aggregates do not fit together, and each level
/// makes that worse (`docs/multigrid.md`).
pub(super) fn founded(graph: &impl Bonds) -> (Vec<u32>, u32) {
    let mut of = vec![NONE; graph.len()];
    let mut count = 0;
    for i in 0..of.len() {
        if of[i] == NONE && !graph.is_alone(i) && graph.neighbors(i).all(|j| of[j] == NONE) {
            of[i] = count;
            graph.neighbors(i).for_each(|j| of[j] = count);
            count += 1;
        }
    }
    (of, count)
}

/// The stronger of two neighbours, the first of equals.
fn stronger(best: Option<(usize, f64)>, next: (usize, f64)) -> Option<(usize, f64)> {
    if best.is_some_and(|b| b.1 >= next.1) { best } else { Some(next) }
}

/// Gives nodes without strong neighbours to the aggregate of the largest entry of their row that has the right sign, from
/// the aggregates outwards; where no such entry leads to an aggregate, they are aggregates of their own.
pub(crate) fn adopt(
    a: &DifferenceMatrix,
    units: Option<&[f64]>,
    graph: &impl Bonds,
    of: &mut [u32],
    count: &mut u32,
) {
    let mut left: Vec<usize> = (0..of.len()).filter(|&i| of[i] == NONE && !graph.is_settled(i)).collect();
    while !left.is_empty() {
        let found: Vec<(usize, u32)> =
            left.iter().filter_map(|&i| Some((i, nearest(a, units, of, i)?))).collect();
        if found.is_empty() {
            for &i in &left {
                of[i] = *count;
                *count += 1;
            }
            return;
        }
        found.iter().for_each(|&(i, k)| of[i] = k);
        left.retain(|&i| of[i] == NONE);
    }
}

fn nearest(a: &DifferenceMatrix, units: Option<&[f64]>, of: &[u32], i: usize) -> Option<u32> {
    let diagonal = a.diagonal(i);
    let (columns, values) = a.row(i);
    let unit = |j: u32| units.map_or(1.0, |c| c[j as usize]);
    let entries = columns.iter().zip(values).map(|(&j, v)| (j as usize, -v * unit(j) / diagonal));
    let tied = entries.filter(|(j, s)| *s > 0.0 && of[*j] != NONE);
    tied.fold(None, stronger).map(|(j, _)| of[j])
}
