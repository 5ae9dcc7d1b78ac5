//! What relaxation leaves of the constant: the field that prolongation reproduces.

use super::smoother::sweep;
use crate::difference::DifferenceMatrix;

/// Sweeps of Gauss-Seidel for `A c = 0` from `c = 1`.
const SWEEPS: usize = 4;

/// Values are rounded to multiples of one over this: where relaxation leaves the constant as it is, as in a stiff region that
/// weak bonds hold, differences are exactly zero, and no large entry multiplies their rounding.
const STEPS: f64 = 1024.0;

/// What is left must be a unit to measure unknowns in: this many steps at least, a tenth.
const LEAST: f64 = 102.0;

/// The constant after a few sweeps of Gauss-Seidel for `A (c / s) = 0`, in steps of which [`value`] has the size. `inverse` has the reciprocals of the
/// diagonal.
pub(crate) fn relaxed(a: &DifferenceMatrix, inverse: &[f64], s: &[f64]) -> Vec<u16> {
    let n = a.n();
    let (zero, mut t) = (vec![0.0; n], vec![0.0; n]);
    let scale = |i: usize| s.get(i).copied().unwrap_or(1.0);
    let mut c: Vec<f64> = (0..n).map(|i| 1.0 / scale(i)).collect();
    (0..SWEEPS).for_each(|_| sweep::<false>(a, inverse, &zero, &mut c, &mut t));
    let steps = |c: f64| if c.is_nan() { STEPS } else { (c * STEPS).round().clamp(LEAST, STEPS) };
    c.iter().enumerate().map(|(i, c)| steps(c * scale(i)) as u16).collect()
}

/// What so many steps are.
#[inline]
pub(crate) fn value(steps: u16) -> f64 {
    f64::from(steps) / STEPS
}
