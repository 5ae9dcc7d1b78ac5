//! The unknowns as the levels have them: in an order and in units of their own.

use super::{Candidate, MultigridParams, candidate, galerkin, kept, numbering, smoother};
use crate::csr::for_each_row;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::parallel;
use std::borrow::Cow;
use std::sync::Arc;

/// What was done to the rows and the unknowns of a matrix before its systems are solved: `F A S^-1`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scaling {
    /// F; ones where it is empty.
    pub(crate) rows: Arc<[f64]>,
    /// S: the unknowns of the matrix times this are smooth where errors are cheap. Ones where it is empty.
    pub(crate) unknowns: Arc<[f64]>,
    /// What rows of the matrix count for in sums over rows. Ones where it is empty.
    pub(crate) weights: Arc<[f64]>,
}

/// How the unknowns of the finest level follow from those of the system that is solved.
#[derive(Debug)]
pub(crate) struct Frame {
    n: usize,
    scaling: Scaling,
    /// Element `k` of the levels is element `order[k]` outside; where this is none, `k`.
    order: Option<Vec<u32>>,
    /// The candidate in steps of [`candidate::value`], in the order of the levels; the constant where this is empty.
    candidate: Vec<u16>,
}

impl Frame {
    /// The frame, the matrix of the finest level and the reciprocals of its diagonal.
    pub(crate) fn new(
        matrix: Arc<DifferenceMatrix>,
        scaling: Scaling,
        params: &MultigridParams,
    ) -> Result<(Self, Arc<DifferenceMatrix>, Vec<f64>), MatrixError> {
        let order = if params.renumber { numbering::found(matrix.off_diagonal()) } else { None };
        let mut frame = Self { n: matrix.n(), scaling, order, candidate: Vec::new() };
        let matrix = frame.matrix(matrix)?;
        let inverse = smoother::reciprocals(&matrix);
        if params.candidate == Candidate::Relaxed {
            frame.candidate = candidate::relaxed(&matrix, &inverse, &frame.scales());
        }
        Ok((frame, matrix, inverse))
    }

    pub(crate) fn scaling(&self) -> Scaling {
        self.scaling.clone()
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

    /// The place outside of element `i` of the levels.
    #[inline]
    fn outside(&self, i: usize) -> usize {
        self.order.as_ref().map_or(i, |order| order[i] as usize)
    }

    #[inline]
    fn candidate(&self, i: usize) -> f64 {
        self.candidate.get(i).map_or(1.0, |&c| candidate::value(c))
    }

    /// What a coarse unknown of 1 is at node `i` of the finest level, `S^-1 c`.
    #[inline]
    pub(crate) fn unit(&self, i: usize) -> f64 {
        let scale = self.scaling.unknowns.get(self.outside(i)).copied().unwrap_or(1.0);
        self.candidate(i) / scale
    }

    /// What row `i` of the finest level counts for. Rows and columns are multiplied by the candidate alike, which keeps a symmetric
    /// matrix symmetric.
    #[inline]
    fn weight(&self, i: usize) -> f64 {
        let weight = self.scaling.weights.get(self.outside(i)).copied().unwrap_or(1.0);
        self.candidate(i) * weight
    }

    /// [`Frame::unit`] of all nodes, where they are not ones.
    pub(crate) fn units(&self) -> Option<Vec<f64>> {
        let ones = self.candidate.is_empty() && self.scaling.unknowns.is_empty();
        (!ones).then(|| parallel::map_rows(self.n, |i| self.unit(i)))
    }

    /// [`Frame::weight`] of all rows, where they are not ones.
    pub(crate) fn weights(&self) -> Option<Vec<f64>> {
        let ones = self.candidate.is_empty() && self.scaling.weights.is_empty();
        (!ones).then(|| parallel::map_rows(self.n, |i| self.weight(i)))
    }

    /// Residuals of the finest level as they count in sums over rows.
    pub(crate) fn weigh(&self, r: &mut [f64]) {
        if !(self.candidate.is_empty() && self.scaling.weights.is_empty()) {
            for_each_row(r, |i, r| *r *= self.weight(i));
        }
    }

    /// The matrix of the finest level times [`Frame::units`].
    pub(crate) fn row_sums(&self, a: &DifferenceMatrix) -> Vec<f64> {
        let candidate = |i: usize| self.candidate(i);
        galerkin::row_sums(a, (!self.candidate.is_empty()).then_some(&candidate), &self.scales())
    }

    /// The unknowns of the finest level that stay as they are.
    pub(crate) fn kept(&self, a: &DifferenceMatrix, inverse: &[f64], keep: f64) -> Vec<bool> {
        kept::rows(a, inverse, &self.scales(), keep)
    }

    /// Bytes that it keeps, without what it shares.
    pub(crate) fn bytes(&self) -> usize {
        let order = self.order.as_ref().map_or(0, |order| size_of_val(&**order));
        order + size_of_val(&*self.candidate) + size_of_val(&*self.scaling.weights)
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
