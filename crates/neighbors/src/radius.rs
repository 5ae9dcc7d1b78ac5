//! Neighbour lists by radius.

use rayon::prelude::*;

use crate::cell_list::{CellList, check_points};
use crate::{NeighborError, NeighborLists};

/// Points that one task searches around; fixed, so that nothing depends on the number of threads.
const POINTS_PER_TASK: usize = 1024;

/// Points nearer than this, relative to the radius, coincide: no stencil could tell them apart.
pub const COINCIDENCE: f64 = 1e-10;

/// Interaction radii.
#[derive(Debug, Clone, Copy)]
pub enum Radius<'a> {
    /// The same for all points.
    Uniform(f64),
    /// One for each point.
    PerPoint(&'a [f64]),
}

impl Radius<'_> {
    fn of(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(radius) => *radius,
            Self::PerPoint(radii) => radii[i],
        }
    }

    fn check(&self, points: usize) -> Result<(), NeighborError> {
        let valid = |radius: f64| radius > 0.0 && radius.is_finite();
        match self {
            Self::Uniform(radius) if valid(*radius) => Ok(()),
            Self::Uniform(radius) => Err(NeighborError::InvalidRadius { index: 0, radius: *radius }),
            Self::PerPoint(radii) if radii.len() != points => {
                Err(NeighborError::LengthMismatch { radii: radii.len(), points })
            }
            Self::PerPoint(radii) => match radii.iter().position(|&r| !valid(r)) {
                Some(index) => Err(NeighborError::InvalidRadius { index, radius: radii[index] }),
                None => Ok(()),
            },
        }
    }
}

/// The relative distance that decides who is a neighbour (Kraus et al. 2022, section 2.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distance {
    /// `d1 = |x_j - x_i| / h_i`: radial, not symmetric.
    D1,
    /// `d2 = 2 |x_j - x_i| / (h_i + h_j)`: symmetric, not radial.
    D2,
}

/// All points j with `d(x_j, x_i) <= 1`, for every point i, in an order that depends on the points alone.
///
/// # Errors
/// Points that are not finite, that coincide, or that have no neighbour; radii that are not positive.
pub fn within_radius<const D: usize>(
    points: &[[f64; D]],
    radius: Radius<'_>,
    distance: Distance,
) -> Result<NeighborLists, NeighborError> {
    check_points(points)?;
    radius.check(points.len())?;
    let largest = (0..points.len()).map(|i| radius.of(i)).fold(0.0, f64::max);
    let mean = (0..points.len()).map(|i| radius.of(i)).sum::<f64>() / points.len().max(1) as f64;
    let cells = CellList::new(points, mean)?;
    let search = Search { points, radius, distance, largest, cells };
    // Searching in the order of the cells keeps the memory that is read close together.
    let found: Vec<(Vec<u32>, Vec<u32>)> = search
        .cells
        .order()
        .par_chunks(POINTS_PER_TASK)
        .map(|task| search.run(task))
        .collect::<Result<_, _>>()?;
    Ok(search.gather(&found))
}

struct Search<'a, const D: usize> {
    points: &'a [[f64; D]],
    radius: Radius<'a>,
    distance: Distance,
    largest: f64,
    cells: CellList<'a, D>,
}

impl<const D: usize> Search<'_, D> {
    /// Counts and neighbours of the points of a task, one after the other.
    fn run(&self, task: &[u32]) -> Result<(Vec<u32>, Vec<u32>), NeighborError> {
        let mut counts = Vec::with_capacity(task.len());
        let mut indices = Vec::with_capacity(32 * task.len());
        for &i in task {
            let before = indices.len();
            let own = self.radius.of(i as usize);
            let nearest = self.collect(i, own, &mut indices);
            let count = indices.len() - before;
            if let Some((squared, j)) = nearest {
                if squared <= (COINCIDENCE * own).powi(2) {
                    let (first, second) = (i.min(j) as usize, i.max(j) as usize);
                    return Err(NeighborError::Duplicate {
                        first,
                        second,
                        position: self.points[first].to_vec(),
                    });
                }
            } else {
                let index = i as usize;
                return Err(NeighborError::Isolated {
                    index,
                    position: self.points[index].to_vec(),
                    radius: own,
                });
            }
            counts.push(count as u32);
        }
        Ok((counts, indices))
    }

    /// Appends the neighbours of i; returns the nearest of them.
    fn collect(&self, i: u32, own: f64, indices: &mut Vec<u32>) -> Option<(f64, u32)> {
        let center = &self.points[i as usize];
        let mut nearest: Option<(f64, u32)> = None;
        let mut take = |j: u32, squared: f64| {
            if nearest.is_none_or(|(s, _)| squared < s) {
                nearest = Some((squared, j));
            }
            indices.push(j);
        };
        match (self.distance, self.radius) {
            (Distance::D2, Radius::PerPoint(radii)) => {
                self.cells.visit(center, 0.5 * (own + self.largest), |j, squared| {
                    let reach = 0.5 * (own + radii[j as usize]);
                    if squared <= reach * reach && j != i {
                        take(j, squared);
                    }
                });
            }
            _ => self.cells.visit(center, own, |j, squared| {
                if j != i {
                    take(j, squared);
                }
            }),
        }
        nearest
    }

    /// Puts the lists of the tasks, which are in the order of the cells, in the order of the points.
    fn gather(&self, found: &[(Vec<u32>, Vec<u32>)]) -> NeighborLists {
        let n = self.points.len();
        let mut offsets = vec![0_usize; n + 1];
        let counts = found.iter().flat_map(|(counts, _)| counts);
        self.cells
            .order()
            .iter()
            .zip(counts)
            .for_each(|(&i, &count)| offsets[i as usize + 1] = count as usize);
        for i in 0..n {
            offsets[i + 1] += offsets[i];
        }
        let mut indices = vec![0_u32; offsets[n]];
        for (task, (counts, list)) in self.cells.order().chunks(POINTS_PER_TASK).zip(found) {
            let mut from = 0;
            for (&i, &count) in task.iter().zip(counts) {
                let to = from + count as usize;
                indices[offsets[i as usize]..offsets[i as usize + 1]].copy_from_slice(&list[from..to]);
                from = to;
            }
        }
        NeighborLists::from_search(offsets, indices)
    }
}
