//! Indicators that are smoothed by explicit steps of diffusion (4.28).

use meshless_stencils::{DcPse, Functional};

use super::super::operators;
use super::indicator::{Share, beyond};
use crate::operator_rows::OperatorRows;
use crate::parallel;
use crate::{MethodError, Problem};

/// Share of the largest stable step that is taken.
const STEP: f64 = 0.5;

/// Least value of a field that counts.
const NOTHING: f64 = 1e-12;

/// Explicit steps of `du/dt = lap u` up to the time `w^2 / 2`; the normal derivative vanishes on the boundary.
pub(super) fn shares<const D: usize>(
    problem: &Problem<'_, D>,
    width: f64,
) -> Result<Vec<Vec<Share<D>>>, MethodError> {
    let interior = |i: usize| !problem.cloud.is_boundary(i);
    // Degree 2: steps of first order in space, of which every one is nearly an average.
    let laplacian = operators::compute(problem, 2, |_| Functional::Laplacian, interior, |_, _| true)?;
    let (steps, step) = steps(problem, &laplacian, width);
    let beyond = beyond(problem);
    let fields: Vec<Vec<f64>> = (0..problem.materials.len() as u16)
        .map(|region| {
            let start = indicator(problem, &beyond, region);
            (0..steps).fold(start, |u, _| stepped(problem, &laplacian, step, &u))
        })
        .collect();
    slopes(problem, &fields)
}

/// The number of steps, and their size in units of the squared spacing of each node, so that the width follows it.
fn steps<const D: usize>(problem: &Problem<'_, D>, laplacian: &OperatorRows, width: f64) -> (usize, f64) {
    let spacing = problem.cloud.spacing();
    let rate =
        |i: usize| laplacian.row(problem, i).1.iter().map(|c| c.abs()).sum::<f64>() * spacing[i] * spacing[i];
    let inside = (0..spacing.len()).filter(|&i| !problem.cloud.is_boundary(i));
    let stiffest = inside.map(rate).fold(1.0_f64, f64::max);
    let time = 0.5 * width * width;
    let steps = (time * stiffest / STEP).ceil();
    (steps as usize, time / steps)
}

/// What every node holds of a region.
fn indicator<const D: usize>(
    problem: &Problem<'_, D>,
    beyond: &[Option<(u16, f64)>],
    region: u16,
) -> Vec<f64> {
    let held = |(&label, other): (&u16, &Option<(u16, f64)>)| match *other {
        Some((_, share)) if label == region => 1.0 - share,
        Some((other, share)) if other == region => share,
        _ => f64::from(u8::from(label == region)),
    };
    problem.labels.iter().zip(beyond).map(held).collect()
}

fn stepped<const D: usize>(
    problem: &Problem<'_, D>,
    laplacian: &OperatorRows,
    step: f64,
    u: &[f64],
) -> Vec<f64> {
    let spacing = problem.cloud.spacing();
    let mut next = parallel::map(u.len(), |i| {
        let (neighbors, row) = laplacian.row(problem, i);
        let change: f64 = neighbors.iter().zip(row).map(|(&j, c)| c * (u[j as usize] - u[i])).sum();
        u[i] + step * spacing[i] * spacing[i] * change
    });
    for node in problem.cloud.boundary() {
        let b = node.node as usize;
        next[b] = mirrored(problem, b, &next);
    }
    next
}

/// The mean of the inner neighbours, near ones first: no flux goes through the boundary.
fn mirrored<const D: usize>(problem: &Problem<'_, D>, b: usize, u: &[f64]) -> f64 {
    let points = problem.cloud.points();
    let h = problem.cloud.spacing()[b];
    let (mut sum, mut mass) = (0.0, 0.0);
    for &j in problem.supports.lists.of(b) {
        if !problem.cloud.is_boundary(j as usize) {
            let squared: f64 = (0..D).map(|k| (points[j as usize][k] - points[b][k]).powi(2)).sum();
            let weight = (-squared / (h * h)).exp();
            sum += weight * u[j as usize];
            mass += weight;
        }
    }
    if mass > 0.0 { sum / mass } else { u[b] }
}

/// Shares and their gradients where more than one field is something.
fn slopes<const D: usize>(
    problem: &Problem<'_, D>,
    fields: &[Vec<f64>],
) -> Result<Vec<Vec<Share<D>>>, MethodError> {
    let points = problem.cloud.points();
    let partial = |axis: usize| DcPse::<D>::derivative(std::array::from_fn(|k| u8::from(k == axis)), 2);
    let operators: [DcPse<D>; D] = std::array::from_fn(partial);
    let most = problem.supports.lists.max_count();
    parallel::try_map_with(
        points.len(),
        || (operators.each_ref().map(|o| o.scratch(most)), Vec::new(), Vec::new()),
        |(scratch, offsets, row), i| {
            if fields.iter().filter(|u| u[i].abs() > NOTHING).count() < 2 {
                return Ok(Vec::new());
            }
            let neighbors = problem.supports.lists.of(i);
            let offset =
                |&j: &u32| -> [f64; D] { std::array::from_fn(|k| points[j as usize][k] - points[i][k]) };
            offsets.clear();
            offsets.extend(neighbors.iter().map(offset));
            row.resize(neighbors.len() + 1, 0.0);
            let mut shares: Vec<Share<D>> =
                (0..).zip(fields).map(|(region, u)| (region, u[i], [0.0; D])).collect();
            for (axis, (operator, scratch)) in operators.iter().zip(scratch).enumerate() {
                operator
                    .stencil(offsets, 0.5 * problem.supports.radius[i], scratch, row)
                    .map_err(|source| MethodError::stencil(i, &points[i], source))?;
                for (share, u) in shares.iter_mut().zip(fields) {
                    let values = neighbors.iter().map(|&j| u[j as usize]);
                    share.2[axis] =
                        row[0] * u[i] + row[1..].iter().zip(values).map(|(c, u)| c * u).sum::<f64>();
                }
            }
            Ok(shares)
        },
    )
}
