//! Estimates of single figures: values at probes, fluxes, extrema, in the units of each.
//!
//! A figure is told by the solution that the estimate is made from as well: by how much both differ is its error, or a known multiple
//! of that. Two solutions may agree in one figure by chance, so a value counts as no better known than a share of the mean error of its region;
//! and where something says that both make the same mistake, than all of that. A flux counts as no better known than what is left over of the balance
//! that it is part of.

use std::collections::BTreeMap;

use meshless_interfaces::{Problem, SystemSolution};

use super::balance::{Flows, Ledger};
use super::estimate::Other;
use super::samples::samples;
use super::{Solved, measure};
use crate::Error;
use crate::plan::Plan;
use crate::report::{BalanceReport, Estimate, Extrema, Probe};
use crate::scene::{ConditionSpec, RegionSpec, Scene};

/// Part of the mean error of a region that an error at one place of it has at least.
const SHARE: f64 = 0.3;

/// Absolute mean errors.
struct MeanErrors {
    whole: f64,
    regions: Vec<Option<f64>>,
    /// The part of them that counts at one place.
    share: f64,
}

impl MeanErrors {
    /// `None` where there is no estimate.
    fn new<const D: usize>(scene: &Scene, solved: &Solved<D>, estimate: &Estimate) -> Option<Self> {
        let whole = estimate.l2?;
        let mut sums = vec![(0.0, 0.0); scene.regions.len()];
        let nodes = solved.system.u.iter().zip(solved.discrete.measures()).zip(&solved.discrete.labels);
        for ((u, measure), &label) in nodes {
            let (squares, all) = &mut sums[label as usize];
            *squares += measure * u * u;
            *all += measure;
        }
        let mean = |(squares, all): (f64, f64)| if all > 0.0 { (squares / all).sqrt() } else { 0.0 };
        let all = sums.iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        let of_region = |(spec, sums): (&RegionSpec, &(f64, f64))| {
            estimate.regions.get(&spec.name).map(|relative| relative * mean(*sums))
        };
        Some(Self {
            whole: whole * mean(all),
            regions: scene.regions.iter().zip(&sums).map(of_region).collect(),
            share: if estimate.raised_by.is_some() { 1.0 } else { SHARE },
        })
    }

    /// What an error in a region is at least, about.
    fn at_least(&self, region: Option<u16>) -> f64 {
        let own = region.and_then(|region| self.regions.get(region as usize).copied().flatten());
        self.share * own.unwrap_or(self.whole)
    }
}

/// Estimates the values at the probes.
pub(super) fn of_probes<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    solved: &Solved<D>,
    (other, estimate): (&Other<D>, &Estimate),
    probes: &mut [Probe],
) -> Result<(), Error> {
    let Some(errors) = MeanErrors::new(scene, solved, estimate).filter(|_| !probes.is_empty()) else {
        return Ok(());
    };
    let places: Vec<[f64; D]> = probes.iter().map(|probe| std::array::from_fn(|k| probe.at[k])).collect();
    let problem = solved.discrete.problem();
    let own = samples(&plan.method.params, &problem, &solved.system, &places)?;
    let (others, shift, times): (Vec<Option<f64>>, f64, f64) = match other {
        Other::None => (vec![None; probes.len()], 0.0, 1.0),
        Other::Finer { method, system, shift } => {
            let found = samples(method, &problem, system, &places)?;
            (found.into_iter().map(|sample| sample.map(|s| s.value)).collect(), *shift, 1.0)
        }
        Other::Coarser { scene, plan, solved, shift, times } => {
            let found = measure::probes(scene, plan, solved)?;
            (found.into_iter().map(|probe| probe.value).collect(), *shift, *times)
        }
    };
    for ((probe, own), other) in probes.iter_mut().zip(&own).zip(others) {
        let difference = probe.value.zip(other).map_or(0.0, |(value, other)| value - other - shift);
        let least = errors.at_least(own.as_ref().map(|sample| sample.region));
        probe.estimate = probe.value.map(|_| least.hypot(difference / times));
    }
    Ok(())
}

/// Estimates the smallest and the largest value of a node.
pub(super) fn of_extrema<const D: usize>(
    scene: &Scene,
    solved: &Solved<D>,
    (other, estimate): (&Other<D>, &Estimate),
    extrema: &mut Extrema,
) {
    let Some(errors) = MeanErrors::new(scene, solved, estimate) else { return };
    let u = &solved.system.u;
    // Each in the region of the node that has it.
    let at = |is_better: fn(f64, f64) -> bool| {
        (0..u.len()).reduce(|best, i| if is_better(u[i], u[best]) { i } else { best })
    };
    let of_node = |i: usize| {
        let difference = match other {
            Other::Finer { system, shift, .. } => u[i] - system.u[i] - shift,
            _ => 0.0,
        };
        errors.at_least(Some(solved.discrete.labels[i])).hypot(difference)
    };
    extrema.estimate =
        [at(|a, b| a < b), at(|a, b| a > b)].into_iter().flatten().map(of_node).reduce(f64::max);
}

/// The fluxes of the other solution, with what differences to them are to be divided by.
pub(super) fn other_flows<const D: usize>(
    ledger: &Ledger<D>,
    problem: &Problem<'_, D>,
    other: &Other<D>,
) -> Result<Option<(Flows, f64)>, Error> {
    Ok(match other {
        Other::None => None,
        Other::Finer { method, system, .. } => Some((ledger.flows(method, problem, system)?, 1.0)),
        Other::Coarser { scene, plan, solved, times, .. } => {
            let problem = solved.discrete.problem();
            let system: &SystemSolution = &solved.system;
            let flows = Ledger::new(scene, plan, solved)?.flows(&plan.method.params, &problem, system)?;
            Some((flows, *times))
        }
    })
}

/// Estimates the fluxes of a balance.
pub(super) fn of_fluxes(
    scene: &Scene,
    (flows, balance): (&mut Flows, &mut BalanceReport),
    other: Option<(&Flows, f64)>,
) {
    let whole = balance.left_over.abs();
    let left: BTreeMap<&str, f64> =
        balance.regions.iter().map(|(name, region)| (name.as_str(), region.left_over.abs())).collect();
    for flux in &mut flows.interfaces {
        let known = other.and_then(|(flows, times)| {
            let same = flows.interfaces.iter().find(|known| known.between == flux.between)?;
            Some((same.flux - flux.flux).abs() / times)
        });
        // One side that closes says what passes.
        let closes = flux.between.iter().filter_map(|name| left.get(name.as_str()).copied()).reduce(f64::min);
        flux.estimate = known.map(|difference| difference.max(closes.unwrap_or(whole)));
    }
    for (flux, reported) in flows.boundaries.iter_mut().zip(&mut balance.into) {
        let same = other.and_then(|(flows, times)| {
            let same = flows.boundaries.iter().find(|known| known.entry == flux.entry)?;
            Some((same.flux - flux.flux).abs() / times)
        });
        // What is prescribed is known.
        let condition = &scene.boundaries[flux.entry].condition;
        let is_prescribed = matches!(condition, ConditionSpec::Neumann(_) | ConditionSpec::Flux(_));
        let least = if is_prescribed { 0.0 } else { whole };
        flux.estimate = same.map(|difference| difference.max(least));
        reported.estimate = flux.estimate;
    }
}
