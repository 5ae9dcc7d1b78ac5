//! Arrays that are even in every direction: the same is done with all lines of a direction, one direction after the other.
//!
//! The first direction is transformed while its lines are made, the others of a plane while it is in the cache, so that the array is
//! written once between. Where it does not matter which direction is which, of a symmetric array half is made and a sixth kept twice.

use rayon::prelude::*;

use super::cosine::{Direction, Scratch, copy};

/// Lines of the first direction that one task makes.
const BLOCK: usize = 32;

/// Where lines of the first direction come from.
pub(super) trait Columns: Sync {
    /// Numbers of the columns from `first` on, a row of `width` for each place; zero where there is no column.
    fn fill(&self, first: usize, width: usize, out: &mut [f64]);

    /// Memory that is no longer needed once the columns are made, for the result.
    fn room(self) -> Vec<f64>
    where
        Self: Sized,
    {
        Vec::new()
    }
}

/// What is done with each direction.
pub(super) struct Separable {
    directions: [Direction; 3],
    /// Whether the directions may be exchanged. Then there are columns only for `y <= z`, and lines only for `x <= y`.
    symmetric: bool,
    /// What results are multiplied by.
    scale: f64,
}

/// The place of the first number of a row, or of a row of a plane, of those that are kept: `i <= j < n`.
pub(super) fn triangle(i: usize, j: usize, n: usize) -> usize {
    i * (2 * n + 1 - i) / 2 + j - i
}

impl Separable {
    pub(super) fn new(directions: [Direction; 3], symmetric: bool, scale: f64) -> Self {
        Self { directions, symmetric, scale }
    }

    /// Lines of the last direction, those of the second one behind each other; of a symmetric array those of [`triangle`]. Where there is no
    /// second direction, the numbers of [`Self::together`] lines lie together.
    pub(super) fn of(&self, columns: impl Columns) -> Vec<f64> {
        let [_, y, z] = &self.directions;
        let all = if self.symmetric { triangle(y.from, y.from, y.from) } else { y.from * z.from };
        let blocks = self.first(&columns, all);
        let mut out = columns.room();
        if out.len() < self.count() {
            out = vec![0.0; self.count()];
        }
        out.truncate(self.count());
        if self.is_flat() {
            self.lines(&blocks, &mut out);
        } else {
            self.planes(&blocks, all, &mut out);
        }
        out
    }

    /// Numbers of the result.
    pub(super) fn count(&self) -> usize {
        let [x, y, z] = &self.directions;
        let lines = match (self.is_flat(), self.symmetric) {
            (true, _) => x.to.next_multiple_of(self.together()),
            (false, true) => triangle(x.to, x.to, x.to),
            (false, false) => x.to * y.to,
        };
        lines * z.to
    }

    /// Whether there are columns only for `y <= z`.
    pub(super) fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Columns that are made together.
    pub(super) fn width(&self) -> usize {
        self.directions[0].width()
    }

    /// Lines whose numbers lie together.
    pub(super) fn together(&self) -> usize {
        if self.is_flat() { self.directions[2].width() / 2 } else { 1 }
    }

    fn is_flat(&self) -> bool {
        self.directions[1].from == 1
    }

    /// The last direction where there is no second one.
    fn lines(&self, blocks: &[Vec<f64>], out: &mut [f64]) {
        let z = &self.directions[2];
        let lanes = self.together();
        out.par_chunks_mut(z.width() * z.to).enumerate().for_each_init(
            || z.scratch(),
            |scratch, (index, out)| {
                let first = index * z.width();
                for (block, at) in blocks.iter().zip((0..).step_by(BLOCK)) {
                    let rows = block.chunks_exact(BLOCK).skip(first).take(z.width());
                    z.take(rows.map(|row| &row[..BLOCK.min(z.from - at)]), at, scratch);
                }
                for (place, from) in z.run(scratch).enumerate() {
                    let parts = out.chunks_exact_mut(lanes * z.to).zip(from.chunks_exact(lanes));
                    parts.for_each(|(to, from)| copy(from, &mut to[place * lanes..][..lanes]));
                }
            },
        );
    }

