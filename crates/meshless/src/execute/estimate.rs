//! The error estimate: the same scene on a cloud of twice the spacing, compared with the solution.
//!
//! With an error of order q in the spacing h, `u_2h - u_h = (2^q - 1) e_h` up to higher orders, so the norm of the
//! difference over `2^q - 1` estimates that of the error. Where something jumps at an interface q = 1 is taken, which
//! every method here reaches; else the order of the stencils. On clouds of irregular nodes the difference is itself
//! irregular; expect a factor of three.
//!
//! A method that has a higher degree of itself on the same cloud is compared with that instead: the difference is the error but for
//! that of the higher degree. On few nodes both comparisons are made, and the larger one counts
//! where it is of a solution that is not resolved.
//!
//! Where the nodes do not see a layer, or stiff regions touch in a point, no comparison of theirs does, and there is no estimate.

use std::collections::BTreeMap;

use meshless_interfaces::{Sampler, SystemParams, SystemSolution, solve};
use rayon::prelude::*;

use super::{Silent, Solved, indicator, solve_in};
use crate::norms::ErrorNorms;
use crate::plan::{MethodParams, Plan, Stage};
use crate::report::{ContactReport, Estimate, ThinLayerReport};
use crate::scene::Scene;
use crate::{Error, build};

/// Part of the size of u over all that is round-off in a region.
const ROUND_OFF: f64 = 1e-13;

/// Up to so many nodes two degrees may agree by chance, and a coarser cloud costs little: then both comparisons are made.
const FEW: usize = 1000;

/// Degrees agree by chance only where neither resolves the solution. A comparison with a coarser cloud that says less than this is
/// of a smooth solution, where errors fall faster than the order promises, and two degrees tell more.
const RESOLVED: f64 = 1e-3;

/// Variation of u in a region, over its size, below which u is constant there: the region is stiff.
const CONSTANT: f64 = 1e-3;

/// Spacing of the coarser cloud over that of the finer one.
const RATIO: f64 = 2.0;

/// What no comparison of clouds or orders tells of.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Unresolved<'a> {
    /// A layer that is thin for the nodes.
    pub(crate) thin_layer: Option<&'a ThinLayerReport>,
    /// Places where stiff regions touch.
    pub(crate) contacts: &'a [ContactReport],
}

impl Unresolved<'_> {
    /// Why there is no estimate; `None` where there is one.
    fn why_not(&self) -> Option<String> {
        let layer = self.thin_layer.filter(|layer| !layer.seen);
        let layer =
            layer.map(|l| format!("nodes on both sides of a layer of \"{}\" do not see it", l.region));
        layer.or_else(|| self.contacts.first().map(ContactReport::why_not))
    }
}

impl ContactReport {
    /// Why there is no estimate.
    fn why_not(&self) -> String {
        let between = self.between.join("\" and \"");
        format!(
            "\"{between}\" touch near {:?}, and the tip between them is not resolved by any spacing",
            self.at
        )
    }
}

/// The solution that an estimate is made from.
#[expect(clippy::large_enum_variant, reason = "there is one of a run")]
pub(crate) enum Other<const D: usize> {
    /// There is none.
    None,
    /// By a method of a higher degree on the same cloud, less a constant where nothing fixes that.
    Finer { method: MethodParams, system: SystemSolution, shift: f64 },
    /// On a coarser cloud: what it differs by, less a constant, is so many times the error.
    Coarser {
        /// The scene, at the end where it has time.
        scene: Scene,
        plan: Plan,
        solved: Box<Solved<D>>,
        shift: f64,
        times: f64,
    },
}

/// An estimate with what it was made from.
pub(crate) struct Estimated<const D: usize> {
    pub(crate) estimate: Estimate,
    /// Where the method is compared with itself on the same cloud: `u` minus the finer solution at every node.
    pub(crate) differences: Option<Vec<f64>>,
    /// How large the own part of every node in the error is, in units of u.
    pub(crate) indicator: Option<Vec<f64>>,
    pub(crate) other: Other<D>,
}

impl<const D: usize> Estimated<D> {
    /// None, for a reason.
    pub(crate) fn none(why_not: String) -> Self {
        Estimate { why_not: Some(why_not), ..Estimate::default() }.into()
    }
}

impl<const D: usize> From<Estimate> for Estimated<D> {
    fn from(estimate: Estimate) -> Self {
        Self { estimate, differences: None, indicator: None, other: Other::None }
    }
}

