//! Strong bonds by the symmetric measure, as marks on the entries of the matrix.

use super::strength::{Bonds, Graph, is_settled};
use crate::difference::DifferenceMatrix;
use crate::parallel;

/// Rows that one task works through.
const ROWS_PER_TASK: usize = 4096;

/// Bits of a word.
const WORD: usize = u64::BITS as usize;

/// Which entries of a matrix are strong bonds: a bit for each, and in single precision the strengths of those that are. With wide rows
/// most entries are strong, and lists of them would take as many bytes as the matrix.
#[derive(Debug)]
pub(crate) struct Marks<'a> {
    a: &'a DifferenceMatrix,
    blocks: Vec<Block>,
    settled: Vec<bool>,
}

/// The symmetric measure `s_ij = sqrt(a_ij a_ji / (a_ii a_jj))`, for entries that are both of the sign opposite to
/// their diagonals, kept where it is at least `threshold` times the largest of either row.
///
/// This is the measure of Vaněk, Mandel and Brezina (Computing 56, 1996, (4)), with the threshold relative to the row as
/// Ruge and Stüben have it, because the rows of wide stencils have no entry beside which 1 is a measure. It does not
/// change when rows or columns are scaled, and a bond across a jump of the diffusivity by `c` has the strength `c^-1/2`.
///
/// `inverse` has the reciprocals of the diagonal, zero where that is zero. `units` measure the columns where it matters: in what
/// settles a row.
pub(crate) fn symmetric<'a>(
    a: &'a DifferenceMatrix,
    inverse: &[f64],
    units: Option<&[f64]>,
    threshold: f64,
) -> Marks<'a> {
    let n = a.n();
    let mut blocks = parallel::map_with(
        n.div_ceil(ROWS_PER_TASK),
        || Mirror::new(n),
        |mirror, task| {
            let rows = task * ROWS_PER_TASK..n.min((task + 1) * ROWS_PER_TASK);
            let mut block = Block::new(a, rows.start, rows.end);
            let mut row = Vec::new();
            rows.for_each(|i| block.push(a, units, inverse, threshold, mirror, i, &mut row));
            mirror.clear();
            block
        },
    );
    let largest: Vec<f32> = blocks.iter_mut().flat_map(|b| std::mem::take(&mut b.largest)).collect();
    let settled: Vec<bool> = blocks.iter_mut().flat_map(|b| std::mem::take(&mut b.settled)).collect();
    let mut marks = Marks { a, blocks, settled };
    let least = (threshold * threshold) as f32;
    marks.retain(|settled, i, j, square| !settled[i] && !settled[j] && square >= least * largest[j]);
    marks
}

impl Marks<'_> {
    /// Keeps the bonds for which `keep(settled, i, j, square of the strength)` holds.
    fn retain(&mut self, keep: impl Fn(&[bool], usize, usize, f32) -> bool + Sync) {
        let (a, settled) = (self.a, &self.settled);
        parallel::for_each_task(self.blocks.iter_mut().collect(), |block: &mut Block| {
            block.retain(a, |i, j, square| keep(settled, i, j, square));
        });
    }

    /// The same in lists.
    pub(crate) fn listed(&self) -> Graph {
        let mut graph = Graph::empty(self.settled.clone());
        for i in 0..self.len() {
            self.of(i).for_each(|(j, s)| graph.push(j as u32, s));
            graph.end_row();
        }
        graph
    }
}

impl Bonds for Marks<'_> {
    fn len(&self) -> usize {
        self.settled.len()
    }

    fn is_settled(&self, i: usize) -> bool {
        self.settled[i]
    }

    fn is_alone(&self, i: usize) -> bool {
        let range = self.blocks[i / ROWS_PER_TASK].squares_of(i);
        range.is_empty()
    }

    fn of(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let block = &self.blocks[i / ROWS_PER_TASK];
        let squares = &block.squares[block.squares_of(i)];
        self.neighbors(i).zip(squares).map(|(j, &square)| (j, f64::from(square).sqrt()))
    }

    #[inline]
    fn neighbors(&self, i: usize) -> impl Iterator<Item = usize> {
        let block = &self.blocks[i / ROWS_PER_TASK];
        let first = self.a.off_diagonal().offsets()[i] - block.first_entry;
        let columns = self.a.row(i).0.iter().enumerate();
        columns.filter(move |(k, _)| block.is_marked(first + k)).map(|(_, &j)| j as usize)
    }

    #[inline]
    fn entries(&self, _: &DifferenceMatrix, i: usize, mut f: impl FnMut(u32, f64)) {
        let block = &self.blocks[i / ROWS_PER_TASK];
        let first = self.a.off_diagonal().offsets()[i] - block.first_entry;
        let (columns, values) = self.a.row(i);
        for (k, (&j, &a_ij)) in columns.iter().zip(values).enumerate() {
            if block.is_marked(first + k) {
                f(j, a_ij);
            }
        }
    }

    fn without(mut self, nodes: &[bool]) -> Self {
        self.retain(|_, i, j, _| !nodes[i] && !nodes[j]);
        self.settled.iter_mut().zip(nodes).for_each(|(settled, node)| *settled |= node);
        self
    }
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

