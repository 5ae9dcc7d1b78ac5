//! From a plan to a solution, stage by stage; what the plan skips is not built.

mod adapt;
mod balance;
mod contacts;
mod corners;
mod discrete;
mod estimate;
mod figures;
mod fluxes;
mod free_space;
mod honest;
mod indicator;
mod linear;
mod measure;
mod picture;
mod refine;
mod reproduce;
mod samples;
mod summary;
mod thin_layer;
mod unsteady;

use std::time::Instant;

use meshless_interfaces::{
    Discretization, MethodError, RowKind, SystemParams, SystemSolution, diagnose_nodes, solve, thin_layers,
};

use crate::build::Boundary;
use crate::plan::{MethodParams, Plan, Stage};
use crate::report::{Report, Seconds};
use crate::scene::Scene;
use crate::{Error, NodalField, ParticleField};
use balance::Ledger;
pub(crate) use contacts::contacts;
pub(crate) use discrete::{Discrete, Exact};
pub(crate) use estimate::{Estimated, Other, Unresolved, estimate};
pub use linear::{PseudoTimeCost, linear_system, pseudo_time};
pub use picture::Picture;
pub use reproduce::{Reproduction, reproduce};
pub(crate) use thin_layer::thin_layer;
use unsteady::History;
pub use unsteady::{Checkpoint, Frame};

/// Told what is being done; for progress bars.
pub trait Progress {
    /// A stage begins.
    fn stage(&mut self, stage: Stage);

    /// The time steps have reached `t`, on the way to `end`. Whether to go on: otherwise the run ends with
    /// [`Error::Stopped`], after its checkpoint has been written.
    fn proceed(&mut self, _t: f64, _end: f64) -> bool {
        true
    }
}

/// Says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&mut self, _stage: Stage) {}
}

/// A solved scene.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Figures about the solve.
    pub report: Report,
    /// The field at the nodes.
    pub field: NodalField,
    /// The field as a picture, where the plan draws one.
    pub picture: Option<Picture>,
    /// The field at the times before the end at which an unsteady scene asks for it.
    pub frames: Vec<Frame>,
    /// The field at the particles of a scene in free space.
    pub particles: Option<ParticleField>,
}

/// Solves a scene as its plan says.
pub fn execute(scene: &Scene, plan: &Plan, progress: &mut dyn Progress) -> Result<Solution, Error> {
    execute_from(scene, plan, None, progress)
}

/// The same; an unsteady scene goes on from the checkpoint, if its file exists, and keeps it up to date.
pub fn execute_from(
    scene: &Scene,
    plan: &Plan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<Solution, Error> {
    match plan.accuracy {
        Some(goal) if plan.runs(Stage::Refinement) => refine::refine(scene, plan, goal, checkpoint, progress),
        _ => execute_once(scene, plan, checkpoint, progress),
    }
}

/// Solves a scene on one cloud.
pub(crate) fn execute_once(
    scene: &Scene,
    plan: &Plan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<Solution, Error> {
    if scene.free_space.is_some() {
        return match scene.dimension {
            1 => free_space::execute::<1>(scene, plan, progress),
            2 => free_space::execute::<2>(scene, plan, progress),
            _ => free_space::execute::<3>(scene, plan, progress),
        };
    }
    match scene.dimension {
        1 => execute_in::<1>(scene, plan, checkpoint, progress),
        2 => execute_in::<2>(scene, plan, checkpoint, progress),
        _ => execute_in::<3>(scene, plan, checkpoint, progress),
    }
}

/// A solve without what is derived from it.
pub(crate) struct Solved<const D: usize> {
    pub(crate) discrete: Discrete<D>,
    discretization: Discretization,
    pub(crate) system: SystemSolution,
    pub(crate) seconds: Seconds,
    history: Option<History>,
}

impl<const D: usize> Solved<D> {
    /// Nodes whose value was solved for.
    pub(crate) fn unknowns(&self) -> usize {
        self.discretization.kinds.iter().filter(|&&kind| kind != RowKind::Dirichlet).count()
    }

    /// Typical distance of nodes, the least one for graded clouds.
    pub(crate) fn spacing(&self) -> f64 {
        self.discrete.cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b))
    }
}

