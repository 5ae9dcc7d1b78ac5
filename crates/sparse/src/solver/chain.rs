//! Multigrid, and what steps in for it.

use super::diagnosis::diagnosed;
use super::direct::Factors;
use super::krylov::{Method, Residuals, iterate};
use super::scaling::Scaled;
use super::{AUTO_RESTART, Levels, SolveError, SolveInfo, SolverParams};
use crate::difference::{DifferenceMatrix, ScaledRows};
use crate::multigrid::{
    HierarchyInfo, Multigrid, MultigridParams, Restriction, Scaling, SmootherKind, is_convective,
};
use crate::precond::{IncompleteLu, Preconditioner, PreconditionerKind, ilu0};
use crate::vector::axpy;
use std::sync::{Arc, OnceLock};

/// Products after which multigrid is given up: three times what it needs where it works.
pub(crate) const PATIENCE: usize = 40;

/// What steps in.
const SUBSTITUTE: Method = Method::BiCgStab { l: 2 };

/// The levels that are asked for; where none are, those that suit the matrix: incomplete factors and a restriction of its own for
/// convection, on which the default levels stagnate.
pub(crate) fn levels_of(rows: &DifferenceMatrix, params: &SolverParams) -> MultigridParams {
    match params.preconditioner {
        PreconditionerKind::Multigrid(levels) => levels,
        _ if is_convective(rows) => MultigridParams {
            smoother: SmootherKind::Ilu0,
            restriction: Restriction::Own,
            ..MultigridParams::default()
        },
        _ => MultigridParams::default(),
    }
}

/// GMRES with multigrid, BiCGStab(2) with ILU(0) where that stagnates, and factors where that does, too.
#[derive(Debug)]
pub(crate) struct Chain {
    rows: Arc<DifferenceMatrix>,
    /// What the rows are multiplied by.
    factors: Arc<[f64]>,
    multigrid: Option<Multigrid>,
    /// Set once multigrid has failed.
    substitute: OnceLock<IncompleteLu>,
    /// Set once both have failed.
    direct: OnceLock<(Scaled, Factors)>,
}

impl Chain {
    /// For rows that are multiplied by `factors`.
    pub(crate) fn new(
        rows: Arc<DifferenceMatrix>,
        factors: Vec<f64>,
        params: &SolverParams,
    ) -> Result<Self, SolveError> {
        if let Some(row) =
            (0..rows.n()).find(|&i| rows.row(i).1.iter().all(|&v| v == 0.0) && rows.row_sum(i) == 0.0)
        {
            return Err(SolveError::EmptyRow { row });
        }
        let factors: Arc<[f64]> = Arc::from(factors);
        let scaling = Scaling { rows: Arc::clone(&factors), ..Scaling::default() };
        let (substitute, direct) = (OnceLock::new(), OnceLock::new());
        let mut chain = Self { rows, factors, multigrid: None, substitute, direct };
        match Multigrid::of(Arc::clone(&chain.rows), scaling, &levels_of(&chain.rows, params)) {
            Ok(multigrid) => chain.multigrid = Some(multigrid),
            // A coarsest level that cannot be factorised, or whose entries overflow.
            Err(SolveError::Singular { .. } | SolveError::Matrix(_)) => {
                chain.substitute = OnceLock::from(ilu0(&chain.scaled().to_csr())?);
            }
            Err(error) => return Err(error),
        }
        Ok(chain)
    }

