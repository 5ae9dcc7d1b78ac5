//! The clouds of a ladder, one method after the other.

use std::time::Instant;

use super::candidates::{Candidate, candidates};
use super::reference::Reference;
use super::{CostParams, CostReport, CostRun};
use crate::execute::{Silent, Solved, execute_once, solve_in};
use crate::plan::{Plan, Stage};
use crate::report::Seconds;
use crate::scene::{GreenName, Scene};
use crate::{Error, build};

/// Spacings over that of the scene, from coarse to fine; the last one is the scene's own.
const RATIOS: [f64; 5] = [4.0, 2.8, 2.0, 1.4, 1.0];

/// The same where the scene's spacing is only what a refinement starts from.
const RATIOS_DOWN: [f64; 5] = [1.0, 0.7, 0.5, 0.35, 0.25];

/// Runs shorter than this are repeated, so often, and their median counts.
const SHORT: f64 = 0.2;
const REPETITIONS: usize = 3;

/// Exponent by which seconds grow with the number of nodes, to tell whether there is time for the next rung.
const GROWTH: f64 = 1.3;

pub(super) fn ratios(scene: &Scene) -> [f64; 5] {
    if scene.accuracy.is_some() { RATIOS_DOWN } else { RATIOS }
}

/// Seconds from points to solution.
fn priced(s: &Seconds) -> f64 {
    s.points + s.neighbors + s.stencils + s.assembly + s.solve
}

/// The median of a few runs where the first was short.
fn median(first: f64, again: impl Fn() -> Result<f64, Error>) -> Result<f64, Error> {
    let mut seconds = vec![first];
    if first < SHORT {
        for _ in 1..REPETITIONS {
            seconds.push(again()?);
        }
    }
    seconds.sort_by(f64::total_cmp);
    Ok(seconds[seconds.len() / 2])
}

/// The method in free space, with a kernel that has no order.
fn kernel_name(scene: &Scene) -> &'static str {
    match scene.free_space.as_ref().and_then(|spec| spec.kernel) {
        Some(GreenName::Spectral) => "free-space, spectral",
        Some(GreenName::Truncated) => "free-space, truncated",
        _ => "free-space",
    }
}

pub(super) fn bounded<const D: usize>(
    scene: &Scene,
    params: &CostParams,
    each: &mut dyn FnMut(&CostRun),
) -> Result<CostReport, Error> {
    let plan = Plan::new(scene)?;
    let ratios = ratios(scene);
    let reference = Reference::<D>::new(scene, &plan, ratios[ratios.len() - 1])?;
    let run = |scene: &Scene| -> Result<CostRun, Error> {
        let plan = Plan::new(scene)?.companion();
        let solve = || solve_in::<D>(scene, &plan, None, &mut Silent);
        let mut solved: Solved<D> = solve()?;
        let seconds = median(priced(&solved.seconds), || Ok(priced(&solve()?.seconds)))?;
        let error = reference.error(scene, &mut solved)?;
        Ok(CostRun {
            method: plan.method.name.as_str().to_owned(),
            order: plan.method.params.order(),
            spacing: solved.spacing(),
            unknowns: solved.unknowns(),
            error: Some(error),
            seconds,
            ..CostRun::default()
        })
    };
    let runs = climb(scene, &candidates(scene, &plan, &params.methods), params, each, run)?;
    Ok(CostReport {
        title: scene.title.clone(),
        dimension: D,
        reference: reference.name(),
        reference_error: reference.own_error(),
        runs,
    })
}

pub(super) fn free_space(
    scene: &Scene,
    params: &CostParams,
    each: &mut dyn FnMut(&CostRun),
) -> Result<CostReport, Error> {
    let plan = Plan::new(scene)?;
    let exact = plan.runs(Stage::Errors);
    let run = |scene: &Scene| -> Result<CostRun, Error> {
        let mut plan = Plan::new(scene)?;
        // The gradient is for the errors only, and makes the convolution dearer.
        plan.stages.retain(|s| !matches!(s, Stage::Plot | Stage::Vtu | Stage::Csv | Stage::Probes));
        let solve = || Ok::<_, Error>(execute_once(scene, &plan, None, &mut Silent)?.report);
        let report = solve()?;
        let seconds = median(priced(&report.seconds), || Ok(priced(&solve()?.seconds)))?;
        let error = if exact { report.errors.as_ref().map(|e| e.l2) } else { report.estimate.l2 };
        Ok(CostRun {
            method: kernel_name(scene).to_owned(),
            order: report.order,
            spacing: report.spacing,
            unknowns: report.unknowns,
            error,
            seconds,
            why: report.estimate.why_not.filter(|_| error.is_none()),
            ..CostRun::default()
        })
    };
    let runs = climb(scene, &candidates(scene, &plan, &params.methods), params, each, run)?;
    let reference =
        if exact { "the exact solution" } else { "what the spectrum of the source leaves to be expected" };
    Ok(CostReport {
        title: scene.title.clone(),
        dimension: scene.dimension,
        reference: reference.to_owned(),
        reference_error: None,
        runs,
    })
}

/// Runs every candidate from coarse to fine, as far as its share of the time reaches.
fn climb(
    scene: &Scene,
    candidates: &[Candidate],
    params: &CostParams,
    each: &mut dyn FnMut(&CostRun),
    run: impl Fn(&Scene) -> Result<CostRun, Error>,
) -> Result<Vec<CostRun>, Error> {
    let share = params.seconds / candidates.len().max(1) as f64;
    let ratios = ratios(scene);
    let mut runs = Vec::new();
    let mut first_error = None;
    for candidate in candidates {
        let start = Instant::now();
        let mut last = 0.0;
        for (k, ratio) in ratios.into_iter().enumerate() {
            let growth =
                k.checked_sub(1).map_or(1.0, |k| (ratios[k] / ratio).powf(GROWTH * scene.dimension as f64));
            let blank = || CostRun {
                method: candidate.name.as_str().to_owned(),
                order: candidate.order.unwrap_or(0),
                spacing: ratio * scene.points.spacing.as_constant().unwrap_or(f64::NAN),
                ..CostRun::default()
            };
            let remaining = share - start.elapsed().as_secs_f64();
            let outcome = if last * growth > remaining.max(0.0) {
                let why = format!(
                    "left out: it would take about {:.0} s, and {:.0} are left for it",
                    last * growth,
                    remaining.max(0.0)
                );
                CostRun { why: Some(why), ..blank() }
            } else {
                let before = Instant::now();
                let outcome = run(&build::with_spacing_times(&candidate.in_scene(scene), ratio));
                last = before.elapsed().as_secs_f64();
                outcome.unwrap_or_else(|error| {
                    let why = error.to_string().lines().next().unwrap_or_default().to_owned();
                    first_error.get_or_insert(error);
                    CostRun { why: Some(why), ..blank() }
                })
            };
            each(&outcome);
            runs.push(outcome);
        }
    }
    match first_error {
        // A scene that nothing can solve is an error; one that some methods cannot solve is not.
        Some(error) if runs.iter().all(|r| r.error.is_none()) => Err(error),
        _ => Ok(runs),
    }
}