    /// The last two directions.
    fn planes(&self, blocks: &[Vec<f64>], all: usize, out: &mut [f64]) {
        let [x, y, z] = &self.directions;
        let (mut parts, mut rest) = (Vec::with_capacity(x.to), out);
        for plane in 0..x.to {
            let (part, others) = std::mem::take(&mut rest).split_at_mut((y.to - self.skipped(plane)) * z.to);
            parts.push(part);
            rest = others;
        }
        parts.into_par_iter().enumerate().for_each_init(
            || Planes {
                of: self,
                columns: vec![0.0; all],
                plane: vec![0.0; y.to * z.from],
                for_y: y.scratch(),
                for_z: z.scratch(),
            },
            |scratch, (plane, part)| {
                let from = blocks.iter().map(|block| &block[plane * BLOCK..]);
                let to = scratch.columns.chunks_mut(BLOCK);
                to.zip(from).for_each(|(to, from)| to.copy_from_slice(&from[..to.len()]));
                scratch.second(self.skipped(plane));
                scratch.third(self.skipped(plane), part);
            },
        );
    }

    /// The indices of all numbers in their order.
    #[cfg(test)]
    pub(super) fn indices(&self) -> impl Iterator<Item = [usize; 3]> {
        let ([x, y, z], together) = (&self.directions, self.together());
        let of =
            move |i: usize, j: usize| (0..z.to).flat_map(move |k| (0..together).map(move |l| [i + l, j, k]));
        let planes = (0..x.to).step_by(together);
        planes.flat_map(move |i| (self.skipped(i)..y.to).flat_map(move |j| of(i, j)))
    }

    /// Lines of a plane that are those of other planes.
    fn skipped(&self, plane: usize) -> usize {
        if self.symmetric { plane } else { 0 }
    }

    /// The first direction: for each block of columns, their numbers for each place.
    fn first(&self, columns: &dyn Columns, all: usize) -> Vec<Vec<f64>> {
        let x = &self.directions[0];
        let block = |scratch: &mut Scratch, start: usize| {
            let (width, mut out) = (x.width(), vec![0.0; x.to * BLOCK]);
            for first in (start..all.min(start + BLOCK)).step_by(width) {
                columns.fill(first, width, &mut scratch.packs[..x.from * width]);
                for (row, from) in out.chunks_exact_mut(BLOCK).zip(x.run(scratch)) {
                    let to = row[first - start..][..width].iter_mut().zip(from);
                    to.for_each(|(to, from)| *to = from * self.scale);
                }
            }
            out
        };
        let blocks = (0..all.div_ceil(BLOCK)).into_par_iter();
        blocks.map_init(|| x.scratch(), |scratch, index| block(scratch, index * BLOCK)).collect()
    }
}

/// Scratch of one thread.
struct Planes<'a> {
    of: &'a Separable,
    /// A plane before.
    columns: Vec<f64>,
    /// A plane whose second direction is done.
    plane: Vec<f64>,
    for_y: Scratch,
    for_z: Scratch,
}

