//! What errors are measured against.

use meshless_interfaces::{Sample, Sampler};

use super::candidates::Candidate;
use crate::execute::{Silent, Solved, Unresolved, contacts, estimate, solve_in, thin_layer};
use crate::norms::ErrorNorms;
use crate::plan::{Effect, Plan, Stage};
use crate::scene::{MethodName, Scene};
use crate::{Error, build};

/// Spacing of the reference over the finest of the ladder.
const FINER: f64 = 0.7;

/// The same for methods of low order, for which it has to make up by nodes.
const MUCH_FINER: f64 = 0.5;

/// Estimated error at which a reference is taken without a look at the next: fits of high order are the best there is unless
/// a gap or a layer is too thin for them, which their estimates show.
const GOOD: f64 = 1e-3;

/// Order of the sharp method as a reference, by dimension.
const ORDERS: [usize; 3] = [8, 8, 6];

/// The exact solution, or one that is more accurate than all runs.
pub(super) enum Reference<const D: usize> {
    Exact,
    Finest(Box<Finest<D>>),
}

/// A solution on a finer cloud.
pub(super) struct Finest<const D: usize> {
    solved: Solved<D>,
    plan: Plan,
    own_error: Option<f64>,
}

impl<const D: usize> Reference<D> {
    /// `ratio` is the finest spacing of the ladder over that of the scene.
    pub(super) fn new(scene: &Scene, plan: &Plan, ratio: f64) -> Result<Self, Error> {
        if plan.runs(Stage::Errors) {
            return Ok(Self::Exact);
        }
        let slits = plan.effects.contains(&Effect::Slits);
        let mut tried = Vec::new();
        if scene.time.is_none() && !slits {
            tried.push((MethodName::Sharp, Some(ORDERS[D - 1]), FINER));
        }
        tried.push((MethodName::ParticleDifference, None, MUCH_FINER));
        tried.push((MethodName::Auto, None, MUCH_FINER));
        let mut refused = None;
        let mut best: Option<Finest<D>> = None;
        for (name, order, finer) in tried {
            let found = match Finest::solve(
                &Candidate { name, order, kernel: None }.in_scene(scene),
                ratio * finer,
            ) {
                Ok(found) => found,
                Err(error) => {
                    refused = refused.or(Some(error));
                    continue;
                }
            };
            if best.as_ref().is_none_or(|best| found.doubt() < best.doubt()) {
                best = Some(found);
            }
            if best.as_ref().is_some_and(|best| best.doubt() <= GOOD) {
                break;
            }
        }
        match (best, refused) {
            (Some(best), _) => Ok(Self::Finest(Box::new(best))),
            // What is wrong with the scene is what the first attempt says.
            (None, Some(error)) => Err(error),
            (None, None) => Ok(Self::Exact),
        }
    }

    /// What it is.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Exact => "the exact solution".to_owned(),
            Self::Finest(finest) => {
                let method = &finest.plan.method;
                let (order, nodes) = (method.params.order(), finest.solved.unknowns());
                format!("{} of order {order} on {nodes} nodes", method.name.as_str())
            }
        }
    }

    /// Its own relative L2 error, as estimated.
    pub(super) fn own_error(&self) -> Option<f64> {
        match self {
            Self::Exact => None,
            Self::Finest(finest) => finest.own_error,
        }
    }

    /// Relative L2 error of a solution.
    pub(super) fn error(&self, scene: &Scene, solved: &mut Solved<D>) -> Result<f64, Error> {
        let values: Vec<Option<f64>> = match self {
            Self::Exact => {
                let end = scene.time.as_ref().map(|time| scene.at_time(time.end));
                let exact = solved.discrete.exact(end.as_ref().unwrap_or(scene))?;
                exact.values.into_iter().map(Some).collect()
            }
            Self::Finest(finest) => finest.at_nodes_of(solved)?,
        };
        let measures = solved.discrete.measures();
        let both: Vec<(f64, f64, f64)> = (solved.system.u.iter().zip(&values).zip(&measures))
            .filter_map(|((u, value), measure)| Some((*measure, u - (*value)?, (*value)?)))
            .collect();
        let shift = if solved.system.up_to_constant {
            both.iter().map(|(m, d, _)| m * d).sum::<f64>() / both.iter().map(|b| b.0).sum::<f64>()
        } else {
            0.0
        };
        let mut norms = ErrorNorms::default();
        both.iter().for_each(|&(measure, difference, value)| norms.add(measure, difference - shift, value));
        Ok(norms.l2())
    }
}

impl<const D: usize> Finest<D> {
    fn solve(scene: &Scene, ratio: f64) -> Result<Self, Error> {
        let scene = build::with_spacing_times(scene, ratio);
        let plan = Plan::new(&scene)?;
        let solved = solve_in::<D>(&scene, &plan.companion(), None, &mut Silent)?;
        let thin_layer = thin_layer(&scene, &plan, &solved.discrete.problem())?;
        let contacts = contacts(&scene, &solved.discrete.problem());
        let unresolved = Unresolved { thin_layer: thin_layer.as_ref(), contacts: &contacts };
        let own_error = estimate(&scene, &plan, &solved, &unresolved)?.estimate.l2;
        Ok(Self { solved, plan, own_error })
    }

    /// Its estimated error; infinite where there is none.
    fn doubt(&self) -> f64 {
        self.own_error.unwrap_or(f64::INFINITY)
    }

    /// Its values at the nodes of another solution, where both see the same region.
    fn at_nodes_of(&self, other: &Solved<D>) -> Result<Vec<Option<f64>>, Error> {
        let points = other.discrete.cloud.points();
        let problem = self.solved.discrete.problem();
        let method = self.plan.method.params.build();
        let samples: Vec<Option<Sample<D>>> = match method.samples(&problem, &self.solved.system, points)? {
            Some(samples) => samples,
            None => {
                let sampler = Sampler::new(&problem, &self.solved.system.u)?;
                let mut scratch = sampler.scratch();
                points.iter().map(|x| sampler.at(x, &mut scratch)).collect()
            }
        };
        let same = |(sample, &label): (Option<Sample<D>>, &u16)| {
            sample.filter(|s| s.region == label).map(|s| s.value)
        };
        Ok(samples.into_iter().zip(&other.discrete.labels).map(same).collect())
    }
}
