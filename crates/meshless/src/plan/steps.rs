//! How many steps in time a scene is expected to take: those of heat along a line through it.
//!
//! Steps follow the solution: short where it starts from values that do not fit or where data jump, long where little is left to
//! happen. So the steps themselves are taken, to the tolerance and the output times of the scene, with its materials, sources and
//! conditions, but in a row of cells along a line through the deepest point of the domain: along each axis, of which the one that
//! takes the most steps counts. What lies beside the line, jumps at interfaces, and slits are not seen.

use std::convert::Infallible;

use meshless_interfaces::Condition;
use meshless_time::{Params, Semidiscrete, Stepper};

use crate::Error;
use crate::build::{Line, LineData, lines};
use crate::scene::{Scene, TimeSpec, Varying};

/// Fewest and most cells along a line.
const CELLS: [f64; 2] = [16.0, 128.0];

/// Steps that are tried at most; what is left of the time then is taken in proportion.
const MOST_STEPS: usize = 2000;

/// What the steps in time are expected to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedSteps {
    /// Steps that are kept.
    pub steps: f64,
    /// Linear systems that are solved.
    pub solves: f64,
    /// Matrices that are factored, or made a preconditioner for.
    pub matrices: f64,
    /// How often the right-hand side is made anew because data depend on `t`.
    pub changes: f64,
}

/// The steps of a scene with so many nodes; `None` for a steady one.
pub(super) fn predict(scene: &Scene, unknowns: f64) -> Result<Option<PredictedSteps>, Error> {
    let Some(time) = &scene.time else { return Ok(None) };
    match scene.dimension {
        1 => predict_in::<1>(scene, time, unknowns),
        2 => predict_in::<2>(scene, time, unknowns),
        _ => predict_in::<3>(scene, time, unknowns),
    }
}

fn predict_in<const D: usize>(
    scene: &Scene,
    time: &TimeSpec,
    unknowns: f64,
) -> Result<Option<PredictedSteps>, Error> {
    let cells = unknowns.powf(1.0 / D as f64).clamp(CELLS[0], CELLS[1]) as usize;
    let taken = lines::<D>(scene, cells)?.into_iter().filter_map(|line| Bar::new(scene, line).run(time));
    Ok(taken.max_by(|a, b| a.solves.total_cmp(&b.solves)))
}

/// Heat along a line: balances over its cells.
struct Bar<'a, const D: usize> {
    scene: &'a Scene,
    line: Line<D>,
    varying: Varying,
    /// The scene as it is at the time for which the rows hold.
    now: Scene,
    rows: Rows,
    /// Step size, times a factor, that the last matrix was for.
    c: f64,
    solves: f64,
    matrices: f64,
    changes: f64,
}

/// `du/dt = b - A u` with three diagonals.
struct Rows {
    lower: Vec<f64>,
    diagonal: Vec<f64>,
    upper: Vec<f64>,
    rhs: Vec<f64>,
}

impl Rows {
    fn new(width: f64, data: &LineData) -> Self {
        let (eta, n) = (&data.diffusivity, data.diffusivity.len());
        // Two half cells in a row.
        let between = |i: usize| 2.0 / (width * width * (1.0 / eta[i] + 1.0 / eta[i + 1]));
        let lower: Vec<f64> = (0..n).map(|i| if i > 0 { -between(i - 1) } else { 0.0 }).collect();
        let upper: Vec<f64> = (0..n).map(|i| if i + 1 < n { -between(i) } else { 0.0 }).collect();
        let mut diagonal: Vec<f64> = (0..n).map(|i| -lower[i] - upper[i]).collect();
        let mut rhs = data.source.clone();
        for (i, end) in [0, n - 1].into_iter().zip(&data.ends) {
            // What enters is `given - taken u` with u in the last cell, half a cell away.
            let half = 2.0 * eta[i] / width;
            let (taken, given) = match end {
                Some(Condition::Dirichlet(u)) => (half, half * u),
                Some(Condition::Neumann(slope)) => (0.0, eta[i] * slope),
                Some(Condition::Flux(flux)) => (0.0, *flux),
                Some(Condition::Robin { a, b, g }) => {
                    let share = half / (half + a / b);
                    (share * a / b, share * g / b)
                }
                _ => (0.0, 0.0),
            };
            diagonal[i] += taken / width;
            rhs[i] += given / width;
        }
        Self { lower, diagonal, upper, rhs }
    }

