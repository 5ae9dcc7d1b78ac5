//! A bordered system solved by elimination of its extra unknowns.

use super::bordered::{Bordered, BorderedSolution};
use super::dense::DenseLu;
use crate::multigrid::HierarchyInfo;
use crate::solver::{NEAR, Prepared, ROUND_OFF, SolveError, SolveInfo, SolverKind, SolverParams};
use crate::vector::{axpy, norm};

/// Steps of refinement at most: one is the rule.
const REFINEMENTS: usize = 4;

/// What a step must leave of the residual for another one to follow.
const GAIN: f64 = 0.5;

/// One solve of `A'` for each extra unknown and one for the right-hand side, and the Schur complement `D - C A'^-1 B'` by
/// Gaussian elimination.
#[derive(Debug)]
pub(super) struct Eliminated {
    /// For `A'`.
    prepared: Prepared,
    /// `A'^-1 B'`, column by column.
    responses: Vec<Vec<f64>>,
    schur: DenseLu,
    /// What rows are multiplied by to be compared.
    factors: Vec<f64>,
    /// Norm of the column of each extra unknown, its rows multiplied by the factors.
    columns: Vec<f64>,
    tolerance: f64,
    direct: bool,
    /// Products that the responses took.
    pub(super) products: usize,
}

impl Eliminated {
    /// # Errors
    /// Those of [`Prepared`], and [`SolveError::Undetermined`].
    pub(super) fn new(system: &Bordered, params: &SolverParams) -> Result<Self, SolveError> {
        let prepared = match system.extra() {
            0 => Prepared::of_rows(system.shared_matrix(), params)?,
            _ => Prepared::new(&system.pinned_matrix(), params)?,
        };
        let factors = if system.extra() > 0 { system.factors() } else { Vec::new() };
        let mut schur = system.corner();
        let (mut responses, mut columns) = (Vec::new(), Vec::new());
        let mut products = 0;
        for (k, column) in system.columns().iter().enumerate() {
            let mut b = vec![0.0; system.n()];
            column.iter().for_each(|&(row, value)| b[row as usize] += value);
            columns.push(scaled_norm(&b, &factors));
            let (x, info) = prepared.solve(&system.without_pinned(b))?;
            products += info.iterations;
            for (l, value) in system.border_rows(&x).into_iter().enumerate() {
                schur[l][k] -= value;
            }
            responses.push(x);
        }
        let direct = params.kind == SolverKind::Direct;
        let (schur, tolerance) = (DenseLu::new(schur)?, params.tolerance);
        Ok(Self { prepared, responses, schur, factors, columns, tolerance, direct, products })
    }

    pub(super) fn hierarchy(&self) -> Option<&HierarchyInfo> {
        self.prepared.hierarchy()
    }

    /// Solves, and refines until the residual is what the tolerance promises, or stagnates.
    ///
    /// # Errors
    /// Those of [`Prepared::solve`]; [`SolveError::NoConvergence`] where refinement stagnates above what an iterative solver
    /// promised (see [`Eliminated::is_promised`]). Factors promise nothing: what they leave is rounding.
    pub(super) fn solve(&self, system: &Bordered, rhs: &[f64]) -> Result<BorderedSolution, SolveError> {
        let (mut values, mut extra, mut info) = self.once(system, rhs)?;
        if system.extra() == 0 {
            return Ok(BorderedSolution { values, extra, info });
        }
        let mut residual = system.residual_of(rhs, &values, &extra);
        let mut size = scaled_norm(&residual, &self.factors);
        let unit = scaled_norm(rhs, &self.factors).max(f64::MIN_POSITIVE);
        for _step in 0..REFINEMENTS {
            // What is left may be rounding that an iterative method cannot reduce: then the solution stays as it is.
            let Ok((d_values, d_extra, d_info)) = self.once(system, &residual) else { break };
            info.iterations += d_info.iterations;
            let better_values: Vec<f64> = values.iter().zip(&d_values).map(|(a, b)| a + b).collect();
            let better_extra: Vec<f64> = extra.iter().zip(&d_extra).map(|(a, b)| a + b).collect();
            let better_residual = system.residual_of(rhs, &better_values, &better_extra);
            let better = scaled_norm(&better_residual, &self.factors);
            let gained = better <= GAIN * size;
            if better <= size {
                (values, extra, residual, size) = (better_values, better_extra, better_residual, better);
            }
            if !gained || size <= self.tolerance * unit {
                break;
            }
        }
        info.residual = size / unit;
        info.backward_error = system.backward_error(rhs, &values, &extra);
        if self.direct || self.is_promised(size, unit, &extra, info.backward_error) {
            return Ok(BorderedSolution { values, extra, info });
        }
        Err(SolveError::NoConvergence {
            solver: format!("elimination of {} constants by {}", extra.len(), info.name),
            reason: "refinement of the whole stagnates",
            residual: info.residual,
            tolerance: self.tolerance,
            iterations: info.iterations,
            best: values,
        })
    }

    /// Whether a residual is what solves to the tolerance lead to: the parts of the solution, `A'^-1 b'` and `c_k A'^-1 B'_k`,
    /// leave a residual of the tolerance times the norms of `b` and `c_k B_k`, all with scaled rows. Or rounding alone is left
    /// of it, as in [`Criterion::RoundOff`](crate::Criterion::RoundOff).
    fn is_promised(&self, size: f64, unit: f64, extra: &[f64], backward_error: f64) -> bool {
        let parts: f64 = self.columns.iter().zip(extra).map(|(b, c)| b * c.abs()).sum();
        size <= self.tolerance * (unit + parts)
            || (backward_error <= ROUND_OFF && size <= NEAR * self.tolerance * unit)
    }

    fn once(&self, system: &Bordered, b: &[f64]) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        if system.extra() == 0 {
            return self.prepared.solve(b).map(|(w, info)| (w, Vec::new(), info));
        }
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

fn scaled_norm(x: &[f64], factors: &[f64]) -> f64 {
    norm(&x.iter().zip(factors).map(|(x, f)| x * f).collect::<Vec<f64>>())
}
