//! A grid of cells over a cloud, for queries by radius.

use crate::NeighborError;

/// Cells a search radius is wide: narrow cells are scanned in longer runs, but hold fewer points that do not count.
const CELLS_PER_RADIUS: f64 = 2.0;

/// Cells for each point at the most; a cloud that is far from filling its box has wider cells.
const MAX_CELLS_PER_POINT: f64 = 4.0;

/// Points sorted into cells; answers which points lie within a radius of any position.
#[derive(Debug, Clone)]
pub struct CellList<'a, const D: usize> {
    points: &'a [[f64; D]],
    min: [f64; D],
    inverse: f64,
    cells: [usize; D],
    /// First sorted point of every cell; one more than there are cells.
    starts: Vec<u32>,
    /// Indices of the points, cell by cell.
    order: Vec<u32>,
    /// The points in that order, side by side in memory.
    sorted: Vec<[f64; D]>,
}

impl<'a, const D: usize> CellList<'a, D> {
    /// Sorts the points for queries with radii around `radius`; other radii work, more slowly.
    ///
    /// # Errors
    /// A point that is not finite, or more points than indices can count.
    pub fn new(points: &'a [[f64; D]], radius: f64) -> Result<Self, NeighborError> {
        check_points(points)?;
        let (mut min, mut max) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for point in points {
            for k in 0..D {
                min[k] = min[k].min(point[k]);
                max[k] = max[k].max(point[k]);
            }
        }
        let extent: [f64; D] = std::array::from_fn(|k| (max[k] - min[k]).max(0.0));
        let mut width = if radius > 0.0 && radius.is_finite() { radius / CELLS_PER_RADIUS } else { 1.0 };
        let count = |width: f64| extent.iter().map(|e| (e / width).floor() + 1.0).product::<f64>();
        let limit = MAX_CELLS_PER_POINT * points.len() as f64 + 16.0;
        while count(width) > limit {
            width *= 1.25;
        }
        let cells: [usize; D] = std::array::from_fn(|k| (extent[k] / width) as usize + 1);
        let mut list = Self {
            points,
            min,
            inverse: 1.0 / width,
            cells,
            starts: Vec::new(),
            order: Vec::new(),
            sorted: Vec::new(),
        };
        list.sort();
        Ok(list)
    }

    /// Counting sort of the points by cell; within a cell they keep their order.
    fn sort(&mut self) {
        let total = self.cells.iter().product::<usize>();
        let of_point: Vec<u32> = self.points.iter().map(|x| self.cell_of(x) as u32).collect();
        let mut starts = vec![0_u32; total + 1];
        of_point.iter().for_each(|&cell| starts[cell as usize + 1] += 1);
        for cell in 0..total {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.clone();
        self.order = vec![0; self.points.len()];
        for (i, &cell) in of_point.iter().enumerate() {
            self.order[next[cell as usize] as usize] = i as u32;
            next[cell as usize] += 1;
        }
        self.sorted = self.order.iter().map(|&i| self.points[i as usize]).collect();
        self.starts = starts;
    }

    fn axis_cell(&self, axis: usize, x: f64) -> usize {
        // A cast of a negative number or of NaN gives 0.
        (((x - self.min[axis]) * self.inverse) as usize).min(self.cells[axis] - 1)
    }

    fn cell_of(&self, x: &[f64; D]) -> usize {
        (0..D).rev().fold(0, |index, k| index * self.cells[k] + self.axis_cell(k, x[k]))
    }

    /// Positions in cell order.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// Calls `visit(index, squared distance)` for every point within `radius` of `center` (and at it).
    pub(crate) fn visit(&self, center: &[f64; D], radius: f64, mut visit: impl FnMut(u32, f64)) {
        let squared_radius = radius * radius;
        let low: [usize; D] = std::array::from_fn(|k| self.axis_cell(k, center[k] - radius));
        let high: [usize; D] = std::array::from_fn(|k| self.axis_cell(k, center[k] + radius));
        let mut cell = low;
        loop {
            // Cells along the first axis follow each other in memory: one run.
            let row = (1..D).rev().fold(0, |index, k| (index + cell[k]) * self.cells[k - 1]);
            let (from, to) = (self.starts[row + low[0]] as usize, self.starts[row + high[0] + 1] as usize);
            for (point, &index) in self.sorted[from..to].iter().zip(&self.order[from..to]) {
                let mut squared = 0.0;
                for k in 0..D {
                    let d = point[k] - center[k];
                    squared += d * d;
                }
                if squared <= squared_radius {
                    visit(index, squared);
                }
            }
            let mut axis = 1;
            loop {
                if axis >= D {
                    return;
                }
                if cell[axis] < high[axis] {
                    cell[axis] += 1;
                    break;
                }
                cell[axis] = low[axis];
                axis += 1;
            }
        }
    }

    /// Appends the points within `radius` of `center` to `found`, in the order of the cells.
    pub fn within(&self, center: &[f64; D], radius: f64, found: &mut Vec<u32>) {
        self.visit(center, radius, |index, _| found.push(index));
    }

    /// The point nearest to `center`, the lower index of two that are as near; `None` where there are no points.
    pub fn nearest_one(&self, center: &[f64; D]) -> Option<u32> {
        if self.points.is_empty() || center.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let mut radius = 1.0 / self.inverse;
        loop {
            let mut best: Option<(f64, u32)> = None;
            self.visit(center, radius, |index, squared| {
                if best.is_none_or(|(s, i)| squared < s || (squared == s && index < i)) {
                    best = Some((squared, index));
                }
            });
            if let Some((_, index)) = best {
                return Some(index);
            }
            radius *= 2.0;
        }
    }
}

/// Points must be finite and countable.
pub(crate) fn check_points<const D: usize>(points: &[[f64; D]]) -> Result<(), NeighborError> {
    if points.len() >= u32::MAX as usize {
        return Err(NeighborError::TooManyPoints { points: points.len() });
    }
    match points.iter().position(|x| x.iter().any(|c| !c.is_finite())) {
        Some(index) => Err(NeighborError::NotFinite { index, position: points[index].to_vec() }),
        None => Ok(()),
    }
}
