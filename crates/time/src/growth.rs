//! What would become of an error: modes of the system that grow by themselves.
//!
//! With the factors at hand, `D = (M + c A)^-1 M` is applied to a disturbance every few steps. Its eigenvalues are
//! `mu = 1/(1 + c lambda)` with those of `M^-1 A`. What decays has them in the disc round 1/2 through 0 and 1; what grows, at whatever
//! rate, outside, and there Krylov spaces find them first. How far a mode has grown follows from its lambda and the steps that
//! were taken: one multiplies it by `R = mu (b mu + a)`, the stability function of the method.

use crate::complex::Complex;
use crate::krylov::{Krylov, Pair};
use crate::tableau::DIAGONAL;

/// Growth that ends a run: of an error of the tolerance hardly anything is left to trust then.
const MOST: f64 = 100.0;

/// D is applied twice at the first step of a size, once at the next few, and then after so many: a tenth of the solves of a run.
const FIRST_STEPS: f64 = 4.0;
const EVERY: f64 = 5.0;

/// Dimension at which a Krylov space is started anew from what its vectors have become.
const LARGEST: usize = 20;

/// Share of something new in that where steps have become smaller: what longer ones damp may grow by these.
const NEW: f64 = 1e-3;

/// An eigenvalue counts if its residual is below this part of its distance from the disc of what decays: rows that are not symmetric may
/// let something grow for a while, which is no mode.
const RELIABLE: f64 = 0.5;

/// And to end a run, in a space of its own that starts from its vector: below this part.
const SURE: f64 = 1e-2;

/// `R = mu (SECOND mu + FIRST)`: the stability function is `(1 + (1 - 2 d) z) / (1 - d z)^2` with d the diagonal of the tableau, and
/// mu is `1 / (1 - d z)`.
const FIRST: f64 = 2.0 - 1.0 / DIAGONAL;
const SECOND: f64 = 1.0 - FIRST;

/// What a run has to know of its past to tell growth.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Past {
    /// A disturbance, of any size; empty before the first step.
    pub disturbance: Vec<f64>,
    /// Logarithm of the growth by rows that have changed since.
    pub before: f64,
    /// When that began.
    pub since: f64,
    /// Steps since the rows changed last.
    pub spells: Vec<Spell>,
}

/// Steps of one size, one after the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spell {
    /// When they began.
    pub since: f64,
    /// Their size.
    pub step: f64,
    /// Their number.
    pub count: f64,
}

/// A mode that seems to grow.
#[derive(Debug)]
struct Mode {
    rate: Complex,
    /// Its real part.
    vector: Vec<f64>,
}

/// What has grown too far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grown {
    pub(crate) since: f64,
    /// Logarithm of it.
    pub(crate) growth: f64,
    /// Unknown at which it is largest.
    pub(crate) place: usize,
}

/// A step that was taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taken {
    pub(crate) since: f64,
    pub(crate) step: f64,
    /// The rows are others.
    pub(crate) changed: bool,
}

/// Looks for modes that grow.
#[derive(Debug)]
pub(crate) struct Watch {
    krylov: Option<Krylov>,
    /// The step that the space belongs to.
    step: f64,
    mode: Option<Mode>,
    /// Residual of a pair that counts; less where one proved to be none.
    reliable: f64,
}

impl Default for Watch {
    fn default() -> Self {
        Self { krylov: None, step: 0.0, mode: None, reliable: RELIABLE }
    }
}

impl Watch {
    /// Takes notice of a step. `weights` are 1 for unknowns with du/dt, else 0; `apply` is D, of values that first have to be made to fulfil
    /// the algebraic rows or do already.
    pub(crate) fn take<E>(
        &mut self,
        past: &mut Past,
        taken: Taken,
        weights: &dyn Fn() -> Vec<f64>,
        mut apply: impl FnMut(&mut [f64], bool) -> Result<(), E>,
    ) -> Result<Option<Grown>, E> {
        if taken.changed {
            self.forget(past, taken.since);
        }
        let fresh = self.krylov.is_none() || taken.changed || taken.step != self.step;
        let shorter = taken.step < self.step;
        if fresh {
            self.step = taken.step;
            past.spells.push(Spell { since: taken.since, step: taken.step, count: 0.0 });
        }
        let count = past.spells.last_mut().map_or(1.0, |spell| {
            spell.count += 1.0;
            spell.count
        });
        let full = self.krylov.as_ref().is_some_and(|krylov| krylov.len() == LARGEST);
        let due = match () {
            () if fresh => 2,
            () => usize::from(count <= FIRST_STEPS || count % EVERY == 0.0),
        };
        if fresh || (full && due > 0) {
            self.restart(past, weights(), shorter, |e| apply(e, true))?;
        }
        if let Some(krylov) = &mut self.krylov {
            (0..due).try_for_each(|_| extend(krylov, &mut apply))?;
        }
        if due > 0 {
            self.look(past, taken.step);
        }
        match self.mode.take_if(|mode| past.growth(mode.rate).0 > MOST.ln()) {
            Some(mode) => self.confirm(past, mode, weights(), &mut apply),
            None => Ok(None),
        }
    }

