//! Scenes that change with time: the same rows in space, stepped by TR-BDF2.

mod checkpoint;
mod system;

use std::time::Instant;

use meshless_interfaces::SystemSolution;
use meshless_time::{Params, StepError, Stepper};

use super::{Discrete, Progress, Solved};
use crate::plan::{Plan, Stage};
use crate::report::{Seconds, TimeReport};
use crate::scene::{ExprField, Scene, TimeSpec};
use crate::{Error, build};
pub use checkpoint::Checkpoint;
use system::Heat;

/// The field at a time before the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time.
    pub t: f64,
    /// Nodal values.
    pub u: Vec<f64>,
}

/// What an unsteady solve leaves besides the field at the end.
#[derive(Debug, Clone)]
pub(super) struct History {
    pub(super) report: TimeReport,
    pub(super) frames: Vec<Frame>,
}

/// Integrates from time 0, or from where a checkpoint was left, to the end.
pub(super) fn solve_in<const D: usize>(
    scene: &Scene,
    time: &TimeSpec,
    plan: &Plan,
    checkpoint: Option<&Checkpoint>,
    progress: &mut dyn Progress,
) -> Result<Solved<D>, Error> {
    let mut seconds = Seconds::default();
    let discrete = Discrete::<D>::build(&scene.at_time(0.0), plan, progress, &mut seconds)?;
    let heat = Heat::new(scene, plan, discrete, progress)?;
    progress.stage(Stage::TimeSteps);
    let params = Params { tolerance: time.tolerance, whole: time.end, ..Params::default() };
    let mut frames = Vec::new();
    let kept = checkpoint.map(|c| c.read(scene, plan, heat.unknowns())).transpose()?.flatten();
    let mut stepper = match kept {
        Some(kept) => {
            frames = kept.frames;
            Stepper::resume(heat, kept.state, params)
        }
        None => {
            let start = initial(time, &heat)?;
            Stepper::new(heat, 0.0, start, params).map_err(explain)?
        }
    };
    let mut saved = Instant::now();
    for &target in time.output.iter().chain([&time.end]) {
        if target <= stepper_time(&stepper) {
            continue;
        }
        while stepper_time(&stepper) < target {
            let t = stepper_time(&stepper);
            if !progress.proceed(t, time.end) {
                checkpoint.map_or(Ok(()), |c| c.write(scene, plan, stepper.state(), &frames))?;
                return Err(Error::Stopped { t });
            }
            stepper.step(target).map_err(explain)?;
            if let Some(checkpoint) = checkpoint.filter(|c| saved.elapsed() >= c.every) {
                checkpoint.write(scene, plan, stepper.state(), &frames)?;
                saved = Instant::now();
            }
        }
        if target < time.end {
            frames.push(Frame { t: target, u: stepper.state().u.clone() });
        }
    }
    let (heat, mut state) = stepper.into_parts();
    let nodes = heat.nodes();
    frames.iter_mut().for_each(|frame| frame.u.truncate(nodes));
    let report = TimeReport {
        end: time.end,
        steps: state.steps,
        rejected: state.rejected,
        matrices: heat.matrices,
        output: frames.iter().map(|frame| frame.t).collect(),
    };
    let (discrete, discretization, (info, split), spent) = heat.into_parts(time.end)?;
    seconds.stencils += spent.stencils;
    seconds.assembly = spent.assembly;
    seconds.solve = spent.solve;
    state.slope.truncate(nodes);
    let system = SystemSolution {
        extra: state.u.split_off(nodes),
        u: state.u,
        info,
        floating_constants: 0,
        up_to_constant: false,
        split,
        rates: Some(state.slope),
    };
    Ok(Solved { discrete, discretization, system, seconds, history: Some(History { report, frames }) })
}

fn stepper_time<const D: usize>(stepper: &Stepper<Heat<'_, D>>) -> f64 {
    stepper.state().t
}

/// The initial values. Where u is prescribed, what is prescribed will count.
fn initial<const D: usize>(time: &TimeSpec, heat: &Heat<'_, D>) -> Result<Vec<f64>, Error> {
    let points = heat.discrete().cloud.points();
    let mut u = vec![0.0; points.len()];
    if let Some(ExprField { expr, place, .. }) = &time.initial {
        build::field::<D>(expr).eval(points, &mut u);
        if let Some(i) = u.iter().position(|u: &f64| !u.is_finite()) {
            let message = format!("the initial value is {} at {:?}", u[i], points[i]);
            return Err(place.error(message, "it must be finite at every node").into());
        }
    }
    // What else is unknown follows from the nodes.
    u.resize(heat.unknowns(), 0.0);
    Ok(u)
}

/// Errors of the solve as they are; those of the steps in words.
fn explain(error: StepError<Error>) -> Error {
    match error {
        StepError::System { source, .. } => source,
        other => Error::Time(other.to_string()),
    }
}
