//! Runs of the suite.

use std::time::Instant;

use meshless::report::Report;
use meshless_freespace::{Kernel, Plan, Workspace};

use super::problems::Problem;
use crate::verify::order;
use crate::verify::row::Row;
use crate::verify::study::{Key, Outcome};
use crate::verify::variant::Variant;

/// One solve.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    pub(super) case: &'static str,
    /// How the mesh is refined; empty where it is not.
    pub(super) variant: &'static str,
    pub(super) kernel: Kernel,
    /// Points along the longest direction.
    pub(super) n: usize,
    pub(super) dimension: usize,
    pub(super) spacing: f64,
    pub(super) points: usize,
    /// Relative L2 error, equation 31.
    pub(super) l2: f64,
    /// Largest error over the largest exact value.
    pub(super) linf: f64,
    /// Largest error.
    pub(super) worst: f64,
    pub(super) plan_seconds: f64,
    pub(super) solve_seconds: f64,
}

/// What diagrams call a kernel.
pub(super) fn label(kernel: Kernel) -> String {
    match kernel {
        Kernel::Gaussian { order, smoothing: Some(s) } => format!("m = {order}, sigma = {s} h"),
        Kernel::Gaussian { order, smoothing: None } => format!("m = {order}"),
        Kernel::Spectral => "spectral".to_owned(),
        Kernel::Truncated => "truncated".to_owned(),
    }
}

/// Solves and compares.
pub(super) fn run<const D: usize>(
    case: &'static str,
    kernel: Kernel,
    problem: &Problem<D>,
) -> Result<Run, String> {
    let said = |e: meshless_freespace::FreeSpaceError| format!("{case} with {}: {e}", label(kernel));
    let start = Instant::now();
    let plan: Plan<D> = Plan::new(&problem.mesh, kernel).map_err(said)?;
    let plan_seconds = start.elapsed().as_secs_f64();
    let sources: Vec<&[f64]> = problem.sources.iter().map(Vec::as_slice).collect();
    let (mut workspace, mut fields) = (Workspace::default(), Vec::new());
    let start = Instant::now();
    plan.solve(&sources, &problem.wanted, &mut workspace, &mut fields).map_err(said)?;
    let solve_seconds = start.elapsed().as_secs_f64();
    let [l2, linf, worst] = errors(&fields, &problem.exact);
    Ok(Run {
        case,
        variant: "",
        kernel,
        n: problem.mesh.points().into_iter().max().unwrap_or(0),
        dimension: D,
        spacing: problem.mesh.spacing()[0],
        points: problem.mesh.len(),
        l2,
        linf,
        worst,
        plan_seconds,
        solve_seconds,
    })
}

/// Relative L2 error (31), relative largest error and largest error of a vector field.
pub(super) fn errors(fields: &[Vec<f64>], exact: &[Vec<f64>]) -> [f64; 3] {
    let (mut error, mut size, mut worst, mut largest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for (field, exact) in fields.iter().zip(exact) {
        for (value, exact) in field.iter().zip(exact) {
            let difference = value - exact;
            error += difference * difference;
            size += exact * exact;
            worst = worst.max(difference.abs());
            largest = largest.max(exact.abs());
        }
    }
    [(error / size).sqrt(), worst / largest, worst]
}

/// The run as a row of the results, with its order against the run before it in its ladder.
pub(super) fn outcome(run: &Run, runs: &[Run]) -> Outcome {
    let before = runs
        .iter()
        .filter(|r| (r.case, r.variant, r.kernel) == (run.case, run.variant, run.kernel) && r.n < run.n)
        .max_by_key(|r| r.n);
    let rate = |error: fn(&Run) -> f64| {
        before.and_then(|b| order::between((b.spacing, error(b)), (run.spacing, error(run))))
    };
    let variant = Variant { support: None, ..Variant::plain("free-space") };
    let row = Row {
        suite: super::SUITE,
        case: run.case,
        method: variant.method,
        params: [&label(run.kernel), run.variant].join("; ").trim_end_matches("; ").to_owned(),
        dimension: run.dimension,
        unknowns: run.points,
        spacing: run.spacing,
        contrast: 1.0,
        err_l2: Some(run.l2),
        err_linf: Some(run.linf),
        order_l2: rate(|r| r.l2),
        order_linf: rate(|r| r.linf),
        t_stencils: run.plan_seconds,
        t_solve: run.solve_seconds,
        t_total: run.plan_seconds + run.solve_seconds,
        threads: rayon::current_num_threads(),
        ..Row::default()
    };
    let key = Key { case: run.case, variant, jump: 1.0, level: run.n, seed: 0 };
    Outcome { key, row, report: Report::default() }
}
