//! Coarse unknowns that are a subset of the fine ones, and interpolation from them (Ruge and Stüben, in "Multigrid methods",
//! SIAM 1987; Stüben, J. Comput. Appl. Math. 128, 2001).

use super::strength::{Bonds, Graph};
use crate::csr::{Csr, computed_rows};

/// Entries that a row of extended interpolation keeps at most; the others' weight goes to those that stay (De Sterck et
/// al. 2008 find four enough, and complexities that grow without bound otherwise).
const KEPT: usize = 4;

/// Is not a coarse unknown.
const FINE: u32 = u32::MAX;

/// Strong dependence of rows: entries of the sign opposite to the diagonal, of at least `threshold` times the largest.
pub(crate) fn dependence(a: &Csr, threshold: f64, base: &impl Bonds) -> Graph {
    let mut graph = Graph::empty((0..a.nrows()).map(|i| base.is_settled(i)).collect());
    for i in 0..a.nrows() {
        let diagonal = a.get(i, i);
        let (columns, values) = a.row(i);
        let size = |v: f64| if diagonal == 0.0 { 0.0 } else { -v / diagonal };
        let others = || columns.iter().zip(values).filter(|(j, _)| **j as usize != i);
        let largest = others().fold(0.0_f64, |m, (_, &v)| m.max(size(v)));
        if !base.is_settled(i) && largest > 0.0 {
            for (&j, &v) in others() {
                if size(v) >= threshold * largest && size(v) > 0.0 && !base.is_settled(j as usize) {
                    graph.push(j, size(v));
                }
            }
        }
        graph.end_row();
    }
    graph
}

/// Chooses the coarse unknowns by the first pass of Ruge and Stüben: again and again that on which most others depend. Gives
/// the number of every coarse unknown, [`FINE`] for the others, and how many there are. Settled ones are neither.
pub(crate) fn splitting(graph: &Graph) -> (Vec<u32>, usize) {
    let n = graph.len();
    let reverse = reversed(graph);
    let mut weight: Vec<usize> = (0..n).map(|i| reverse[i].len()).collect();
    let mut queue = std::collections::BTreeSet::new();
    // The largest weight first, of equals the first node.
    let key = |w: usize, i: usize| (usize::MAX - w, i);
    let mut open: Vec<bool> = graph.settled.iter().map(|s| !s).collect();
    (0..n).filter(|&i| open[i]).for_each(|i| {
        queue.insert(key(weight[i], i));
    });
    let mut coarse = vec![false; n];
    while let Some((_, i)) = queue.pop_first() {
        open[i] = false;
        if weight[i] == 0 && !graph.list(i).is_empty() {
            // Nobody needs it, and it can be interpolated.
            continue;
        }
        coarse[i] = true;
        for &j in &reverse[i] {
            let j = j as usize;
            if !std::mem::replace(&mut open[j], false) {
                continue;
            }
            queue.remove(&key(weight[j], j));
            for &k in graph.list(j) {
                let k = k as usize;
                if open[k] {
                    queue.remove(&key(weight[k], k));
                    weight[k] += 1;
                    queue.insert(key(weight[k], k));
                }
            }
        }
        for &k in graph.list(i) {
            let k = k as usize;
            if open[k] && weight[k] > 0 {
                queue.remove(&key(weight[k], k));
                weight[k] -= 1;
                queue.insert(key(weight[k], k));
            }
        }
    }
    // A fine unknown without a strong coarse neighbour, which the last steps may leave, is made coarse.
    for i in 0..n {
        if !coarse[i] && !graph.settled[i] && graph.list(i).iter().all(|&j| !coarse[j as usize]) {
            coarse[i] = true;
        }
    }
    let mut count = 0;
    let number = coarse.iter().map(|&c| {
        if c {
            count += 1;
            count as u32 - 1
        } else {
            FINE
        }
    });
    (number.collect(), count)
}

fn reversed(graph: &Graph) -> Vec<Vec<u32>> {
    let mut reverse = vec![Vec::new(); graph.len()];
    for i in 0..graph.len() {
        graph.list(i).iter().for_each(|&j| reverse[j as usize].push(i as u32));
    }
    reverse
}

/// Interpolation. Direct: `w_ij = a_ij / sum_C a_ik` over strong coarse neighbours. Extended: each strong fine neighbour `k`
/// hands its entry on to its own strong coarse neighbours and to `i`, in proportion to its entries for them. Rows add up to
/// 1, as they do in the literature where the rows of the matrix add up to 0.
pub(crate) fn interpolation(a: &Csr, graph: &Graph, number: &[u32], count: usize, extended: bool) -> Csr {
    computed_rows(a.nrows(), count, |i, places, block| {
        if number[i] != FINE {
            block.add(places, number[i], 1.0);
            return;
        }
        let mut weights: Vec<(u32, f64)> = Vec::new();
        for &j in graph.list(i) {
            let a_ij = a.get(i, j as usize);
            if number[j as usize] != FINE {
                weights.push((number[j as usize], a_ij));
            } else if extended {
                hand_on(a, graph, number, (i, j as usize, a_ij), &mut weights);
            }
        }
        let weights = truncated(weights, extended);
        let sum: f64 = weights.iter().map(|w| w.1).sum();
        if sum != 0.0 {
            weights.iter().for_each(|&(c, w)| block.add(places, c, w / sum));
        }
    })
}

/// What a strong fine neighbour `k` of `i` hands on. Its share for `i` itself goes to the diagonal, so it drops out of the
/// quotients.
fn hand_on(
    a: &Csr,
    graph: &Graph,
    number: &[u32],
    (i, k, a_ik): (usize, usize, f64),
    weights: &mut Vec<(u32, f64)>,
) {
    let diagonal = a.get(k, k);
    let back = a.get(k, i);
    let mut total = if back * diagonal < 0.0 { back } else { 0.0 };
    let coarse = || graph.list(k).iter().filter(|&&l| number[l as usize] != FINE);
    total += coarse().map(|&l| a.get(k, l as usize)).sum::<f64>();
    if total != 0.0 {
        weights.extend(coarse().map(|&l| (number[l as usize], a_ik * a.get(k, l as usize) / total)));
    }
}

fn truncated(mut weights: Vec<(u32, f64)>, extended: bool) -> Vec<(u32, f64)> {
    if !extended {
        return weights;
    }
    weights.sort_by_key(|w| w.0);
    let mut merged: Vec<(u32, f64)> = Vec::with_capacity(weights.len());
    for (c, w) in weights {
        match merged.last_mut() {
            Some(last) if last.0 == c => last.1 += w,
            _ => merged.push((c, w)),
        }
    }
    merged.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
    merged.truncate(KEPT);
    merged
}
