//! The search for all neighbours of all points of a cloud.

use rayon::prelude::*;

use crate::cell_list::CELL_WIDTH;
use crate::check::{duplicate, squared_distance};
use crate::grid::GridTree;
use crate::radius::{COINCIDENCE, Radius};
use crate::{NeighborError, NeighborLists};

/// Points that one task searches around; fixed, so that nothing depends on the number of threads.
const POINTS_PER_TASK: usize = 1024;

/// Room for neighbours of a point that a task starts with.
const EXPECTED_NEIGHBORS: usize = 32;

/// Which points are found around a point.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Reach<'a> {
    /// All in its ball.
    Ball(Radius<'a>),
    /// All within the mean of both radii, of which the point with the smaller radius learns from the other one:
    /// to find them all itself it would have to search as far as the largest radius there is.
    Mean(&'a [f64]),
}

/// A cloud in cells; the rank of a point is its place in their order.
pub(crate) struct Search<'a, const D: usize> {
    points: &'a [[f64; D]],
    reach: Reach<'a>,
    tree: GridTree<D>,
    /// Radii in the order of the cells; empty where only that of the centre counts.
    radii: Vec<f64>,
}

/// What a task has found.
struct Found {
    /// Where the neighbours of each of its points end.
    ends: Vec<u32>,
    /// Indices; for [`Reach::Mean`] ranks, which are close together in memory where points are close in space.
    neighbors: Vec<u32>,
}

impl<'a, const D: usize> Search<'a, D> {
    pub(crate) fn new(points: &'a [[f64; D]], reach: Reach<'a>) -> Self {
        let width = if let Reach::Ball(Radius::Uniform(radius)) = reach { CELL_WIDTH * radius } else { 0.0 };
        let tree = GridTree::new(points, width);
        let radii = match reach {
            Reach::Mean(radii) => tree.order().iter().map(|&i| radii[i as usize]).collect(),
            Reach::Ball(_) => Vec::new(),
        };
        Self { points, reach, tree, radii }
    }

    /// Neighbours of all points.
    pub(crate) fn run(&self) -> Result<NeighborLists, NeighborError> {
        // Searching in the order of the cells keeps the memory that is read close together.
        let tasks: Vec<usize> = (0..self.points.len()).step_by(POINTS_PER_TASK).collect();
        let outcomes: Vec<_> = tasks.into_par_iter().map(|first| self.task(first)).collect();
        // Which points an error names must not depend on which thread was faster.
        let found: Vec<Found> = outcomes.into_iter().collect::<Result<_, _>>()?;
        Ok(match self.reach {
            Reach::Ball(_) => self.gather(&found, &Transposed::default()),
            Reach::Mean(_) => self.gather(&found, &Transposed::new(&found, &self.radii)),
        })
    }

    fn task(&self, first: usize) -> Result<Found, NeighborError> {
        let last = (first + POINTS_PER_TASK).min(self.points.len());
        let mut ends = Vec::with_capacity(last - first);
        let mut neighbors = vec![0; EXPECTED_NEIGHBORS * (last - first)];
        let mut end = 0;
        for at in first..last {
            end = match self.reach {
                Reach::Ball(radius) => {
                    let radius = radius.of(self.tree.order()[at] as usize);
                    let squared_radius = radius * radius;
                    let near = |_, squared| squared <= squared_radius;
                    self.around(at, radius, near, |_, index| index, end, &mut neighbors)?
                }
                Reach::Mean(_) => {
                    let own = self.radii[at];
                    let near = |other: usize, squared: f64| {
                        let radius = self.radii[other];
                        let mean = 0.5 * (own + radius);
                        (squared <= mean * mean) & (radius <= own)
                    };
                    self.around(at, own, near, |rank, _| rank as u32, end, &mut neighbors)?
                }
            };
            ends.push(end as u32);
        }
        neighbors.truncate(end);
        Ok(Found { ends, neighbors })
    }

