//! Which unknowns depend strongly on which.

use crate::csr::{Csr, joined};
use rayon::prelude::*;

/// Rows that one task works through.
const ROWS_PER_TASK: usize = 4096;

/// A row whose diagonal exceeds the sum of its other entries by this factor is settled by smoothing alone: an error
/// shrinks tenfold in a sweep (Stüben, "A review of algebraic multigrid", 2001, section 7.1, leaves such rows out likewise).
const DOMINANT: f64 = 10.0;

/// A directed graph: the neighbours of every node, with the strength of each.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Graph {
    pub(crate) offsets: Vec<usize>,
    pub(crate) neighbors: Vec<u32>,
    pub(crate) strengths: Vec<f64>,
    /// Rows that need no correction from a coarser level.
    pub(crate) settled: Vec<bool>,
}

impl Graph {
    pub(crate) fn len(&self) -> usize {
        self.settled.len()
    }

    pub(crate) fn neighbors(&self, i: usize) -> &[u32] {
        &self.neighbors[self.offsets[i]..self.offsets[i + 1]]
    }

    pub(crate) fn of(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.offsets[i]..self.offsets[i + 1];
        self.neighbors[range.clone()].iter().map(|&j| j as usize).zip(self.strengths[range].iter().copied())
    }
}

/// The symmetric measure `s_ij = sqrt(a_ij a_ji / (a_ii a_jj))`, for entries that are both of the sign opposite to
/// their diagonals, kept where it is at least `threshold` times the largest of either row.
///
/// This is the measure of Vaněk, Mandel and Brezina (Computing 56, 1996, (4)), with the threshold relative to the row as
/// Ruge and Stüben have it, because the rows of wide stencils have no entry beside which 1 is a measure. It does not
/// change when rows or columns are scaled, and a bond across a jump of the diffusivity by `c` has the strength `c^-1/2`.
pub(crate) fn symmetric(a: &Csr, threshold: f64) -> Graph {
    let n = a.nrows();
    let diagonal = a.diagonal();
    let mut measure = vec![0.0; a.nnz()];
    let mut largest = vec![0.0_f64; n];
    let mut settled = vec![false; n];
    by_rows(a, &mut measure, &mut largest, &mut settled, |i, s, largest, settled| {
        let (columns, values) = a.row(i);
        let mut others = 0.0;
        for ((&j, &a_ij), s) in columns.iter().zip(values).zip(s) {
            let j = j as usize;
            if j == i {
                continue;
            }
            others += a_ij.abs();
            let there = a_ij / diagonal[i];
            if there < 0.0 {
                let back = a.get(j, i) / diagonal[j];
                if back < 0.0 {
                    *s = (there * back).sqrt();
                    *largest = largest.max(*s);
                }
            }
        }
        *settled = diagonal[i].abs() >= DOMINANT * others;
    });
    filtered(a, &measure, &largest, settled, threshold)
}

/// Whether smoothing alone settles every row.
pub(crate) fn all_settled(a: &Csr) -> bool {
    (0..a.nrows()).into_par_iter().with_min_len(ROWS_PER_TASK).all(|i| {
        let (columns, values) = a.row(i);
        let (mut diagonal, mut others) = (0.0, 0.0);
        for (&j, v) in columns.iter().zip(values) {
            *(if j as usize == i { &mut diagonal } else { &mut others }) += v.abs();
        }
        diagonal >= DOMINANT * others
    })
}

/// Calls `f(i, measures of row i, largest of i, settled of i)` for every row, in parallel.
fn by_rows(
    a: &Csr,
    measure: &mut [f64],
    largest: &mut [f64],
    settled: &mut [bool],
    f: impl Fn(usize, &mut [f64], &mut f64, &mut bool) + Sync,
) {
    let mut parts = Vec::new();
    let mut rest = measure;
    for (task, (largest, settled)) in
        largest.chunks_mut(ROWS_PER_TASK).zip(settled.chunks_mut(ROWS_PER_TASK)).enumerate()
    {
        let first = task * ROWS_PER_TASK;
        let entries = a.offsets()[first + largest.len()] - a.offsets()[first];
        let (own, others) = rest.split_at_mut(entries);
        rest = others;
        parts.push((first, own, largest, settled));
    }
    parts.into_par_iter().for_each(|(first, mut own, largest, settled)| {
        for (k, (largest, settled)) in largest.iter_mut().zip(settled).enumerate() {
            let (row, others) = own.split_at_mut(a.row(first + k).0.len());
            own = others;
            f(first + k, row, largest, settled);
        }
    });
}

/// Keeps the entries that are strong for both ends, in rows that are not settled.
fn filtered(a: &Csr, measure: &[f64], largest: &[f64], settled: Vec<bool>, threshold: f64) -> Graph {
    let n = a.nrows();
    let kept = |task: usize| {
        let mut part = (Vec::new(), Vec::new(), Vec::new());
        for i in task * ROWS_PER_TASK..n.min((task + 1) * ROWS_PER_TASK) {
            let before = part.1.len();
            if !settled[i] {
                let start = a.offsets()[i];
                for (k, &j) in a.row(i).0.iter().enumerate() {
                    let s = measure[start + k];
                    let bound = threshold * largest[i].max(largest[j as usize]);
                    if s > 0.0 && s >= bound && !settled[j as usize] {
                        part.1.push(j);
                        part.2.push(s);
                    }
                }
            }
            part.0.push(part.1.len() - before);
        }
        part
    };
    let parts: Vec<(Vec<usize>, Vec<u32>, Vec<f64>)> =
        (0..n.div_ceil(ROWS_PER_TASK)).into_par_iter().map(kept).collect();
    let parts = parts.iter().map(|p| (&p.0[..], &p.1[..], &p.2[..])).collect();
    let (offsets, neighbors, strengths) = joined(n, n, parts).into_parts();
    Graph { offsets, neighbors, strengths, settled }
}
