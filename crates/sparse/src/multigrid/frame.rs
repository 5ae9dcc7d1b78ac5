//! The unknowns as the levels have them: in an order and in units of their own.

use super::{Candidate, MultigridParams, candidate, galerkin, kept, numbering};
use crate::csr::for_each_row;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use std::borrow::Cow;
use std::sync::Arc;

/// What was done to the rows and the unknowns of a matrix before its systems are solved: `F A S^-1`.
#[derive(Debug, Default)]
pub(crate) struct Scaling {
    /// F; ones where it is empty.
    pub(crate) rows: Vec<f64>,
    /// S: the unknowns of the matrix times this are smooth where errors are cheap. Ones where it is empty.
    pub(crate) unknowns: Vec<f64>,
}

/// How the unknowns of the finest level follow from those of the system that is solved.
#[derive(Debug)]
pub(crate) struct Frame {
    scaling: Scaling,
    /// Element `k` of the levels is element `order[k]` outside; where this is none, `k`.
    order: Option<Vec<u32>>,
    /// The candidate, in the order of the levels; the constant where this is none.
    candidate: Option<Vec<f64>>,
}

impl Frame {
    /// The frame and the matrix of the finest level.
    pub(crate) fn new(
        matrix: Arc<DifferenceMatrix>,
        scaling: Scaling,
        params: &MultigridParams,
    ) -> Result<(Self, Arc<DifferenceMatrix>), MatrixError> {
        let order = if params.renumber { numbering::found(matrix.off_diagonal()) } else { None };
        let mut frame = Self { scaling, order, candidate: None };
        let matrix = frame.matrix(matrix)?;
        if params.candidate == Candidate::Relaxed {
            frame.candidate = Some(candidate::relaxed(&matrix, &frame.scales())?);
        }
        Ok((frame, matrix))
    }

    /// S in the order of the levels.
    fn scales(&self) -> Cow<'_, [f64]> {
        match &self.order {
            Some(order) if !self.scaling.unknowns.is_empty() => {
                Cow::Owned(taken(order, &self.scaling.unknowns).collect())
            }
            _ => Cow::Borrowed(&self.scaling.unknowns),
        }
    }

    /// The matrix of the finest level.
    pub(crate) fn matrix(&self, matrix: Arc<DifferenceMatrix>) -> Result<Arc<DifferenceMatrix>, MatrixError> {
        match &self.order {
            None => Ok(matrix),
            Some(order) => Ok(Arc::new(matrix.permuted(order)?)),
        }
    }

    /// What coarse unknowns of 1 are on the finest level, `S^-1 c`, where they are not ones.
    pub(crate) fn units(&self) -> Option<Cow<'_, [f64]>> {
        let scales = self.scales();
        match &self.candidate {
            None if scales.is_empty() => None,
            None => Some(Cow::Owned(scales.iter().map(|s| 1.0 / s).collect())),
            Some(c) if scales.is_empty() => Some(Cow::Borrowed(c)),
            Some(c) => Some(Cow::Owned(c.iter().zip(&*scales).map(|(c, s)| c / s).collect())),
        }
    }

    /// The matrix of the finest level times [`Frame::units`].
    pub(crate) fn row_sums(&self, a: &DifferenceMatrix) -> Vec<f64> {
        galerkin::row_sums(a, self.candidate.as_deref(), &self.scales())
    }

    /// The unknowns of the finest level that stay as they are.
    pub(crate) fn kept(&self, a: &DifferenceMatrix, keep: f64) -> Vec<bool> {
        kept::rows(a, &self.scales(), keep)
    }

    /// Bytes that it keeps.
    pub(crate) fn bytes(&self) -> usize {
        let order = self.order.as_ref().map_or(0, |order| size_of_val(&**order));
        let vectors = [&self.scaling.rows, &self.scaling.unknowns].into_iter().chain(&self.candidate);
        order + vectors.map(|x| size_of_val(&**x)).sum::<usize>()
    }

    /// What rows count for. Rows and columns are multiplied by the candidate alike, which keeps a symmetric matrix symmetric.
    pub(crate) fn weights<'a>(&'a self, weights: Option<&'a [f64]>) -> Option<Cow<'a, [f64]>> {
        let ordered = match (&self.order, weights) {
            (Some(order), Some(weights)) => Some(Cow::Owned(taken(order, weights).collect())),
            _ => weights.map(Cow::Borrowed),
        };
        match (&self.candidate, ordered) {
            (None, ordered) => ordered,
            (Some(c), None) => Some(Cow::Borrowed(c)),
            (Some(c), Some(weights)) => Some(Cow::Owned(weights.iter().zip(c).map(|(w, c)| w * c).collect())),
        }
    }

    /// Elements of scratch that a change of order or of rows needs.
    pub(crate) fn scratch_len(&self, n: usize) -> usize {
        match (&self.order, self.scaling.rows.is_empty()) {
            (Some(_), _) => 2 * n,
            (None, false) => n,
            (None, true) => 0,
        }
    }

    /// `z = f(r)` for vectors from outside.
    pub(crate) fn within(
        &self,
        r: &[f64],
        z: &mut [f64],
        scratch: &mut [f64],
        f: impl FnOnce(&[f64], &mut [f64], &mut [f64]),
    ) {
        let factor = |i: usize| self.scaling.rows.get(i).copied().unwrap_or(1.0);
        match &self.order {
            None if self.scaling.rows.is_empty() => f(r, z, scratch),
            None => {
                let (own_r, scratch) = scratch.split_at_mut(r.len());
                for_each_row(own_r, |i, own| *own = r[i] / factor(i));
                f(own_r, z, scratch);
            }
            Some(order) => {
                let (own_r, scratch) = scratch.split_at_mut(order.len());
                let (own_z, scratch) = scratch.split_at_mut(order.len());
                own_r.iter_mut().zip(order).for_each(|(own, &i)| *own = r[i as usize] / factor(i as usize));
                f(own_r, own_z, scratch);
                order.iter().zip(&*own_z).for_each(|(&i, own)| z[i as usize] = *own);
            }
        }
        if !self.scaling.unknowns.is_empty() {
            for_each_row(z, |i, z| *z *= self.scaling.unknowns[i]);
        }
    }
}

fn taken<'a>(order: &'a [u32], x: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    order.iter().map(|&i| x[i as usize])
}
