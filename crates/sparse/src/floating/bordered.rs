//! Systems with a few extra unknowns, solved by block elimination.

use super::prepared::PreparedBordered;
use super::split::Split;
use crate::csr::{Csr, for_each_row};
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::solver::{SolveError, SolveInfo, SolverParams};
use std::sync::Arc;

/// `A w + B c = b` in `n` equations for `n` values `w` and `m` extra unknowns `c`, where `w = 0` at `m` pinned nodes.
///
/// It is solved as
/// ```text
/// [ A'  B' ] [w]   [b']
/// [ C   D  ] [c] = [g ]
/// ```
/// where `A'` has the equations of the pinned nodes replaced by `w = 0`, and these equations are the rows of `C`, `D`,
/// `g`. `A` is kept in difference form, so that residuals are accurate.
#[derive(Debug, Clone, PartialEq)]
pub struct Bordered {
    matrix: Arc<DifferenceMatrix>,
    /// Entries of each column of `B`: row, value.
    columns: Vec<Vec<(u32, f64)>>,
    pinned: Vec<u32>,
    rhs: Vec<f64>,
    /// `s`, see [`Bordered::with_scales`]; empty where all are 1.
    scales: Arc<[f64]>,
    /// How nodal values are made of all unknowns, where that is known.
    split: Option<Split>,
}

/// Solution of a [`Bordered`] system.
#[derive(Debug, Clone, PartialEq)]
pub struct BorderedSolution {
    /// `w`
    pub values: Vec<f64>,
    /// `c`
    pub extra: Vec<f64>,
    /// How the last system with `A'` was solved; products of all of them; residual and backward error of the whole
    /// bordered system.
    pub info: SolveInfo,
}

impl Bordered {
    /// `columns[k]` has the entries (row, value) of extra unknown `k`, `pinned[k]` is the node whose `w` is 0 for it.
    ///
    /// # Errors
    /// Lengths that do not fit, rows out of range, a node pinned twice, numbers that are not finite.
    pub fn new(
        matrix: impl Into<Arc<DifferenceMatrix>>,
        columns: Vec<Vec<(u32, f64)>>,
        pinned: Vec<u32>,
        rhs: Vec<f64>,
    ) -> Result<Self, MatrixError> {
        let matrix = matrix.into();
        MatrixError::check_length("right-hand side", rhs.len(), matrix.n())?;
        MatrixError::check_finite("right-hand side", &rhs)?;
        MatrixError::check_length("pinned nodes", pinned.len(), columns.len())?;
        for (row, value) in columns.iter().flatten().map(|&(row, value)| (row as usize, value)) {
            if row >= matrix.n() {
                return Err(MatrixError::RowOutOfRange { row, nrows: matrix.n() });
            }
            if !value.is_finite() {
                return Err(MatrixError::BadNumber {
                    what: "coefficient of an extra unknown",
                    node: row,
                    value,
                });
            }
        }
        for (cluster, node) in pinned.iter().enumerate() {
            if *node as usize >= matrix.n() {
                return Err(MatrixError::RowOutOfRange { row: *node as usize, nrows: matrix.n() });
            }
            if pinned[..cluster].contains(node) {
                return Err(MatrixError::NoPin {
                    cluster,
                    reason: "its node is pinned for another one already",
                });
            }
        }
        Ok(Self { matrix, columns, pinned, rhs, scales: Arc::default(), split: None })
    }

    /// The same, with the scales `s` of the values: fields that are smooth and cheap are smooth in `s w`, not in `w`, and
    /// multigrid has to know. [`Split::apply`](crate::Split::apply) gives its own.
    ///
    /// # Errors
    /// [`MatrixError::Length`], and [`MatrixError::BadNumber`] for a scale that is not positive and finite.
    pub fn with_scales(mut self, scales: Vec<f64>) -> Result<Self, MatrixError> {
        MatrixError::check_length("scales", scales.len(), self.n())?;
        if let Some(node) = scales.iter().position(|s| !(*s > 0.0 && s.is_finite())) {
            return Err(MatrixError::BadNumber { what: "scale of the node", node, value: scales[node] });
        }
        self.scales = if scales.iter().all(|&s| s == 1.0) { Arc::default() } else { Arc::from(scales) };
        Ok(self)
    }

