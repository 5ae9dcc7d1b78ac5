//! One differential operator at many nodes: its coefficients on the differences `u_j - u_i`.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use crate::local::enlarged_support;
use crate::support_values::SupportValues;
use crate::{MethodError, Problem};

/// Coefficients of an operator on the support of every node that was asked for; on a larger one where that failed.
pub(crate) struct OperatorRows {
    values: SupportValues,
    enlarged: BTreeMap<u32, (Vec<u32>, Vec<f64>)>,
}

impl OperatorRows {
    /// Calls `row(i, neighbors, scratch, out)` for the nodes for which `wanted` holds, with `out` zero and as long as
    /// the neighbours: first the support of i, then, if that is an error, the neighbours of its neighbours, too. The
    /// rows of all other nodes stay zero.
    ///
    /// # Errors
    /// Those of `row` on the larger support.
    pub(crate) fn compute<const D: usize, S: Send>(
        problem: &Problem<'_, D>,
        wanted: impl Fn(usize) -> bool + Sync,
        scratch: impl Fn() -> S + Sync,
        row: impl Fn(usize, &[u32], &mut S, &mut [f64]) -> Result<(), MethodError> + Sync,
    ) -> Result<Self, MethodError> {
        let enlarged = Mutex::new(BTreeMap::new());
        let values = SupportValues::compute(problem.supports.lists, scratch, |scratch, i, out| {
            if !wanted(i) || row(i, problem.supports.lists.of(i), scratch, out).is_ok() {
                return Ok(());
            }
            out.fill(0.0);
            let neighbors = enlarged_support(problem, i);
            let mut larger = vec![0.0; neighbors.len()];
            row(i, &neighbors, scratch, &mut larger)?;
            enlarged.lock().unwrap_or_else(PoisonError::into_inner).insert(i as u32, (neighbors, larger));
            Ok::<(), MethodError>(())
        })?;
        Ok(Self { values, enlarged: enlarged.into_inner().unwrap_or_else(PoisonError::into_inner) })
    }

    /// Neighbours and coefficients of node i.
    pub(crate) fn row<'a, const D: usize>(
        &'a self,
        problem: &Problem<'a, D>,
        i: usize,
    ) -> (&'a [u32], &'a [f64]) {
        match self.enlarged.get(&(i as u32)) {
            Some((neighbors, row)) => (neighbors, row),
            None => (problem.supports.lists.of(i), self.values.of(i)),
        }
    }

    /// Nodes that needed a larger support.
    pub(crate) fn enlarged(&self) -> usize {
        self.enlarged.len()
    }
}
