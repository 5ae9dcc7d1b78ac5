//! Pseudo-time stepping to the steady state: for comparison only.

use meshless_sparse::DifferenceMatrix;

use crate::{Discretization, MethodError, Problem, RowKind};

/// Share of the largest step that Gershgorin's discs allow.
const STEP: f64 = 0.9;

/// How to step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PseudoTimeParams {
    /// Relative residual at which it stops.
    pub tolerance: f64,
    /// Most steps.
    pub max_steps: usize,
}

impl Default for PseudoTimeParams {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_steps: 1_000_000 }
    }
}

/// What stepping led to.
#[derive(Debug, Clone)]
pub struct PseudoTimeSolution {
    /// One value a node.
    pub u: Vec<f64>,
    /// Steps done.
    pub steps: usize,
    /// Relative residual that was reached.
    pub residual: f64,
}

/// Steps `du/dt = div(eta grad u) + f` explicitly until it no longer changes, as Fiétier et al. do (4.6).
///
/// Rows of boundary conditions are algebraic equations, which are solved for their node at every step. The number of
/// steps grows with the square of the domain's size in spacings, and with the contrast: a sparse solver needs a fraction
/// of the time, and this is here to show that.
///
/// # Errors
/// [`MethodError::InvalidProblem`] where a row has no diagonal to divide by, [`MethodError::Unsupported`] where constants
/// of stiff regions are unknowns.
pub fn pseudo_time<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    params: &PseudoTimeParams,
) -> Result<PseudoTimeSolution, MethodError> {
    let Discretization { rows, rhs, kinds, volumes, .. } = discretization;
    if discretization.constants.is_some() {
        return Err(MethodError::Unsupported {
            method: "pseudo-time",
            what: "step rows whose constants are unknowns of their own",
            instead: "use a sparse solver",
        });
    }
    let known = problem.dirichlet();
    if let Some(i) = (0..rows.n()).find(|&i| known[i].is_none() && rows.diagonal(i) == 0.0) {
        let what = format!("row {i} has no diagonal, so that it cannot be stepped");
        return Err(MethodError::InvalidProblem { what });
    }
    let factors = factors(rows, kinds, volumes);
    let mut u: Vec<f64> = known.iter().map(|g| g.unwrap_or(0.0)).collect();
    let rhs: Vec<f64> = known.iter().zip(rhs).map(|(g, b)| g.unwrap_or(*b)).collect();
    let mut r = vec![0.0; u.len()];
    let mut first = 0.0;
    for steps in 0..=params.max_steps {
        rows.residual(&u, &rhs, &mut r);
        let size = (r.iter().zip(&factors).map(|(r, f)| (r * f).powi(2)).sum::<f64>()).sqrt();
        if steps == 0 {
            first = size;
        }
        let residual = if first > 0.0 { size / first } else { 0.0 };
        if residual <= params.tolerance || steps == params.max_steps || !residual.is_finite() {
            return Ok(PseudoTimeSolution { u, steps, residual });
        }
        u.iter_mut().zip(&r).zip(&factors).for_each(|((u, r), f)| *u += f * r);
    }
    Err(MethodError::InvalidProblem { what: "no step was asked for".to_owned() })
}

/// What residuals are multiplied by: the time step over the volume; for algebraic rows their own diagonal's inverse.
fn factors(rows: &DifferenceMatrix, kinds: &[RowKind], volumes: &[f64]) -> Vec<f64> {
    let stepped = |i: usize| !matches!(kinds[i], RowKind::Dirichlet | RowKind::StrongBoundary);
    let rate = |i: usize| {
        let off: f64 = rows.row(i).1.iter().map(|a| a.abs()).sum();
        (rows.diagonal(i).abs() + off) / volumes[i]
    };
    let stiffest = (0..rows.n()).filter(|&i| stepped(i)).map(rate).fold(f64::MIN_POSITIVE, f64::max);
    let step = 2.0 * STEP / stiffest;
    (0..rows.n())
        .map(|i| match kinds[i] {
            RowKind::Dirichlet => 0.0,
            RowKind::StrongBoundary => 1.0 / rows.diagonal(i),
            _ => step / volumes[i],
        })
        .collect()
}