    /// Writes the names of the points in reach of the point of rank `at` to `neighbors` from `end` on; returns where
    /// they end. A point is named by its rank and its index.
    fn around(
        &self,
        at: usize,
        radius: f64,
        near: impl Fn(usize, f64) -> bool,
        name: impl Fn(usize, u32) -> u32,
        mut end: usize,
        neighbors: &mut Vec<u32>,
    ) -> Result<usize, NeighborError> {
        let (order, sorted) = (self.tree.order(), self.tree.sorted());
        let (own, center) = (order[at], &sorted[at]);
        let too_close = (COINCIDENCE * radius).powi(2);
        let mut coinciding = 0;
        self.tree.runs(center, radius, &mut |run| {
            if neighbors.len() < end + run.len() {
                neighbors.resize(2 * (end + run.len()), 0);
            }
            // Every name is written and the end moves for those that count: there is no branch to be guessed wrong.
            for (other, (&index, point)) in run.clone().zip(order[run.clone()].iter().zip(&sorted[run])) {
                let squared = squared_distance(point, center);
                neighbors[end] = name(other, index);
                end += usize::from(near(other, squared) & (index != own));
                coinciding += usize::from(squared <= too_close);
            }
        });
        // One is the point itself.
        if coinciding > 1 {
            let twin = self.twin(at, too_close);
            return Err(duplicate(self.points, own, twin));
        }
        Ok(end)
    }

    /// The point of lowest index that coincides with the one at `at`.
    fn twin(&self, at: usize, too_close: f64) -> u32 {
        let center = &self.points[self.tree.order()[at] as usize];
        let coincides = |&&j: &&u32| {
            j != self.tree.order()[at] && squared_distance(&self.points[j as usize], center) <= too_close
        };
        self.tree.order().iter().filter(coincides).min().copied().unwrap_or(self.tree.order()[at])
    }

    /// Puts what was found in the order of the points, each list by ascending index.
    fn gather(&self, found: &[Found], learned: &Transposed) -> NeighborLists {
        let (n, order) = (self.points.len(), self.tree.order());
        let mut ranks = vec![0; n];
        for (rank, &i) in order.iter().enumerate() {
            ranks[i as usize] = rank as u32;
        }
        let mut offsets = Vec::with_capacity(n + 1);
        offsets.push(0);
        let mut total = 0;
        for &rank in &ranks {
            total += found_at(found, rank as usize).len() + learned.at(rank as usize).len();
            offsets.push(total);
        }
        let mut indices = vec![0_u32; total];
        let mut rest = &mut indices[..];
        let mut parts = Vec::with_capacity(n / POINTS_PER_TASK + 1);
        for first in (0..n).step_by(POINTS_PER_TASK) {
            let last = (first + POINTS_PER_TASK).min(n);
            let (part, others) = rest.split_at_mut(offsets[last] - offsets[first]);
            rest = others;
            parts.push((first..last, part));
        }
        parts.into_par_iter().for_each(|(range, mut part)| {
            for i in range {
                let rank = ranks[i] as usize;
                let (own, others) = (found_at(found, rank), learned.at(rank));
                let (list, rest) = part.split_at_mut(own.len() + others.len());
                list[..own.len()].copy_from_slice(own);
                list[own.len()..].copy_from_slice(others);
                if matches!(self.reach, Reach::Mean(_)) {
                    list.iter_mut().for_each(|name| *name = order[*name as usize]);
                }
                list.sort_unstable();
                part = rest;
            }
        });
        NeighborLists::from_search(offsets, indices)
    }
}

/// What was found around the point of a rank.
fn found_at(found: &[Found], rank: usize) -> &[u32] {
    let (task, place) = (&found[rank / POINTS_PER_TASK], rank % POINTS_PER_TASK);
    let from = if place == 0 { 0 } else { task.ends[place - 1] as usize };
    &task.neighbors[from..task.ends[place] as usize]
}

/// The points that found a point, where that one has the smaller radius and so did not find them; all by rank.
#[derive(Default)]
struct Transposed {
    offsets: Vec<usize>,
    ranks: Vec<u32>,
}

impl Transposed {
    fn new(found: &[Found], radii: &[f64]) -> Self {
        let n = radii.len();
        let smaller = |i: usize| found_at(found, i).iter().filter(move |&&j| radii[j as usize] < radii[i]);
        let mut offsets = vec![0_usize; n + 2];
        (0..n).for_each(|i| smaller(i).for_each(|&j| offsets[j as usize + 2] += 1));
        for i in 0..n {
            offsets[i + 2] += offsets[i + 1];
        }
        // Kept one place ahead, an offset has moved to where the next list starts when its own list is full.
        let mut ranks = vec![0; offsets[n + 1]];
        for i in 0..n {
            for &j in smaller(i) {
                ranks[offsets[j as usize + 1]] = i as u32;
                offsets[j as usize + 1] += 1;
            }
        }
        Self { offsets, ranks }
    }

    fn at(&self, rank: usize) -> &[u32] {
        if self.offsets.is_empty() { &[] } else { &self.ranks[self.offsets[rank]..self.offsets[rank + 1]] }
    }
}
