//! A bordered system solved as one: GMRES on all equations, preconditioned by multigrid in nodal values.
//!
//! The unknowns are those of [`coupled`](super::coupled), `s w` and, at the pinned nodes, the constants. Multigrid knows neither: it
//! is set up for the matrix as it acts on u, in which a stiff region keeps its weak bonds on every level, and its answer is taken
//! apart afterwards. So no node is pinned on coarse levels, no response has to be solved for, and nothing large multiplies what is
//! rounded: products and residuals are formed in `s w` and constants. What is rounded is the answer of the preconditioner, by
//! `1e-16 / s` of it; GMRES is flexible for that reason.
//!
//! A pure Neumann problem has the incompatibility as one more unknown. Its matrix in nodal values is singular, which multigrid is
//! right with: the coarsest level sees to the constant. What is to be taken from the equations is told by their sum, which is exact
//! where rows are balances; where not, the preconditioner differs from a better one by a matrix of rank one.

use super::all_rows::AllRows;
use super::bordered::Bordered;
use super::joined::take_extra;
use super::split::Split;
use crate::csr::for_each_row;
use crate::multigrid::{HierarchyInfo, Multigrid, Scaling};
use crate::precond::Preconditioner;
use crate::solver::{SolveError, SolveInfo, SolverParams, levels_of};
use std::sync::Arc;

/// The smallest scale for which rounding leaves the preconditioner three digits.
const LEAST_SCALE: f64 = 1e-13;

/// Part of the sizes of its coefficients that those of the incompatibility must add up to.
const ONE_SIGN: f64 = 0.1;

/// The split by which nodal values are taken apart, if the system has one and it is for this solver.
pub(super) fn split(system: &Bordered) -> Option<&Split> {
    let told_by_sum = |split: &&Split| {
        system.columns().get(split.extra()).is_none_or(|column| {
            let sum = |f: fn(f64) -> f64| column.iter().map(|entry| f(entry.1)).sum::<f64>();
            sum(|v| v).abs() > ONE_SIGN * sum(f64::abs)
        })
    };
    system.split().filter(|_| system.scales().iter().all(|&s| s >= LEAST_SCALE)).filter(told_by_sum)
}

/// Levels for the matrix as it acts on u, which share the rows of the system.
#[derive(Debug)]
pub(super) struct Nodal {
    multigrid: Multigrid,
    /// What the rows are multiplied by.
    factors: Arc<[f64]>,
}

impl Nodal {
    /// # Errors
    /// Those of [`Multigrid::new`].
    pub(super) fn new(system: &Bordered, params: &SolverParams) -> Result<Self, SolveError> {
        let factors: Arc<[f64]> = Arc::from(system.factors());
        let unknowns = system.shared_scales();
        let scaling = Scaling { rows: Arc::clone(&factors), unknowns, ..Scaling::default() };
        let multigrid = Multigrid::of(system.shared_matrix(), scaling, &levels_of(system.matrix(), params))?;
        Ok(Self { multigrid, factors })
    }

    pub(super) fn hierarchy(&self) -> &HierarchyInfo {
        self.multigrid.info()
    }

    /// `w` and `c` for a right-hand side.
    ///
    /// # Errors
    /// [`SolveError::NoConvergence`] where the iteration stagnates.
    pub(super) fn solve(
        &self,
        system: &Bordered,
        split: &Split,
        rhs: &[f64],
        params: &SolverParams,
    ) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        let product = |x: &[f64], y: &mut [f64]| self.multiply(system, x, y);
        let balance = Balance::of(system, split, &self.factors);
        let preconditioner = Apart { split, multigrid: &self.multigrid, balance };
        AllRows { system, factors: &self.factors, product: &product }.solve(&preconditioner, rhs, params)
    }

    /// `y = A x` for all equations, their rows scaled.
    fn multiply(&self, system: &Bordered, x: &[f64], y: &mut [f64]) {
        // The constants stand where `s w` is zero.
        let mut w = x.to_vec();
        let extra = take_extra(system, &mut w);
        system.unscale(&mut w);
        for_each_row(y, |i, y| *y = self.factors[i] * system.matrix().row_product(i, &w));
        for (c, column) in extra.iter().zip(system.columns()) {
            for &(i, v) in column {
                y[i as usize] += self.factors[i as usize] * v * c;
            }
        }
    }
}

/// The incompatibility of a pure Neumann problem.
#[derive(Debug)]
struct Balance<'a> {
    /// Its coefficients in the equations: row, value.
    column: &'a [(u32, f64)],
    /// What the rows are multiplied by.
    factors: &'a [f64],
    /// The node where u = 0.
    pinned: usize,
    /// The sum of the coefficients.
    sum: f64,
}

impl<'a> Balance<'a> {
    /// `None` where all extra unknowns are constants of clusters.
    fn of(system: &'a Bordered, split: &Split, factors: &'a [f64]) -> Option<Self> {
        let (column, &pinned) = (system.columns().get(split.extra())?, system.pinned().last()?);
        let sum = column.iter().map(|entry| entry.1).sum();
        Some(Self { column, factors, pinned: pinned as usize, sum })
    }

    /// Takes the incompatibility out of a residual, and gives it.
    fn take(&self, r: &mut [f64]) -> f64 {
        let lambda = r.iter().zip(self.factors).map(|(r, f)| r / f).sum::<f64>() / self.sum;
        self.column.iter().for_each(|&(i, v)| r[i as usize] -= lambda * v * self.factors[i as usize]);
        lambda
    }
}

/// Multigrid, with what it answers taken apart.
#[derive(Debug)]
struct Apart<'a> {
    split: &'a Split,
    multigrid: &'a Multigrid,
    balance: Option<Balance<'a>>,
}

impl Preconditioner for Apart<'_> {
    fn name(&self) -> String {
        self.multigrid.name()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], scratch: &mut [f64]) {
        let last = self.balance.as_ref().map(|balance| {
            let (balanced, scratch) = scratch.split_at_mut(r.len());
            balanced.copy_from_slice(r);
            let lambda = balance.take(balanced);
            self.multigrid.apply(balanced, z, scratch);
            let level = z[balance.pinned];
            z.iter_mut().for_each(|u| *u -= level);
            (balance.pinned, lambda)
        });
        if last.is_none() {
            self.multigrid.apply(r, z, scratch);
        }
        let constants = self.split.take_constants(z);
        self.split.pinned().iter().zip(constants).for_each(|(&p, c)| z[p as usize] = c);
        if let Some((pinned, lambda)) = last {
            z[pinned] = lambda;
        }
    }

    fn scratch_len(&self) -> usize {
        let balanced = self.balance.as_ref().map_or(0, |balance| balance.factors.len());
        balanced + self.multigrid.scratch_len()
    }

    fn is_linear(&self) -> bool {
        false
    }
}
