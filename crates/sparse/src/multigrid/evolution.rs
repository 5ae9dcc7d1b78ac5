//! Evolution strength: two unknowns belong together if a point source at one soon looks the same at the other.

use super::strength::{Bonds, Graph};
use crate::csr::Csr;
use crate::parallel;

/// Damping of the relaxation that spreads the source.
const DAMPING: f64 = 2.0 / 3.0;

/// How much worse than the best neighbour a strong one may be (4 in PyAMG, after Olson, Schroder and Tuminaro 2010).
const SLACK: f64 = 4.0;

/// Rows that one task works through.
const ROWS_PER_TASK: usize = 4096;

/// What stands for a perfect match, so that strengths are finite.
const PERFECT: f64 = 1e-12;

/// The graph of strength by evolution: `z = (I - omega D^-1 A)^2 e_i` is compared with the constant at its neighbours `j`;
/// `|1 - z_i / z_j|` at most [`SLACK`] times the least makes a strong bond, if it is one seen from both ends. `base` says
/// which rows are settled.
pub(crate) fn evolution(a: &Csr, base: &impl Bonds) -> Graph {
    let n = a.nrows();
    let transpose = a.transpose();
    let diagonal = a.diagonal();
    let step = |i: usize, j: usize, a_ij: f64| {
        let unit = if i == j { 1.0 } else { 0.0 };
        if diagonal[i] == 0.0 { unit } else { unit - DAMPING * a_ij / diagonal[i] }
    };
    let row = |source: &mut Vec<f64>, i: usize| -> Vec<(u32, f64)> {
        let (sources, values) = transpose.row(i);
        sources.iter().zip(values).for_each(|(&k, &v)| source[k as usize] = step(k as usize, i, v));
        let spread = |j: usize| -> f64 {
            let (columns, values) = a.row(j);
            columns.iter().zip(values).map(|(&k, &v)| step(j, k as usize, v) * source[k as usize]).sum()
        };
        let own = spread(i);
        let error = |&j: &u32| {
            let z = spread(j as usize);
            let e = if own * z > 0.0 { (1.0 - own / z).abs() } else { f64::INFINITY };
            (j, e.max(PERFECT))
        };
        let others = a.row(i).0.iter().filter(|j| **j as usize != i && !base.is_settled(**j as usize));
        let mut errors: Vec<(u32, f64)> =
            if base.is_settled(i) { Vec::new() } else { others.map(error).collect() };
        let best = errors.iter().fold(f64::INFINITY, |m, e| m.min(e.1));
        errors.retain(|e| e.1.is_finite() && e.1 <= SLACK * best);
        sources.iter().for_each(|&k| source[k as usize] = 0.0);
        errors
    };
    let rows_of = |source: &mut Vec<f64>, task: usize| -> Vec<Vec<(u32, f64)>> {
        let rows = task * ROWS_PER_TASK..n.min((task + 1) * ROWS_PER_TASK);
        rows.map(|i| row(source, i)).collect()
    };
    let rows: Vec<Vec<(u32, f64)>> = parallel::map_with(n.div_ceil(ROWS_PER_TASK), || vec![0.0; n], rows_of)
        .into_iter()
        .flatten()
        .collect();
    let back = |i: usize, j: u32| {
        let found = rows[j as usize].binary_search_by_key(&(i as u32), |e| e.0);
        found.ok().map(|k| rows[j as usize][k].1)
    };
    let mut graph = Graph::empty((0..n).map(|i| base.is_settled(i)).collect());
    for (i, row) in rows.iter().enumerate() {
        for &(j, e) in row {
            if let Some(other) = back(i, j) {
                graph.push(j, 1.0 / e.max(other));
            }
        }
        graph.end_row();
    }
    graph
}