    /// The same, with the split that tells what `w` and `c` make of nodal values, and its scales: multigrid is set up in nodal
    /// values then. The extra unknowns are the constants of its clusters; one more may follow, which takes up what is not
    /// balanced in a pure Neumann problem. A method that makes rows over `w` and `c` itself says so by this; its columns must be what
    /// a shift of all `w` of a cluster by `-1 / s` amounts to, up to rounding. [`Split::apply`](crate::Split::apply) gives its own.
    ///
    /// # Errors
    /// [`MatrixError::Length`], and [`MatrixError::NoPin`] where the split pins other nodes.
    pub fn with_split(self, split: Split) -> Result<Self, MatrixError> {
        if self.extra() != split.extra() + 1 {
            MatrixError::check_length("pinned nodes of the split", split.pinned().len(), self.extra())?;
        }
        if let Some(cluster) = split.pinned().iter().zip(&self.pinned).position(|(a, b)| a != b) {
            return Err(MatrixError::NoPin {
                cluster,
                reason: "another node than that of the split is pinned",
            });
        }
        let scaled = self.with_scales(split.scales())?;
        let split = (scaled.extra() > 0).then_some(split);
        Ok(Self { split, ..scaled })
    }

    pub(super) fn split(&self) -> Option<&Split> {
        self.split.as_ref()
    }

    /// The scales, see [`Bordered::with_scales`]; empty where all are 1.
    #[must_use]
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// The scales, to be shared.
    pub(super) fn shared_scales(&self) -> Arc<[f64]> {
        Arc::clone(&self.scales)
    }

    /// `x` becomes `s x`.
    pub(super) fn scale(&self, x: &mut [f64]) {
        x.iter_mut().zip(&*self.scales).for_each(|(x, s)| *x *= s);
    }

    /// `x` becomes `x / s`.
    pub(super) fn unscale(&self, x: &mut [f64]) {
        x.iter_mut().zip(&*self.scales).for_each(|(x, s)| *x /= s);
    }

    /// `1 / s` of a node.
    pub(super) fn inverse_scale(&self, i: usize) -> f64 {
        self.scales.get(i).map_or(1.0, |s| 1.0 / s)
    }

    /// Number of values `w`.
    #[must_use]
    pub fn n(&self) -> usize {
        self.rhs.len()
    }

    /// Number of extra unknowns `c`.
    #[must_use]
    pub fn extra(&self) -> usize {
        self.pinned.len()
    }

    /// The matrix `A`, before any equation is replaced.
    #[must_use]
    pub fn matrix(&self) -> &DifferenceMatrix {
        &self.matrix
    }

    /// The columns of `B` as (row, value).
    #[must_use]
    pub fn columns(&self) -> &[Vec<(u32, f64)>] {
        &self.columns
    }

    /// The right-hand side, one element for each equation.
    #[must_use]
    pub fn rhs(&self) -> &[f64] {
        &self.rhs
    }

    /// The node for each extra unknown where `w = 0`.
    #[must_use]
    pub fn pinned(&self) -> &[u32] {
        &self.pinned
    }

    /// Powers of two by which rows are multiplied for their entries to count alike, those of the nodes as they act on `w`:
    /// in stiff regions they would count for nothing otherwise.
    pub(super) fn factors(&self) -> Vec<f64> {
        self.matrix.balancing_factors()
    }

    /// The matrix `A`, to be shared.
    pub(super) fn shared_matrix(&self) -> Arc<DifferenceMatrix> {
        Arc::clone(&self.matrix)
    }

    /// The extra unknown for which a node is pinned, by node.
    pub(super) fn pin_of(&self) -> Vec<Option<u32>> {
        let mut pin_of = vec![None; self.n()];
        (0..).zip(&self.pinned).for_each(|(k, &p)| pin_of[p as usize] = Some(k));
        pin_of
    }

    /// `D`: row `l` has the coefficients of the extra unknowns in the equation of pinned node `l`.
    pub(super) fn corner(&self) -> Vec<Vec<f64>> {
        let pin_of = self.pin_of();
        let mut corner = vec![vec![0.0; self.extra()]; self.extra()];
        for (k, column) in self.columns.iter().enumerate() {
            for &(row, value) in column {
                if let Some(l) = pin_of[row as usize] {
                    corner[l as usize][k] += value;
                }
            }
        }
        corner
    }

