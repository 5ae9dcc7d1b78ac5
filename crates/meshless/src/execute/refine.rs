//! Solving to a tolerance: clouds of smaller and smaller spacing until the estimate of the error says that it is met.
//!
//! Every rung is a solve of the same scene with another spacing and a plan of its own. The next spacing follows from the
//! estimates: the order at which they fall, or that of the method while there is one estimate only. A cloud that does
//! not resolve a layer, a gap or a region is refined as well. A tolerance counts as met where twice the estimate is
//! below it, on the second cloud at the earliest unless it is far below: one estimate alone may be small by chance.

use std::time::Instant;

use super::{Checkpoint, Progress, Solution, adapt, execute_once};
use crate::plan::{AccuracyPlan, Plan};
use crate::report::{AccuracyReport, ContactReport, FluxReport, Report, Rung, ThinLayerReport};
use crate::scene::{AccuracyOf, Scene};
use crate::{Error, build};

/// How much of the tolerance the estimate may take up.
const SHARE: f64 = 0.5;

/// The same on the first cloud.
const SHARE_AT_ONCE: f64 = 0.01;

/// Clouds that are tried at most.
const MAX_RUNGS: usize = 12;

/// Limits of the ratio of a spacing to the one before.
const RATIOS: (f64, f64) = (0.35, 0.8);

/// The ratio where the cloud was too coarse to be solved on, or gave no estimate.
const BLIND_RATIO: f64 = 0.7;

/// The smallest such ratio, towards the spacing at which a layer is seen.
const LEAST_BLIND_RATIO: f64 = 0.2;

/// The part of the order of the method that is counted on after an estimate that did not fall.
const BY_CHANCE: f64 = 0.5;

/// How much coarser gaps are left where they would take too many nodes.
const COARSER_GAP: f64 = 4.0;

/// The order that is counted on at least, and how far above that of the method an observed one is believed.
const LEAST_ORDER: f64 = 0.5;
const ORDER_ABOVE: f64 = 1.0;

/// The order that estimates which the balance has raised must fall at between two clouds; what falls more slowly is not the
/// spacing's.
const LEAST_RAISED_ORDER: f64 = 1.5;

