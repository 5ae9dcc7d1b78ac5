//! A hierarchy of grids over a cloud: cells that are too full hold a grid of their own.
//!
//! One grid is enough for points of one density. Where the density varies, no width of cells suits all points: wide
//! cells are overfull in dense parts, narrow ones are mostly empty elsewhere. Here an overfull cell is divided again, by
//! a grid over the box of its points, so that the work of a search stays in proportion to what it finds.

use std::ops::Range;

/// Points for each cell of a grid, on average; fewer make searches visit more cells, more make them test more points.
const POINTS_PER_CELL: usize = 2;

/// A cell with more points than this holds a grid.
const CROWDED: usize = 24;

/// The cell holds points and no grid.
const NO_GRID: u32 = u32::MAX;

/// One grid of cells of the same width in all directions.
#[derive(Debug, Clone)]
struct Grid<const D: usize> {
    min: [f64; D],
    max: [f64; D],
    inverse: f64,
    cells: [usize; D],
    /// Place of its first cell among the starts of all grids.
    first: usize,
    /// Whether any of its cells holds a grid.
    divided: bool,
}

/// Points sorted by the cells of nested grids.
#[derive(Debug, Clone)]
pub(crate) struct GridTree<const D: usize> {
    grids: Vec<Grid<D>>,
    /// First sorted point of every cell, grid by grid; each grid has one more for the end of its last cell.
    starts: Vec<u32>,
    /// The grid that a cell holds, in step with `starts`.
    inner: Vec<u32>,
    /// Indices of the points, cell by cell.
    order: Vec<u32>,
    /// The points in that order, side by side in memory.
    sorted: Vec<[f64; D]>,
}

impl<const D: usize> Grid<D> {
    /// A grid over the box of finite points, of cells at least `width` wide.
    fn over(points: &[[f64; D]], width: f64) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for point in points {
            for k in 0..D {
                min[k] = min[k].min(point[k]);
                max[k] = max[k].max(point[k]);
            }
        }
        let extent: [f64; D] = std::array::from_fn(|k| (max[k] - min[k]).max(0.0));
        let limit = (points.len() / POINTS_PER_CELL).max(2);
        let width = width.max(width_for(&extent, limit));
        // Points in one place, or nearly, leave no width that could be divided by: then there is one cell.
        let inverse = if width > f64::MIN_POSITIVE { 1.0 / width } else { 0.0 };
        let cells = std::array::from_fn(|k| ((extent[k] * inverse) as usize).min(limit) + 1);
        Self { min, max, inverse, cells, first: 0, divided: false }
    }

    /// Place of a coordinate along an axis; never decreases with the coordinate, so that no rounding separates a point
    /// from a box that contains it.
    fn place(&self, axis: usize, x: f64) -> usize {
        // A cast of a negative number or of NaN gives 0.
        (((x - self.min[axis]) * self.inverse) as usize).min(self.cells[axis] - 1)
    }

    fn cell_of(&self, x: &[f64; D]) -> usize {
        (0..D).rev().fold(0, |index, k| index * self.cells[k] + self.place(k, x[k]))
    }

    fn count(&self) -> usize {
        self.cells.iter().product()
    }
}

/// Width of cells of which about `limit` fill a box; flat boxes count the directions they have.
fn width_for<const D: usize>(extent: &[f64; D], limit: usize) -> f64 {
    let mut width = extent.iter().copied().fold(0.0, f64::max) / limit as f64;
    if width == 0.0 {
        return 0.0;
    }
    let count = |width: f64| extent.iter().map(|e| (e / width).floor() + 1.0).product::<f64>();
    // In steps from the width that suits a line; the number of steps grows with the logarithm of the limit only.
    while count(width) > limit as f64 {
        width *= 1.1;
    }
    width
}

impl<const D: usize> GridTree<D> {
    /// Sorts finite points; cells are at least `width` wide where they are not crowded.
    pub(crate) fn new(points: &[[f64; D]], width: f64) -> Self {
        let mut tree = Self {
            grids: Vec::new(),
            starts: Vec::new(),
            inner: Vec::new(),
            order: (0..points.len() as u32).collect(),
            sorted: points.to_vec(),
        };
        tree.divide(0, points.len(), width);
        tree
    }

    /// Indices of the points in the order of the cells.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The points in that order.
    pub(crate) fn sorted(&self) -> &[[f64; D]] {
        &self.sorted
    }

    /// Sorts a range of the points into a grid, then divides the crowded cells of it; returns the grid.
    fn divide(&mut self, from: usize, to: usize, width: f64) -> u32 {
        let mut grid = Grid::over(&self.sorted[from..to], width);
        grid.first = self.starts.len();
        let count = grid.count();
        let place = self.grids.len();
        self.sort(&grid, from, to);
        self.grids.push(grid);
        if count > 1 {
            for cell in self.grids[place].first..self.grids[place].first + count {
                let (from, to) = (self.starts[cell] as usize, self.starts[cell + 1] as usize);
                if to - from > CROWDED {
                    self.inner[cell] = self.divide(from, to, 0.0);
                    self.grids[place].divided = true;
                }
            }
        }
        place as u32
    }

