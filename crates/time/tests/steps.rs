//! Order, stability, algebraic rows, tolerances, and going on from a kept state.

use std::convert::Infallible;

use meshless_time::{Params, Past, Semidiscrete, State, StepError, Stepper};
use proptest::prelude::*;

/// `du_i/dt = -rate_i (u_i - cos t) - sin t`, and one algebraic row `u_n = 2 u_0`.
#[derive(Debug, Clone)]
struct Rates(Vec<f64>);

impl Rates {
    fn forcing(rate: f64, t: f64) -> f64 {
        rate * t.cos() - t.sin()
    }
}

impl Semidiscrete for Rates {
    type Error = Infallible;

    fn slope(&mut self, t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Infallible> {
        for (i, &rate) in self.0.iter().enumerate() {
            out[i] = Self::forcing(rate, t) - rate * u[i];
        }
        out[self.0.len()] = 0.0;
        Ok(())
    }

    fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Infallible> {
        for (i, &rate) in self.0.iter().enumerate() {
            u[i] = (v[i] / c + Self::forcing(rate, t)) / (1.0 / c + rate);
        }
        u[self.0.len()] = 2.0 * u[0];
        Ok(())
    }

    fn damp(&mut self, _t: f64, c: f64, e: &mut [f64]) -> Result<(), Infallible> {
        self.0.iter().zip(&mut *e).for_each(|(rate, e)| *e /= 1.0 + c * rate);
        e[self.0.len()] = 2.0 * e[0];
        Ok(())
    }

    fn norm(&self, e: &[f64]) -> f64 {
        (e.iter().map(|x| x * x).sum::<f64>() / e.len() as f64).sqrt()
    }
}

/// `u_i(t)` from `u_i(0) = start`.
fn exact(rate: f64, start: f64, t: f64) -> f64 {
    t.cos() + (start - 1.0) * (-rate * t).exp()
}

fn run(rates: &[f64], start: f64, end: f64, params: Params) -> Stepper<Rates> {
    let mut stepper =
        Stepper::new(Rates(rates.to_vec()), 0.0, vec![start; rates.len() + 1], params).expect("valid");
    stepper.advance_to(end).expect("within the steps");
    stepper
}

#[test]
fn halving_the_step_quarters_the_error() {
    for rate in [0.0, 0.7, 5.0] {
        let error = |steps: u32| {
            let params =
                Params { fixed: true, first_step: Some(2.0 / f64::from(steps)), ..Params::default() };
            let stepper = run(&[rate], 0.3, 2.0, params);
            assert_eq!(stepper.state().steps as u32, steps);
            (stepper.state().u[0] - exact(rate, 0.3, 2.0)).abs()
        };
        let order = (error(40) / error(80)).log2();
        assert!((1.9..2.2).contains(&order), "rate {rate}: order {order}");
    }
}

#[test]
fn stiff_components_are_damped_at_once_and_algebraic_rows_hold() {
    let params = Params { fixed: true, first_step: Some(0.1), ..Params::default() };
    let stepper = run(&[1.0, 1e12], 1.0 + 1e3, 1.0, params);
    let u = &stepper.state().u;
    assert!((u[1] - 1.0_f64.cos()).abs() < 1e-6, "{}", u[1]);
    assert_eq!(u[2], 2.0 * u[0]);
}

#[test]
fn a_run_that_goes_on_is_the_run_that_went_through() {
    let params = Params { tolerance: 1e-6, ..Params::default() };
    let through = run(&[0.4, 30.0], 0.0, 3.0, params);
    let mut first = Stepper::new(Rates(vec![0.4, 30.0]), 0.0, vec![0.0; 3], params).expect("valid");
    (0..7).for_each(|_| first.step(3.0).expect("a step"));
    let (system, state) = first.into_parts();
    let mut second = Stepper::resume(system, state, params);
    second.advance_to(3.0).expect("within the steps");
    // What grows is looked for anew.
    let steps = |state: &State| State { past: Past::default(), ..state.clone() };
    assert_eq!(steps(second.state()), steps(through.state()));
}

#[test]
fn what_cannot_be_done_is_said() {
    let start = |params, u| Stepper::new(Rates(vec![1.0]), 0.0, vec![u, u], params).map(|_| ());
    let none = Params { tolerance: 0.0, ..Params::default() };
    assert!(matches!(start(none, 1.0), Err(StepError::Invalid { what: "the tolerance", .. })));
    assert!(matches!(start(Params::default(), f64::NAN), Err(StepError::Invalid { .. })));
    let few = Params { tolerance: 1e-10, max_steps: 10, ..Params::default() };
    let mut stepper = Stepper::new(Rates(vec![1.0]), 0.0, vec![0.0; 2], few).expect("valid");
    assert!(matches!(stepper.advance_to(10.0), Err(StepError::TooMany { steps: 10, .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The error at the end is of the size of the tolerance, and steps are not wasted.
    #[test]
    fn tolerances_are_kept(
        exponents in proptest::collection::vec(-1.0..8.0_f64, 1..4), start in -2.0..2.0_f64, digits in 2.0..6.0_f64,
    ) {
        let rates: Vec<f64> = exponents.iter().map(|e| 10.0_f64.powf(*e)).collect();
        let tolerance = 10.0_f64.powf(-digits);
        let stepper = run(&rates, start, 2.0, Params { tolerance, whole: 2.0, ..Params::default() });
        let state = stepper.state();
        let scale = start.abs().max(1.0);
        for (u, rate) in state.u.iter().zip(&rates) {
            let error = (u - exact(*rate, start, 2.0)).abs();
            prop_assert!(error < 3.0 * tolerance * scale, "rate {rate:e}: {error:e} for {tolerance:e}");
        }
        prop_assert!(state.rejected <= 5 + state.steps / 4, "{} of {}", state.rejected, state.steps);
        prop_assert!(state.steps as f64 <= 200.0 + 3.0 / tolerance.sqrt(), "{} steps", state.steps);
    }

    /// The equation is linear: so is what becomes of the initial values, with fixed steps.
    #[test]
    fn solutions_superpose(rate in 0.0..1e3_f64, a in -2.0..2.0_f64, b in -2.0..2.0_f64) {
        let params = Params { fixed: true, first_step: Some(0.05), ..Params::default() };
        let end = |start: f64| run(&[rate], start, 1.0, params).state().u[0];
        let (zero, sum) = (end(0.0), end(a + b));
        prop_assert!((sum + zero - end(a) - end(b)).abs() < 1e-12);
    }
}

/// `u_0' + 0.3 u_1' = u_1 - u_0`, and `u_1` is prescribed: 0 up to t = 0.5 and 1 from there on.
struct Switched;

impl Switched {
    fn given(t: f64) -> f64 {
        f64::from(u8::from(t >= 0.5))
    }
}

impl Semidiscrete for Switched {
    type Error = Infallible;

    fn make_consistent(&mut self, t: f64, u: &mut [f64]) -> Result<(), Infallible> {
        u[1] = Self::given(t);
        Ok(())
    }

    fn slope(&mut self, _t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Infallible> {
        out.copy_from_slice(&[u[1] - u[0], 0.0]);
        Ok(())
    }

    fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Infallible> {
        u[1] = Self::given(t);
        u[0] = ((v[0] + 0.3 * (v[1] - u[1])) / c + u[1]) / (1.0 / c + 1.0);
        Ok(())
    }

    fn damp(&mut self, _t: f64, c: f64, e: &mut [f64]) -> Result<(), Infallible> {
        e.copy_from_slice(&[e[0] / (1.0 + c), 0.0]);
        Ok(())
    }

    fn norm(&self, e: &[f64]) -> f64 {
        e[0].abs()
    }
}

/// What jumps gets no part in the other rows: the run starts anew behind the jump.
#[test]
fn data_that_jump_start_the_run_anew() {
    let params = Params { tolerance: 1e-5, whole: 1.0, ..Params::default() };
    let mut stepper = Stepper::new(Switched, 0.0, vec![0.0, 0.0], params).expect("valid");
    stepper.advance_to(1.0).expect("within the steps");
    let error = stepper.state().u[0] - (1.0 - (-0.5_f64).exp());
    assert!(error.abs() < 1e-5, "{error:e}");
}
