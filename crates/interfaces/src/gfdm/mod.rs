//! Generalised finite differences with a conservative fallback.
//!
//! H. Kraus, J. Kuhnert, A. Meister, P. Suchde, "A meshfree point collocation method for elliptic interface
//! problems", 2022. One type serves its four methods; [`GfdmParams`] says which rows are strong and which conservative.

mod boundary;
mod conservative;
mod diffusivity;
mod flows;
mod params;
mod select;
mod source;
mod strong;
mod walls;

use std::time::Instant;

use meshless_sparse::DifferenceMatrix;

use crate::method::{Counts, Discretization, Method, RowKind};
use crate::operator_rows::OperatorRows;
use crate::parallel;
use crate::{MethodError, Problem, SystemSolution};
use boundary::BoundaryRow;
use conservative::{CellBalance, CellRow};
pub use flows::{CellContent, CellFlows, CellSeam, CellWall};
pub use params::{GfdmParams, Selection, StrongParams};
pub(crate) use strong::add_correction;

/// A generalised finite difference method.
#[derive(Debug, Clone, Copy)]
pub struct Gfdm {
    /// What was chosen.
    pub params: GfdmParams,
}

impl<const D: usize> Method<D> for Gfdm {
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        problem.check()?;
        problem.without_slits("gfdm")?;
        self.check(problem)?;
        Parts::build(problem, &self.params)?.assemble(problem)
    }

    fn cell_flows(
        &self,
        problem: &Problem<'_, D>,
        solution: &SystemSolution,
    ) -> Result<Option<CellFlows<D>>, MethodError> {
        let balances = self.params.selection != Selection::None;
        balances.then(|| flows::cell_flows(problem, solution)).transpose()
    }
}

impl Gfdm {
    fn check<const D: usize>(&self, problem: &Problem<'_, D>) -> Result<(), MethodError> {
        if self.params.selection == Selection::None && !problem.laws.is_empty() {
            return Err(MethodError::Unsupported {
                method: "the classical method",
                what: "prescribe a jump of u or of the flux",
                instead: "use gfdm-conservative or gfdm-hybrid",
            });
        }
        Ok(())
    }
}

/// The rows of a discretisation before they are put together.
struct Parts {
    kinds: Vec<RowKind>,
    known: Vec<Option<f64>>,
    strong: Option<OperatorRows>,
    boundary: Vec<Option<BoundaryRow>>,
    cells: Vec<Option<CellRow>>,
    counts: Counts,
    stencil_seconds: f64,
}

impl Parts {
    fn build<const D: usize>(problem: &Problem<'_, D>, params: &GfdmParams) -> Result<Self, MethodError> {
        let start = Instant::now();
        let known = problem.dirichlet();
        let mut kinds = select::boundary_kinds(problem, &known, params.conservative_neumann);
        let mut counts = Counts::default();
        let strong = if params.selection == Selection::All {
            kinds.iter_mut().filter(|k| **k == RowKind::Strong).for_each(|k| *k = RowKind::Conservative);
            None
        } else {
            let wanted: Vec<bool> = kinds.iter().map(|&k| k == RowKind::Strong).collect();
            let rows = strong::compute(problem, &params.strong, &wanted)?;
            counts.stencils += wanted.iter().filter(|&&w| w).count();
            counts.enlarged = rows.enlarged();
            counts.flagged = select::conservative_nodes(problem, params, &rows, &mut kinds);
            Some(rows)
        };
        let boundary = boundary_rows(problem, &mut kinds)?;
        let cells = cell_rows(problem, &kinds)?;
        counts.stencils += boundary.iter().flatten().count();
        counts.cells = cells.iter().flatten().count();
        Ok(Self {
            kinds,
            known,
            strong,
            boundary,
            cells,
            counts,
            stencil_seconds: start.elapsed().as_secs_f64(),
        })
    }