    /// Whether a mode is one, and has grown as much.
    fn confirm<E>(
        &mut self,
        past: &Past,
        mode: Mode,
        weights: Vec<f64>,
        apply: &mut impl FnMut(&mut [f64], bool) -> Result<(), E>,
    ) -> Result<Option<Grown>, E> {
        let Some(mut krylov) = Krylov::new(mode.vector, weights) else { return Ok(None) };
        while krylov.len() < LARGEST && krylov.next().is_some() {
            extend(&mut krylov, apply)?;
            for pair in krylov.pairs().filter(|pair| pair.grows(SURE)) {
                let (growth, since) = past.growth(pair.rate(self.step));
                if growth > MOST.ln() {
                    return Ok(Some(Grown { since, growth, place: krylov.place(&pair) }));
                }
            }
        }
        self.reliable *= 0.5;
        Ok(None)
    }

    /// The rows are others: what has grown by the old ones stays, how they did so does not.
    fn forget(&mut self, past: &mut Past, now: f64) {
        if let Some(mode) = self.mode.take() {
            (past.before, past.since) = past.growth(mode.rate);
        }
        if past.before <= 0.0 {
            (past.before, past.since) = (0.0, now);
        }
        past.spells.clear();
    }

    /// A new space, from what became of the disturbance.
    fn restart<E>(
        &mut self,
        past: &mut Past,
        weights: Vec<f64>,
        shorter: bool,
        clean: impl FnOnce(&mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Some(krylov) = &self.krylov {
            past.disturbance = krylov.last();
        }
        let unknowns = weights.len();
        let known = past.disturbance.len() == unknowns;
        if !known || shorter {
            let share = if known { NEW / (unknowns as f64).sqrt() } else { 1.0 };
            past.disturbance.resize(unknowns, 0.0);
            let new = patternless(past.spells.len());
            past.disturbance.iter_mut().zip(new).for_each(|(e, new)| *e += share * new);
            clean(&mut past.disturbance)?;
        }
        self.krylov = Krylov::new(past.disturbance.clone(), weights);
        Ok(())
    }

    /// Keeps the mode that has grown most.
    fn look(&mut self, past: &Past, step: f64) {
        let Some(krylov) = &self.krylov else { return };
        let grows = krylov.pairs().filter(|pair| pair.grows(self.reliable));
        let most = grows
            .map(|pair| (pair.rate(step), pair))
            .map(|(rate, pair)| (past.growth(rate).0, rate, pair))
            .reduce(|most, next| if next.0 > most.0 { next } else { most });
        let known = self.mode.as_ref().map_or(0.0, |mode| past.growth(mode.rate).0);
        if let Some((growth, rate, pair)) = most
            && growth >= known
        {
            let vector = krylov.vector(&pair).into_iter().map(|x| x.re).collect();
            self.mode = Some(Mode { rate, vector });
        }
    }
}

/// One more dimension.
fn extend<E>(
    krylov: &mut Krylov,
    apply: &mut impl FnMut(&mut [f64], bool) -> Result<(), E>,
) -> Result<(), E> {
    let Some(last) = krylov.next() else { return Ok(()) };
    let mut image = last.to_vec();
    apply(&mut image, false)?;
    krylov.extend(image);
    Ok(())
}

impl Pair {
    /// Whether it is outside of the disc of what decays, by so many times its residual.
    fn grows(&self, reliable: f64) -> bool {
        let outside = (self.value - Complex::real(0.5)).abs() - 0.5;
        outside > 0.0 && self.residual < reliable * outside
    }

    /// The eigenvalue of `M^-1 A` for one of `(M + c A)^-1 M`.
    fn rate(&self, step: f64) -> Complex {
        (Complex::real(1.0) / self.value - Complex::real(1.0)).scaled(1.0 / (DIAGONAL * step))
    }
}

impl Past {
    /// Logarithm of the growth of a mode since it was smallest, and when that was.
    fn growth(&self, rate: Complex) -> (f64, f64) {
        let mut sum = 0.0;
        let mut most = (0.0, self.spells.last().map_or(self.since, |spell| spell.since));
        for spell in self.spells.iter().rev() {
            sum += spell.count * amplification(rate, spell.step).ln();
            if sum > most.0 {
                most = (sum, spell.since);
            }
        }
        if sum + self.before > most.0 {
            most = (sum + self.before, self.since);
        }
        most
    }
}

/// `|R|`.
fn amplification(rate: Complex, step: f64) -> f64 {
    let mu = Complex::real(1.0) / (Complex::real(1.0) + rate.scaled(DIAGONAL * step));
    (mu * (mu.scaled(SECOND) + Complex::real(FIRST))).abs()
}

/// Values without a pattern, others for every number.
fn patternless(number: usize) -> impl Iterator<Item = f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const PLASTIC: f64 = 0.754_877_666_246_692_8;
    let shift = number as f64 * PLASTIC;
    (1..).map(move |i: u32| (f64::from(i) * GOLDEN + shift).fract() - 0.5)
}
