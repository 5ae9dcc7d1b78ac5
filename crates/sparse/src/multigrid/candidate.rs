//! What relaxation leaves of the constant: the field that prolongation reproduces.

use super::SmootherKind;
use super::smoother::Smoother;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;

/// Sweeps of Gauss-Seidel for `A c = 0` from `c = 1`.
const SWEEPS: usize = 4;

/// What is left must be a unit to measure unknowns in.
const LEAST: f64 = 0.1;

/// Values are rounded to multiples of one over this: where relaxation leaves the constant as it is, as in a stiff region that
/// weak bonds hold, differences are exactly zero, and no large entry multiplies their rounding.
const STEPS: f64 = 1024.0;

/// The constant after a few sweeps of Gauss-Seidel for `A (c / s) = 0`, kept between [`LEAST`] and 1.
pub(crate) fn relaxed(a: &DifferenceMatrix, s: &[f64]) -> Result<Vec<f64>, MatrixError> {
    let n = a.n();
    let smoother = Smoother::new(SmootherKind::GaussSeidel, a)?;
    let (zero, mut t) = (vec![0.0; n], vec![0.0; n]);
    let mut c: Vec<f64> = if s.is_empty() { vec![1.0; n] } else { s.iter().map(|s| 1.0 / s).collect() };
    (0..SWEEPS).for_each(|_| smoother.before(a, &zero, &mut c, &mut t));
    c.iter_mut().zip(s).for_each(|(c, s)| *c *= s);
    let unit = |c: f64| if c.is_nan() { 1.0 } else { ((c * STEPS).round() / STEPS).clamp(LEAST, 1.0) };
    c.iter_mut().for_each(|c| *c = unit(*c));
    Ok(c)
}
