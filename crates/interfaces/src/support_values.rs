//! Numbers that belong to the entries of a neighbour list, computed in parallel into one array.

use std::ops::Range;

use meshless_neighbors::NeighborLists;

use crate::parallel;

/// Nodes that one task computes; fixed, so that nothing depends on the number of threads.
const NODES_PER_TASK: usize = 128;

/// One number for every entry of a neighbour list.
#[derive(Debug, Clone)]
pub(crate) struct SupportValues {
    offsets: Vec<usize>,
    values: Vec<f64>,
}

impl SupportValues {
    /// Calls `fill(scratch, i, out)` for every node, where `out` has one place for each neighbour of i.
    pub(crate) fn compute<S: Send, E: Send>(
        lists: &NeighborLists,
        scratch: impl Fn() -> S + Sync,
        fill: impl Fn(&mut S, usize, &mut [f64]) -> Result<(), E> + Sync,
    ) -> Result<Self, E> {
        let mut offsets = Vec::with_capacity(lists.len() + 1);
        offsets.push(0);
        for i in 0..lists.len() {
            offsets.push(offsets[i] + lists.of(i).len());
        }
        let mut values = vec![0.0; offsets[lists.len()]];
        let mut tasks = Vec::with_capacity(lists.len() / NODES_PER_TASK + 1);
        let mut rest = values.as_mut_slice();
        for first in (0..lists.len()).step_by(NODES_PER_TASK) {
            let last = (first + NODES_PER_TASK).min(lists.len());
            let (head, tail) = rest.split_at_mut(offsets[last] - offsets[first]);
            tasks.push((first..last, head));
            rest = tail;
        }
        parallel::for_each_with(
            tasks,
            &scratch,
            &|scratch, (nodes, mut block): (Range<usize>, &mut [f64])| {
                for i in nodes {
                    let (row, tail) = block.split_at_mut(lists.of(i).len());
                    fill(scratch, i, row)?;
                    block = tail;
                }
                Ok(())
            },
        )?;
        Ok(Self { offsets, values })
    }

    /// The numbers of node i, in the order of its neighbours.
    pub(crate) fn of(&self, i: usize) -> &[f64] {
        &self.values[self.offsets[i]..self.offsets[i + 1]]
    }
}