    /// The matrix `A'`: the equations of the pinned nodes replaced by `w = 0`.
    #[must_use]
    pub fn pinned_matrix(&self) -> Csr {
        let a = self.matrix.to_csr();
        let mut is_pinned = vec![false; self.n()];
        self.pinned.iter().for_each(|&p| is_pinned[p as usize] = true);
        let mut offsets = vec![0];
        let (mut indices, mut values) = (Vec::with_capacity(a.nnz()), Vec::with_capacity(a.nnz()));
        for i in 0..self.n() {
            let (columns, row) = a.row(i);
            if is_pinned[i] {
                indices.push(i as u32);
                values.push(1.0);
            } else {
                indices.extend_from_slice(columns);
                values.extend_from_slice(row);
            }
            offsets.push(indices.len());
        }
        Csr::from_trusted(self.n(), offsets, indices, values)
    }

    /// The right-hand side that belongs to [`Bordered::pinned_matrix`].
    #[must_use]
    pub fn pinned_rhs(&self) -> Vec<f64> {
        self.without_pinned(self.rhs.clone())
    }

    /// Solves the system, see [`PreparedBordered`].
    ///
    /// # Errors
    /// Those of [`solve`](crate::solve), and [`SolveError::Undetermined`] where the equations leave an extra unknown
    /// open.
    pub fn solve(&self, params: &SolverParams) -> Result<BorderedSolution, SolveError> {
        let prepared = PreparedBordered::new(self.clone(), params)?;
        let mut solution = prepared.solve(&self.rhs)?;
        solution.info.iterations += prepared.products();
        Ok(solution)
    }

    /// `b - A w - B c`, by differences.
    #[must_use]
    pub fn residual(&self, values: &[f64], extra: &[f64]) -> Vec<f64> {
        self.residual_of(&self.rhs, values, extra)
    }

    pub(super) fn residual_of(&self, rhs: &[f64], values: &[f64], extra: &[f64]) -> Vec<f64> {
        let mut r = vec![0.0; self.n()];
        self.residual_into(rhs, values, extra, &mut r);
        r
    }

    pub(super) fn residual_into(&self, rhs: &[f64], values: &[f64], extra: &[f64], r: &mut [f64]) {
        self.matrix.residual(values, rhs, r);
        for (column, c) in self.columns.iter().zip(extra) {
            for &(row, value) in column {
                r[row as usize] -= value * c;
            }
        }
    }

    /// Largest residual relative to the sum of the sizes of the terms of its equation.
    pub(super) fn backward_error(&self, rhs: &[f64], values: &[f64], extra: &[f64]) -> f64 {
        let r = self.residual_of(rhs, values, extra);
        let mut size = vec![0.0; self.n()];
        for_each_row(&mut size, |i, size| {
            let (columns, row) = self.matrix.row(i);
            let terms = columns.iter().zip(row).map(|(&j, a)| (a * values[j as usize]).abs());
            *size = rhs[i].abs() + terms.sum::<f64>() + (self.matrix.diagonal(i) * values[i]).abs();
        });
        for (column, c) in self.columns.iter().zip(extra) {
            for &(row, value) in column {
                size[row as usize] += (value * c).abs();
            }
        }
        let ratio = r.iter().zip(&size).map(|(r, s)| if *s == 0.0 { 0.0 } else { r.abs() / s });
        ratio.fold(0.0, |m: f64, v| if v > m || v.is_nan() { v } else { m })
    }

    /// `(A w)_p` for each pinned node.
    pub(super) fn border_rows(&self, w: &[f64]) -> Vec<f64> {
        let row = |&p: &u32| {
            let p = p as usize;
            let (columns, values) = self.matrix.row(p);
            let sum: f64 = columns.iter().zip(values).map(|(&j, a)| a * (w[j as usize] - w[p])).sum();
            sum + self.matrix.row_sum(p) * w[p]
        };
        self.pinned.iter().map(row).collect()
    }

    pub(super) fn without_pinned(&self, mut b: Vec<f64>) -> Vec<f64> {
        self.pinned.iter().for_each(|&p| b[p as usize] = 0.0);
        b
    }
}