    /// Solves `(1 / c + A) u = rhs`, in place.
    fn solve(&self, c: f64, u: &mut [f64]) {
        let n = u.len();
        let mut above = vec![0.0; n];
        for i in 0..n {
            let (left, up) = if i > 0 { (u[i - 1], above[i - 1]) } else { (0.0, 0.0) };
            let pivot = 1.0 / c + self.diagonal[i] - self.lower[i] * up;
            above[i] = self.upper[i] / pivot;
            u[i] = (u[i] - self.lower[i] * left) / pivot;
        }
        for i in (1..n).rev() {
            u[i - 1] -= above[i - 1] * u[i];
        }
    }
}

impl<'a, const D: usize> Bar<'a, D> {
    fn new(scene: &'a Scene, line: Line<D>) -> Self {
        let now = scene.at_time(0.0);
        let rows = Rows::new(line.width, &line.data(&now));
        let varying = scene.varying();
        Self { scene, line, varying, now, rows, c: 0.0, solves: 0.0, matrices: 0.0, changes: 0.0 }
    }

    /// Steps to the end; `None` where data on the line are no numbers.
    fn run(self, time: &TimeSpec) -> Option<PredictedSteps> {
        let params =
            Params { tolerance: time.tolerance, whole: time.end, max_steps: MOST_STEPS, ..Params::default() };
        let start = self.line.initial(self.scene);
        let mut stepper = Stepper::new(self, 0.0, start, params).ok()?;
        // Whatever ends the steps early, they have gone some way.
        let _ = time.output.iter().chain([&time.end]).try_for_each(|&target| stepper.advance_to(target));
        let (bar, state) = stepper.into_parts();
        let rest = time.end / state.t;
        rest.is_finite().then_some(PredictedSteps {
            steps: rest * state.steps as f64,
            solves: rest * bar.solves,
            matrices: rest * bar.matrices,
            changes: rest * bar.changes,
        })
    }

    fn move_to(&mut self, t: f64) {
        if !self.varying.data {
            return;
        }
        let scene = self.scene.at_time(t);
        let changed = scene.differs_from(&self.now);
        if changed.data {
            self.rows = Rows::new(self.line.width, &self.line.data(&scene));
            self.now = scene;
            self.changes += 1.0;
        }
        if changed.matrix {
            self.c = 0.0;
        }
    }

    fn count(&mut self, c: f64) {
        self.solves += 1.0;
        if self.c != c {
            self.matrices += 1.0;
            self.c = c;
        }
    }
}

impl<const D: usize> Semidiscrete for Bar<'_, D> {
    type Error = Infallible;

    fn slope(&mut self, t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Infallible> {
        self.move_to(t);
        let Rows { lower, diagonal, upper, rhs } = &self.rows;
        for (i, out) in out.iter_mut().enumerate() {
            let left = if i > 0 { lower[i] * u[i - 1] } else { 0.0 };
            let right = u.get(i + 1).map_or(0.0, |next| upper[i] * next);
            *out = rhs[i] - diagonal[i] * u[i] - left - right;
        }
        Ok(())
    }

    fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Infallible> {
        self.move_to(t);
        self.count(c);
        u.iter_mut().zip(v.iter().zip(&self.rows.rhs)).for_each(|(u, (v, b))| *u = v / c + b);
        self.rows.solve(c, u);
        Ok(())
    }

    fn damp(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Infallible> {
        self.move_to(t);
        self.count(c);
        e.iter_mut().for_each(|e| *e /= c);
        self.rows.solve(c, e);
        Ok(())
    }

    fn may_grow(&self) -> bool {
        false
    }

    fn norm(&self, e: &[f64]) -> f64 {
        (e.iter().map(|e| e * e).sum::<f64>() / e.len() as f64).sqrt()
    }
}