    fn assemble<const D: usize>(self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        let mut rhs = vec![0.0; self.kinds.len()];
        let mut boundary_index = vec![u32::MAX; self.kinds.len()];
        for (index, node) in problem.cloud.boundary().iter().enumerate() {
            boundary_index[node.node as usize] = index as u32;
        }
        for (i, b) in rhs.iter_mut().enumerate() {
            *b = match self.kinds[i] {
                RowKind::Dirichlet => self.known[i].unwrap_or(0.0),
                RowKind::Strong | RowKind::Constrained => {
                    strong_measure(problem, i) * problem.source.map_or(0.0, |f| f[i])
                }
                RowKind::StrongBoundary => self.boundary[boundary_index[i] as usize]
                    .as_ref()
                    .map_or(0.0, |row| boundary_measure(problem, i) * row.rhs),
                RowKind::Conservative => self.cells[i].as_ref().map_or(0.0, |row| row.rhs),
            };
        }
        let rows = DifferenceMatrix::from_rows(self.kinds.len(), |i, out| match self.kinds[i] {
            RowKind::Dirichlet => out.add_to_row_sum(1.0),
            RowKind::Strong | RowKind::Constrained => {
                if let Some(strong) = &self.strong {
                    let measure = strong_measure(problem, i);
                    let (neighbors, row) = strong.row(problem, i);
                    neighbors.iter().zip(row).for_each(|(&j, c)| out.push(j as usize, -measure * c));
                    out.add_to_row_sum(measure * problem.reaction(i));
                }
            }
            RowKind::StrongBoundary => {
                if let Some(row) = &self.boundary[boundary_index[i] as usize] {
                    let measure = boundary_measure(problem, i);
                    row.neighbors
                        .iter()
                        .zip(&row.coefficients)
                        .for_each(|(&j, c)| out.push(j as usize, measure * c));
                    out.add_to_row_sum(measure * row.row_sum);
                }
            }
            RowKind::Conservative => {
                if let Some(row) = &self.cells[i] {
                    row.entries.iter().for_each(|&(j, t)| out.push(j as usize, -t));
                    out.add_to_row_sum(row.row_sum);
                }
            }
        })?;
        let volumes = (0..self.kinds.len())
            .map(|i| self.cells[i].as_ref().map_or_else(|| strong_measure(problem, i), |row| row.volume))
            .collect();
        let capacity = |i: usize| match &self.cells[i] {
            Some(row) => row.capacity,
            None => strong_measure(problem, i) * problem.capacity(i),
        };
        // That of a cell is what its balance has of it and of its neighbours', as its source is.
        let capacities = Some((0..self.kinds.len()).map(capacity).collect());
        let Self { kinds, counts, stencil_seconds, .. } = self;
        let rows = Discretization::of_nodes((rows, rhs), volumes, kinds, counts, stencil_seconds);
        Ok(Discretization { capacities, ..rows })
    }
}

/// Volume by which a collocated equation is multiplied, so that its row is as large as those of its neighbours' cells.
fn strong_measure<const D: usize>(problem: &Problem<'_, D>, i: usize) -> f64 {
    problem.cloud.spacing()[i].powi(D as i32)
}

/// Area by which a collocated boundary condition is multiplied, for the same reason.
fn boundary_measure<const D: usize>(problem: &Problem<'_, D>, i: usize) -> f64 {
    problem.cloud.spacing()[i].powi(D as i32 - 1)
}

/// Collocated conditions, in the order of `cloud.boundary()`. Nodes whose stencil would reach over a prescribed jump, or
/// is unsound, get a conservative row instead.
fn boundary_rows<const D: usize>(
    problem: &Problem<'_, D>,
    kinds: &mut [RowKind],
) -> Result<Vec<Option<BoundaryRow>>, MethodError> {
    let nodes = problem.cloud.boundary();
    let mut rows = parallel::try_map_with(
        nodes.len(),
        || (),
        |(), index| match kinds[nodes[index].node as usize] {
            RowKind::StrongBoundary => boundary::collocate(problem, index).map(Some),
            _ => Ok(None),
        },
    )?;
    for (node, row) in nodes.iter().zip(&mut rows) {
        let i = node.node as usize;
        if row.take_if(|row| !row.is_sound() || select::crosses_a_jump(problem, i, &row.neighbors)).is_some()
        {
            kinds[i] = RowKind::Conservative;
        }
    }
    Ok(rows)
}

/// Balances of the conservative nodes; nothing is built where there is none.
fn cell_rows<const D: usize>(
    problem: &Problem<'_, D>,
    kinds: &[RowKind],
) -> Result<Vec<Option<CellRow>>, MethodError> {
    if !kinds.contains(&RowKind::Conservative) {
        return Ok(vec![None; kinds.len()]);
    }
    let takes_part = |i: usize| matches!(kinds[i], RowKind::Conservative | RowKind::Dirichlet);
    let balance = CellBalance::new(problem)?;
    let made = parallel::try_map_with(
        kinds.len(),
        || balance.scratch(),
        |scratch, i| match kinds[i] {
            RowKind::Conservative => balance.row(i, &takes_part, scratch).map(Some),
            _ => Ok(None),
        },
    )?;
    let (mut rows, mut given) = (Vec::with_capacity(kinds.len()), Vec::new());
    for made in made {
        rows.push(made.map(|(row, mut beyond)| {
            given.append(&mut beyond);
            row
        }));
    }
    // What prescribed values receive has no row to go to.
    for (j, part) in given {
        rows[j as usize].iter_mut().for_each(|row: &mut CellRow| row.add(&part));
    }
    Ok(rows)
}
