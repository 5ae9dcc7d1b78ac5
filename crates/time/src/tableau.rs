//! The coefficients of TR-BDF2 as a diagonally implicit Runge-Kutta method with three stages, the first explicit.

use std::f64::consts::SQRT_2;

/// Place of the second stage in the step: with it both implicit stages have the same matrix.
pub(crate) const GAMMA: f64 = 2.0 - SQRT_2;

/// Diagonal of the tableau: `c = DIAGONAL * step` in `M / c + A`.
pub(crate) const DIAGONAL: f64 = 0.5 * GAMMA;

/// Weights of the first two slopes in the last stage, that of the last is [`DIAGONAL`].
pub(crate) const WEIGHT: f64 = SQRT_2 / 4.0;

/// Weights of the embedded method of order 3 less those of the method.
pub(crate) const ERROR: [f64; 3] =
    [(1.0 - WEIGHT) / 3.0 - WEIGHT, (3.0 * WEIGHT + 1.0) / 3.0 - WEIGHT, DIAGONAL / 3.0 - DIAGONAL];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_conditions_hold() {
        let b = [WEIGHT, WEIGHT, DIAGONAL];
        let c = [0.0, GAMMA, 1.0];
        let sum = |power: i32| b.iter().zip(c).map(|(b, c): (&f64, f64)| b * c.powi(power)).sum::<f64>();
        assert!((sum(0) - 1.0).abs() < 1e-15 && (sum(1) - 0.5).abs() < 1e-15);
        // The embedded method: order 3, with c A = (0, gamma^2/2, 1/2) in the last condition.
        let h: Vec<f64> = b.iter().zip(ERROR).map(|(b, e)| b + e).collect();
        let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(|i| h[i] * f(i)).sum::<f64>();
        assert!((sum(&|_| 1.0) - 1.0).abs() < 1e-15);
        assert!((sum(&|i| c[i]) - 0.5).abs() < 1e-15);
        assert!((sum(&|i| c[i] * c[i]) - 1.0 / 3.0).abs() < 1e-15);
        let inner = [0.0, DIAGONAL * GAMMA, WEIGHT * GAMMA + DIAGONAL];
        assert!((sum(&|i| inner[i]) - 1.0 / 6.0).abs() < 1e-15);
    }
}
