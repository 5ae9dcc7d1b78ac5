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
mod kept;
mod numbering;
mod pairwise;
mod params;
mod prolongation;
mod ruge_stueben;
mod smoother;
mod strength;
#[cfg(test)]
mod tests;

use crate::csr::Csr;
use crate::error::MatrixError;
use crate::precond::Preconditioner;
use crate::solver::SolveError;
use coarse::Coarse;
use frame::Frame;
pub use params::{
    Candidate, Coarsening, CycleKind, HierarchyInfo, MultigridParams, ProlongationKind, Restriction,
    SmootherKind, StrengthKind,
};
use smoother::Smoother;
use std::borrow::Cow;
use std::sync::Arc;

/// Levels at most; each has a fraction of the unknowns of the one before, so more are never reached.
const MAX_LEVELS: usize = 25;

/// A level that has more than this part of the unknowns of the one above is not worth having.
const LEAST_COARSENING: f64 = 0.8;

#[derive(Debug)]
struct Level {
    a: Arc<Csr>,
    p: Csr,
    r: Csr,
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
}

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
        params.check()?;
        matrix.require_square()?;
        if let Some(weights) = weights {
            MatrixError::check_length("weights of rows", weights.len(), matrix.nrows())?;
            MatrixError::check_finite("weight", weights)?;
        }
        let mut multigrid = Self {
            levels: Vec::new(),
            coarse: Coarse::trivial()?,
            frame: Frame::new(&matrix, params)?,
            params: *params,
            info: HierarchyInfo::default(),
        };
        let weights = multigrid.frame.weights(weights);
        let matrix = multigrid.frame.matrix(matrix)?;
        multigrid.info.levels.push((matrix.nrows(), matrix.nnz()));
        multigrid.info.bytes = multigrid.frame.bytes();
        let mut a = matrix;
        let mut sums = galerkin::row_sums(&a, multigrid.frame.units());
        let mut kept = kept::rows(&a, params.keep);
        while a.nrows() > params.coarsest && multigrid.levels.len() + 1 < MAX_LEVELS {
            let weights = weights.as_deref().filter(|_| multigrid.levels.is_empty());
            let transfers = match multigrid.units() {
                None => transfers(&a, weights, &mut kept, params)?,
                Some(units) => transfers(&a.columns_scaled(units)?, weights, &mut kept, params)?
                    .map(|(p, r)| p.row_scaled(units).map(|p| (p, r)))
                    .transpose()?,
            };
            let Some((p, r)) = transfers else { break };
            (a, sums) = multigrid.add_level(a, &sums, p, r)?;
        }
        multigrid.coarse = Coarse::new(&a, &sums, params.coarsest)?;
        Ok(multigrid)
    }

    /// The same levels for a matrix of the same pattern with other values: prolongation and restriction stay, coarse matrices
    /// and smoothers are computed anew. For matrices that change little, as those of time steps do.
    ///
    /// # Errors
    /// A matrix of another size; those of [`Multigrid::new`].
    pub fn refresh(&mut self, matrix: Arc<Csr>) -> Result<(), SolveError> {
        matrix.require_square()?;
        let n = self.info.levels.first().map_or(0, |l| l.0);
        MatrixError::check_length("rows of the matrix", matrix.nrows(), n)?;
        let matrix = self.frame.matrix(matrix)?;
        let old = std::mem::take(&mut self.levels);
        self.info = HierarchyInfo { levels: vec![(matrix.nrows(), matrix.nnz())], bytes: self.frame.bytes() };
        let mut a = matrix;
        let mut sums = galerkin::row_sums(&a, self.frame.units());
        for level in old {
            (a, sums) = self.add_level(a, &sums, level.p, level.r)?;
        }
        self.coarse = Coarse::new(&a, &sums, self.params.coarsest)?;
        Ok(())
    }

    /// What ones on the next level are on the one that is at hand, where that is not ones.
    fn units(&self) -> Option<&[f64]> {
        self.frame.units().filter(|_| self.levels.is_empty())
    }

    fn add_level(
        &mut self,
        a: Arc<Csr>,
        sums: &[f64],
        p: Csr,
        r: Csr,
    ) -> Result<(Arc<Csr>, Vec<f64>), SolveError> {
        let (coarse, sums) = galerkin::product(&a, sums, self.units(), &p, &r);
        coarse.require_finite()?;
        let smoother = Smoother::new(self.params.smoother, &a)?;
        self.info.levels.push((coarse.nrows(), coarse.nnz()));
        self.info.bytes += coarse.bytes() + p.bytes() + r.bytes() + smoother.bytes();
        self.levels.push(Level { a, p, r, smoother });
        Ok((Arc::new(coarse), sums))
    }

    /// The sizes of the levels.
    #[must_use]
    pub fn info(&self) -> &HierarchyInfo {
        &self.info
    }
}