/// Solves a scene to the tolerance of its plan.
pub(super) fn refine(
    scene: &Scene,
    plan: &Plan,
    goal: AccuracyPlan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<Solution, Error> {
    if let Some(checkpoint) = checkpoint {
        return Err(Error::Checkpoint {
            path: checkpoint.path.clone(),
            reason:
                "a tolerance takes several runs, each on a cloud of its own: give a spacing instead of it"
                    .to_owned(),
        });
    }
    let mut rungs: Vec<Rung> = Vec::new();
    let (mut refused, mut thin) = (None, None);
    let (mut rung_scene, mut factor) = (scene.clone(), 1.0);
    let adapts = scene.points.corners.is_some();
    while rungs.len() < MAX_RUNGS {
        let rung_plan = if rungs.is_empty() && adapts {
            with_gaps_in_reach(&mut rung_scene, goal.max_nodes)?
        } else {
            Plan::new(&rung_scene)?
        };
        if rung_plan.predicted.unknowns > goal.max_nodes {
            let needed = rung_plan.predicted.unknowns;
            return Err(unmet(scene, goal, &rungs, refused, thin, Some(needed)));
        }
        let start = Instant::now();
        let (estimate, rung, solution) = match execute_once(&rung_scene, &rung_plan, None, progress) {
            Ok(solution) => {
                let report = &solution.report;
                if let (Some(contact), None) = (report.contacts.first(), report.estimate.l2) {
                    return Err(at_contact(scene, goal, contact));
                }
                let estimate = relative_error(report, goal.of);
                thin = report.thin_layer.clone();
                let why = report.estimate.why_not.clone();
                let rung = Rung {
                    spacing: report.spacing,
                    unknowns: report.unknowns,
                    raised_by: report.estimate.raised_by.clone(),
                    why,
                    ..Rung::default()
                };
                (estimate, rung, Some(solution))
            }
            Err(error) if error.is_too_coarse() => {
                let spacing = rung_scene.points.spacing.as_constant().unwrap_or(f64::NAN);
                let why = Some(error.to_string().lines().next().unwrap_or_default().to_owned());
                refused = Some(error);
                (None, Rung { spacing, why, ..Rung::default() }, None)
            }
            Err(error) => return Err(error),
        };
        rungs.push(Rung { estimate, seconds: start.elapsed().as_secs_f64(), ..rung });
        let share = if rungs.len() > 1 { SHARE } else { SHARE_AT_ONCE };
        if estimate.is_some_and(|e| e <= share * goal.tolerance)
            && let Some(mut solution) = solution
        {
            solution.report.accuracy =
                Some(AccuracyReport { tolerance: goal.tolerance, of: goal.of.as_str().to_owned(), rungs });
            solution.report.seconds.total =
                solution.report.accuracy.iter().flat_map(|a| &a.rungs).map(|r| r.seconds).sum();
            return Ok(solution);
        }
        if out_of_reach(&rungs, goal, scene.dimension) {
            return Err(unmet(scene, goal, &rungs, refused, thin, None));
        }
        let unseen = thin.as_ref().filter(|layer| !layer.seen).zip(rungs.last());
        let blind = unseen
            .map(|(layer, rung)| layer.thickness / rung.spacing)
            .filter(|ratio| ratio.is_finite())
            .map_or(BLIND_RATIO, |ratio| ratio.clamp(LEAST_BLIND_RATIO, BLIND_RATIO));
        let next = next(&rungs, plan.expected_order() as f64, SHARE * goal.tolerance, scene.dimension);
        let asked = match (next, &solution) {
            // What raises an estimate is not where the indicators are.
            (Some(next), Some(solution)) if adapts && solution.report.estimate.raised_by.is_none() => {
                let ratios = (RATIOS.0, RATIOS.1, next.ratio());
                adapt::wanted(&rung_scene, &solution.field, (next.order, next.factor), ratios)
            }
            _ => None,
        };
        match asked {
            Some(wanted) => {
                let adapted = &mut rung_scene.points.adapted;
                (adapted.wanted, adapted.wanted_times) = (wanted, 1.0);
            }
            None => {
                let ratio = next.map_or(blind, Next::ratio);
                factor *= ratio;
                let before = std::mem::replace(&mut rung_scene, build::with_spacing_times(scene, factor));
                let adapted = &mut rung_scene.points.adapted;
                (adapted.wanted, adapted.least_gap) =
                    (before.points.adapted.wanted, before.points.adapted.least_gap);
                adapted.wanted_times = ratio * before.points.adapted.wanted_times;
            }
        }
    }
    Err(unmet(scene, goal, &rungs, refused, thin, None))
}

/// The estimated relative error of what a tolerance is about.
fn relative_error(report: &Report, of: AccuracyOf) -> Option<f64> {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    let over = |error: f64, size: f64| if size > 0.0 { error / size } else { error };
    report.estimate.l2?;
    match of {
        AccuracyOf::U => report.estimate.l2,
        AccuracyOf::Probes => {
            let error = report.probes.iter().filter_map(|probe| probe.estimate).reduce(f64::max)?;
            Some(over(error, largest(&mut [report.extrema.min, report.extrema.max].into_iter())))
        }
        AccuracyOf::Fluxes => {
            let FluxReport { boundaries, interfaces, .. } = report.fluxes.as_ref()?;
            let fluxes = boundaries.iter().map(|b| (b.flux, b.estimate));
            let fluxes: Vec<(f64, Option<f64>)> =
                fluxes.chain(interfaces.iter().map(|i| (i.flux, i.estimate))).collect();
            let error = fluxes.iter().map(|flux| flux.1).try_fold(0.0, |m, e| Some(f64::max(m, e?)))?;
            Some(over(error, largest(&mut fluxes.iter().map(|flux| flux.0))))
        }
    }
}

/// The plan of the first cloud. Gaps that are resolved by more nodes than are allowed are left as thin as they are.
fn with_gaps_in_reach(scene: &mut Scene, max_nodes: f64) -> Result<Plan, Error> {
    let plan = Plan::new(scene);
    let is_within =
        |plan: &Result<Plan, Error>| plan.as_ref().is_ok_and(|p| p.predicted.unknowns <= max_nodes);
    if is_within(&plan) || scene.points.gaps.is_some() {
        return plan;
    }
    let mut coarser = scene.clone();
    while coarser.points.adapted.least_gap < 1.0 {
        coarser.points.adapted.least_gap *= COARSER_GAP;
        let other = Plan::new(&coarser);
        if is_within(&other) {
            *scene = coarser;
            return other;
        }
    }
    plan
}

/// The distance of nodes that a cloud of so many would have were it even: what errors of adapted clouds fall with.
fn even(rung: &Rung, dimension: usize) -> f64 {
    (rung.unknowns as f64).powf(-1.0 / dimension as f64)
}

/// The order at which errors fall from one cloud to another.
fn order_between(before: (&Rung, f64), last: (&Rung, f64), dimension: usize) -> f64 {
    (before.1 / last.1).ln() / (even(before.0, dimension) / even(last.0, dimension)).ln()
}

/// Whether what the balance leaves over falls so slowly that no cloud which is allowed has the tolerance.
fn out_of_reach(rungs: &[Rung], goal: AccuracyPlan, dimension: usize) -> bool {
    let mut known = rungs.iter().rev().filter(|rung| rung.raised_by.is_some());
    let (Some(last), Some(before)) = (known.next(), known.next()) else { return false };
    let (Some(now), Some(then)) = (last.estimate, before.estimate) else { return false };
    if rungs.last().is_some_and(|rung| rung.raised_by.is_none()) {
        return false;
    }
    let order = order_between((before, then), (last, now), dimension);
    let ratio = (now / (SHARE * goal.tolerance)).powf(1.0 / order.max(LEAST_ORDER));
    order < LEAST_RAISED_ORDER && last.unknowns as f64 * ratio * ratio > goal.max_nodes
}

/// What the next cloud has to bring.
#[derive(Debug, Clone, Copy)]
struct Next {
    /// What the error has to fall by.
    factor: f64,
    /// The order that is counted on.
    order: f64,
}

impl Next {
    /// The ratio of the next spacing to the last one, where all fall alike.
    fn ratio(self) -> f64 {
        self.factor.powf(1.0 / self.order).clamp(RATIOS.0, RATIOS.1)
    }
}

/// The same after the clouds that were tried; `None` where the last one gave no estimate.
fn next(rungs: &[Rung], nominal: f64, wanted: f64, dimension: usize) -> Option<Next> {
    let mut known = rungs.iter().rev().filter_map(|r| r.estimate.filter(|e| *e > 0.0).map(|e| (r, e)));
    let last = known.next()?;
    if rungs.last().is_some_and(|r| r.estimate.is_none()) {
        return None;
    }
    let observed = known.next().map(|before| order_between(before, last, dimension));
    let order = match observed.filter(|q| q.is_finite()) {
        // An estimate that did not fall was small by chance before.
        Some(q) if q <= 0.0 => (BY_CHANCE * nominal).max(LEAST_ORDER),
        Some(q) => q.clamp(LEAST_ORDER, nominal + ORDER_ABOVE),
        None => nominal,
    };
    Some(Next { factor: wanted / last.1, order })
}

/// Why the tolerance was not met: what was reached, and what to do.
fn unmet(
    scene: &Scene,
    goal: AccuracyPlan,
    rungs: &[Rung],
    refused: Option<Error>,
    thin: Option<ThinLayerReport>,
    needed: Option<f64>,
) -> Error {
    // Where a layer is what is missing, nodes elsewhere do not help.
    let layer = thin.filter(|_| scene.points.gaps.is_none()).map(|layer| {
        format!(
            "the region \"{}\" is {:.1e} thin near {:?}: `refine_gaps_to = {:.1e}` in [points] puts the nodes there",
            layer.region, layer.thickness, layer.at, layer.resolving_spacing
        )
    });
    let best = rungs.iter().filter_map(|r| r.estimate.map(|e| (e, r))).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((estimate, rung)) = best else {
        // No cloud gave an estimate: the first thing to know is why.
        return refused.unwrap_or_else(|| {
            let message = "no cloud that is allowed gives an estimate of the error";
            let help = layer.as_deref().unwrap_or("allow more nodes by `max_nodes`, or give a spacing");
            located(scene, message.to_owned(), help)
        });
    };
    let message = format!(
        "a relative error of {:.1e} was not reached: the estimate is {estimate:.1e} on {} nodes of spacing {:.3e}",
        goal.tolerance, rung.unknowns, rung.spacing
    );
    let raised = rungs.last().is_some_and(|rung| rung.raised_by.is_some());
    let help = match (layer, needed) {
        (None, _) if raised => "what enters and arises is not what leaves (`balance` in the report of a solve at a spacing): the solution is \
                                singular where interfaces or the boundary have corners, or the method does not conserve there: give a \
                                spacing and look at the balance, or take the method \"gfdm-conservative\""
            .to_owned(),
        (Some(layer), _) => layer,
        (None, Some(needed)) => format!(
            "the next cloud would have {needed:.1e} nodes, and {:.0} are allowed: raise `max_nodes`, take a larger \
             tolerance or another order, or grade the cloud towards corners",
            goal.max_nodes
        ),
        (None, None) => {
            "the error does not fall any more: take a larger tolerance, or another method".to_owned()
        }
    };
    located(scene, message, &help)
}

/// A contact that no cloud resolves.
fn at_contact(scene: &Scene, goal: AccuracyPlan, contact: &ContactReport) -> Error {
    let message = format!(
        "a relative error of {:.1e} cannot be told to be reached: \"{}\" touch near {:?}, where it falls with the root of \
         the spacing only, and no estimate sees it",
        goal.tolerance,
        contact.between.join("\" and \""),
        contact.at
    );
    let help = "leave a gap between them, or let them overlap; or give a spacing instead, and compare with smaller ones";
    located(scene, message, help)
}

fn located(scene: &Scene, message: String, help: &str) -> Error {
    let place = scene.accuracy.as_ref().map_or(&scene.points.place, |spec| &spec.place);
    Error::Unmet(Box::new(place.error(message, help)))
}
