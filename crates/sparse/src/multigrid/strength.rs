//! Which unknowns depend strongly on which.

use crate::difference::DifferenceMatrix;

/// A row whose diagonal exceeds the sum of its other entries by this factor is settled by smoothing alone: an error
/// shrinks tenfold in a sweep (Stüben, "A review of algebraic multigrid", 2001, section 7.1, leaves such rows out likewise).
const DOMINANT: f64 = 10.0;

/// A directed graph of bonds.
pub(crate) trait Bonds: Sync {
    /// Number of nodes.
    fn len(&self) -> usize;

    /// Whether a row needs no correction from a coarser level.
    fn is_settled(&self, i: usize) -> bool;

    /// Whether a node has no bond.
    fn is_alone(&self, i: usize) -> bool;

    /// The neighbours of a node, with the strength of each bond.
    fn of(&self, i: usize) -> impl Iterator<Item = (usize, f64)>;

    /// The neighbours of a node.
    fn neighbors(&self, i: usize) -> impl Iterator<Item = usize>;

    /// Calls `f(j, a_ij)` for the bonds of a node, with the entries of the matrix `a`.
    fn entries(&self, a: &DifferenceMatrix, i: usize, f: impl FnMut(u32, f64));

    /// The graph without the bonds of some nodes, which are settled.
    fn without(self, nodes: &[bool]) -> Self;
}

/// Bonds in lists, for measures that no matrix has an entry for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Graph {
    offsets: Vec<usize>,
    pub(crate) neighbors: Vec<u32>,
    pub(crate) strengths: Vec<f64>,
    pub(crate) settled: Vec<bool>,
}

impl Graph {
    /// No rows yet, of as many as there are marks of settled ones.
    pub(crate) fn empty(settled: Vec<bool>) -> Self {
        Self { offsets: vec![0], neighbors: Vec::new(), strengths: Vec::new(), settled }
    }

    /// Adds a bond to the row that is being made.
    pub(crate) fn push(&mut self, j: u32, strength: f64) {
        self.neighbors.push(j);
        self.strengths.push(strength);
    }

    /// The bonds of the row that is being made.
    pub(crate) fn row_len(&self) -> usize {
        self.neighbors.len() - self.offsets[self.offsets.len() - 1]
    }

    pub(crate) fn end_row(&mut self) {
        self.offsets.push(self.neighbors.len());
    }

    pub(crate) fn list(&self, i: usize) -> &[u32] {
        &self.neighbors[self.offsets[i]..self.offsets[i + 1]]
    }
}

impl Bonds for Graph {
    fn len(&self) -> usize {
        self.settled.len()
    }

    fn is_settled(&self, i: usize) -> bool {
        self.settled[i]
    }

    fn is_alone(&self, i: usize) -> bool {
        self.list(i).is_empty()
    }

    fn of(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.offsets[i]..self.offsets[i + 1];
        self.neighbors[range.clone()].iter().map(|&j| j as usize).zip(self.strengths[range].iter().copied())
    }

    fn neighbors(&self, i: usize) -> impl Iterator<Item = usize> {
        self.list(i).iter().map(|&j| j as usize)
    }

    fn entries(&self, a: &DifferenceMatrix, i: usize, mut f: impl FnMut(u32, f64)) {
        let mut strong = self.list(i).iter().peekable();
        let (columns, values) = a.row(i);
        for (&j, &a_ij) in columns.iter().zip(values) {
            if strong.next_if(|&&k| k == j).is_some() {
                f(j, a_ij);
            }
        }
    }

    fn without(self, nodes: &[bool]) -> Self {
        let settled = self.settled.iter().zip(nodes).map(|(s, k)| *s || *k).collect();
        let mut rest = Self::empty(settled);
        for i in 0..self.len() {
            let bonds = self.of(i).filter(|&(j, _)| !nodes[i] && !nodes[j]);
            bonds.for_each(|(j, s)| rest.push(j as u32, s));
            rest.end_row();
        }
        rest
    }
}

/// Whether smoothing alone settles a row, by the reciprocal of its diagonal, zero where there is none, the unit of that and the sum of
/// its other entries.
pub(crate) fn is_settled(inverse: f64, unit: f64, others: f64) -> bool {
    let own = if inverse == 0.0 { 0.0 } else { unit / inverse.abs() };
    own >= DOMINANT * others
}

/// Whether smoothing alone settles every row.
pub(crate) fn all_settled(a: &DifferenceMatrix) -> bool {
    (0..a.n()).all(|i| {
        let others: f64 = a.row(i).1.iter().map(|v| v.abs()).sum();
        a.diagonal(i).abs() >= DOMINANT * others
    })
}
