//! Algebraic multigrid: levels made from the matrix alone.

mod aggregation;
mod blocks;
mod coarse;
mod cycle;
mod galerkin;
mod prolongation;
mod smoother;
mod strength;
#[cfg(test)]
mod tests;

use crate::csr::Csr;
use crate::error::MatrixError;
use crate::precond::Preconditioner;
use crate::solver::SolveError;
use coarse::Coarse;
use smoother::Smoother;
use std::sync::Arc;

/// Levels at most; each has a fraction of the unknowns of the one before, so more are never reached.
const MAX_LEVELS: usize = 25;

/// A level that has more than this part of the unknowns of the one above is not worth having.
const LEAST_COARSENING: f64 = 0.8;

/// How often coarse levels are visited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum CycleKind {
    /// Once.
    V,
    /// Twice.
    #[default]
    W,
    /// By two steps of a Krylov method (Notay and Vassilevski, Numer. Linear Algebra Appl. 15, 2008): a preconditioner
    /// that is not linear, for flexible methods only.
    K,
}

/// What removes the errors that coarse levels cannot see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SmootherKind {
    /// Damped Jacobi.
    Jacobi,
    /// Gauss-Seidel within blocks of rows of a fixed size, Jacobi between them: forward before the coarse correction,
    /// backward after it.
    #[default]
    GaussSeidel,
    /// Incomplete factors on the pattern of the matrix.
    Ilu0,
}

/// How to make and use levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultigridParams {
    /// How often coarse levels are visited.
    pub cycle: CycleKind,
    /// The smoother.
    pub smoother: SmootherKind,
    /// Its sweeps before and after each coarse correction, at least 1.
    pub sweeps: usize,
    /// A bond is strong from this part of the strongest of its nodes on; between 0 and 1.
    pub threshold: f64,
    /// Unknowns up to which a level is solved directly, at least 1.
    pub coarsest: usize,
}

impl Default for MultigridParams {
    fn default() -> Self {
        Self {
            cycle: CycleKind::W,
            smoother: SmootherKind::GaussSeidel,
            sweeps: 2,
            threshold: 0.25,
            coarsest: 400,
        }
    }
}

/// The sizes of a hierarchy.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HierarchyInfo {
    /// Unknowns and entries of every level, the finest first.
    pub levels: Vec<(usize, usize)>,
    /// Bytes of everything that was set up, without the finest matrix, which belongs to the solver.
    pub bytes: usize,
}

impl HierarchyInfo {
    /// Entries of all levels over those of the finest one.
    #[must_use]
    pub fn operator_complexity(&self) -> f64 {
        let entries: usize = self.levels.iter().map(|l| l.1).sum();
        entries as f64 / self.levels.first().map_or(1, |l| l.1.max(1)) as f64
    }

    /// Unknowns of all levels over those of the finest one.
    #[must_use]
    pub fn grid_complexity(&self) -> f64 {
        let unknowns: usize = self.levels.iter().map(|l| l.0).sum();
        unknowns as f64 / self.levels.first().map_or(1, |l| l.0.max(1)) as f64
    }
}

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
        let mut info = HierarchyInfo { levels: vec![(matrix.nrows(), matrix.nnz())], bytes: 0 };
        let mut levels = Vec::new();
        let mut a = matrix;
        let mut sums = galerkin::row_sums(&a);
        while a.nrows() > params.coarsest && levels.len() + 1 < MAX_LEVELS {
            let graph = strength::symmetric(&a, params.threshold);
            let aggregates = aggregation::standard(&a, &graph);
            if aggregates.count == 0 || aggregates.count as f64 > LEAST_COARSENING * a.nrows() as f64 {
                break;
            }
            let p = prolongation::smoothed(&a, &graph, &aggregates);
            drop(graph);
            let weights = weights.filter(|_| levels.is_empty());
            let r = restriction(&p, weights);
            let (coarse, coarse_sums) = galerkin::product(&a, &sums, &p, &r);
            coarse.require_finite()?;
            let smoother = Smoother::new(params.smoother, &a)?;
            info.levels.push((coarse.nrows(), coarse.nnz()));
            info.bytes += coarse.bytes() + p.bytes() + r.bytes() + smoother.bytes();
            levels.push(Level { a, p, r, smoother });
            (a, sums) = (Arc::new(coarse), coarse_sums);
        }
        let coarse = Coarse::new(&a, &sums)?;
        Ok(Self { levels, coarse, params: *params, info })
    }

    /// The sizes of the levels.
    #[must_use]
    pub fn info(&self) -> &HierarchyInfo {
        &self.info
    }
}

/// The transpose of the prolongation, with its columns weighted.
fn restriction(p: &Csr, weights: Option<&[f64]>) -> Csr {
    let r = p.transpose();
    let Some(weights) = weights else { return r };
    let values = r.indices().iter().zip(r.values()).map(|(&i, v)| weights[i as usize] * v).collect();
    Csr::from_trusted(r.ncols(), r.offsets().to_vec(), r.indices().to_vec(), values)
}

impl MultigridParams {
    pub(crate) fn check(&self) -> Result<(), SolveError> {
        let bad = |what, value, expected| Err(SolveError::BadParameter { what, value, expected });
        if !(0.0..1.0).contains(&self.threshold) {
            return bad("the threshold of strength", self.threshold, "it must lie in [0, 1)");
        }
        if self.sweeps == 0 {
            return bad("the number of sweeps", 0.0, "it must be at least 1");
        }
        if self.coarsest == 0 {
            return bad("the size of the coarsest level", 0.0, "it must be at least 1");
        }
        Ok(())
    }
}

impl Preconditioner for Multigrid {
    fn name(&self) -> String {
        "multigrid".to_owned()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], scratch: &mut [f64]) {
        self.cycle(0, r, z, scratch);
    }

    fn scratch_len(&self) -> usize {
        self.scratch_from(0)
    }

    fn is_linear(&self) -> bool {
        self.params.cycle != CycleKind::K
    }

    fn hierarchy(&self) -> Option<&HierarchyInfo> {
        Some(&self.info)
    }
}