/// The estimate of a method's own choice, and where the method is compared with itself on the same cloud, `u` minus the finer
/// solution at every node.
pub(crate) fn estimate<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    solved: &Solved<D>,
    unresolved: &Unresolved<'_>,
) -> Result<Estimated<D>, Error> {
    if let Some(why_not) = unresolved.why_not() {
        return Ok(Estimated::none(why_not));
    }
    let mut estimated = match plan.finer() {
        Some(finer) => {
            let mut estimated = against_finer(scene, plan, finer, solved)?;
            if estimated.estimate.l2.is_some() && solved.discrete.cloud.len() <= FEW {
                let coarser = against_coarser(scene, plan, solved)?.estimate;
                if coarser.l2.is_some_and(|l2| l2 > RESOLVED) {
                    take_larger(&mut estimated.estimate, &coarser);
                }
            }
            estimated
        }
        None => against_coarser(scene, plan, solved)?,
    };
    if estimated.estimate.l2.is_some_and(|l2| !l2.is_finite()) {
        let why_not = "the squares of u are beyond double precision: take other units".to_owned();
        return Ok(Estimated { differences: estimated.differences, ..Estimated::none(why_not) });
    }
    if let Some(own) = &mut estimated.indicator {
        let problem = solved.discrete.problem();
        let of_data = indicator::of_data(&problem, &solved.system.u, plan.method.params.order());
        own.iter_mut().zip(of_data).for_each(|(own, data)| *own = own.max(data));
        *own = indicator::smoothed(problem.supports.lists, own);
    }
    Ok(estimated)
}

/// The larger of two estimates, for the whole and for every region that both have.
fn take_larger(estimate: &mut Estimate, other: &Estimate) {
    if let (Some(l2), Some(more)) = (&mut estimate.l2, other.l2) {
        *l2 = l2.max(more);
    }
    for (name, own) in &mut estimate.regions {
        *own = other.regions.get(name).map_or(*own, |more| own.max(*more));
    }
}

/// Norms over all nodes and over those of each region.
struct Norms {
    whole: ErrorNorms,
    regions: Vec<ErrorNorms>,
}

impl Norms {
    fn of(scene: &Scene) -> Self {
        Self { whole: ErrorNorms::default(), regions: vec![ErrorNorms::default(); scene.regions.len()] }
    }

    fn add(&mut self, label: u16, measure: f64, difference: f64, value: f64) {
        self.whole.add(measure, difference, value);
        self.regions[label as usize].add(measure, difference, value);
    }

    /// Differences are so many times the error.
    fn estimate(&self, scene: &Scene, times: f64) -> Estimate {
        let least = ROUND_OFF * self.whole.exact_size();
        let named = scene.regions.iter().zip(&self.regions).filter(|(_, norms)| norms.exact_size() > least);
        let regions = named.map(|(region, norms)| (region.name.clone(), norms.l2() / times));
        Estimate {
            l2: Some(self.whole.l2() / times),
            regions: if scene.regions.len() > 1 { regions.collect() } else { BTreeMap::new() },
            ..Estimate::default()
        }
    }
}

fn against_finer<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    finer: MethodParams,
    solved: &Solved<D>,
) -> Result<Estimated<D>, Error> {
    let problem = solved.discrete.problem();
    let params = SystemParams { solver: plan.solver, split_floating: plan.runs(Stage::FloatingConstants) };
    let method = finer.build::<D>();
    let outcome = method.discretize(&problem).and_then(|finer| solve(&problem, &finer, &params));
    let better = match outcome {
        Ok(better) => better,
        Err(error) => {
            let error = solved.discrete.explain(scene, error);
            return Ok(Estimated::none(format!("no solution of a higher order: {error}")));
        }
    };
    let measures = solved.discrete.measures();
    let mut differences: Vec<f64> = solved.system.u.iter().zip(&better.u).map(|(u, b)| u - b).collect();
    let mut shift = 0.0;
    if solved.system.up_to_constant {
        // Where nothing fixes the constant of u, only what differs beside a constant is an error.
        let total: f64 = differences.iter().zip(&measures).map(|(d, m)| d * m).sum();
        shift = total / measures.iter().sum::<f64>();
        differences.iter_mut().for_each(|d| *d -= shift);
    }
    let mut norms = Norms::of(scene);
    for (((&difference, &better), &measure), &label) in
        differences.iter().zip(&better.u).zip(&measures).zip(&solved.discrete.labels)
    {
        norms.add(label, measure, difference, better);
    }
    let mut estimate = norms.estimate(scene, 1.0);
    let constants = of_constants(scene, solved, &differences, &measures);
    take_larger(&mut estimate, &Estimate { regions: constants, ..Estimate::default() });
    let (cloud, lists) = (problem.cloud, problem.supports.lists);
    let indicator =
        Some(indicator::of_differences(cloud.points(), lists, &solved.discrete.labels, &differences));
    let other = Other::Finer { method: finer, system: better, shift };
    Ok(Estimated { estimate, differences: Some(differences), indicator, other })
}

