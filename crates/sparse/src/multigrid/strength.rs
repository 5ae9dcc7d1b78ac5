//! Which unknowns depend strongly on which.

use crate::csr::joined;
use crate::difference::DifferenceMatrix;
use crate::parallel;

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
///
/// `units` measure the columns where it matters: in what settles a row.
pub(crate) fn symmetric(a: &DifferenceMatrix, units: Option<&[f64]>, threshold: f64) -> Graph {
    let n = a.n();
    let inverse: Vec<f64> = parallel::map_rows(n, |i| 1.0 / a.diagonal(i));
    let blocks = parallel::map_with(
        n.div_ceil(ROWS_PER_TASK),
        || Mirror::new(n),
        |mirror, task| {
            let rows = task * ROWS_PER_TASK..n.min((task + 1) * ROWS_PER_TASK);
            let mut block = Block::default();
            rows.for_each(|i| block.push(a, units, &inverse, threshold, mirror, i));
            mirror.clear();
            block
        },
    );
    let largest: Vec<f64> = blocks.iter().flat_map(|b| b.largest.iter().copied()).collect();
    let settled: Vec<bool> = blocks.iter().flat_map(|b| b.settled.iter().copied()).collect();
    let parts = parallel::map(blocks.len(), |task| blocks[task].filtered(&largest, &settled, threshold));
    drop(blocks);
    let parts = parts.iter().map(|p| (&p.0[..], &p.1[..], &p.2[..])).collect();
    let (offsets, neighbors, strengths) = joined(n, n, parts).into_parts();
    Graph { offsets, neighbors, strengths, settled }
}

/// Where the entries `a_ji` stand whose columns are rows that are gone through in order: a place in every row, which moves on
/// with the rows. A search in each row would take several times as long.
struct Mirror {
    place: Vec<u32>,
    touched: Vec<u32>,
}

/// No place yet.
const NOWHERE: u32 = u32::MAX;

impl Mirror {
    fn new(n: usize) -> Self {
        Self { place: vec![NOWHERE; n], touched: Vec::new() }
    }

    /// The entry in row `j` and column `i`; the `i` never decrease.
    #[inline]
    fn entry(&mut self, a: &DifferenceMatrix, j: usize, i: u32) -> f64 {
        let (columns, values) = a.row(j);
        let place = &mut self.place[j];
        if *place == NOWHERE {
            *place = columns.partition_point(|&k| k < i) as u32;
            self.touched.push(j as u32);
        }
        let mut k = *place as usize;
        while k < columns.len() && columns[k] < i {
            k += 1;
        }
        *place = k as u32;
        if columns.get(k) == Some(&i) { values[k] } else { 0.0 }
    }

    fn clear(&mut self) {
        self.touched.drain(..).for_each(|j| self.place[j as usize] = NOWHERE);
    }
}

/// What is strong as seen from the rows of a block: squares of measures.
#[derive(Default)]
struct Block {
    lengths: Vec<usize>,
    columns: Vec<u32>,
    squares: Vec<f64>,
    /// The largest square of every row.
    largest: Vec<f64>,
    settled: Vec<bool>,
    row: Vec<(u32, f64)>,
}

impl Block {
    fn push(
        &mut self,
        a: &DifferenceMatrix,
        units: Option<&[f64]>,
        inverse: &[f64],
        threshold: f64,
        mirror: &mut Mirror,
        i: usize,
    ) {
        let (columns, values) = a.row(i);
        let (mut others, mut largest) = (0.0, 0.0_f64);
        self.row.clear();
        for (&j, &a_ij) in columns.iter().zip(values) {
            others += units.map_or(a_ij.abs(), |c| c[j as usize] * a_ij.abs());
            let there = a_ij * inverse[i];
            if there < 0.0 {
                let back = mirror.entry(a, j as usize, i as u32) * inverse[j as usize];
                if back < 0.0 {
                    let square = there * back;
                    largest = largest.max(square);
                    self.row.push((j, square));
                }
            }
        }
        let own = units.map_or(1.0, |c| c[i]) / inverse[i].abs();
        self.settled.push(own >= DOMINANT * others);
        self.largest.push(largest);
        let bound = threshold * threshold * largest;
        let before = self.columns.len();
        for &(j, square) in self.row.iter().filter(|e| e.1 > 0.0 && e.1 >= bound) {
            self.columns.push(j);
            self.squares.push(square);
        }
        self.lengths.push(self.columns.len() - before);
    }

    /// Keeps what is strong for both ends, in rows that are not settled.
    fn filtered(
        &self,
        largest: &[f64],
        settled: &[bool],
        threshold: f64,
    ) -> (Vec<usize>, Vec<u32>, Vec<f64>) {
        let (mut lengths, mut neighbors, mut strengths) = (Vec::new(), Vec::new(), Vec::new());
        let mut start = 0;
        for (k, &length) in self.lengths.iter().enumerate() {
            let before = neighbors.len();
            let row = start..start + length;
            start += length;
            if !self.settled[k] {
                for (&j, &square) in self.columns[row.clone()].iter().zip(&self.squares[row]) {
                    let bound = threshold * threshold * largest[j as usize];
                    if square >= bound && !settled[j as usize] {
                        neighbors.push(j);
                        strengths.push(square.sqrt());
                    }
                }
            }
            lengths.push(neighbors.len() - before);
        }
        (lengths, neighbors, strengths)
    }
}

/// Whether smoothing alone settles every row.
pub(crate) fn all_settled(a: &DifferenceMatrix) -> bool {
    (0..a.n()).all(|i| {
        let others: f64 = a.row(i).1.iter().map(|v| v.abs()).sum();
        a.diagonal(i).abs() >= DOMINANT * others
    })
}