/// Prolongation and restriction to the next level; `None` where there is none that is worth having. Of a level that there is
/// `kept` says which unknowns stay, before and after.
fn transfers(
    a: &Csr,
    weights: Option<&[f64]>,
    kept: &mut Vec<bool>,
    params: &MultigridParams,
) -> Result<Option<(Csr, Csr)>, SolveError> {
    let symmetric = strength::symmetric(a, params.threshold);
    let graph = match params.strength {
        StrengthKind::Symmetric => symmetric,
        StrengthKind::Evolution => evolution::evolution(a, &symmetric),
    };
    let worth = |count: usize| count > 0 && count as f64 <= LEAST_COARSENING * a.nrows() as f64;
    let p = match params.coarsening {
        Coarsening::SmoothedAggregation => {
            let graph = kept::without(graph, kept);
            let mut aggregates = aggregation::standard(a, &graph);
            *kept = kept::single_out(&mut aggregates, kept);
            if !worth(aggregates.count) {
                return Ok(None);
            }
            let smoothed = |a: &Csr| match params.prolongation {
                ProlongationKind::Jacobi => Ok(prolongation::smoothed(a, &graph, &aggregates)),
                ProlongationKind::EnergyMinimizing => energy::minimized(a, &graph, &aggregates),
            };
            let own = params.restriction == Restriction::Own;
            let balanced = own || params.prolongation == ProlongationKind::EnergyMinimizing;
            let balances = match weights.filter(|_| balanced) {
                Some(weights) => Cow::Owned(a.row_scaled(weights)?),
                None => Cow::Borrowed(a),
            };
            let p = smoothed(&balances)?;
            if own {
                let left = smoothed(&balances.transpose())?;
                return Ok(Some((p, restriction(&left, weights))));
            }
            p
        }
        Coarsening::PairwiseAggregation => {
            let aggregates = pairwise::pairwise(a, &graph);
            if !worth(aggregates.count) {
                return Ok(None);
            }
            prolongation::tentative(&aggregates)
        }
        Coarsening::RugeStuebenDirect | Coarsening::RugeStuebenExtended => {
            let dependence = ruge_stueben::dependence(a, params.threshold, &graph);
            let (number, count) = ruge_stueben::splitting(&dependence);
            if !worth(count) {
                return Ok(None);
            }
            let extended = params.coarsening == Coarsening::RugeStuebenExtended;
            ruge_stueben::interpolation(a, &dependence, &number, count, extended)
        }
    };
    let r = restriction(&p, weights);
    Ok(Some((p, r)))
}

/// The transpose of the prolongation, with its columns weighted.
fn restriction(p: &Csr, weights: Option<&[f64]>) -> Csr {
    let r = p.transpose();
    let Some(weights) = weights else { return r };
    let values = r.indices().iter().zip(r.values()).map(|(&i, v)| weights[i as usize] * v).collect();
    Csr::from_trusted(r.ncols(), r.offsets().to_vec(), r.indices().to_vec(), values)
}

impl Preconditioner for Multigrid {
    fn name(&self) -> String {
        "multigrid".to_owned()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], scratch: &mut [f64]) {
        self.frame.within(r, z, scratch, |r, z, scratch| self.cycle(0, r, z, scratch));
    }

    fn scratch_len(&self) -> usize {
        self.frame.scratch_len() + self.scratch_from(0)
    }

    fn is_linear(&self) -> bool {
        self.params.cycle != CycleKind::K
    }

    fn refresh(&mut self, matrix: &Arc<Csr>) -> Result<bool, SolveError> {
        Self::refresh(self, Arc::clone(matrix))?;
        Ok(true)
    }

    fn hierarchy(&self) -> Option<&HierarchyInfo> {
        Some(&self.info)
    }
}
