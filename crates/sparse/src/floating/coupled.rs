//! A bordered system solved as one: GMRES on all equations, multigrid for those of the nodes, the Schur complement of a
//! rough response to every extra unknown for the others.
//!
//! The elements of vectors that belong to pinned nodes hold the extra unknowns, and the residuals of their equations. At the
//! others, the unknown is `s w`, because prolongation takes constants for smooth: at moderate contrasts aggregates cross
//! interfaces, where `w` jumps and `s w` does not.

use super::all_rows::{AllRows, METHOD};
use super::bordered::Bordered;
use super::dense::DenseLu;
use crate::multigrid::Multigrid;
use crate::precond::Preconditioner;
use crate::solver::{Levels, LinearOperator, PATIENCE, SolveError, SolveInfo, SolverParams, iterate};
use crate::vector::axpy;

/// Residual to which the responses are solved for. They only precondition: with 1e-2 the coupled iteration takes as many
/// steps as with exact ones (`docs/multigrid.md`).
const RESPONSE: f64 = 1e-2;

/// What is computed once for all right-hand sides.
#[derive(Debug)]
pub(super) struct Coupled {
    /// Rough `A'^-1 B'`, column by column.
    responses: Vec<Vec<f64>>,
    schur: DenseLu,
    /// `D[l][k]`: coefficient of extra unknown `k` in the equation of pinned node `l`.
    corner: Vec<Vec<f64>>,
    /// Products that the responses took.
    pub(super) products: usize,
}

impl Coupled {
    /// # Errors
    /// A response that multigrid does not find, or [`SolveError::Undetermined`].
    pub(super) fn new(system: &Bordered, levels: &Levels<'_>) -> Result<Self, SolveError> {
        let rough = SolverParams { tolerance: RESPONSE, max_iterations: PATIENCE, ..SolverParams::default() };
        let m = system.extra();
        let corner = system.corner();
        let mut schur = corner.clone();
        let mut responses = Vec::with_capacity(m);
        let mut products = 0;
        for (k, column) in system.columns().iter().enumerate() {
            let mut b = vec![0.0; system.n()];
            column
                .iter()
                .for_each(|&(row, value)| b[row as usize] += value * levels.rows.factors[row as usize]);
            system.pinned().iter().for_each(|&p| b[p as usize] = 0.0);
            let (mut x, info) = iterate(METHOD, &levels.rows, levels.multigrid, &b, &rough)?;
            system.unscale(&mut x);
            products += info.iterations;
            for (l, value) in system.border_rows(&x).into_iter().enumerate() {
                schur[l][k] -= value;
            }
            responses.push(x);
        }
        Ok(Self { responses, schur: DenseLu::new(schur)?, corner, products })
    }

    /// `w` and `c` for a right-hand side.
    ///
    /// # Errors
    /// [`SolveError::NoConvergence`] where the iteration stagnates.
    pub(super) fn solve(
        &self,
        system: &Bordered,
        levels: &Levels<'_>,
        rhs: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        let product = |x: &[f64], y: &mut [f64]| self.multiply(system, levels, x, y);
        let factors = levels.rows.factors;
        let preconditioner = Arrow { system, factors, multigrid: levels.multigrid, of: self };
        AllRows { system, factors, product: &product }.solve(&preconditioner, rhs, params)
    }

    /// `y = A x` for the coupled matrix, its rows scaled.
    fn multiply(&self, system: &Bordered, levels: &Levels<'_>, x: &[f64], y: &mut [f64]) {
        levels.rows.apply(x, y);
        let pinned = system.pinned();
        for (l, &p) in pinned.iter().enumerate() {
            let (columns, values) = system.matrix().row(p as usize);
            let nodes = columns.iter().zip(values).filter(|(j, _)| !pinned.contains(j));
            let sum: f64 = nodes.map(|(&j, a)| a * system.inverse_scale(j as usize) * x[j as usize]).sum();
            let border: f64 = pinned.iter().zip(&self.corner[l]).map(|(&q, d)| d * x[q as usize]).sum();
            y[p as usize] = levels.rows.factors[p as usize] * (sum + border);
        }
    }
}

/// Block elimination with multigrid for `A'^-1`.
#[derive(Debug)]
struct Arrow<'a> {
    system: &'a Bordered,
    factors: &'a [f64],
    multigrid: &'a Multigrid,
    of: &'a Coupled,
}

impl Preconditioner for Arrow<'_> {
    fn name(&self) -> String {
        self.multigrid.name()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], scratch: &mut [f64]) {
        let pinned = self.system.pinned();
        let (t, scratch) = scratch.split_at_mut(r.len());
        t.copy_from_slice(r);
        pinned.iter().for_each(|&p| t[p as usize] = 0.0);
        self.multigrid.apply(t, z, scratch);
        pinned.iter().for_each(|&p| z[p as usize] = 0.0);
        self.system.unscale(z);
        let carried = self.system.border_rows(z);
        let rest = |(&p, row): (&u32, f64)| r[p as usize] / self.factors[p as usize] - row;
        let g: Vec<f64> = pinned.iter().zip(carried).map(rest).collect();
        let extra = self.of.schur.solve(&g);
        for (x, c) in self.of.responses.iter().zip(&extra) {
            axpy(-c, x, z);
        }
        self.system.scale(z);
        pinned.iter().zip(extra).for_each(|(&p, c)| z[p as usize] = c);
    }

    fn scratch_len(&self) -> usize {
        self.factors.len() + self.multigrid.scratch_len()
    }

    fn is_linear(&self) -> bool {
        self.multigrid.is_linear()
    }
}