pub(crate) fn solve_in<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<Solved<D>, Error> {
    match &scene.time {
        Some(time) => unsteady::solve_in(scene, time, plan, checkpoint, progress),
        None => solve_steady(scene, plan, progress),
    }
}

/// The same; where the nodes do not resolve what the method needs, as the plan says that is gone on with then. That plan is
/// returned, too.
fn solve_or_fall_back<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<(Solved<D>, Option<Plan>), Error> {
    match solve_in(scene, plan, checkpoint, progress) {
        Err(Error::Method(error)) => match plan.after(&error, scene)? {
            Some(other) => Ok((solve_in(scene, &other, checkpoint, progress)?, Some(other))),
            None => Err(error.into()),
        },
        outcome => Ok((outcome?, None)),
    }
}

fn solve_steady<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    progress: &mut dyn Progress,
) -> Result<Solved<D>, Error> {
    let mut seconds = Seconds::default();
    let discrete = Discrete::build(scene, plan, progress, &mut seconds)?;
    let problem = discrete.problem();
    progress.stage(if plan.runs(Stage::Cells) { Stage::Cells } else { Stage::LaplacianStencils });
    let start = Instant::now();
    let params = &plan.method.params;
    let method = if plan.runs(Stage::Gradient) { params.keeping_gradients() } else { params.clone() }.build();
    let discretization = method.discretize(&problem).map_err(|e| discrete.explain(scene, e))?;
    seconds.stencils += discretization.stencil_seconds;
    seconds.assembly = start.elapsed().as_secs_f64() - discretization.stencil_seconds;
    progress.stage(Stage::Solve);
    let start = Instant::now();
    let params = SystemParams { solver: plan.solver, split_floating: plan.runs(Stage::FloatingConstants) };
    let system = solve(&problem, &discretization, &params).map_err(|e| match e {
        MethodError::Solve(_) if matches!(plan.method.params, MethodParams::Sharp(_)) => {
            thin_layers::suspect(&problem).map_or(e, |layer| thin_layers::unresolved(&layer))
        }
        e => e,
    });
    let system = system.map_err(|e| discrete.explain(scene, e))?;
    seconds.solve = start.elapsed().as_secs_f64();
    Ok(Solved { discrete, discretization, system, seconds, history: None })
}

