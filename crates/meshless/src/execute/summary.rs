//! The figures about a solve.

use meshless_interfaces::{Condition, RowKind};

use super::Solved;
use crate::memory::peak_memory_mb;
use crate::plan::{Effect, Plan};
use crate::report::{
    Errors, Estimate, Extrema, MatrixSummary, NodeReport, Probe, Report, Seconds, SolverReport,
};
use crate::scene::Scene;

pub(super) fn report<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    solved: &Solved<D>,
    errors: Option<Errors>,
    estimate: Estimate,
    seconds: Seconds,
    probes: Vec<Probe>,
) -> Report {
    let problem = solved.discrete.problem();
    let (min, max) = range(solved.system.u.iter().copied());
    let count = |kind: RowKind| solved.discretization.kinds.iter().filter(|&&k| k == kind).count();
    let counts = &solved.discretization.counts;
    let rows = solved.discretization.report();
    let info = &solved.system.info;
    Report {
        title: scene.title.clone(),
        dimension: D,
        unknowns: solved.unknowns(),
        spacing: solved.spacing(),
        method: plan.method.name.as_str().to_owned(),
        order: plan.method.params.order(),
        fallback: None,
        thin_layer: None,
        contacts: Vec::new(),
        corners: Vec::new(),
        fluxes: None,
        balance: None,
        contrast: problem.contrast(),
        effects: plan.effects.iter().map(|e| e.name().to_owned()).collect(),
        skipped: plan.skipped.iter().map(|s| s.what.to_owned()).collect(),
        errors,
        estimate,
        accuracy: None,
        extrema: Extrema { min, max, estimate: None },
        speed: None,
        solver: SolverReport {
            name: info.name.to_string(),
            iterations: info.iterations,
            residual: info.residual,
            backward_error: info.backward_error,
            criterion: info.criterion.as_str().to_owned(),
            floating_constants: solved.system.floating_constants,
        },
        nodes: NodeReport {
            dirichlet: count(RowKind::Dirichlet),
            strong: count(RowKind::Strong),
            strong_boundary: count(RowKind::StrongBoundary),
            conservative: count(RowKind::Conservative),
            constrained: count(RowKind::Constrained),
            flagged: counts.flagged,
            enlarged: counts.enlarged,
        },
        matrix: MatrixSummary {
            wrong_sign: rows.wrong_sign,
            row_sum: rows.row_sum,
            column_sum: rows.column_sum,
            overshoot: overshoot(plan, problem.conditions, min, max),
        },
        time: solved.history.as_ref().map(|history| history.report.clone()),
        seconds,
        peak_memory_mb: peak_memory_mb().unwrap_or(0.0),
        probes,
    }
}

/// How far the solution leaves the range of its Dirichlet values, where a maximum principle says that it must not.
fn overshoot(plan: &Plan, conditions: &[Vec<Condition>], min: f64, max: f64) -> Option<f64> {
    let forced = plan.effects.iter().any(|e| {
        let slits = matches!(e, Effect::Slits);
        slits || matches!(e, Effect::Source | Effect::ValueJump | Effect::FluxJump | Effect::Robin)
    });
    let fluxes = conditions
        .iter()
        .flatten()
        .any(|c| matches!(*c, Condition::Neumann(g) | Condition::Flux(g) if g != 0.0));
    let (low, high) = range(conditions.iter().flatten().filter_map(|c| match *c {
        Condition::Dirichlet(value) => Some(value),
        _ => None,
    }));
    let width = high - low;
    (!forced && !fluxes && width > 0.0).then(|| ((max - high).max(low - min) / width).max(0.0))
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}
