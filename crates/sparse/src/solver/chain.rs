//! Multigrid, and what steps in for it.

use super::direct::Factors;
use super::krylov::{Method, iterate};
use super::scaling::Scaled;
use super::{AUTO_RESTART, SolveError, SolveInfo, SolverParams};
use crate::csr::Csr;
use crate::multigrid::{CycleKind, HierarchyInfo, Multigrid, MultigridParams};
use crate::precond::{IncompleteLu, Preconditioner, PreconditionerKind, ilu0};
use crate::vector::axpy;
use std::sync::{Arc, OnceLock};

/// Products after which multigrid is given up: three times what it needs where it works.
pub(crate) const PATIENCE: usize = 40;

/// What steps in.
const SUBSTITUTE: Method = Method::BiCgStab { l: 2 };

/// GMRES with multigrid, BiCGStab(2) with ILU(0) where that stagnates, and factors where that does, too.
#[derive(Debug)]
pub(crate) struct Chain {
    multigrid: Option<Multigrid>,
    /// Set once multigrid has failed.
    substitute: OnceLock<IncompleteLu>,
    /// Set once both have failed.
    direct: OnceLock<(Scaled, Factors)>,
}

impl Chain {
    pub(crate) fn new(scaled: &Scaled, params: &SolverParams) -> Result<Self, SolveError> {
        let levels = match params.preconditioner {
            PreconditionerKind::Multigrid(levels) => levels,
            _ => MultigridParams { cycle: CycleKind::W, ..MultigridParams::default() },
        };
        let weights = scaled.weights();
        match Multigrid::new(Arc::clone(&scaled.matrix), weights.as_deref(), &levels) {
            Ok(multigrid) => Ok(Self::of(Some(multigrid), OnceLock::new())),
            // A coarsest level that cannot be factorised, or whose entries overflow.
            Err(SolveError::Singular { .. } | SolveError::Matrix(_)) => {
                Ok(Self::of(None, OnceLock::from(ilu0(&scaled.matrix)?)))
            }
            Err(error) => Err(error),
        }
    }

    fn of(multigrid: Option<Multigrid>, substitute: OnceLock<IncompleteLu>) -> Self {
        Self { multigrid, substitute, direct: OnceLock::new() }
    }

    /// Other values in the same pattern: the levels stay, and multigrid gets another chance.
    pub(crate) fn refresh(&mut self, matrix: &Arc<Csr>) -> Result<(), SolveError> {
        self.direct = OnceLock::new();
        let Some(multigrid) = &mut self.multigrid else {
            self.substitute = OnceLock::from(ilu0(matrix)?);
            return Ok(());
        };
        self.substitute = OnceLock::new();
        multigrid.refresh(Arc::clone(matrix))
    }

    /// Multigrid, as long as nothing had to step in for it.
    pub(crate) fn multigrid(&self) -> Option<&Multigrid> {
        self.multigrid.as_ref().filter(|_| self.substitute.get().is_none())
    }

    pub(crate) fn hierarchy(&self) -> Option<&HierarchyInfo> {
        self.multigrid.as_ref().map(Multigrid::info)
    }

    pub(crate) fn solve(
        &self,
        a: &Csr,
        b: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        if let Some(factors) = self.direct.get() {
            return by_factors(factors, b);
        }
        match self.iterated(a, b, params) {
            Err(error @ (SolveError::NoConvergence { .. } | SolveError::BreakDown { .. }))
                if a.nrows() <= params.direct_max =>
            {
                let Ok(factors) = Factors::new(a) else { return Err(error) };
                by_factors(self.direct.get_or_init(|| factors), b)
            }
            solved => solved,
        }
    }

    fn iterated(
        &self,
        a: &Csr,
        b: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        if let Some(lu) = self.substitute.get() {
            return iterate(SUBSTITUTE, a, lu, b, params);
        }
        let Some(multigrid) = &self.multigrid else { return iterate(SUBSTITUTE, a, &ilu0(a)?, b, params) };
        let gmres = Method::Gmres { restart: AUTO_RESTART };
        let patient = SolverParams { max_iterations: params.max_iterations.min(PATIENCE), ..*params };
        match iterate(gmres, a, multigrid, b, &patient) {
            Err(
                SolveError::NoConvergence { solver, residual, iterations, best, .. }
                | SolveError::BreakDown { solver, residual, iterations, best, .. },
            ) if params.max_iterations > iterations => {
                let factors = ilu0(a)?;
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
    a: &Csr,
    lu: &dyn Preconditioner,
    b: &[f64],
    params: &SolverParams,
    first: &str,
    (reached, products, mut x): (f64, usize, Vec<f64>),
) -> Result<(Vec<f64>, SolveInfo), SolveError> {
    let mut residual = vec![0.0; b.len()];
    a.residual(&x, b, &mut residual);
    let rest = SolverParams {
        tolerance: (params.tolerance / reached.max(params.tolerance)).min(0.5),
        max_iterations: params.max_iterations - products,
        ..*params
    };
    match iterate(SUBSTITUTE, a, lu, &residual, &rest) {
        Ok((correction, mut info)) => {
            axpy(1.0, &correction, &mut x);
            info.iterations += products;
            info.name = format!("{first}, then {}", info.name);
            info.residual *= reached;
            info.backward_error = a.backward_error(&x, b);
            Ok((x, info))
        }
        // The remainder may be out of reach where the whole is not.
        Err(_) => iterate(SUBSTITUTE, a, lu, b, params),
    }
}
