//! Modes that grow by themselves end a run before the solution has any of them; nothing else does.

use std::convert::Infallible;

use meshless_time::{Params, Semidiscrete, StepError, Stepper};

/// Unknowns of the systems here.
const N: usize = 300;

/// `du/dt = -B u` with blocks `[[rate, -turn], [turn, rate]]` on the diagonal, and `couple` times the next unknown but one.
struct Blocks {
    rates: Vec<(f64, f64)>,
    couple: f64,
    watched: bool,
    solves: usize,
}

impl Blocks {
    /// Rates of diffusion on a line, from 1 on, of which some are replaced.
    fn new(others: &[(usize, f64, f64)]) -> Self {
        let mut rates: Vec<(f64, f64)> = (1..=N / 2).map(|k| ((k * k) as f64, 0.0)).collect();
        others.iter().for_each(|&(k, rate, turn)| rates[k] = (rate, turn));
        Self { rates, couple: 0.0, watched: true, solves: 0 }
    }

    fn run(self, tolerance: f64, end: f64) -> (Result<(), StepError<Infallible>>, Self, usize) {
        let params = Params { tolerance, whole: end, ..Params::default() };
        // Nothing but the slowest mode.
        let mut start = vec![0.0; N];
        start[0] = 1.0;
        let mut stepper = Stepper::new(self, 0.0, start, params).expect("valid");
        let outcome = stepper.advance_to(end);
        let (system, state) = stepper.into_parts();
        (outcome, system, state.steps + state.rejected)
    }
}

impl Semidiscrete for Blocks {
    type Error = Infallible;

    fn slope(&mut self, _t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Infallible> {
        for (k, &(rate, turn)) in self.rates.iter().enumerate() {
            let (x, y) = (u[2 * k], u[2 * k + 1]);
            let next = |i: usize| u.get(i).map_or(0.0, |u| self.couple * u);
            out[2 * k] = -rate * x + turn * y + next(2 * k + 2);
            out[2 * k + 1] = -turn * x - rate * y + next(2 * k + 3);
        }
        Ok(())
    }

    fn solve(&mut self, _t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Infallible> {
        self.solves += 1;
        for (k, &(rate, turn)) in self.rates.iter().enumerate().rev() {
            let next = |i: usize| u.get(i).map_or(0.0, |u| c * self.couple * u);
            let (a, b) = (v[2 * k] + next(2 * k + 2), v[2 * k + 1] + next(2 * k + 3));
            let (p, q) = (1.0 + c * rate, c * turn);
            let size = p * p + q * q;
            (u[2 * k], u[2 * k + 1]) = ((p * a + q * b) / size, (p * b - q * a) / size);
        }
        Ok(())
    }

    fn damp(&mut self, t: f64, c: f64, e: &mut [f64]) -> Result<(), Infallible> {
        let v = e.to_vec();
        self.solve(t, c, &v, e)
    }

    fn may_grow(&self) -> bool {
        self.watched
    }

    fn norm(&self, e: &[f64]) -> f64 {
        (e.iter().map(|x| x * x).sum::<f64>() / e.len() as f64).sqrt()
    }
}

/// Logarithm of the largest growth of `rate +- turn i` by the steps of a run that nobody watches, from any time on.
fn growth(rate: f64, turn: f64, tolerance: f64) -> f64 {
    let params = Params { tolerance, ..Params::default() };
    let mut start = vec![0.0; N];
    start[0] = 1.0;
    let system = Blocks { watched: false, ..Blocks::new(&[(77, rate, turn)]) };
    let mut stepper = Stepper::new(system, 0.0, start, params).expect("valid");
    let (mut most, mut sum, mut t) = (0.0_f64, 0.0_f64, 0.0);
    while t < 1.0 {
        stepper.step(1.0).expect("nothing of it is in the solution");
        let z = [-rate, -turn].map(|x| x * (stepper.state().t - t));
        t = stepper.state().t;
        // (1 + (1 - 2 d) z) / (1 - d z)^2
        let d = 1.0 - 0.5_f64.sqrt();
        let above = (1.0 + (1.0 - 2.0 * d) * z[0]).hypot((1.0 - 2.0 * d) * z[1]);
        let below = (1.0 - d * z[0]).hypot(d * z[1]);
        sum = (sum + (above / below.powi(2)).ln()).max(0.0);
        most = most.max(sum);
    }
    most
}

/// A mode of any rate, with or without oscillations, that the solution has nothing of. Steps that are too long for it damp it.
#[test]
fn a_mode_that_grows_ends_the_run() {
    let mut grown = 0;
    for k in 0..24 {
        let rate = -10.0_f64.powf(0.25 * f64::from(k));
        for turn in [0.0, 0.3, 3.0] {
            for tolerance in [1e-3, 1e-4, 1e-5] {
                let most = growth(rate, turn * rate, tolerance);
                let what = format!("rate {rate:.3e}, {turn}, tolerance {tolerance:e}: grows by exp {most}");
                match Blocks::new(&[(77, rate, turn * rate)]).run(tolerance, 1.0).0 {
                    Err(StepError::Grows { t, since, growth, place }) => {
                        assert!(most > 3.0 && growth > 100.0, "{what}: {growth:e}");
                        assert!(place / 2 == 77 && since < t, "{what}: {place}, {since}, {t}");
                        grown += 1;
                    }
                    Err(error) => panic!("{what}: {error}"),
                    Ok(()) => assert!(most < 8.0, "{what}: nothing was said"),
                }
            }
        }
    }
    assert!(grown > 50, "{grown}");
}

#[test]
fn what_decays_or_hardly_grows_does_not() {
    for others in [vec![], vec![(3, 1.0, 3000.0)], vec![(0, 0.0, 0.0), (9, 1e-3, 1e4)], vec![(50, -1.0, 0.0)]]
    {
        for tolerance in [1e-2, 1e-4, 1e-6] {
            let (outcome, _, _) = Blocks::new(&others).run(tolerance, 2.0);
            assert!(outcome.is_ok(), "{others:?}, {tolerance:e}: {outcome:?}");
        }
    }
}

/// Rows far from symmetric: a disturbance grows for a while, though no mode does.
#[test]
fn what_grows_for_a_while_does_not() {
    for couple in [3.0, 10.0, 20.0] {
        let system = Blocks { couple, ..Blocks::new(&[]) };
        let (outcome, _, _) = system.run(1e-4, 2.0);
        assert!(outcome.is_ok(), "{couple}: {outcome:?}");
    }
}

/// About a tenth of the solves that the steps take.
#[test]
fn looking_costs_little() {
    let run = |watched: bool| {
        let (outcome, system, steps) = Blocks { watched, ..Blocks::new(&[]) }.run(1e-5, 2.0);
        outcome.expect("all decays");
        (system.solves, steps)
    };
    let ((watched, steps), (without, same)) = (run(true), run(false));
    assert_eq!(steps, same);
    assert!(watched - without < without / 8, "{watched} and {without} solves, {steps} steps");
}
