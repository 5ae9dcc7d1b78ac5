//! What the iterative methods share: restarts, the true residual, and when to give up.

use super::bicgstab::bicgstab_cycle;
use super::cg::cg_cycle;
use super::gmres::gmres_cycle;
use super::idr::idr_cycle;
use super::{Criterion, SolveError, SolveInfo, SolverParams};
use crate::csr::Csr;
use crate::precond::Preconditioner;
use crate::vector::{axpy, norm};

/// A cycle that reduces the true residual by less than this factor has gained nothing to speak of.
const LEAST_GAIN: f64 = 0.5;

/// The same for a cycle that ended only because GMRES ran out of vectors: slow is not hopeless.
const LEAST_GAIN_RESTART: f64 = 0.999;

/// Cycles in a row without gain before the iteration is given up.
const CYCLES_WITHOUT_GAIN: usize = 3;

/// A cycle aims at this part of the tolerance, so that the true residual meets it at the first attempt.
const AIM: f64 = 0.5;

/// What a cycle aims at, relative to its start, where only the componentwise error is left to improve.
const AIM_FURTHER: f64 = 1e-3;

/// Componentwise backward error at which rounding alone keeps the residual from shrinking: what sums of a few tens of terms
/// leave, with room. No other solution would fit the equations better.
pub(crate) const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// How far above the tolerance a residual may stay when rounding is all that is left of it. Beyond, a solution that is large for
/// want of a better one, of a system that has none, would pass as well.
pub(crate) const NEAR: f64 = 1e3;

/// Something that maps vectors to vectors, `y = A x`.
pub trait LinearOperator: Sync {
    /// Number of rows and columns.
    fn dim(&self) -> usize;
    /// `y = A x`; both have [`LinearOperator::dim`] elements.
    fn apply(&self, x: &[f64], y: &mut [f64]);
}

impl LinearOperator for Csr {
    fn dim(&self) -> usize {
        self.nrows()
    }
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        self.mul_vec(x, y);
    }
}

/// What tells how well a system is solved; it may be formed more accurately than from a matrix.
pub(crate) trait Residuals {
    /// `r = b - A x`
    fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]);
    /// Componentwise backward error of `x`, see [`Csr::backward_error`].
    fn backward_error(&self, x: &[f64], b: &[f64]) -> f64;
}

/// A system that an iterative method solves.
pub(crate) trait System: LinearOperator + Residuals {}

impl<T: LinearOperator + Residuals> System for T {}

impl Residuals for Csr {
    fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        Self::residual(self, x, b, r);
    }
    fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        Self::backward_error(self, x, b)
    }
}

/// An iterative method, its parameters checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    BiCgStab { l: usize },
    Gmres { restart: usize },
    Idr { s: usize },
    Cg,
}

impl Method {
    fn name(self) -> String {
        match self {
            Self::BiCgStab { l } => format!("BiCGStab({l})"),
            Self::Gmres { restart } => format!("GMRES({restart})"),
            Self::Idr { s } => format!("IDR({s})"),
            Self::Cg => "CG".to_owned(),
        }
    }
}

/// Why a cycle ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CycleEnd {
    /// The recurrence says that the target is met.
    Claimed,
    /// All vectors are used.
    Restart,
    /// No products are left.
    Budget,
    /// A denominator vanished.
    BreakDown(&'static str),
}

/// The correction equation `A d = r` of one cycle, from `d = 0`.
pub(crate) struct Cycle<'a> {
    pub(crate) a: &'a dyn LinearOperator,
    pub(crate) m: &'a dyn Preconditioner,
    /// Residual norm at which the cycle may stop.
    pub(crate) target: f64,
    /// What residual norms are divided by in the history.
    pub(crate) unit: f64,
    /// Products with the matrix that may still be made.
    pub(crate) budget: usize,
    pub(crate) history: &'a mut Vec<f64>,
    pub(crate) scratch: &'a mut [f64],
    pub(crate) products: usize,
    /// How many cycles before this one gained nothing.
    pub(crate) attempt: usize,
}

impl Cycle<'_> {
    /// The correction d of the residual r, by one of the methods.
    fn run(&mut self, method: Method, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
        match method {
            Method::BiCgStab { l } => bicgstab_cycle(self, l, r, d),
            Method::Gmres { restart } => gmres_cycle(self, restart, r, d),
            Method::Idr { s } => idr_cycle(self, s, r, d),
            Method::Cg => cg_cycle(self, r, d),
        }
    }

    /// `y = A M^-1 x`, with `M^-1 x` left in `z`.
    pub(crate) fn apply(&mut self, x: &[f64], z: &mut [f64], y: &mut [f64]) {
        self.m.apply(x, z, self.scratch);
        self.a.apply(z, y);
        self.products += 1;
    }

    /// `y = A z`
    pub(crate) fn multiply(&mut self, z: &[f64], y: &mut [f64]) {
        self.a.apply(z, y);
        self.products += 1;
    }

    pub(crate) fn precondition(&mut self, x: &[f64], z: &mut [f64]) {
        self.m.apply(x, z, self.scratch);
    }

    pub(crate) fn record(&mut self, residual: f64) {
        self.history.push(residual / self.unit);
    }

    pub(crate) fn is_spent(&self) -> bool {
        self.products >= self.budget
    }
}

