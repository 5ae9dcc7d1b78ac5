//! Algebraic multigrid: levels made from the matrix alone.

mod aggregation;
mod blocks;
mod candidate;
mod chebyshev;
mod coarse;
mod colored;
mod cycle;
mod energy;
mod evolution;
mod frame;
mod galerkin;
mod interpolation;
mod kept;
mod marks;
mod numbering;
mod pairwise;
mod params;
mod prolongation;
mod ruge_stueben;
mod skew;
mod smoother;
mod stale;
mod strength;
#[cfg(test)]
mod tests;
mod transfers;

use crate::csr::Csr;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::precond::Preconditioner;
use crate::solver::SolveError;
use coarse::Coarse;
pub(crate) use coarse::floating_parts;
use frame::Frame;
pub(crate) use frame::Scaling;
use interpolation::Interpolation;
pub use params::{
    Candidate, Coarsening, CycleKind, HierarchyInfo, MultigridParams, ProlongationKind, Restriction,
    SmootherKind, StrengthKind,
};
use prolongation::Step;
pub(crate) use skew::is_convective;
use smoother::Smoother;
use stale::Drift;
use std::sync::Arc;
use transfers::transfers;

/// Levels at most; each has a fraction of the unknowns of the one before, so more are never reached.
const MAX_LEVELS: usize = 25;

#[derive(Debug)]
struct Level {
    a: Arc<DifferenceMatrix>,
    /// Weights that add up to 1 in every row or are none; on the finest level they count in [`Frame::units`].
    p: Interpolation,
    /// The same for restriction, in [`Frame::weights`].
    r: Interpolation,
    smoother: Smoother,
}

/// A hierarchy of levels, with the cycle through them as a preconditioner.
#[derive(Debug)]
pub struct Multigrid {
    levels: Vec<Level>,
    coarse: Coarse,
    frame: Frame,
    params: MultigridParams,
    info: HierarchyInfo,
    drift: Drift,
}

/// Prolongation, restriction and matrix of a level that is to follow.
type NextLevel = (Interpolation, Interpolation, DifferenceMatrix);

impl Multigrid {
    /// Sets the levels up. `weights[i]` is what row `i` counts for in sums over rows: the factor that turns the row
    /// into a balance, such that columns of the weighted matrix add up to nearly nothing away from boundaries.
    /// Where rows have been divided by their diagonal, or by a volume, that is what they were divided by.
    ///
    /// # Errors
    /// A matrix that is not square, a parameter out of range, weights of the wrong number, or a coarsest matrix that
    /// cannot be factorised.
    pub fn new(
        matrix: Arc<Csr>,
        weights: Option<&[f64]>,
        params: &MultigridParams,
    ) -> Result<Self, SolveError> {
        matrix.require_square()?;
        if let Some(weights) = weights {
            MatrixError::check_length("weights of rows", weights.len(), matrix.nrows())?;
            MatrixError::check_finite("weight", weights)?;
        }
        let rows = Arc::new(DifferenceMatrix::from_csr(&matrix)?);
        let weights = weights.map_or_else(Arc::default, Arc::from);
        Self::of(rows, Scaling { weights, ..Scaling::default() }, params)
    }

    /// For rows in difference form, which the levels share with whoever has them. What it preconditions is the scaled matrix.
    ///
    /// # Errors
    /// Those of [`Multigrid::new`].
    pub(crate) fn of(
        matrix: Arc<DifferenceMatrix>,
        scaling: Scaling,
        params: &MultigridParams,
    ) -> Result<Self, SolveError> {
        params.check()?;
        let (frame, mut a, mut inverse) = Frame::new(matrix, scaling, params)?;
        let coarse = Coarse::trivial()?;
        let mut multigrid = Self {
            levels: Vec::new(),
            coarse,
            frame,
            params: *params,
            info: HierarchyInfo::default(),
            drift: Drift::default(),
        };
        multigrid.start(&a);
        let mut kept = multigrid.frame.kept(&a, &inverse, params.keep);
        while a.n() > params.coarsest && multigrid.levels.len() + 1 < MAX_LEVELS {
            let Some((p, r, coarse)) = multigrid.next_level(&a, &inverse, &mut kept)? else { break };
            a = multigrid.add_level(a, inverse, p, r, coarse)?;
            inverse = smoother::reciprocals(&a);
        }
        multigrid.coarse = Coarse::new(&a, params.coarsest)?;
        Ok(multigrid)
    }

    /// The same levels for a matrix of the same pattern with other values: prolongation and restriction stay, coarse matrices
    /// and smoothers are computed anew. For matrices that change little, as those of time steps do. Where rows have changed their
    /// shapes since the levels were made, as by an interface that has moved, these are made anew.
    ///
    /// # Errors
    /// A matrix of another size; those of [`Multigrid::new`].
    pub fn refresh(&mut self, matrix: Arc<Csr>) -> Result<(), SolveError> {
        let rows = Arc::new(DifferenceMatrix::from_csr(&matrix)?);
        if !self.refresh_rows(&rows)? {
            *self = Self::of(rows, self.frame.scaling(), &self.params)?;
        }
        Ok(())
    }