    fn scaled(&self) -> ScaledRows<'_> {
        ScaledRows { matrix: &self.rows, factors: &self.factors }
    }

    /// Number of unknowns.
    pub(crate) fn n(&self) -> usize {
        self.rows.n()
    }

    /// Other values in the same pattern: the levels stay as long as they fit, and multigrid gets another chance. With the levels rows
    /// keep their factors, so that sums over rows keep their meaning.
    pub(crate) fn refresh(
        &mut self,
        rows: Arc<DifferenceMatrix>,
        params: &SolverParams,
    ) -> Result<(), SolveError> {
        let stale = match &mut self.multigrid {
            Some(multigrid) => !multigrid.refresh_rows(&rows)?,
            None => false,
        };
        if stale {
            let factors = rows.balancing_factors();
            *self = Self::new(rows, factors, params)?;
            return Ok(());
        }
        self.rows = rows;
        self.direct = OnceLock::new();
        self.substitute = OnceLock::new();
        if self.multigrid.is_none() {
            self.substitute = OnceLock::from(ilu0(&self.scaled().to_csr())?);
        }
        Ok(())
    }

    /// What multigrid preconditions, as long as nothing had to step in for it.
    pub(crate) fn levels(&self) -> Option<Levels<'_>> {
        let multigrid = self.multigrid.as_ref().filter(|_| self.substitute.get().is_none())?;
        Some(Levels { rows: self.scaled(), multigrid })
    }

    pub(crate) fn hierarchy(&self) -> Option<&HierarchyInfo> {
        self.multigrid.as_ref().map(Multigrid::info)
    }

    /// Solves for a right-hand side, which is not scaled.
    pub(crate) fn solve(
        &self,
        rhs: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        let b: Vec<f64> = rhs.iter().zip(&*self.factors).map(|(b, f)| b * f).collect();
        if let Some(factors) = self.direct.get() {
            return by_factors(factors, &b);
        }
        match self.iterated(&b, params) {
            Err(error @ (SolveError::NoConvergence { .. } | SolveError::BreakDown { .. }))
                if self.n() <= params.direct_max =>
            {
                let Ok(factors) = Factors::new(&self.scaled().to_csr()) else {
                    return Err(diagnosed(error, &self.rows));
                };
                by_factors(self.direct.get_or_init(|| factors), &b)
            }
            Err(error) => Err(diagnosed(error, &self.rows)),
            solved => solved,
        }
    }

    fn iterated(&self, b: &[f64], params: &SolverParams) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        let a = self.scaled();
        if let Some(lu) = self.substitute.get() {
            return iterate(SUBSTITUTE, &a, lu, b, params);
        }
        let Some(multigrid) = &self.multigrid else {
            return iterate(SUBSTITUTE, &a, &ilu0(&a.to_csr())?, b, params);
        };
        let gmres = Method::Gmres { restart: AUTO_RESTART };
        let patient = SolverParams { max_iterations: params.max_iterations.min(PATIENCE), ..*params };
        match iterate(gmres, &a, multigrid, b, &patient) {
            Err(
                SolveError::NoConvergence { solver, residual, iterations, best, .. }
                | SolveError::BreakDown { solver, residual, iterations, best, .. },
            ) if params.max_iterations > iterations => {
                let factors = ilu0(&a.to_csr())?;
                let lu = self.substitute.get_or_init(|| factors);
                go_on(a, lu, b, params, &solver, (residual, iterations, best))
            }
            solved => solved,
        }
    }
}

fn by_factors((scaled, factors): &(Scaled, Factors), b: &[f64]) -> Result<(Vec<f64>, SolveInfo), SolveError> {
    let (x, info) = factors.solve_refined(&*scaled.matrix, &scaled.rhs(b))?;
    Ok((scaled.unscale(x), info))
}

/// Solves for what the first method has left.
fn go_on(
    a: ScaledRows<'_>,
    lu: &dyn Preconditioner,
    b: &[f64],
    params: &SolverParams,
    first: &str,
    (reached, products, mut x): (f64, usize, Vec<f64>),
) -> Result<(Vec<f64>, SolveInfo), SolveError> {
    let before = x.clone();
    let mut residual = vec![0.0; b.len()];
    a.residual(&x, b, &mut residual);
    let rest = SolverParams {
        tolerance: (params.tolerance / reached.max(params.tolerance)).min(0.5),
        max_iterations: params.max_iterations - products,
        ..*params
    };
    match iterate(SUBSTITUTE, &a, lu, &residual, &rest) {
        Ok((correction, mut info)) => {
            axpy(1.0, &correction, &mut x);
            info.iterations += products;
            info.name = format!("{first}, then {}", info.name);
            info.residual *= reached;
            info.backward_error = a.backward_error(&x, b);
            Ok((x, info))
        }
        // The remainder may be out of reach where the whole is not.
        Err(_) => iterate(SUBSTITUTE, &a, lu, b, params)
            .map_err(|error| combined(error, params.tolerance, first, (reached, products, before))),
    }
}

/// What two methods have reached that both failed: the better of their solutions, the products of both.
fn combined(
    error: SolveError,
    tolerance: f64,
    first: &str,
    (reached, products, before): (f64, usize, Vec<f64>),
) -> SolveError {
    let (second, reason, residual, further, best) = match error {
        SolveError::NoConvergence { solver, reason, residual, iterations, best, .. } => {
            (solver, reason, residual, iterations, best)
        }
        SolveError::BreakDown { solver, residual, iterations, best, .. } => {
            (solver, "the recurrence breaks down", residual, iterations, best)
        }
        other => return other,
    };
    let (residual, best) = if reached < residual { (reached, before) } else { (residual, best) };
    let solver = format!("{first}, then {second}");
    SolveError::NoConvergence { solver, reason, residual, tolerance, iterations: products + further, best }
}
