//! Rows without du/dt beside rows whose mass is not diagonal: values that fulfil them, and rates that keep them fulfilled.
//!
//! `M du/dt + A u = b(t)`, where M has rows that are zero, is of index 1: with these rows of A in the place of those of M the
//! matrix is regular. So the values of the other nodes determine all, and rates follow from `M du/dt = b - A u` and from the
//! derivative of the algebraic rows in time, `A du/dt = db/dt - dA/dt u`.

use meshless_sparse::{DifferenceMatrix, SolverKind, SolverParams};

use super::mass::{Columns, Mass, MassRows};
use super::{PreparedSystem, SystemParams};
use crate::method::SplitRows;
use crate::{Discretization, MethodError, Problem, RowKind};

impl Mass {
    /// The rows that get a part in others by M and have none of their own, prescribed values aside.
    pub fn algebraic(&self) -> impl Iterator<Item = usize> + '_ {
        let rows = match self {
            Self::Diagonal(_) => &[][..],
            Self::Rows(rows) => rows.algebraic.as_slice(),
        };
        rows.iter().enumerate().filter(|(_, algebraic)| **algebraic).map(|(i, _)| i)
    }

    /// Values that fulfil the algebraic rows and those of further unknowns, and are those of `u` at all other nodes.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn consistent<const D: usize>(
        &self,
        problem: &Problem<'_, D>,
        discretization: &Discretization,
        u: &[f64],
        solver: &SolverParams,
    ) -> Result<Vec<f64>, MethodError> {
        let Self::Rows(mass) = self else { return further_unknowns(problem, discretization, u, solver) };
        if self.algebraic().next().is_none() {
            return Ok(u.to_vec());
        }
        let identity = DifferenceMatrix::from_rows(u.len(), |_, out| out.add_to_row_sum(1.0))?;
        let own = match &discretization.constants {
            Some(constants) => {
                let own = constants.split.apply(&identity, u)?;
                (own.matrix().clone(), Some(own.columns().to_vec()))
            }
            None => (identity, None),
        };
        let mut given = u.to_vec();
        self.algebraic().for_each(|i| given[i] = discretization.rhs[i]);
        mass.solve(problem, discretization, (&own.0, own.1.as_ref()), |_| 1.0, given, solver)
    }

    /// The rates with `M du/dt = r`; `given` are those of the nodes whose values are prescribed, and what algebraic rows
    /// of `A du/dt` are.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn rates<const D: usize>(
        &self,
        problem: &Problem<'_, D>,
        discretization: &Discretization,
        residual: &[f64],
        given: &[f64],
        solver: &SolverParams,
    ) -> Result<Vec<f64>, MethodError> {
        let mass = match self {
            Self::Diagonal(mass) => {
                let rate = |(m, r): (&f64, &f64)| if *m > 0.0 { r / m } else { 0.0 };
                return Ok(mass.iter().zip(residual).map(rate).collect());
            }
            Self::Rows(mass) => mass,
        };
        let kinds = &discretization.kinds;
        let is_given = |i: usize| kinds[i] == RowKind::Dirichlet || mass.algebraic[i];
        let rhs = (0..kinds.len()).map(|i| if is_given(i) { given[i] } else { residual[i] }).collect();
        let own = match (&mass.split, self.algebraic().next()) {
            (Some((rows, columns)), Some(_)) => (rows, Some(columns)),
            _ => (&mass.nodal, None),
        };
        let size = |i: usize| discretization.volumes[i];
        mass.solve(problem, discretization, own, size, rhs, solver)
    }
}

impl MassRows {
    /// Solves rows of one size over the unknowns of the method, with the algebraic ones in their places; returns nodal values.
    fn solve<const D: usize>(
        &self,
        problem: &Problem<'_, D>,
        discretization: &Discretization,
        (own, columns): (&DifferenceMatrix, Option<&Columns>),
        size: impl Fn(usize) -> f64 + Sync,
        mut rhs: Vec<f64>,
        solver: &SolverParams,
    ) -> Result<Vec<f64>, MethodError> {
        let Discretization { rows, kinds, .. } = discretization;
        // Algebraic rows are of the size of fluxes.
        let scale = |i: usize| {
            let total: f64 = rows.row(i).1.iter().map(|a| a.abs()).sum();
            size(i) / (total + rows.row_sum(i).abs())
        };
        let scales: Vec<f64> =
            self.algebraic.iter().enumerate().map(|(i, &a)| if a { scale(i) } else { 1.0 }).collect();
        rhs.iter_mut().zip(&scales).for_each(|(b, scale)| *b *= scale);
        let matrix = DifferenceMatrix::from_rows(kinds.len(), |i, out| {
            let source = if self.algebraic[i] { rows } else { own };
            let (neighbors, values) = source.row(i);
            neighbors.iter().zip(values).for_each(|(&j, a)| out.push(j as usize, scales[i] * a));
            out.add_to_row_sum(scales[i] * source.row_sum(i));
        })?;
        let known: Vec<bool> = kinds.iter().map(|&kind| kind == RowKind::Dirichlet).collect();
        // The diagonal outweighs the rest: multigrid has nothing to do here.
        let kind = match solver.kind {
            SolverKind::Direct => SolverKind::Direct,
            _ => SolverKind::Gmres { restart: 30 },
        };
        let params = SystemParams { solver: SolverParams { kind, ..*solver }, split_floating: false };
        let system = match (columns, &discretization.constants) {
            (Some(columns), Some(constants)) => {
                let constants = self.columns(columns, constants, &scales);
                PreparedSystem::with_constants(&matrix, &constants, &known, &params)?
            }
            _ => PreparedSystem::new(problem, &matrix, &known, &params)?,
        };
        Ok(system.solve(&rhs)?.0)
    }

    fn columns(&self, own: &Columns, constants: &SplitRows, scales: &[f64]) -> SplitRows {
        let column = |k: usize| {
            let (own, of_rows) = (&own[k], &constants.columns[k]);
            let own = own.iter().filter(|(row, _)| !self.algebraic[*row as usize]).copied();
            let algebraic = of_rows.iter().filter(|(row, _)| self.algebraic[*row as usize]);
            own.chain(algebraic.map(|&(row, value)| (row, scales[row as usize] * value))).collect()
        };
        SplitRows { columns: (0..own.len()).map(column).collect(), ..constants.clone() }
    }
}

/// What the values of the nodes make of the further unknowns that rows have.
fn further_unknowns<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    u: &[f64],
    solver: &SolverParams,
) -> Result<Vec<f64>, MethodError> {
    let Discretization { rows, kinds, .. } = discretization;
    let nodes = kinds.len();
    if rows.n() == nodes {
        return Ok(u.to_vec());
    }
    let matrix = DifferenceMatrix::from_rows(rows.n(), |i, out| {
        if i < nodes {
            return out.add_to_row_sum(1.0);
        }
        let (columns, values) = rows.row(i);
        columns.iter().zip(values).for_each(|(&j, a)| out.push(j as usize, *a));
        out.add_to_row_sum(rows.row_sum(i));
    })?;
    let given: Vec<f64> = u[..nodes].iter().chain(&discretization.rhs[nodes..]).copied().collect();
    let known: Vec<bool> = (0..rows.n()).map(|i| i < nodes).collect();
    let params = SystemParams { solver: *solver, split_floating: false };
    Ok(PreparedSystem::new(problem, &matrix, &known, &params)?.solve(&given)?.0)
}