    /// The same; false, with nothing done, where the levels have to be made anew.
    pub(crate) fn refresh_rows(&mut self, matrix: &Arc<DifferenceMatrix>) -> Result<bool, SolveError> {
        let n = self.info.levels.first().map_or(0, |l| l.0);
        MatrixError::check_length("rows of the matrix", matrix.n(), n)?;
        let mut a = self.frame.matrix(Arc::clone(matrix))?;
        let fits = self.levels.first().is_some_and(|finest| !self.drift.is_too_far(&finest.a, &a));
        if !fits {
            return Ok(false);
        }
        let old = std::mem::take(&mut self.levels);
        self.start(&a);
        for level in old {
            let coarse = self.coarse_matrix(&a, &level.p, &level.r)?;
            let inverse = smoother::reciprocals(&a);
            a = self.add_level(a, inverse, level.p, level.r, coarse)?;
        }
        self.coarse = Coarse::new(&a, self.params.coarsest)?;
        Ok(true)
    }

    fn start(&mut self, a: &DifferenceMatrix) {
        self.info = HierarchyInfo { levels: vec![(a.n(), a.nnz() + a.n())], bytes: self.frame.bytes() };
    }

    /// Prolongation, restriction and matrix of the next level; `None` where there is none that is worth having. Where smoothed
    /// aggregates give it more entries than the level has, as in graphs in which everything is near everything, they are not smoothed.
    fn next_level(
        &self,
        a: &Arc<DifferenceMatrix>,
        inverse: &[f64],
        kept: &mut Vec<bool>,
    ) -> Result<Option<NextLevel>, SolveError> {
        let finest = self.levels.is_empty();
        let make = |kept: &mut Vec<bool>, step: Option<Step>| {
            let units = if finest { self.frame.units() } else { None };
            let weights = if finest { self.frame.weights() } else { None };
            let in_units = [units.as_deref(), weights.as_deref()];
            let transfers = transfers(a, inverse, in_units, kept, &self.params, step)?;
            drop((units, weights));
            let Some((p, r)) = transfers else { return Ok(None) };
            let coarse = self.coarse_matrix(a, &p, &r)?;
            Ok(Some((p, r, coarse)))
        };
        let step = match self.params.restriction {
            Restriction::Own => Step::SAFE,
            Restriction::Transpose if finest => Step::LONG,
            Restriction::Transpose => Step::COARSE,
        };
        let before = kept.clone();
        match make(kept, Some(step))? {
            Some((_, _, coarse))
                if coarse.nnz() > a.nnz() && self.params.coarsening == Coarsening::SmoothedAggregation =>
            {
                drop(coarse);
                *kept = before;
                make(kept, None)
            }
            next => Ok(next),
        }
    }

    /// The matrix of the level after the last.
    fn coarse_matrix(
        &self,
        a: &DifferenceMatrix,
        p: &Interpolation,
        r: &Interpolation,
    ) -> Result<DifferenceMatrix, SolveError> {
        let coarse = if self.levels.is_empty() {
            let (units, weights) = (self.frame.units(), self.frame.weights());
            galerkin::product(a, self.frame.row_sums(a), [units.as_deref(), weights.as_deref()], p, r)
        } else {
            galerkin::product(a, a.row_sums().to_vec(), [None, None], p, r)
        };
        coarse.require_finite()?;
        Ok(coarse)
    }

    fn add_level(
        &mut self,
        a: Arc<DifferenceMatrix>,
        inverse: Vec<f64>,
        p: Interpolation,
        r: Interpolation,
        coarse: DifferenceMatrix,
    ) -> Result<Arc<DifferenceMatrix>, SolveError> {
        let smoother = match self.levels.len() {
            0 => Smoother::new(self.params.smoother, &a, inverse)?,
            _ => Smoother::of_coarse(self.params.smoother, &a, inverse)?,
        };
        self.info.levels.push((coarse.n(), coarse.nnz() + coarse.n()));
        self.info.bytes += coarse.bytes() + p.bytes() + r.bytes() + smoother.bytes();
        self.levels.push(Level { a, p, r, smoother });
        Ok(Arc::new(coarse))
    }

    /// The sizes of the levels.
    #[must_use]
    pub fn info(&self) -> &HierarchyInfo {
        &self.info
    }
}

impl Preconditioner for Multigrid {
    fn name(&self) -> String {
        "multigrid".to_owned()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], scratch: &mut [f64]) {
        self.frame.within(r, z, scratch, |r, z, scratch| self.cycle(0, r, z, scratch));
    }

    fn scratch_len(&self) -> usize {
        self.frame.scratch_len(self.info.levels.first().map_or(0, |l| l.0)) + self.scratch_from(0)
    }

    fn is_linear(&self) -> bool {
        self.params.cycle != CycleKind::K
    }

    fn refresh(&mut self, matrix: &Arc<Csr>) -> Result<bool, SolveError> {
        self.refresh_rows(&Arc::new(DifferenceMatrix::from_csr(matrix)?))
    }

    fn hierarchy(&self) -> Option<&HierarchyInfo> {
        Some(&self.info)
    }
}