    /// Counting sort by cell; within a cell the points keep their order.
    fn sort(&mut self, grid: &Grid<D>, from: usize, to: usize) {
        let cells: Vec<u32> = self.sorted[from..to].iter().map(|x| grid.cell_of(x) as u32).collect();
        let count = grid.count();
        self.starts.resize(grid.first + count + 1, 0);
        self.inner.resize(grid.first + count + 1, NO_GRID);
        let starts = &mut self.starts[grid.first..];
        cells.iter().for_each(|&cell| starts[cell as usize + 1] += 1);
        starts[0] = from as u32;
        for cell in 0..count {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.to_vec();
        let (order, sorted) = (self.order[from..to].to_vec(), self.sorted[from..to].to_vec());
        for ((cell, index), point) in cells.into_iter().zip(order).zip(sorted) {
            let next = &mut next[cell as usize];
            self.order[*next as usize] = index;
            self.sorted[*next as usize] = point;
            *next += 1;
        }
    }

    /// Width of the narrowest cells around x: about the distance of its nearest points.
    pub(crate) fn width_at(&self, x: &[f64; D]) -> f64 {
        let mut grid = &self.grids[0];
        loop {
            match self.inner[grid.first + grid.cell_of(x)] {
                NO_GRID => break,
                inner => grid = &self.grids[inner as usize],
            }
        }
        if grid.inverse > 0.0 { 1.0 / grid.inverse } else { f64::MIN_POSITIVE }
    }

    /// Distance of x from the box of all points, or a little less; 0 inside.
    pub(crate) fn distance_to(&self, x: &[f64; D]) -> f64 {
        let (min, max) = (&self.grids[0].min, &self.grids[0].max);
        (0..D).map(|k| (min[k] - x[k]).max(x[k] - max[k]).max(0.0)).fold(0.0, f64::max)
    }

    /// Calls `run` for ranges of [`Self::sorted`] that together hold all points within `reach` of `center`.
    pub(crate) fn runs(&self, center: &[f64; D], reach: f64, run: &mut impl FnMut(Range<usize>)) {
        // Squares and differences of the test itself are rounded; the box must not be narrower than what passes it.
        let reach = reach * (1.0 + 8.0 * f64::EPSILON);
        let low = center.map(|x| x - reach);
        let high = center.map(|x| x + reach);
        self.runs_of(&self.grids[0], &low, &high, run);
    }

    fn runs_of(&self, grid: &Grid<D>, low: &[f64; D], high: &[f64; D], run: &mut impl FnMut(Range<usize>)) {
        if (0..D).any(|k| high[k] < grid.min[k] || low[k] > grid.max[k]) {
            return;
        }
        let first: [usize; D] = std::array::from_fn(|k| grid.place(k, low[k]));
        let last: [usize; D] = std::array::from_fn(|k| grid.place(k, high[k]));
        let mut cell = first;
        loop {
            let row = grid.first + (1..D).rev().fold(0, |index, k| (index + cell[k]) * grid.cells[k - 1]);
            if grid.divided {
                self.runs_of_row(row + first[0], row + last[0], low, high, run);
            } else {
                // Cells along the first axis follow each other in memory.
                let (from, to) =
                    (self.starts[row + first[0]] as usize, self.starts[row + last[0] + 1] as usize);
                run(from..to);
            }
            let Some(axis) = (1..D).find(|&k| cell[k] < last[k]) else { return };
            cell[1..axis].copy_from_slice(&first[1..axis]);
            cell[axis] += 1;
        }
    }

    /// The cells of a row of a divided grid, one by one.
    fn runs_of_row(
        &self,
        first: usize,
        last: usize,
        low: &[f64; D],
        high: &[f64; D],
        run: &mut impl FnMut(Range<usize>),
    ) {
        for cell in first..=last {
            let (from, to) = (self.starts[cell] as usize, self.starts[cell + 1] as usize);
            match self.inner[cell] {
                NO_GRID if from == to => {}
                NO_GRID => run(from..to),
                inner => self.runs_of(&self.grids[inner as usize], low, high, run),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two lattices, one ten thousand times finer than the other and in a corner of it.
    fn two_scales() -> Vec<([f64; 2], f64)> {
        let lattice = |scale: f64, shift: f64| {
            let at = move |i: u32| scale * (f64::from(i) + shift);
            (0..4096_u32).map(move |i| ([at(i % 64), at(i / 64)], scale))
        };
        lattice(1.0, 0.0).chain(lattice(1e-4, 0.5)).collect()
    }

    #[test]
    fn work_is_in_proportion_to_what_is_found_at_any_scale() {
        let cloud = two_scales();
        let points: Vec<[f64; 2]> = cloud.iter().map(|(x, _)| *x).collect();
        let tree = GridTree::new(&points, 0.0);
        let (mut tested, mut runs) = (0, 0);
        // Coarse points beside the corner do find all of the fine lattice, and are not counted.
        let away = |(x, spacing): &&([f64; 2], f64)| *spacing < 1.0 || x[0].max(x[1]) >= 4.0;
        for (x, spacing) in cloud.iter().filter(away) {
            tree.runs(x, 2.9 * spacing, &mut |run| {
                runs += 1;
                tested += run.len();
            });
        }
        // 25 points are within 2.9 spacings; boxes of cells hold about 7.2 by 7.2.
        assert!(tested < 60 * cloud.len(), "{tested} points tested");
        assert!(runs < 60 * cloud.len(), "{runs} cells visited");
    }

    #[test]
    fn every_point_is_in_its_place_once() {
        let points: Vec<[f64; 2]> = two_scales().into_iter().map(|(x, _)| x).collect();
        let tree = GridTree::new(&points, 0.0);
        let mut order = tree.order().to_vec();
        order.sort_unstable();
        assert!(order.iter().enumerate().all(|(i, &j)| i == j as usize));
        assert!(tree.order().iter().zip(tree.sorted()).all(|(&i, x)| points[i as usize] == *x));
        assert!(tree.grids.len() > 1, "the fine lattice has a grid of its own");
    }
}
