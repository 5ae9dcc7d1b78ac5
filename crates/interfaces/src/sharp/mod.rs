//! The sharp method: order four to twelve on clouds that do not follow the interface, at any contrast.
//!
//! At every node one polynomial for each region that is present in the stencil is fitted to the values at the nearest
//! nodes, to the equation, and to what is known at the interfaces between them. The equation of the node says that
//! its value is what the fit to all others predicts. Stiff regions that touch no prescribed value have a constant
//! of their own, and their nodes' unknowns carry the flux. See `docs/sharp.md`.

mod adapted;
mod balance;
mod basis;
mod connected;
mod corner;
mod dense;
mod fit;
mod harmonic;
mod held;
mod interface;
mod maker;
mod operator;
mod params;
mod particular;
mod parts;
mod rate;
mod sample;
mod stencil;
mod thickness;
mod unknowns;
mod vertex;

use std::time::Instant;

use meshless_neighbors::CellList;
use meshless_sparse::DifferenceMatrix;

use crate::method::{Counts, Discretization, Method, RowKind, SplitRows};
use crate::{GradientRow, MethodError, Problem, Sample, SystemSolution};
use crate::{parallel, thin_layers};
use connected::ConnectedParts;
use interface::InterfacePoints;
use maker::{Maker, Row, Scratch};
pub use params::{Conservation, Form, MAX_ORDER, SharpParams};
use sample::Values;
use unknowns::Unknowns;

/// The sharp method.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sharp {
    /// What was chosen.
    pub params: SharpParams,
}

impl Sharp {
    /// Whether there are fits of that order.
    pub fn offers(order: usize, dimension: usize) -> bool {
        order >= 2 && order.is_multiple_of(2) && order <= MAX_ORDER[dimension.clamp(1, 3) - 1]
    }

    fn check<const D: usize>(&self, problem: &Problem<'_, D>) -> Result<(), MethodError> {
        problem.check()?;
        problem.without_slits("sharp")?;
        let order = self.params.order;
        if !Self::offers(order, D) {
            let what = format!(
                "order {order} of the sharp method in {D}-D; it must be even and at most {}",
                MAX_ORDER[D - 1]
            );
            return Err(MethodError::InvalidProblem { what });
        }
        Ok(())
    }

    /// Calls `work` with what all fits share.
    fn with_maker<const D: usize, T>(
        &self,
        problem: &Problem<'_, D>,
        work: impl FnOnce(&Maker<'_, D>) -> Result<T, MethodError>,
    ) -> Result<T, MethodError> {
        self.check(problem)?;
        let widest = problem.cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
        let nodes = CellList::new(problem.cloud.points(), 3.0 * widest)?;
        let parts = ConnectedParts::find(problem, &nodes)?;
        let interfaces = InterfacePoints::sample(problem, &parts, &nodes)?;
        // In time jumps change, and rates have none of the offsets.
        let unknowns = Unknowns::find(problem, parts, &interfaces, !self.params.unsteady);
        work(&Maker::new(problem, self.params, &unknowns, &nodes, &interfaces)?)
    }
}

impl<const D: usize> Method<D> for Sharp {
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        let start = Instant::now();
        self.check(problem)?;
        let known = problem.dirichlet();
        thin_layers::check(problem)?;
        self.with_maker(problem, |maker| {
            let nodes: Vec<usize> = (0..known.len()).filter(|&i| known[i].is_none()).collect();
            let mut rows = parallel::try_map_with(nodes.len(), Scratch::default, |scratch, k| {
                maker.row(nodes[k], scratch)
            })?;
            let gradients =
                maker.keeps_gradients().then(|| gradients(maker, &known, &mut rows)).transpose()?;
            let interface_fluxes = balance::replace(maker, &mut rows)?;
            let seconds = start.elapsed().as_secs_f64();
            let corners = (D > 1).then(|| maker.vertices.corners.clone());
            Ok(Discretization {
                gradients,
                corners,
                interface_fluxes,
                ..assemble(problem, maker.unknowns, &known, &rows, seconds)?
            })
        })
    }

    /// The gradient of each node's own fit.
    fn gradient(&self, problem: &Problem<'_, D>, u: &[f64]) -> Result<Vec<[f64; D]>, MethodError> {
        self.with_maker(problem, |maker| {
            at_all_nodes(u.len(), |i, scratch| maker.gradient_of_values(i, u, scratch))
        })
    }

    fn gradient_of(
        &self,
        problem: &Problem<'_, D>,
        solution: &SystemSolution,
    ) -> Result<Vec<[f64; D]>, MethodError> {
        let values = Values::new(solution);
        self.with_maker(problem, |maker| {
            at_all_nodes(solution.u.len(), |i, scratch| maker.gradient(i, &values, scratch))
        })
    }

