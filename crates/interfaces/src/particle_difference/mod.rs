//! The interface-immersed particle difference method: collocation whose stencils know the interface condition.
//!
//! Y.-C. Yoon, J.-H. Song, "Interface Immersed Particle Difference Method for weak discontinuity in elliptic boundary
//! value problems", Comput. Methods Appl. Mech. Engrg. 375 (2021) 113650. Away from interfaces the stencils are plain
//! moving least squares; near one the local polynomial continues beyond it as the condition says, so that there are no
//! further equations and no further unknowns. Here in any dimension and of any degree; see `docs/particle-difference.md`.

mod extended;
mod feet;
mod fit;
mod frame;
mod leg;
mod params;
mod rows;
mod slit;
mod wedge;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use meshless_sparse::DifferenceMatrix;
use meshless_stencils::Functional;

use crate::method::{Counts, Discretization, Method, RowKind};
use crate::parallel;
use crate::support_values::SupportValues;
use crate::{MethodError, Problem};
pub use extended::ParticleDifferenceExtended;
use feet::Feet;
pub use params::{ParticleDifferenceParams, Wedge};
use rows::{Row, StencilMaker};

/// The interface-immersed particle difference method.
#[derive(Debug, Clone, Copy, Default)]
pub struct ParticleDifference {
    /// What was chosen.
    pub params: ParticleDifferenceParams,
}

impl<const D: usize> Method<D> for ParticleDifference {
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        problem.check()?;
        let start = Instant::now();
        let feet = Feet::new(problem);
        let maker = StencilMaker::new(problem, &feet, self.params);
        let known = problem.dirichlet();
        let (plain, rows) = build(&maker, &feet, &known)?;
        assemble(problem, &known, &plain, &rows, start.elapsed().as_secs_f64())
    }

    /// The gradient of the approximation itself: near an interface it uses the nodes of both sides.
    fn gradient(&self, problem: &Problem<'_, D>, u: &[f64]) -> Result<Vec<[f64; D]>, MethodError> {
        let feet = Feet::new(problem);
        let maker = StencilMaker::new(problem, &feet, self.params);
        let partials: [Functional<D>; D] = std::array::from_fn(Functional::Partial);
        parallel::try_map_with(
            u.len(),
            || maker.scratch(),
            |scratch, i| {
                let stencils = maker.stencil(i, &partials, false, scratch)?;
                Ok(stencils.map(|s| {
                    let differences =
                        s.neighbors.iter().zip(&s.coefficients).map(|(&j, c)| c * (u[j as usize] - u[i]));
                    differences.sum::<f64>() + s.constant * u[i] - s.shift
                }))
            },
        )
    }
}

/// Plain coefficients over the supports, and the rows of all nodes that have others.
fn build<const D: usize>(
    maker: &StencilMaker<'_, D>,
    feet: &Feet<D>,
    known: &[Option<f64>],
) -> Result<(SupportValues, Vec<Row>), MethodError> {
    let problem = maker.problem;
    let failed: Vec<AtomicBool> = (0..known.len()).map(|_| AtomicBool::new(false)).collect();
    let is_plain = |i: usize| {
        known[i].is_none() && !problem.cloud.is_boundary(i) && !feet.is_near(i) && !maker.may_meet_slit(i)
    };
    let plain = SupportValues::compute(
        problem.supports.lists,
        || maker.scratch().plain,
        |scratch, i, out| {
            if is_plain(i) && (maker.plain_row(i, scratch, out).is_err() || !maker.decays(out)) {
                failed[i].store(true, Ordering::Relaxed);
            }
            Ok::<(), MethodError>(())
        },
    )?;
    let mut boundary_index = vec![0; known.len()];
    problem.cloud.boundary().iter().enumerate().for_each(|(k, b)| boundary_index[b.node as usize] = k);
    let special = |&i: &usize| known[i].is_none() && (!is_plain(i) || failed[i].load(Ordering::Relaxed));
    let nodes: Vec<usize> = (0..known.len()).filter(special).collect();
    let rows = parallel::try_map_with(
        nodes.len(),
        || maker.scratch(),
        |scratch, k| match problem.cloud.is_boundary(nodes[k]) {
            true => maker.boundary(boundary_index[nodes[k]], scratch),
            false => maker.interior(nodes[k], scratch),
        },
    )?;
    Ok((plain, rows))
}

fn assemble<const D: usize>(
    problem: &Problem<'_, D>,
    known: &[Option<f64>],
    plain: &SupportValues,
    rows: &[Row],
    stencil_seconds: f64,
) -> Result<Discretization, MethodError> {
    let n = known.len();
    let mut special: Vec<Option<&Row>> = vec![None; n];
    rows.iter().for_each(|row| special[row.node] = Some(row));
    // Every row is multiplied by the measure of what it is collocated on, so that all are of one size.
    let measure = |i: usize| {
        let dimension = if problem.cloud.is_boundary(i) { D as i32 - 1 } else { D as i32 };
        problem.cloud.spacing()[i].powi(dimension)
    };
    let kinds: Vec<RowKind> = (0..n)
        .map(|i| match (known[i], special[i]) {
            (Some(_), _) => RowKind::Dirichlet,
            (None, Some(row)) => row.kind,
            (None, None) => RowKind::Strong,
        })
        .collect();
    let rhs = (0..n)
        .map(|i| match (known[i], special[i]) {
            (Some(value), _) => value,
            (None, Some(row)) => measure(i) * row.rhs,
            (None, None) => measure(i) * problem.source.map_or(0.0, |f| f[i]),
        })
        .collect();
    let matrix = DifferenceMatrix::from_rows(n, |i, out| match (known[i], special[i]) {
        (Some(_), _) => out.add_to_row_sum(1.0),
        (None, Some(row)) => {
            let pairs = row.neighbors.iter().zip(&row.coefficients);
            pairs.for_each(|(&j, c)| out.push(j as usize, measure(i) * c));
            out.add_to_row_sum(measure(i) * row.row_sum);
        }
        (None, None) => {
            let pairs = problem.supports.lists.of(i).iter().zip(plain.of(i));
            pairs.for_each(|(&j, c)| out.push(j as usize, -measure(i) * c));
        }
    })?;
    let count = |kind: RowKind| kinds.iter().filter(|&&k| k == kind).count();
    let counts = Counts {
        stencils: n - count(RowKind::Dirichlet),
        enlarged: rows.iter().filter(|row| row.enlarged).count(),
        constrained: count(RowKind::Constrained),
        ..Counts::default()
    };
    let volumes = (0..n).map(|i| problem.cloud.spacing()[i].powi(D as i32)).collect();
    Ok(Discretization::of_nodes((matrix, rhs), volumes, kinds, counts, stencil_seconds))
}
