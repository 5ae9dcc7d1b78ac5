//! What can go wrong.

use thiserror::Error;

/// Why the integration ended before its time.
#[derive(Debug, Error)]
pub enum StepError<E: std::error::Error> {
    /// A solve, or the evaluation of data, failed.
    #[error("at t = {t}: {source}")]
    System {
        /// When.
        t: f64,
        /// Why.
        source: E,
    },
    /// A tolerance, time or initial value that cannot be.
    #[error("{what} is {value}, which must be {expected}")]
    Invalid {
        /// What was given.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// The step became too small to change t.
    #[error(
        "the step at t = {t} has become {step:e} without reaching the tolerance: the data jump there, or the tolerance \
         is below round-off; raise it, or start a new run at the jump"
    )]
    TooSmall {
        /// When.
        t: f64,
        /// Step size.
        step: f64,
    },
    /// Too many steps.
    #[error("{steps} steps reach t = {t} only; raise the tolerance")]
    TooMany {
        /// Steps taken.
        steps: usize,
        /// Time reached.
        t: f64,
    },
    /// The system lets something grow by itself.
    #[error(
        "since t = {since} a mode has grown {growth:.1e}-fold by itself by t = {t}, most of it at unknown {place}: the system lets \
         something grow where diffusion lets all decay"
    )]
    Grows {
        /// When it was found.
        t: f64,
        /// When it began.
        since: f64,
        /// Size over that at the beginning.
        growth: f64,
        /// The unknown at which the mode is largest.
        place: usize,
    },
    /// The solution is not a number any more.
    #[error("the solution is not finite at t = {t}")]
    NotFinite {
        /// When.
        t: f64,
    },
}
