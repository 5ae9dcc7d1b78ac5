//! The nodes of each region that are nearest to a point.

use meshless_neighbors::{CellList, NeighborError};

use crate::Problem;

/// How far a node of a region may lie on the wrong side of the tangent plane at the foot, in spacings: interfaces are
/// curved, but the other side of a thin layer is another interface.
const BEHIND: f64 = 0.5;

/// How often the number of nodes that are looked at is doubled.
const MAX_SEARCHES: usize = 4;

/// An index of the cloud.
pub(super) struct Sides<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    index: CellList<'a, D>,
}

impl<'a, const D: usize> Sides<'a, D> {
    pub(super) fn new(problem: &'a Problem<'a, D>) -> Result<Self, NeighborError> {
        let reach = problem.supports.radius.iter().fold(0.0_f64, |a, &b| a.max(b));
        Ok(Self { problem, index: CellList::new(problem.cloud.points(), reach)? })
    }

    /// The `count` nodes of `region` nearest to `x`, or as many as are near, by distance, to `out`; those more than half
    /// a spacing behind the plane through `x` are left out, and so is node `except`. `normal` points to the region.
    pub(super) fn nearest(
        &self,
        x: &[f64; D],
        normal: Option<&[f64; D]>,
        (region, except): (u16, Option<u32>),
        count: usize,
        found: &mut Vec<(f64, u32)>,
        out: &mut Vec<u32>,
    ) {
        let points = self.problem.cloud.points();
        let in_front = |j: u32| {
            let h = self.problem.cloud.spacing()[j as usize];
            normal.is_none_or(|n| {
                (0..D).map(|k| (points[j as usize][k] - x[k]) * n[k]).sum::<f64>() > -BEHIND * h
            })
        };
        let mut asked = 5 * count / 2;
        for _ in 0..MAX_SEARCHES {
            out.clear();
            let wanted =
                |&j: &u32| self.problem.labels[j as usize] == region && Some(j) != except && in_front(j);
            out.extend(self.index.nearest(x, asked, found).filter(wanted).take(count));
            if out.len() == count || asked >= points.len() {
                return;
            }
            asked *= 2;
        }
    }
}
