//! The time loop.

use crate::growth::{Taken, Watch};
use crate::tableau::{DIAGONAL, ERROR, GAMMA, WEIGHT};
use crate::{Params, Past, Semidiscrete, State, StepError};

/// Part of the largest step allowed by the error that is taken.
const SAFETY: f64 = 0.85;
/// A step size is kept until it could grow by this factor: a change costs a new factorisation.
const WORTH_GROWING: f64 = 1.6;
/// Largest growth and shrinkage at once.
const MOST_GROWTH: f64 = 8.0;
const MOST_SHRINKAGE: f64 = 0.1;
/// Least share of the tolerance that a step has, however short: what is sharp at the start is gone soon, and its error
/// with it.
const LEAST_SHARE: f64 = 1e-2;
/// Order in the step size of the estimate over the step's share of the tolerance.
const SHARE_ORDER: f64 = 2.0;
/// First step, relative to the time in which the solution would change by itself, times the cubic root of the
/// tolerance.
const FIRST: f64 = 0.1;
/// First step relative to the whole, where nothing happens at the start.
const FIRST_OF_ALL: f64 = 1e-3;
/// Step sizes that differ by less than this part are the same.
const SAME: f64 = 1e-9;
/// Steps below this part of the time reached do not change it reliably.
const SMALLEST: f64 = 1e-13;
/// What jumps again within this part of the time reached is not data that jump.
const APART: f64 = 1e-9;

/// Integrates a [`Semidiscrete`] system.
#[derive(Debug)]
pub struct Stepper<S> {
    system: S,
    params: Params,
    state: State,
    /// When the run was last started anew.
    started: f64,
    watch: Watch,
    /// Changes of the system that the watch knows of.
    changes: usize,
}

/// A tried step.
struct Trial {
    u: Vec<f64>,
    slope: Vec<f64>,
    error: f64,
}

impl<S: Semidiscrete> Stepper<S> {
    /// Starts at `t` from `u`, which need not satisfy the algebraic rows: see [`Semidiscrete::make_consistent`].
    ///
    /// # Errors
    /// [`StepError::Invalid`] for a tolerance or a first step that is not positive, and initial values that are not
    /// finite; those of the system.
    pub fn new(system: S, t: f64, u: Vec<f64>, params: Params) -> Result<Self, StepError<S::Error>> {
        check(&params, t, &u)?;
        let slope = vec![0.0; u.len()];
        let past = Past::default();
        let state = State { t, step: 0.0, u, slope, scale: 0.0, steps: 0, rejected: 0, past };
        let (watch, changes) = (Watch::default(), 0);
        let mut stepper = Self { system, params, state, started: t, watch, changes };
        stepper.start(t).map_err(|source| StepError::System { t, source })?;
        Ok(stepper)
    }

    /// Starts anew at `t` from the values reached.
    fn start(&mut self, t: f64) -> Result<(), S::Error> {
        let state = &mut self.state;
        self.system.make_consistent(t, &mut state.u)?;
        self.system.slope(t, &state.u, &mut state.slope)?;
        state.scale = state.scale.max(self.system.norm(&state.u));
        (state.t, self.started) = (t, t);
        state.step = self.params.first_step.unwrap_or(0.0);
        Ok(())
    }

    /// Goes on from a state that was kept.
    pub fn resume(system: S, state: State, params: Params) -> Self {
        let changes = system.changes();
        Self { system, params, state, started: f64::NEG_INFINITY, watch: Watch::default(), changes }
    }

