//! Special functions that the kernels are made of, to a few units of the last place.

mod bessel;
mod exponential;
mod logarithm;
mod oscillating;
mod sine;

pub(crate) use bessel::one_minus_j0;
pub(crate) use bessel::one_minus_j0_integral;
pub(crate) use exponential::{e1, ein};
pub(crate) use logarithm::logarithms;
pub(crate) use oscillating::one_minus_j0_ratios;
pub(crate) use sine::sine_integral;

/// Euler's constant.
pub(crate) const EULER: f64 = 0.577_215_664_901_532_9;

/// From here on asymptotic series reach round-off: the smallest term of each is below 1e-16.
const ASYMPTOTIC: f64 = 40.0;

/// Below, power series with alternating signs lose at most a digit.
const SMALL: f64 = 2.0;

/// Orders above the argument from which Miller's recurrence starts: the neglected Bessel functions are below 1e-20 there.
const MILLER_MARGIN: usize = 40;