impl Planes<'_> {
    /// The third direction of rows from one on.
    fn third(&mut self, first: usize, out: &mut [f64]) {
        let z = &self.of.directions[2];
        let rows = self.plane[first * z.from..].chunks(z.from * z.width());
        for (rows, out) in rows.zip(out.chunks_mut(z.to * z.width())) {
            z.take(rows.chunks_exact(z.from), 0, &mut self.for_z);
            z.give(out.chunks_exact_mut(z.to), &mut self.for_z);
        }
    }

    /// The second direction, of which `skipped` places are not wanted.
    fn second(&mut self, skipped: usize) {
        let [_, y, z] = &self.of.directions;
        let width = y.width();
        for first in (0..z.from).step_by(width) {
            let count = width.min(z.from - first);
            if self.of.symmetric {
                y.half(&self.columns, first, &mut self.for_y);
            } else {
                let packs = self.for_y.packs.chunks_exact_mut(width);
                for (row, to) in self.columns.chunks_exact(z.from).zip(packs) {
                    copy(&row[first..first + count], &mut to[..count]);
                    if count < width {
                        to[count..].fill(0.0);
                    }
                }
            }
            let rows = self.plane.chunks_exact_mut(z.from).skip(skipped);
            for (row, from) in rows.zip(y.run(&mut self.for_y).skip(skipped)) {
                copy(&from[..count], &mut row[first..first + count]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::columns::{Given, Known};
    use super::{Direction, Separable};

    /// `x_0 + (-1)^k x_n + 2 sum x_j cos(pi j k / n)`, or the line itself if it has one number.
    fn cosines(line: &[f64]) -> Vec<f64> {
        let n = line.len() - 1;
        let weight = |j: usize| if n == 0 || (0 < j && j < n) { 2.0 } else { 1.0 };
        let term = |k: usize, j: usize| weight(j) * line[j] * (PI * (j * k) as f64 / n as f64).cos();
        if n == 0 { line.to_vec() } else { (0..=n).map(|k| (0..=n).map(|j| term(k, j)).sum()).collect() }
    }

    /// One direction by its definition.
    fn direct(values: &[f64], shape: [usize; 3], axis: usize, half: usize, times: usize) -> Vec<f64> {
        let mut to = shape;
        to[axis] = half;
        let below: usize = shape[axis + 1..].iter().product();
        let mut out = vec![0.0; to.iter().product()];
        for start in (0..values.len()).filter(|p| (p / below).is_multiple_of(shape[axis])) {
            let mut line: Vec<f64> =
                values[start..].iter().step_by(below).take(shape[axis]).copied().collect();
            for time in 0..times {
                line = cosines(&line[..if time > 0 { half } else { line.len() }]);
            }
            let first = start / (below * shape[axis]) * below * half + start % below;
            line[..half].iter().enumerate().for_each(|(k, value)| out[first + k * below] = *value);
        }
        out
    }

    #[test]
    fn every_direction_is_transformed_and_cropped() {
        let cases = [
            ([5, 4, 7], [5, 4, 7], [1, 1, 1], false),
            ([13, 11, 36], [7, 5, 20], [2, 2, 2], false),
            ([6, 4, 9], [6, 4, 5], [0, 1, 2], false),
            ([6, 1, 37], [4, 1, 20], [2, 2, 2], false),
            ([9, 1, 1], [5, 1, 1], [2, 0, 0], false),
            ([1, 1, 9], [1, 1, 9], [1, 1, 1], false),
            ([13, 13, 13], [7, 7, 7], [2, 2, 2], true),
            ([31, 31, 31], [31, 31, 31], [1, 1, 1], true),
        ];
        for (wide, half, times, symmetric) in cases {
            let [x, y, z] = wide;
            let table: Vec<f64> =
                (0..3 * x * x).map(|i| ((i * 7919 + 13) % 1013) as f64 / 506.5 - 1.0).collect();
            let square = |p: usize| (p / (y * z)).pow(2) + (p / z % y).pow(2) + (p % z).pow(2);
            let before: Vec<f64> = (0..x * y * z)
                .map(|p| if symmetric { table[square(p)] } else { (p * p % 23) as f64 - 7.0 })
                .collect();
            let (mut expected, mut shape) = (before.clone(), wide);
            for axis in 0..3 {
                expected = direct(&expected, shape, axis, half[axis], times[axis]);
                shape[axis] = half[axis];
            }
            let directions = std::array::from_fn(|a| Direction::new(wide[a], half[a], times[a]));
            let done = Separable::new(directions, symmetric, 0.5);
            let across: Vec<usize> = (0..y).flat_map(|j| (j..z).map(move |k| j * j + k * k)).collect();
            let values = if symmetric {
                done.of(Known { table: &table, across: &across })
            } else {
                done.of(Given { values: &before, across: y * z })
            };
            let scale = expected.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
            let mut count = 0;
            for ([i, j, k], value) in done.indices().zip(values).filter(|([i, ..], _)| *i < half[0]) {
                let exact = 0.5 * expected[(i * half[1] + j) * half[2] + k];
                assert!((value - exact).abs() < 1e-14 * scale, "{wide:?} {i} {j} {k}: {value} {exact}");
                count += 1;
            }
            let lines = if symmetric { half[0] * (half[0] + 1) / 2 } else { half[0] * half[1] };
            assert_eq!(count, lines * half[2], "{wide:?}");
        }
    }
}
