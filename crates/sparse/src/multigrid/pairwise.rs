//! Aggregates of two pairs each (Notay, Electron. Trans. Numer. Anal. 37, 2010).

use super::aggregation::{Aggregates, NONE, adopt};
use super::strength::{Bonds, Graph};
use crate::difference::DifferenceMatrix;

/// Passes of pairing: two make aggregates of about four.
const PASSES: usize = 2;

/// Pairs every node with its strongest free neighbour, then every pair with its strongest free pair.
pub(crate) fn pairwise(a: &DifferenceMatrix, units: Option<&[f64]>, graph: &Graph) -> Aggregates {
    let (mut of, mut count) = matched(graph);
    for _pass in 1..PASSES {
        let (pair_of, pairs) = matched(&collapsed(graph, &of, count));
        of.iter_mut().filter(|k| **k != NONE).for_each(|k| *k = pair_of[*k as usize]);
        count = pairs;
    }
    adopt(a, units, graph, &mut of, &mut count);
    Aggregates { of, count: count as usize }
}

/// One pass; nodes without a free strong neighbour stay alone, those without any strong neighbour stay out.
fn matched(graph: &Graph) -> (Vec<u32>, u32) {
    let mut of = vec![NONE; graph.len()];
    let mut count = 0;
    for i in 0..graph.len() {
        if of[i] != NONE || graph.is_alone(i) {
            continue;
        }
        let free = graph.of(i).filter(|(j, _)| of[*j] == NONE && *j != i);
        let best = free.fold(None, |best: Option<(usize, f64)>, next| match best {
            Some(b) if b.1 >= next.1 => best,
            _ => Some(next),
        });
        of[i] = count;
        if let Some((j, _)) = best {
            of[j] = count;
        }
        count += 1;
    }
    (of, count)
}

/// The graph of the aggregates: bonds between two of them add up. An aggregate of its own stays in it by a bond to itself.
fn collapsed(graph: &Graph, of: &[u32], count: u32) -> Graph {
    let mut members = vec![Vec::new(); count as usize];
    for (i, &k) in of.iter().enumerate().filter(|(_, k)| **k != NONE) {
        members[k as usize].push(i);
    }
    let mut coarse = Graph::empty(vec![false; count as usize]);
    for (k, members) in members.iter().enumerate() {
        let mut bonds: Vec<(u32, f64)> = vec![(k as u32, 0.0)];
        for &i in members {
            bonds.extend(
                graph.of(i).filter(|b| of[b.0] != NONE && of[b.0] as usize != k).map(|b| (of[b.0], b.1)),
            );
        }
        bonds.sort_by_key(|b| b.0);
        for (j, s) in bonds {
            if coarse.row_len() > 0 && coarse.neighbors.last() == Some(&j) {
                let end = coarse.strengths.len() - 1;
                coarse.strengths[end] += s;
            } else {
                coarse.push(j, s);
            }
        }
        coarse.end_row();
    }
    coarse
}
