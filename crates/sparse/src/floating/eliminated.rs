//! A bordered system prepared for any number of right-hand sides.

use super::bordered::{Bordered, BorderedSolution};
use super::coupled::{self, Coupled};
use super::dense::DenseLu;
use crate::error::MatrixError;
use crate::precond::PreconditionerKind;
use crate::solver::{AUTO_DIRECT_MAX, Prepared, SolveError, SolveInfo, SolverKind, SolverParams};
use crate::vector::{axpy, norm};
use std::sync::OnceLock;

/// A [`Bordered`] system with what is computed once for all right-hand sides.
///
/// With multigrid, GMRES runs on all equations at once, and the Schur complement of rough responses is part of its
/// preconditioner: one solve for a right-hand side, whatever the number of extra unknowns. Otherwise, or where that
/// stagnates (then by BiCGStab(2) with ILU(0)), one solve of `A'` for each extra unknown and one for the right-hand side,
/// the Schur complement `D - C A'^-1 B'` by Gaussian elimination, and a step of iterative refinement on the whole.
#[derive(Debug)]
pub struct PreparedBordered {
    system: Bordered,
    params: SolverParams,
    coupled: Option<(Prepared, Coupled)>,
    /// Made when it is needed.
    eliminated: OnceLock<Eliminated>,
}

/// What block elimination keeps.
#[derive(Debug)]
struct Eliminated {
    /// For `A'`.
    prepared: Prepared,
    /// `A'^-1 B'`, column by column.
    responses: Vec<Vec<f64>>,
    schur: DenseLu,
    products: usize,
}

impl PreparedBordered {
    /// Factors, or sets up the preconditioner, and solves for the response to every extra unknown.
    ///
    /// # Errors
    /// See [`Bordered::solve`].
    pub fn new(system: Bordered, params: &SolverParams) -> Result<Self, SolveError> {
        let multigrid = match params.kind {
            SolverKind::Multigrid => true,
            SolverKind::Auto => system.n() > AUTO_DIRECT_MAX,
            _ => false,
        };
        let joined = multigrid && system.extra() > 0;
        let coupled = if joined { coupled(&system, params)? } else { None };
        // What multigrid does not get along with is left to what steps in for it.
        let params = match joined {
            true => SolverParams {
                kind: SolverKind::BiCgStab { l: 2 },
                preconditioner: PreconditionerKind::Ilu0,
                ..*params
            },
            false => *params,
        };
        let new = Self { system, params, coupled, eliminated: OnceLock::new() };
        if new.coupled.is_none() {
            new.eliminated()?;
        }
        Ok(new)
    }

    /// Products that the responses to the extra unknowns have taken so far.
    pub(super) fn products(&self) -> usize {
        self.coupled.as_ref().map_or(0, |c| c.1.products) + self.eliminated.get().map_or(0, |e| e.products)
    }

    /// Solves for another right-hand side.
    ///
    /// # Errors
    /// See [`Bordered::solve`]; [`MatrixError::Length`] where `rhs` does not have one element for each equation.
    pub fn solve(&self, rhs: &[f64]) -> Result<BorderedSolution, SolveError> {
        let system = &self.system;
        MatrixError::check_length("right-hand side", rhs.len(), system.n())?;
        MatrixError::check_finite("right-hand side", rhs)?;
        if let (Some((prepared, coupled)), None) = (&self.coupled, self.eliminated.get())
            && let Some(levels) = prepared.levels()
            && let Ok((values, extra, info)) = coupled.solve(system, &levels, rhs, &self.params)
        {
            return Ok(BorderedSolution { values, extra, info });
        }
        self.by_elimination(rhs)
    }

    fn eliminated(&self) -> Result<&Eliminated, SolveError> {
        if let Some(eliminated) = self.eliminated.get() {
            return Ok(eliminated);
        }
        let new = Eliminated::new(&self.system, &self.params)?;
        Ok(self.eliminated.get_or_init(|| new))
    }

    fn by_elimination(&self, rhs: &[f64]) -> Result<BorderedSolution, SolveError> {
        let (system, eliminated) = (&self.system, self.eliminated()?);
        let (mut values, mut extra, mut info) = eliminated.solve(system, rhs)?;
        let mut products = info.iterations;
        if system.extra() > 0 {
            let residual = system.residual_of(rhs, &values, &extra);
            // What is left may be rounding that an iterative method cannot reduce: then the solution stays as it is.
            if let Ok((d_values, d_extra, d_info)) = eliminated.solve(system, &residual) {
                products += d_info.iterations;
                let better_values: Vec<f64> = values.iter().zip(&d_values).map(|(a, b)| a + b).collect();
                let better_extra: Vec<f64> = extra.iter().zip(&d_extra).map(|(a, b)| a + b).collect();
                let better = system.backward_error(rhs, &better_values, &better_extra);
                if better <= system.backward_error(rhs, &values, &extra) {
                    (values, extra) = (better_values, better_extra);
                }
            }
            let left = norm(&system.residual_of(rhs, &values, &extra));
            info.residual = left / norm(rhs).max(f64::MIN_POSITIVE);
            info.backward_error = system.backward_error(rhs, &values, &extra);
        }
        info.iterations = products;
        Ok(BorderedSolution { values, extra, info })
    }
}

/// `None` where multigrid does not find the responses.
fn coupled(system: &Bordered, params: &SolverParams) -> Result<Option<(Prepared, Coupled)>, SolveError> {
    let (matrix, factors) = coupled::matrix(system);
    let prepared = Prepared::multigrid(&matrix, factors, params)?;
    let coupled = prepared.levels().and_then(|levels| Coupled::new(system, &levels).ok());
    Ok(coupled.map(|coupled| (prepared, coupled)))
}

impl Eliminated {
    fn new(system: &Bordered, params: &SolverParams) -> Result<Self, SolveError> {
        let prepared = Prepared::new(&system.pinned_matrix(), params)?;
        let mut schur = system.corner();
        let mut responses = Vec::with_capacity(system.extra());
        let mut products = 0;
        for (k, column) in system.columns().iter().enumerate() {
            let mut b = vec![0.0; system.n()];
            column.iter().for_each(|&(row, value)| b[row as usize] += value);
            let (x, info) = prepared.solve(&system.without_pinned(b))?;
            products += info.iterations;
            for (l, value) in system.border_rows(&x).into_iter().enumerate() {
                schur[l][k] -= value;
            }
            responses.push(x);
        }
        Ok(Self { prepared, responses, schur: DenseLu::new(schur)?, products })
    }

    fn solve(&self, system: &Bordered, b: &[f64]) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        let (mut w, info) = self.prepared.solve(&system.without_pinned(b.to_vec()))?;
        let carried = system.border_rows(&w);
        let g: Vec<f64> = system.pinned().iter().zip(&carried).map(|(&p, row)| b[p as usize] - row).collect();
        let extra = self.schur.solve(&g);
        for (x, c) in self.responses.iter().zip(&extra) {
            axpy(-c, x, &mut w);
        }
        Ok((w, extra, info))
    }
}