/// Relative errors of regions in which u is constant: two solutions may agree by chance in one number, but that is known from the
/// fluxes round the region, no better than what is outside. Errors there count by what they drive.
fn of_constants<const D: usize>(
    scene: &Scene,
    solved: &Solved<D>,
    differences: &[f64],
    measures: &[f64],
) -> BTreeMap<String, f64> {
    /// Sums over the nodes of a region.
    #[derive(Debug, Clone, Copy, Default)]
    struct Sums {
        measure: f64,
        u: f64,
        squares: f64,
        conducted: f64,
        errors: f64,
    }
    let eta = solved.discrete.problem().eta;
    let mut sums = vec![Sums::default(); scene.regions.len()];
    for (i, (&label, &measure)) in solved.discrete.labels.iter().zip(measures).enumerate() {
        let (sum, u, conducted) = (&mut sums[label as usize], solved.system.u[i], measure * eta[i]);
        sum.measure += measure;
        sum.u += measure * u;
        sum.squares += measure * u * u;
        sum.conducted += conducted;
        sum.errors += conducted * differences[i].powi(2);
    }
    let is_constant = |s: &Sums| {
        let mean_square = s.squares / s.measure;
        mean_square - (s.u / s.measure).powi(2) < CONSTANT.powi(2) * mean_square
    };
    let (conducted, errors) = (sums.iter().filter(|s| s.measure > 0.0 && !is_constant(s)))
        .fold((0.0, 0.0), |(c, e), s| (c + s.conducted, e + s.errors));
    let error = if conducted > 0.0 { (errors / conducted).sqrt() } else { 0.0 };
    let constant = scene.regions.iter().zip(&sums).filter(|(_, s)| s.measure > 0.0 && is_constant(s));
    constant.map(|(region, s)| (region.name.clone(), error / (s.squares / s.measure).sqrt())).collect()
}

fn against_coarser<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    fine: &Solved<D>,
) -> Result<Estimated<D>, Error> {
    let coarse_scene = build::with_spacing_times(scene, RATIO);
    let companion = plan.companion();
    let coarse = match solve_in::<D>(&coarse_scene, &companion, None, &mut Silent) {
        Ok(coarse) => coarse,
        // A region or a gap that the coarser cloud does not resolve is no fault of the scene.
        Err(error) => {
            // What an error says of the scene takes several lines.
            let said = error.to_string();
            let first = said.lines().next().unwrap_or_default();
            let why_not = Some(format!("no solution at twice the spacing: {first}"));
            return Ok(Estimate { why_not, ..Estimate::default() }.into());
        }
    };
    let problem = fine.discrete.problem();
    let sampler = Sampler::new(&problem, &fine.system.u)?;
    let measures = coarse.discrete.measures();
    let values: Vec<Option<(f64, u16)>> = coarse
        .discrete
        .cloud
        .points()
        .par_iter()
        .map_init(|| sampler.scratch(), |scratch, x| sampler.at(x, scratch).map(|s| (s.value, s.region)))
        .collect();
    let differences: Vec<(f64, f64, f64, u16)> = (values.iter().zip(&measures).enumerate())
        .filter_map(|(i, (value, &measure))| {
            let (value, region) = (*value)?;
            (region == coarse.discrete.labels[i])
                .then(|| (measure, coarse.system.u[i] - value, value, region))
        })
        .collect();
    // Where nothing fixes the constant of u, only what differs beside a constant is an error.
    let shift = if fine.system.up_to_constant {
        let total: f64 = differences.iter().map(|d| d.0).sum();
        differences.iter().map(|d| d.0 * d.1).sum::<f64>() / total
    } else {
        0.0
    };
    // Points from a file can only be thinned as they are.
    let nodes = [fine, &coarse].map(|solved| solved.discrete.cloud.len() as f64);
    let ratio = if scene.points.file.is_some() { (nodes[0] / nodes[1]).powf(1.0 / D as f64) } else { RATIO };
    let times = ratio.powi(plan.expected_order() as i32) - 1.0;
    let mut norms = Norms::of(scene);
    differences.iter().for_each(|&(measure, difference, value, region)| {
        // Relative to the extrapolated solution: the size of one that is far off says nothing of its error.
        norms.add(region, measure, difference - shift, value - (difference - shift) / times);
    });
    let indicator = {
        let (cloud, lists) = (&coarse.discrete.cloud, coarse.discrete.problem().supports.lists);
        let of_nodes = |(i, value): (usize, &Option<(f64, u16)>)| {
            value.map_or(0.0, |(value, _)| (coarse.system.u[i] - value - shift) / times)
        };
        let differences: Vec<f64> = values.iter().enumerate().map(of_nodes).collect();
        let own = indicator::of_differences(cloud.points(), lists, &coarse.discrete.labels, &differences);
        indicator::at_nearest(cloud.points(), cloud.spacing(), &own, fine.discrete.cloud.points())
    };
    let scene_at_end = coarse_scene.time.as_ref().map(|time| coarse_scene.at_time(time.end));
    let estimate = norms.estimate(scene, times);
    let other = Other::Coarser {
        scene: scene_at_end.unwrap_or(coarse_scene),
        plan: companion,
        solved: Box::new(coarse),
        // Differences here are the other way round.
        shift: -shift,
        times,
    };
    Ok(Estimated { estimate, differences: None, indicator, other })
}