/// The marks on the entries of consecutive rows.
#[derive(Debug)]
struct Block {
    first: usize,
    first_entry: usize,
    marks: Vec<u64>,
    /// Where the squares of every row end.
    ends: Vec<u32>,
    /// Squares of strengths, of the marked entries.
    squares: Vec<f32>,
    /// The largest square of every row, until they are known of all blocks; and which rows are settled.
    largest: Vec<f32>,
    settled: Vec<bool>,
}

impl Block {
    fn new(a: &DifferenceMatrix, first: usize, end: usize) -> Self {
        let offsets = a.off_diagonal().offsets();
        let (first_entry, entries) = (offsets[first], offsets[end] - offsets[first]);
        Self {
            first,
            first_entry,
            marks: vec![0; entries.div_ceil(WORD)],
            ends: Vec::with_capacity(end - first),
            squares: Vec::with_capacity(entries),
            largest: Vec::with_capacity(end - first),
            settled: Vec::with_capacity(end - first),
        }
    }

    #[inline]
    fn is_marked(&self, entry: usize) -> bool {
        self.marks[entry / WORD] >> (entry % WORD) & 1 == 1
    }

    fn squares_of(&self, i: usize) -> std::ops::Range<usize> {
        let k = i - self.first;
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        start as usize..self.ends[k] as usize
    }

    /// Marks what is strong as seen from row `i`, the next one.
    fn push(
        &mut self,
        a: &DifferenceMatrix,
        units: Option<&[f64]>,
        inverse: &[f64],
        threshold: f64,
        mirror: &mut Mirror,
        i: usize,
        row: &mut Vec<(usize, f32)>,
    ) {
        let (columns, values) = a.row(i);
        let first = a.off_diagonal().offsets()[i] - self.first_entry;
        let (mut others, mut largest) = (0.0, 0.0_f32);
        row.clear();
        for (k, (&j, &a_ij)) in columns.iter().zip(values).enumerate() {
            others += units.map_or(a_ij.abs(), |c| c[j as usize] * a_ij.abs());
            let there = a_ij * inverse[i];
            if there < 0.0 {
                let back = mirror.entry(a, j as usize, i as u32) * inverse[j as usize];
                if back < 0.0 {
                    let square = ((there * back) as f32).max(f32::MIN_POSITIVE);
                    largest = largest.max(square);
                    row.push((first + k, square));
                }
            }
        }
        self.settled.push(is_settled(inverse[i], units.map_or(1.0, |c| c[i]), others));
        self.largest.push(largest);
        let bound = (threshold * threshold) as f32 * largest;
        for &(entry, square) in row.iter().filter(|e| e.1 >= bound) {
            self.marks[entry / WORD] |= 1 << (entry % WORD);
            self.squares.push(square);
        }
        self.ends.push(self.squares.len() as u32);
    }

    fn retain(&mut self, a: &DifferenceMatrix, keep: impl Fn(usize, usize, f32) -> bool) {
        let (mut next, mut kept) = (0, 0);
        for k in 0..self.ends.len() {
            let i = self.first + k;
            let first = a.off_diagonal().offsets()[i] - self.first_entry;
            for (entry, &j) in (first..).zip(a.row(i).0) {
                if !self.is_marked(entry) {
                    continue;
                }
                let square = self.squares[next];
                next += 1;
                if keep(i, j as usize, square) {
                    self.squares[kept] = square;
                    kept += 1;
                } else {
                    self.marks[entry / WORD] &= !(1 << (entry % WORD));
                }
            }
            self.ends[k] = kept as u32;
        }
        self.squares.truncate(kept);
    }
}
