//! A bordered system solved as one: GMRES on all equations, multigrid for those of the nodes, the Schur complement of a
//! rough response to every extra unknown for the others.
//!
//! The vectors have one element for each node. As `w = 0` at the pinned nodes, their elements hold the extra unknowns, and
//! the residuals of their equations. At the others, the unknown is `s w`, because prolongation takes constants for smooth:
//! at moderate contrasts aggregates cross interfaces, where `w` jumps and `s w` does not.

use super::bordered::Bordered;
use super::dense::DenseLu;
use crate::csr::Csr;
use crate::multigrid::Multigrid;
use crate::precond::Preconditioner;
use crate::solver::{
    AUTO_RESTART, Levels, LinearOperator, Method, PATIENCE, System, iterate, reciprocal_power,
};
use crate::solver::{SolveError, SolveInfo, SolverParams};
use crate::vector::axpy;

/// Residual to which the responses are solved for. They only precondition: with 1e-2 the coupled iteration takes as many
/// steps as with exact ones (`docs/multigrid.md`).
const RESPONSE: f64 = 1e-2;

const METHOD: Method = Method::Gmres { restart: AUTO_RESTART };

/// The matrix `[A' B'; 0 1]` with the column of each extra unknown in the place of its pinned node, whose own column has
/// only zeros to multiply: what multigrid is set up for, and all rows of the coupled matrix but those of the pinned nodes.
/// And factors of the rows, by the sizes of their entries before the change of unknowns: in stiff regions they would
/// count for nothing otherwise.
pub(super) fn matrix(system: &Bordered) -> (Csr, Vec<f64>) {
    let a = system.matrix().to_csr();
    let pin_of = system.pin_of();
    let mut entries: Vec<(u32, u32, f64)> = Vec::new();
    for (&p, column) in system.pinned().iter().zip(system.columns()) {
        entries.extend(column.iter().map(|&(row, value)| (row, p, value)));
    }
    entries.sort_unstable_by_key(|e| (e.0, e.1));
    let (mut offsets, mut factors) = (vec![0], Vec::with_capacity(a.nrows()));
    let (mut indices, mut values) = (Vec::with_capacity(a.nnz()), Vec::with_capacity(a.nnz()));
    let mut next = 0;
    for i in 0..a.nrows() {
        let start = next;
        while entries.get(next).is_some_and(|e| e.0 as usize == i) {
            next += 1;
        }
        let (columns, row) = a.row(i);
        let largest = row.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        factors.push(if largest > 0.0 { reciprocal_power(largest) } else { 1.0 });
        if pin_of[i].is_some() {
            indices.push(i as u32);
            values.push(1.0);
        } else {
            let mut border = entries[start..next].iter().peekable();
            for (&j, &v) in columns.iter().zip(row).filter(|(j, _)| pin_of[**j as usize].is_none()) {
                while let Some(&&(_, p, value)) = border.peek().filter(|e| e.1 < j) {
                    push_sum(&mut indices, &mut values, offsets[i], p, value);
                    border.next();
                }
                indices.push(j);
                values.push(v * system.inverse_scale(j as usize));
            }
            border.for_each(|&(_, p, value)| push_sum(&mut indices, &mut values, offsets[i], p, value));
        }
        offsets.push(indices.len());
    }
    (Csr::from_trusted(a.nrows(), offsets, indices, values), factors)
}

/// Appends an entry to the row that began at `start`, or adds to its last one where that is of the same column.
fn push_sum(indices: &mut Vec<u32>, values: &mut Vec<f64>, start: usize, column: u32, value: f64) {
    match (indices[start..].last(), values.last_mut()) {
        (Some(&last), Some(sum)) if last == column => *sum += value,
        _ => {
            indices.push(column);
            values.push(value);
        }
    }
}

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
            column.iter().for_each(|&(row, value)| b[row as usize] += value * levels.factors[row as usize]);
            system.pinned().iter().for_each(|&p| b[p as usize] = 0.0);
            let (mut x, info) = iterate(METHOD, levels.matrix, levels.multigrid, &b, &rough)?;
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
        let operator = Operator { system, levels, corner: &self.corner };
        let preconditioner = Arrow { system, factors: levels.factors, multigrid: levels.multigrid, of: self };
        let b: Vec<f64> = rhs.iter().zip(levels.factors).map(|(b, f)| b * f).collect();
        let patient = SolverParams { max_iterations: params.max_iterations.min(PATIENCE), ..*params };
        let (mut x, info) = iterate(METHOD, &operator, &preconditioner, &b, &patient)?;
        let extra = take_extra(system, &mut x);
        system.unscale(&mut x);
        Ok((x, extra, info))
    }
}

/// Takes the extra unknowns out of the places of the pinned nodes, where `w` is zero.
fn take_extra(system: &Bordered, x: &mut [f64]) -> Vec<f64> {
    system.pinned().iter().map(|&p| std::mem::take(&mut x[p as usize])).collect()
}

/// The coupled matrix, its rows scaled.
struct Operator<'a> {
    system: &'a Bordered,
    levels: &'a Levels<'a>,
    corner: &'a [Vec<f64>],
}

impl LinearOperator for Operator<'_> {
    fn dim(&self) -> usize {
        self.system.n()
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        self.levels.matrix.mul_vec(x, y);
        let pinned = self.system.pinned();
        for (l, &p) in pinned.iter().enumerate() {
            let (columns, values) = self.system.matrix().row(p as usize);
            let nodes = columns.iter().zip(values).filter(|(j, _)| !pinned.contains(j));
            let sum: f64 =
                nodes.map(|(&j, a)| a * self.system.inverse_scale(j as usize) * x[j as usize]).sum();
            let border: f64 = pinned.iter().zip(&self.corner[l]).map(|(&q, d)| d * x[q as usize]).sum();
            y[p as usize] = self.levels.factors[p as usize] * (sum + border);
        }
    }
}

impl Operator<'_> {
    /// The unknowns and the right-hand side as [`Bordered`] has them.
    fn unscaled(&self, x: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let mut w = x.to_vec();
        let extra = take_extra(self.system, &mut w);
        self.system.unscale(&mut w);
        // Factors are powers of two: nothing is rounded.
        let rhs = b.iter().zip(self.levels.factors).map(|(b, f)| b / f).collect();
        (w, extra, rhs)
    }
}

impl System for Operator<'_> {
    fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        let (w, extra, rhs) = self.unscaled(x, b);
        self.system.residual_into(&rhs, &w, &extra, r);
        r.iter_mut().zip(self.levels.factors).for_each(|(r, f)| *r *= f);
    }

    fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        let (w, extra, rhs) = self.unscaled(x, b);
        self.system.backward_error(&rhs, &w, &extra)
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
