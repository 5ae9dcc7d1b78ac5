//! The unknowns as the levels have them: in an order of their own, with a candidate of their own.

use super::{Candidate, MultigridParams, candidate, numbering};
use crate::csr::Csr;
use crate::error::MatrixError;
use std::borrow::Cow;
use std::sync::Arc;

/// How the unknowns of the finest level follow from those of the matrix that is given.
#[derive(Debug)]
pub(crate) struct Frame {
    /// Element `k` of the levels is element `order[k]` outside; where this is none, `k`.
    order: Option<Vec<u32>>,
    /// The candidate, in the order of the levels; the constant where this is none.
    units: Option<Vec<f64>>,
}

impl Frame {
    pub(crate) fn new(matrix: &Csr, params: &MultigridParams) -> Result<Self, MatrixError> {
        let order = if params.renumber { numbering::found(matrix) } else { None };
        let units = match (params.candidate, &order) {
            (Candidate::Constant, _) => None,
            (Candidate::Relaxed, None) => Some(candidate::relaxed(matrix)?),
            (Candidate::Relaxed, Some(order)) => Some(candidate::relaxed(&matrix.permuted(order)?)?),
        };
        Ok(Self { order, units })
    }

    /// The matrix of the finest level.
    pub(crate) fn matrix(&self, matrix: Arc<Csr>) -> Result<Arc<Csr>, MatrixError> {
        match &self.order {
            None => Ok(matrix),
            Some(order) => Ok(Arc::new(matrix.permuted(order)?)),
        }
    }

    /// What coarse unknowns of 1 are on the finest level: the candidate, where it is not the constant.
    pub(crate) fn units(&self) -> Option<&[f64]> {
        self.units.as_deref()
    }

    /// Bytes that it keeps.
    pub(crate) fn bytes(&self) -> usize {
        let order = self.order.as_ref().map_or(0, |order| size_of_val(&**order));
        order + self.units.as_ref().map_or(0, |units| size_of_val(&**units))
    }

    /// What rows count for. Rows and columns are multiplied by the candidate alike, which keeps a symmetric matrix symmetric.
    pub(crate) fn weights<'a>(&self, weights: Option<&'a [f64]>) -> Option<Cow<'a, [f64]>> {
        let ordered = match (&self.order, weights) {
            (Some(order), Some(weights)) => Some(Cow::Owned(taken(order, weights).collect())),
            _ => weights.map(Cow::Borrowed),
        };
        match &self.units {
            None => ordered,
            Some(units) => Some(Cow::Owned(match ordered {
                Some(weights) => weights.iter().zip(units).map(|(w, c)| w * c).collect(),
                None => units.clone(),
            })),
        }
    }

    /// Elements of scratch that a change of order needs.
    pub(crate) fn scratch_len(&self) -> usize {
        self.order.as_ref().map_or(0, |order| 2 * order.len())
    }

    /// `z = f(r)` for vectors from outside.
    pub(crate) fn within(
        &self,
        r: &[f64],
        z: &mut [f64],
        scratch: &mut [f64],
        f: impl FnOnce(&[f64], &mut [f64], &mut [f64]),
    ) {
        let Some(order) = &self.order else { return f(r, z, scratch) };
        let (own_r, scratch) = scratch.split_at_mut(order.len());
        let (own_z, scratch) = scratch.split_at_mut(order.len());
        own_r.iter_mut().zip(taken(order, r)).for_each(|(own, r)| *own = r);
        f(own_r, own_z, scratch);
        order.iter().zip(&*own_z).for_each(|(&i, own)| z[i as usize] = *own);
    }
}

fn taken<'a>(order: &'a [u32], x: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    order.iter().map(|&i| x[i as usize])
}