/// Solves `A x = b` by cycles of `method`, each of which solves for a correction of the true residual.
pub(crate) fn iterate(
    method: Method,
    a: &dyn System,
    m: &dyn Preconditioner,
    b: &[f64],
    params: &SolverParams,
) -> Result<(Vec<f64>, SolveInfo), SolveError> {
    let mut run = Run::new(method, m, b);
    if run.unit == 0.0 {
        return Ok((vec![0.0; b.len()], run.info(0.0, 0.0, Criterion::Residual, m)));
    }
    // The first correction is the solution so far: one vector less where one cycle is enough.
    let mut further: Option<Vec<f64>> = None;
    let mut residual = b.to_vec();
    let (mut last_size, mut last_error) = (run.unit, f64::INFINITY);
    loop {
        let met = params.tolerance * run.unit;
        let mut cycle = Cycle {
            a,
            m,
            // Where the norm is met already, the componentwise error is what is left to improve.
            target: if last_size > met { AIM * met } else { AIM_FURTHER * last_size },
            unit: run.unit,
            budget: params.max_iterations.saturating_sub(run.products),
            history: &mut run.history,
            scratch: &mut run.scratch,
            products: 0,
            attempt: run.without_gain,
        };
        if let Some(correction) = &mut further {
            correction.fill(0.0);
        }
        let correction = further.as_deref_mut().unwrap_or(&mut run.x);
        let end = cycle.run(method, &mut residual, correction);
        run.products += cycle.products;
        if let Some(correction) = &further {
            axpy(1.0, correction, &mut run.x);
        }
        a.residual(&run.x, b, &mut residual);
        let size = norm(&residual);
        let gained = size <= LEAST_GAIN * last_size;
        // Above the tolerance it is asked for only where the residual stagnates.
        let error = if size <= met || !gained { a.backward_error(&run.x, b) } else { f64::INFINITY };
        if size <= met && params.backward_error.is_none_or(|e| error <= e) {
            let info = run.info(size / run.unit, error, Criterion::Residual, m);
            return Ok((run.x, info));
        }
        if !gained && size <= NEAR * met && error <= params.backward_error.unwrap_or(ROUND_OFF).min(ROUND_OFF)
        {
            let info = run.info(size / run.unit, error, Criterion::RoundOff, m);
            return Ok((run.x, info));
        }
        run.keep_best(size);
        further.get_or_insert_with(|| vec![0.0; b.len()]);
        let error = if size <= met { error } else { f64::INFINITY };
        let gain = (size / last_size).min(if error < last_error { error / last_error } else { 1.0 });
        run.judge(end, gain, params)?;
        if !size.is_finite() || (size > last_size && size > met) {
            // A cycle that made it worse is undone before the next one.
            run.x = run.best();
            a.residual(&run.x, b, &mut residual);
        }
        (last_size, last_error) = (norm(&residual), error);
    }
}

/// State of an iteration between cycles.
struct Run {
    name: String,
    x: Vec<f64>,
    /// The best solution so far; none as long as it is zero.
    best: Option<Vec<f64>>,
    best_size: f64,
    /// Norm of the right-hand side.
    unit: f64,
    history: Vec<f64>,
    scratch: Vec<f64>,
    products: usize,
    without_gain: usize,
}

impl Run {
    fn new(method: Method, m: &dyn Preconditioner, b: &[f64]) -> Self {
        let unit = norm(b);
        Self {
            name: format!("{} + {}", method.name(), m.name()),
            x: vec![0.0; b.len()],
            best: None,
            best_size: unit,
            unit,
            history: vec![1.0],
            scratch: vec![0.0; m.scratch_len()],
            products: 0,
            without_gain: 0,
        }
    }

    fn keep_best(&mut self, size: f64) {
        if size < self.best_size {
            self.best_size = size;
            self.best = Some(self.x.clone());
        }
    }

    fn best(&self) -> Vec<f64> {
        self.best.clone().unwrap_or_else(|| vec![0.0; self.x.len()])
    }

    /// Whether to go on after a cycle that did not meet the tolerance.
    fn judge(&mut self, end: CycleEnd, gain: f64, params: &SolverParams) -> Result<(), SolveError> {
        let least = if end == CycleEnd::Restart { LEAST_GAIN_RESTART } else { LEAST_GAIN };
        self.without_gain = if gain <= least { 0 } else { self.without_gain + 1 };
        let residual = self.best_size / self.unit;
        let hopeless = self.without_gain >= CYCLES_WITHOUT_GAIN;
        let spent = end == CycleEnd::Budget || self.products >= params.max_iterations;
        if !hopeless && !spent {
            return Ok(());
        }
        let (solver, best, iterations) = (self.name.clone(), self.best(), self.products);
        if let (CycleEnd::BreakDown(what), true) = (end, hopeless) {
            return Err(SolveError::BreakDown { solver, what, residual, iterations, best });
        }
        let reason = if hopeless { "the residual stagnates" } else { "the limit of products" };
        let tolerance = params.tolerance;
        Err(SolveError::NoConvergence { solver, reason, residual, tolerance, iterations, best })
    }

    fn info(
        &self,
        residual: f64,
        backward_error: f64,
        criterion: Criterion,
        m: &dyn Preconditioner,
    ) -> SolveInfo {
        let mut history = self.history.clone();
        history.push(residual);
        SolveInfo {
            name: self.name.clone(),
            iterations: self.products,
            residual,
            backward_error,
            criterion,
            history,
            replaced_pivots: m.replaced_pivots(),
            condition: None,
        }
    }
}