    /// Where the integration stands.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The system, and where the integration stands.
    pub fn into_parts(self) -> (S, State) {
        (self.system, self.state)
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Steps until `end` is reached, exactly.
    ///
    /// # Errors
    /// See [`step`](Self::step).
    pub fn advance_to(&mut self, end: f64) -> Result<(), StepError<S::Error>> {
        while self.state.t < end {
            self.step(end)?;
        }
        Ok(())
    }

    /// Takes one step towards `end`, and no farther. Does nothing at `end`.
    ///
    /// # Errors
    /// [`StepError::TooSmall`] and [`StepError::TooMany`] where the tolerance cannot be reached, [`StepError::Grows`] where
    /// the system lets disturbances grow, those of the system.
    pub fn step(&mut self, end: f64) -> Result<(), StepError<S::Error>> {
        if self.state.t >= end {
            return Ok(());
        }
        loop {
            let t = self.state.t;
            if self.state.step <= 0.0 {
                self.state.step = self.first_step(end - t);
            }
            if self.state.steps + self.state.rejected >= self.params.max_steps {
                return Err(StepError::TooMany { steps: self.params.max_steps, t });
            }
            // Equal steps to the end: the last one needs no matrix of its own.
            let count = ((end - t) / self.state.step * (1.0 - SAME)).ceil().max(1.0);
            let even = (end - t) / count;
            // What rounding makes of the same division is no new step size, and needs no new matrix.
            let same = (even / self.state.step - 1.0).abs() <= SAME;
            let step = if same { self.state.step } else { even };
            let next = if count == 1.0 { end } else { t + step };
            if step <= SMALLEST * t.abs().max(end.abs()) {
                // Data jump within the step that was rejected last: what follows starts behind it.
                let behind = t + step / MOST_SHRINKAGE;
                if t - self.started <= APART * end.abs() || behind >= end {
                    return Err(StepError::TooSmall { t, step });
                }
                self.start(behind).map_err(|source| StepError::System { t: behind, source })?;
                continue;
            }
            let trial = self.attempt(t, next, step).map_err(|source| StepError::System { t, source })?;
            if !trial.error.is_finite() {
                return Err(StepError::NotFinite { t: next });
            }
            let share = (step / self.params.whole).max(LEAST_SHARE);
            let fits = self.params.tolerance * share / trial.error.max(f64::MIN_POSITIVE);
            let factor = SAFETY * fits.powf(1.0 / SHARE_ORDER);
            if fits < 1.0 && !self.params.fixed {
                self.state.rejected += 1;
                self.state.step = step * factor.max(MOST_SHRINKAGE);
                continue;
            }
            let grows = factor >= WORTH_GROWING && !self.params.fixed;
            self.state.step = if grows { step * factor.min(MOST_GROWTH) } else { step };
            self.state.scale = self.state.scale.max(self.system.norm(&trial.u));
            self.state.t = next;
            self.state.u = trial.u;
            self.state.slope = trial.slope;
            self.state.steps += 1;
            return self.look_for_growth(t, step);
        }
    }

    /// Whether the step that was taken from `since` lets something grow, or has let it.
    fn look_for_growth(&mut self, since: f64, step: f64) -> Result<(), StepError<S::Error>> {
        if !self.system.may_grow() {
            return Ok(());
        }
        let changes = self.system.changes();
        let taken = Taken { since, step, changed: changes != self.changes };
        self.changes = changes;
        let (system, t, c) = (&mut self.system, self.state.t, DIAGONAL * step);
        let algebraic = system.algebraic(self.state.u.len());
        let weights = || algebraic.iter().map(|&a| f64::from(u8::from(!a))).collect();
        let apply = |e: &mut [f64], clean: bool| match clean {
            true => system.damp(t, c, e),
            false => system.decay(t, c, e),
        };
        let grown = self.watch.take(&mut self.state.past, taken, &weights, apply);
        match grown.map_err(|source| StepError::System { t, source })? {
            Some(grown) => Err(StepError::Grows {
                t,
                since: grown.since,
                growth: grown.growth.exp(),
                place: grown.place,
            }),
            None => Ok(()),
        }
    }

    /// A step that is short beside the time in which the solution changes.
    fn first_step(&self, whole: f64) -> f64 {
        let rate = self.system.norm(&self.state.slope);
        let wanted = FIRST * self.params.tolerance.cbrt() * self.state.scale / rate;
        if wanted > 0.0 && wanted.is_finite() { wanted.min(0.1 * whole) } else { FIRST_OF_ALL * whole }
    }

    /// One step of TR-BDF2 with its error estimate.
    ///
    /// Slopes of the implicit stages are those that the stages' equations give, `(u - v) / c`: evaluating them from u
    /// would multiply what the solver left over by the stiffness.
    fn attempt(&mut self, t: f64, next: f64, step: f64) -> Result<Trial, S::Error> {
        let State { u: u0, slope: k1, scale, .. } = &self.state;
        let (n, c) = (u0.len(), DIAGONAL * step);
        let slope_of = |u: &[f64], v: &[f64]| -> Vec<f64> { (0..n).map(|i| (u[i] - v[i]) / c).collect() };
        let v: Vec<f64> = (0..n).map(|i| u0[i] + c * k1[i]).collect();
        let mut u = u0.clone();
        self.system.solve(t + GAMMA * step, c, &v, &mut u)?;
        let k2 = slope_of(&u, &v);
        let v: Vec<f64> = (0..n).map(|i| u0[i] + step * WEIGHT * (k1[i] + k2[i])).collect();
        self.system.solve(next, c, &v, &mut u)?;
        let k3 = slope_of(&u, &v);
        let mut e: Vec<f64> =
            (0..n).map(|i| step * (ERROR[0] * k1[i] + ERROR[1] * k2[i] + ERROR[2] * k3[i])).collect();
        self.system.damp(next, c, &mut e)?;
        let scale = scale.max(self.system.norm(&u));
        let error = self.system.norm(&e);
        let error = if scale > 0.0 { error / scale } else { error };
        Ok(Trial { u, slope: k3, error })
    }
}

fn check<E: std::error::Error>(params: &Params, t: f64, u: &[f64]) -> Result<(), StepError<E>> {
    let positive = |what, value: f64| match value > 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(StepError::Invalid { what, value, expected: "positive and finite" }),
    };
    positive("the tolerance", params.tolerance)?;
    positive("the whole time", params.whole)?;
    params.first_step.map_or(Ok(()), |step| positive("the first step", step))?;
    match std::iter::once(&t).chain(u).find(|x| !x.is_finite()) {
        Some(&value) => Err(StepError::Invalid { what: "an initial value", value, expected: "finite" }),
        None => Ok(()),
    }
}