fn execute_in<const D: usize>(
    whole: &Scene,
    plan: &Plan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<Solution, Error> {
    let start = Instant::now();
    let (mut solved, other) = solve_or_fall_back::<D>(whole, plan, checkpoint, progress)?;
    let fallback = other.as_ref().map(|other| other.method.why.clone());
    let plan = other.as_ref().unwrap_or(plan);
    // All that follows is about the end.
    let scene = &whole.time.as_ref().map_or_else(|| whole.clone(), |time| whole.at_time(time.end));
    let mut seconds = solved.seconds.clone();
    let post = Instant::now();
    let exact = plan.runs(Stage::Errors).then(|| solved.discrete.exact(scene)).transpose()?;
    if let (true, Some(exact)) = (solved.system.up_to_constant, &exact) {
        measure::match_means(&mut solved, exact);
    }
    let problem = solved.discrete.problem();
    let u = &solved.system.u;
    let gradient = if plan.runs(Stage::Gradient) {
        progress.stage(Stage::Gradient);
        let method = plan.method.params.build();
        Some(solved.discretization.gradient(method.as_ref(), &problem, &solved.system)?)
    } else {
        None
    };
    let errors = match (&exact, &gradient) {
        (Some(exact), Some(gradient)) => Some(measure::errors(scene, &solved, exact, gradient)),
        _ => None,
    };
    let diagnosis = plan
        .runs(Stage::Diagnosis)
        .then(|| diagnose_nodes(&problem, &solved.discretization, plan.method.params.order()));
    let mut probes = measure::probes(scene, plan, &solved)?;
    seconds.post = post.elapsed().as_secs_f64();
    let before = Instant::now();
    let mut ledger = if plan.runs(Stage::Balance) {
        progress.stage(Stage::Balance);
        let ledger = Ledger::new(scene, plan, &solved)?;
        let flows = ledger.flows(&plan.method.params, &problem, &solved.system)?;
        Some((ledger, flows))
    } else {
        None
    };
    let mut balance = ledger.as_ref().map(|(ledger, flows)| ledger.report(flows));
    seconds.balance = before.elapsed().as_secs_f64();
    progress.stage(Stage::Estimate);
    let before = Instant::now();
    let thin_layer = thin_layer(scene, plan, &problem)?;
    let contacts = contacts(scene, &problem);
    let corners = corners::found(plan, &problem, &solved.discretization);
    let Estimated { mut estimate, differences, indicator, other } = if plan.runs(Stage::Estimate) {
        estimate(whole, plan, &solved, &Unresolved { thin_layer: thin_layer.as_ref(), contacts: &contacts })?
    } else {
        Estimated::none("not asked for".to_owned())
    };
    seconds.estimate = before.elapsed().as_secs_f64();
    let before = Instant::now();
    let mut others = match &ledger {
        Some((ledger, _)) if plan.runs(Stage::Fluxes) => figures::other_flows(ledger, &problem, &other)?,
        _ => None,
    };
    if let Some((ledger, flows)) =
        ledger.as_ref().filter(|(l, flows)| honest::suspects(scene, l, flows, &estimate))
    {
        let own;
        let second = match &other {
            Other::Finer { .. } => {
                if others.is_none() {
                    others = figures::other_flows(ledger, &problem, &other)?;
                }
                others.as_ref().map(|(flows, _)| flows)
            }
            _ => {
                own = ledger.other_flows(&plan.method.params, &problem, &solved.system)?;
                own.as_ref()
            }
        };
        let reasons = [honest::by_balance(scene, ledger, flows, second, &estimate)];
        honest::raise(&mut estimate, &reasons);
    }
    honest::raise(&mut estimate, &[corners::reason(scene, &problem, u, &corners)]);
    figures::of_probes(scene, plan, &solved, (&other, &estimate), &mut probes)?;
    let fluxes = match (&mut ledger, &mut balance) {
        (Some((_, flows)), Some(balance)) if plan.runs(Stage::Fluxes) => {
            if estimate.l2.is_some() {
                let others = others.as_ref().map(|(flows, times)| (flows, *times));
                figures::of_fluxes(scene, (flows, balance), others);
            }
            Some(fluxes::fluxes(flows, balance))
        }
        _ => None,
    };
    seconds.balance += before.elapsed().as_secs_f64();
    let before = Instant::now();
    let picture = plan.runs(Stage::Plot).then(|| picture::draw(scene, plan, &solved)).transpose()?;
    seconds.post += before.elapsed().as_secs_f64();
    seconds.total = start.elapsed().as_secs_f64();
    let kinds = &solved.discretization.kinds;
    let field = NodalField::new(&solved.discrete, u, gradient, exact.map(|e| e.values), kinds, diagnosis);
    let field = NodalField { estimate: differences, indicator, ..field };
    let mut report = summary::report(scene, plan, &solved, errors, estimate, seconds, probes);
    figures::of_extrema(scene, &solved, (&other, &report.estimate), &mut report.extrema);
    let corners = corners::report(&corners, problem.domain.bounds().diameter());
    let report = Report { fallback, thin_layer, contacts, corners, fluxes, balance, ..report };
    let frames = solved.history.map_or_else(Vec::new, |history| history.frames);
    Ok(Solution { report, field, picture, frames, particles: None })
}