    fn samples(
        &self,
        problem: &Problem<'_, D>,
        solution: &SystemSolution,
        points: &[[f64; D]],
    ) -> Result<Option<Vec<Option<Sample<D>>>>, MethodError> {
        let values = Values::new(solution);
        self.with_maker(problem, |maker| {
            let mut samples = maker.samples(points, &values);
            if solution.up_to_constant {
                // What was solved for has another constant than what was made of it.
                let level = maker.level(&solution.u, &values);
                samples.iter_mut().flatten().for_each(|sample| sample.value += level);
            }
            Ok(Some(samples))
        })
    }
}

/// The gradients that rows were made with, and those at prescribed values.
fn gradients<const D: usize>(
    maker: &Maker<'_, D>,
    known: &[Option<f64>],
    rows: &mut [Row],
) -> Result<Vec<GradientRow>, MethodError> {
    let prescribed: Vec<usize> = (0..known.len()).filter(|&i| known[i].is_some()).collect();
    let others = at_all_nodes(prescribed.len(), |k, scratch| maker.gradient_at(prescribed[k], scratch))?;
    let mut all = vec![GradientRow::default(); known.len()];
    prescribed.into_iter().zip(others).for_each(|(i, row)| all[i] = row);
    rows.iter_mut().for_each(|row| all[row.node] = row.gradient.take().unwrap_or_default());
    Ok(all)
}

/// Which node an error names must not depend on which thread was faster.
fn at_all_nodes<T: Send, const D: usize>(
    nodes: usize,
    work: impl Fn(usize, &mut Scratch<D>) -> Result<T, MethodError> + Sync,
) -> Result<Vec<T>, MethodError> {
    parallel::try_map_with(nodes, Scratch::default, |scratch, i| work(i, scratch))
}

fn assemble<const D: usize>(
    problem: &Problem<'_, D>,
    unknowns: &Unknowns,
    known: &[Option<f64>],
    rows: &[Row],
    stencil_seconds: f64,
) -> Result<Discretization, MethodError> {
    let n = known.len();
    let mut row_of: Vec<Option<&Row>> = vec![None; n];
    rows.iter().for_each(|row| row_of[row.node] = Some(row));
    let kinds: Vec<RowKind> = (0..n)
        .map(|i| match row_of[i] {
            None => RowKind::Dirichlet,
            Some(row) if row.balanced => RowKind::Conservative,
            Some(row) if row.crosses => RowKind::Constrained,
            Some(_) if problem.cloud.is_boundary(i) => RowKind::StrongBoundary,
            Some(_) => RowKind::Strong,
        })
        .collect();
    let rhs = (0..n).map(|i| row_of[i].map_or(known[i].unwrap_or(0.0), |row| row.rhs)).collect();
    let matrix = DifferenceMatrix::from_rows(n, |i, out| match row_of[i] {
        None => out.add_to_row_sum(1.0),
        Some(row) => {
            let pairs = row.neighbors.iter().zip(&row.coefficients);
            pairs.for_each(|(&j, &c)| out.push(j as usize, c));
            out.add_to_row_sum(row.row_sum);
        }
    })?;
    let mass = rows.iter().any(|row| !row.mass.is_empty()).then(|| {
        DifferenceMatrix::from_rows(n, |i, out| {
            let Some(row) = row_of[i] else { return };
            row.neighbors.iter().zip(&row.mass[1..]).for_each(|(&j, &m)| out.push(j as usize, m));
            out.add_to_row_sum(row.mass.iter().sum());
        })
    });
    let constants = if unknowns.constants() == 0 && !unknowns.any_held() {
        None
    } else {
        let mut columns = vec![Vec::new(); unknowns.constants()];
        for row in rows {
            row.constants.iter().for_each(|&(k, value)| columns[k as usize].push((row.node as u32, value)));
        }
        let offset = |&part: &u32| unknowns.offset[part as usize];
        let offsets = unknowns.part.iter().map(offset).collect();
        Some(SplitRows { split: unknowns.split(&matrix)?, columns, offsets })
    };
    let counts = Counts {
        stencils: rows.len(),
        enlarged: rows.iter().filter(|row| row.enlarged).count(),
        constrained: rows.iter().filter(|row| row.crosses && !row.balanced).count(),
        cells: rows.iter().filter(|row| row.balanced).count(),
        ..Counts::default()
    };
    let volumes = (0..n).map(|i| problem.cloud.spacing()[i].powi(D as i32)).collect();
    let rows = Discretization::of_nodes((matrix, rhs), volumes, kinds, counts, stencil_seconds);
    Ok(Discretization { constants, mass: mass.transpose()?, ..rows })
}
