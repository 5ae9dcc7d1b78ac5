//! Scenes that change with time: the same rows in space, stepped by TR-BDF2.

mod checkpoint;
mod pulses;
mod system;

use std::time::Instant;

use meshless_interfaces::{MethodError, SystemSolution};
use meshless_time::{Params, State, StepError, Stepper};

use super::{Discrete, Progress, Solved};
use crate::plan::{Plan, Stage};
use crate::report::{Seconds, TimeReport};
use crate::scene::{ExprField, Scene, TimeSpec};
use crate::{Error, build};
pub use checkpoint::Checkpoint;
use checkpoint::Kept;
use pulses::Pulses;
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
    let pulses = Pulses::new(scene, &heat.discrete().cloud);
    progress.stage(Stage::TimeSteps);
    let kept = checkpoint.map(|c| c.read(scene, plan, heat.unknowns())).transpose()?.flatten();
    let (stepper, frames) = started(time, heat, kept)?;
    let mut run = Run { scene, time, plan, checkpoint, stepper, pulses, frames, saved: Instant::now() };
    for &target in time.output.iter().chain([&time.end]) {
        run.advance_to(target, progress)?;
    }
    run.finish(seconds)
}

/// A run at some time between its start and its end.
struct Run<'a, const D: usize> {
    scene: &'a Scene,
    time: &'a TimeSpec,
    plan: &'a Plan,
    checkpoint: Option<&'a Checkpoint>,
    stepper: Stepper<Heat<'a, D>>,
    /// What steps must not pass over.
    pulses: Pulses,
    frames: Vec<Frame>,
    /// When the checkpoint was written last.
    saved: Instant,
}

/// Steps from the initial values, or from what a checkpoint holds.
fn started<'a, const D: usize>(
    time: &TimeSpec,
    heat: Heat<'a, D>,
    kept: Option<Kept>,
) -> Result<(Stepper<Heat<'a, D>>, Vec<Frame>), Error> {
    let params = Params { tolerance: time.tolerance, whole: time.end, ..Params::default() };
    if let Some(kept) = kept {
        return Ok((Stepper::resume(heat, kept.state, params), kept.frames));
    }
    let start = initial(time, &heat)?;
    let started = Stepper::new(heat, 0.0, start, params);
    Ok((started.map_err(|error| explain::<D>(error, None))?, Vec::new()))
}

impl<const D: usize> Run<'_, D> {
    /// Steps to an output time and keeps the field there; a time that is past was kept before.
    fn advance_to(&mut self, target: f64, progress: &mut dyn Progress) -> Result<(), Error> {
        if target <= self.stepper.state().t {
            return Ok(());
        }
        while self.stepper.state().t < target {
            let State { t, step, .. } = *self.stepper.state();
            if !progress.proceed(t, self.time.end) {
                self.save()?;
                return Err(Error::Stopped { t });
            }
            let taken = self.stepper.step(self.pulses.reach(t, step, target));
            taken.map_err(|error| explain(error, Some(self.stepper.system())))?;
            if self.checkpoint.is_some_and(|c| self.saved.elapsed() >= c.every) {
                self.save()?;
                self.saved = Instant::now();
            }
        }
        if target < self.time.end {
            self.frames.push(Frame { t: target, u: self.stepper.state().u.clone() });
        }
        Ok(())
    }

    fn save(&self) -> Result<(), Error> {
        let Some(checkpoint) = self.checkpoint else { return Ok(()) };
        checkpoint.write(self.scene, self.plan, self.stepper.state(), &self.frames)
    }

    /// The solution at the end and what is said of the way there.
    fn finish(self, mut seconds: Seconds) -> Result<Solved<D>, Error> {
        let (heat, mut state) = self.stepper.into_parts();
        let (nodes, mut frames) = (heat.nodes(), self.frames);
        frames.iter_mut().for_each(|frame| frame.u.truncate(nodes));
        let report = TimeReport {
            end: self.time.end,
            steps: state.steps,
            rejected: state.rejected,
            matrices: heat.matrices,
            output: frames.iter().map(|frame| frame.t).collect(),
        };
        let (discrete, discretization, (info, split), spent) = heat.into_parts(self.time.end)?;
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
            interface_flows: Vec::new(),
        };
        Ok(Solved { discrete, discretization, system, seconds, history: Some(History { report, frames }) })
    }
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
fn explain<const D: usize>(error: StepError<Error>, heat: Option<&Heat<'_, D>>) -> Error {
    match (error, heat) {
        (StepError::System { source, .. }, _) => source,
        (StepError::Grows { t, since, growth, place }, Some(heat)) => {
            MethodError::Grows { t, since, growth, position: heat.position(place) }.into()
        }
        (other, _) => Error::Time(other.to_string()),
    }
}
