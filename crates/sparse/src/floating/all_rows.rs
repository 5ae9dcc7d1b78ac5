//! GMRES on all equations of a bordered system, whatever forms their products and preconditions them.

use super::bordered::Bordered;
use super::joined::{Equations, take_extra};
use crate::precond::Preconditioner;
use crate::solver::{AUTO_RESTART, LinearOperator, Method, PATIENCE, Residuals, iterate};
use crate::solver::{SolveError, SolveInfo, SolverParams};

pub(super) const METHOD: Method = Method::Gmres { restart: AUTO_RESTART };

/// All equations, their rows scaled, in `s w` and, at the pinned nodes, the extra unknowns.
pub(super) struct AllRows<'a> {
    pub(super) system: &'a Bordered,
    /// What the rows are multiplied by.
    pub(super) factors: &'a [f64],
    /// `y = A x`
    pub(super) product: &'a (dyn Fn(&[f64], &mut [f64]) + Sync),
}

impl AllRows<'_> {
    /// `w` and the extra unknowns for a right-hand side.
    ///
    /// # Errors
    /// [`SolveError::NoConvergence`] where the iteration stagnates.
    pub(super) fn solve(
        &self,
        preconditioner: &dyn Preconditioner,
        rhs: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        let b: Vec<f64> = rhs.iter().zip(self.factors).map(|(b, f)| b * f).collect();
        let patient = SolverParams { max_iterations: params.max_iterations.min(PATIENCE), ..*params };
        let (mut x, info) = iterate(METHOD, self, preconditioner, &b, &patient)?;
        let extra = take_extra(self.system, &mut x);
        self.system.unscale(&mut x);
        Ok((x, extra, info))
    }

    fn equations(&self) -> Equations<'_> {
        Equations { system: self.system, factors: self.factors, scaled: true }
    }
}

impl LinearOperator for AllRows<'_> {
    fn dim(&self) -> usize {
        self.system.n()
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        (self.product)(x, y);
    }
}

impl Residuals for AllRows<'_> {
    fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        self.equations().residual(x, b, r);
    }

    fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        self.equations().backward_error(x, b)
    }
}
