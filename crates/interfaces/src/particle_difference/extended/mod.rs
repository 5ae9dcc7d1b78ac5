//! The former particle difference method: the jump of the slope as an unknown at points of the interface.
//!
//! Y.-C. Yoon and J.-H. Song (2021), the last lines of section 3.5, and their earlier papers [6, 8] there. Beyond an
//! interface `u = q + a + d J`, with the jump J of the slope at the foot interpolated between unknowns at points of the
//! interface; for each of them there is one more equation, that the flux jumps by g, or that u has a prescribed value on the
//! interface, which J then follows from (section 3.5). In time that equation is another one, see `joint`. It is here to be compared with
//! [`ParticleDifference`](super::ParticleDifference), which eliminates J where it arises.

mod joint;
mod points;
mod rows;

use std::time::Instant;

use meshless_sparse::DifferenceMatrix;

use super::feet::Feet;
use super::{ParticleDifference, ParticleDifferenceParams, Wedge};
use crate::method::{Counts, Discretization, Method, RowKind};
use crate::parallel;
use crate::{MethodError, Problem, SystemSolution};
use points::InterfacePoints;
use rows::{ExtendedRow, RowMaker};

/// The particle difference method with the jumps of the slope at interfaces as unknowns.
#[derive(Debug, Clone, Copy, Default)]
pub struct ParticleDifferenceExtended {
    /// What was chosen; of the wedges, [`Wedge::Plane`] and [`Wedge::Varying`] have a meaning here.
    pub params: ParticleDifferenceParams,
}

impl<const D: usize> Method<D> for ParticleDifferenceExtended {
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        problem.check()?;
        problem.without_slits("particle-difference-extended")?;
        let start = Instant::now();
        let feet = Feet::new(problem);
        let points = InterfacePoints::new(problem, &feet);
        let maker = RowMaker::new(problem, &feet, &points, self.params);
        let known = problem.dirichlet();
        let nodes = known.len();
        let of_points = parallel::try_map_with(
            points.list.len(),
            || maker.scratch(),
            |scratch, k| maker.point(k, scratch),
        )?;
        let of_nodes = parallel::try_map_with(
            nodes,
            || maker.scratch(),
            |scratch, i| match known[i] {
                Some(value) => Ok(ExtendedRow { row_sum: 1.0, rhs: value, ..ExtendedRow::default() }),
                None => maker.node(i, &of_points, scratch),
            },
        )?;
        let stencil_seconds = start.elapsed().as_secs_f64();
        let constrained = |i: usize| !of_nodes[i].jumps.is_empty();
        let kinds: Vec<RowKind> = (0..nodes)
            .map(|i| match known[i] {
                Some(_) => RowKind::Dirichlet,
                None if problem.cloud.is_boundary(i) => RowKind::StrongBoundary,
                None if constrained(i) => RowKind::Constrained,
                None => RowKind::Strong,
            })
            .collect();
        let all: Vec<&ExtendedRow> = of_nodes.iter().chain(&of_points).collect();
        let rows = DifferenceMatrix::from_rows(all.len(), |i, out| {
            let row = all[i];
            row.nodes.iter().for_each(|&(j, c)| out.push(j as usize, c));
            // An unknown that is no value of u enters as it is, not by its difference from this one.
            for &(k, c) in row.jumps.iter().filter(|(k, _)| nodes + *k as usize != i) {
                out.push(nodes + k as usize, c);
                out.add_to_row_sum(c);
            }
            let own = row.jumps.iter().filter(|(k, _)| nodes + *k as usize == i).map(|(_, c)| c).sum::<f64>();
            out.add_to_row_sum(row.row_sum + own);
        })?;
        let counts = Counts {
            stencils: nodes + points.list.len() - known.iter().flatten().count(),
            enlarged: of_nodes.iter().filter(|row| row.enlarged).count(),
            constrained: (0..nodes).filter(|&i| constrained(i)).count(),
            ..Counts::default()
        };
        Ok(Discretization {
            rows,
            rhs: all.iter().map(|row| row.rhs).collect(),
            constants: None,
            mass: None,
            capacities: None,
            kinds,
            volumes: (0..nodes).map(|i| problem.cloud.spacing()[i].powi(D as i32)).collect(),
            counts,
            stencil_seconds,
            interface_points: points.described(),
            gradients: None,
            corners: None,
            interface_fluxes: Vec::new(),
        })
    }

    /// That of [`ParticleDifference`] with one slope: the same functions, J eliminated.
    fn gradient(&self, problem: &Problem<'_, D>, u: &[f64]) -> Result<Vec<[f64; D]>, MethodError> {
        let wedge = if self.params.wedge == Wedge::Plane { Wedge::Plane } else { Wedge::Varying };
        let params = ParticleDifferenceParams { wedge, ..self.params };
        ParticleDifference { params }.gradient(problem, u)
    }

    /// That of the fits, with the jumps that were found.
    fn gradient_of(
        &self,
        problem: &Problem<'_, D>,
        solution: &SystemSolution,
    ) -> Result<Vec<[f64; D]>, MethodError> {
        let feet = Feet::new(problem);
        let points = InterfacePoints::new(problem, &feet);
        let maker = RowMaker::new(problem, &feet, &points, self.params);
        parallel::try_map_with(
            problem.cloud.len(),
            || maker.scratch(),
            |scratch, i| maker.gradient(i, &solution.u, &solution.extra, scratch),
        )
    }
}
