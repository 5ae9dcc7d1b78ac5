//! DC-PSE operators with immersed interfaces.
//!
//! N. Fiétier, Ö. Demirel, I. F. Sbalzarini, "A meshless particle method for Poisson and diffusion problems with
//! discontinuous coefficients and inhomogeneous boundary conditions". The equation is collocated at every node by a
//! DC-PSE operator that sees one region only: where its support reaches over an interface, the values there are those
//! of *ghosts*, which continue the field of the region. Ghosts are combinations of nodal values and are eliminated, so
//! that one sparse system over the nodes remains.

mod constrained;
mod foot;
mod ghosts;
mod image;
mod operators;
mod params;
mod reaction;
mod sides;

use std::time::Instant;

use meshless_sparse::{DifferenceMatrix, RowBuilder};

use crate::method::{Counts, Discretization, Method, RowKind};
use crate::operator_rows::OperatorRows;
use crate::{MethodError, Problem};
use constrained::Ghost;
use ghosts::GhostTable;
pub use params::{Ghosts, ImmersedParams, Interpolation};
pub use reaction::{Indicators, ReactionParams, ReactionSource, Share, Sigma, Smoothing, SurfaceReaction};

/// The immersed interface method.
#[derive(Debug, Clone, Copy, Default)]
pub struct ImmersedInterface {
    /// What was chosen.
    pub params: ImmersedParams,
}

impl<const D: usize> Method<D> for ImmersedInterface {
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        problem.check()?;
        problem.without_slits("immersed-interface")?;
        let start = Instant::now();
        let known = problem.dirichlet();
        let mut kinds = kinds(problem, &known);
        let collocated = |i: usize| kinds[i] == RowKind::Strong;
        let sees = |i: usize, j: usize| ghosts::sees(problem, i, j);
        let degree = params::operator_degree(self.params.order);
        let operators =
            operators::compute(problem, degree, |i| operators::diffusion(problem, i), collocated, sees)?;
        let table = GhostTable::build(problem, &self.params, &kinds, &operators)?;
        let stencil_seconds = start.elapsed().as_secs_f64();
        let counts = Counts {
            stencils: kinds.iter().filter(|k| **k != RowKind::Dirichlet).count() + table.len(),
            enlarged: operators.enlarged(),
            flagged: 0,
            constrained: table.rows().len(),
            cells: 0,
        };
        table.rows().iter().for_each(|&i| kinds[i as usize] = RowKind::Constrained);
        let rows = Rows { problem, kinds: &kinds, known: &known, operators: &operators, table: &table };
        let (rows, rhs, volumes) = rows.assemble()?;
        Ok(Discretization::of_nodes((rows, rhs), volumes, kinds, counts, stencil_seconds))
    }
}

fn kinds<const D: usize>(problem: &Problem<'_, D>, known: &[Option<f64>]) -> Vec<RowKind> {
    let kind = |(i, value): (usize, &Option<f64>)| match (value, problem.cloud.is_boundary(i)) {
        (Some(_), _) => RowKind::Dirichlet,
        (None, true) => RowKind::StrongBoundary,
        (None, false) => RowKind::Strong,
    };
    known.iter().enumerate().map(kind).collect()
}

/// The rows, ghosts eliminated.
struct Rows<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    kinds: &'a [RowKind],
    known: &'a [Option<f64>],
    operators: &'a OperatorRows,
    table: &'a GhostTable,
}

impl<const D: usize> Rows<'_, D> {
    fn assemble(&self) -> Result<(DifferenceMatrix, Vec<f64>, Vec<f64>), MethodError> {
        let n = self.kinds.len();
        let rows = DifferenceMatrix::from_rows(n, |i, out| match self.kinds[i] {
            RowKind::Dirichlet => out.add_to_row_sum(1.0),
            RowKind::StrongBoundary => self.boundary_row(i, out),
            _ => self.interior_row(i, out),
        })?;
        let rhs = (0..n).map(|i| self.rhs(i)).collect();
        let volumes = (0..n).map(|i| self.volume(i)).collect();
        Ok((rows, rhs, volumes))
    }

    /// Volume by which a collocated equation is multiplied, so that rows are as large as those of other methods.
    fn volume(&self, i: usize) -> f64 {
        self.problem.cloud.spacing()[i].powi(D as i32)
    }

    /// What a boundary row is multiplied by, so that it is as large as its neighbours' rows.
    fn boundary_scale(&self, i: usize) -> f64 {
        2.0 * D as f64 * self.problem.eta[i] * self.problem.cloud.spacing()[i].powi(D as i32 - 2)
    }

    fn interior_row(&self, i: usize, out: &mut RowBuilder) {
        let volume = self.volume(i);
        let (neighbors, coefficients) = self.operators.row(self.problem, i);
        for (&j, c) in neighbors.iter().zip(coefficients).filter(|(_, c)| **c != 0.0) {
            match self.ghost(i, j) {
                None => out.push(j as usize, -volume * c),
                Some(ghost) => ghost
                    .nodes
                    .iter()
                    .zip(&ghost.coefficients)
                    .for_each(|(&p, e)| out.push(p as usize, -volume * c * e)),
            }
        }
    }

    fn boundary_row(&self, i: usize, out: &mut RowBuilder) {
        let scale = self.boundary_scale(i);
        if let Some(value) = self.table.on_boundary(i) {
            value.subtract(scale, out);
        }
    }

    fn rhs(&self, i: usize) -> f64 {
        match self.kinds[i] {
            RowKind::Dirichlet => self.known[i].unwrap_or(0.0),
            RowKind::StrongBoundary => {
                self.boundary_scale(i) * self.table.on_boundary(i).map_or(0.0, |value| value.constant)
            }
            _ => {
                let (neighbors, coefficients) = self.operators.row(self.problem, i);
                let constants: f64 = neighbors
                    .iter()
                    .zip(coefficients)
                    .filter(|(_, c)| **c != 0.0)
                    .filter_map(|(&j, c)| self.ghost(i, j).map(|ghost| c * ghost.constant))
                    .sum();
                self.volume(i) * (self.problem.source.map_or(0.0, |f| f[i]) + constants)
            }
        }
    }

    /// The ghost that stands for node j in the row of node i; `None` where both are of one region.
    fn ghost(&self, i: usize, j: u32) -> Option<&Ghost> {
        let own = self.problem.labels[i];
        if self.problem.labels[j as usize] == own { None } else { self.table.across(j, own) }
    }
}
