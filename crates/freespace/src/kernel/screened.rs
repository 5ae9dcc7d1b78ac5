//! Green's functions of `kappa^2 - lap`, cut off at a radius: what is left of the Poisson equation in the open directions
//! once it is transformed in the periodic ones.

use std::f64::consts::TAU;

use super::truncated::Truncated;
use crate::error::FreeSpaceError;

/// Step of the trapezoidal rule for modified Bessel functions: its error is `exp(-pi^2 / step)`, below 1e-21.
const STEP: f64 = 0.2;

/// `kappa L` from which nothing reaches the radius of truncation.
const FAR: f64 = 700.0;

/// The transform, in `open` directions, of the singular Green's function of `kappa^2 - lap` times the indicator of the ball of
/// radius L.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Screened {
    open: usize,
    radius: f64,
    kappa: f64,
    /// `K0` and `K1` at `kappa L`.
    bessel: [f64; 2],
}

impl Screened {
    /// For `open` directions, 1 or 2, and the wave number `kappa >= 0` of the others; with no direction open, the transform is
    /// `1/kappa^2`, and zero for the constant.
    pub(crate) fn new(open: usize, radius: f64, kappa: f64) -> Self {
        let x = kappa * radius;
        let bessel = if open == 2 && x > 0.0 && x < FAR { bessel_k(x) } else { [0.0; 2] };
        Self { open, radius, kappa, bessel }
    }

    /// What of an unscreened kernel is left out of [`Self::transform`], a constant wherever it is not cut off.
    pub(crate) fn rim(open: usize, radius: f64) -> Result<f64, FreeSpaceError> {
        match open {
            1 => Truncated::<1>::new(radius).map(|t| t.rim()),
            2 => Truncated::<2>::new(radius).map(|t| t.rim()),
            _ => Ok(0.0),
        }
    }

    /// Value at the wave number `k` of the open directions.
    pub(crate) fn transform(&self, k: f64) -> Result<f64, FreeSpaceError> {
        let (l, kappa) = (self.radius, self.kappa);
        if self.open == 0 {
            return Ok(if kappa > 0.0 { 1.0 / (kappa * kappa) } else { 0.0 });
        }
        if kappa == 0.0 {
            return match self.open {
                1 => Truncated::<1>::new(l).map(|t| t.transform_above_rim(k)),
                2 => Truncated::<2>::new(l).map(|t| t.transform_above_rim(k)),
                _ => Truncated::<3>::new(l).map(|t| t.transform(k)),
            };
        }
        let all = k * k + kappa * kappa;
        let x = k * l;
        let left = if kappa * l > FAR {
            0.0
        } else if self.open == 1 {
            // int_{-L}^{L} exp(-kappa |x|)/(2 kappa) cos(kx) dx
            -(-kappa * l).exp() * (x.cos() - k / kappa * x.sin())
        } else {
            // int_0^L K0(kappa r) J0(k r) r dr
            l * (k * libm::j1(x) * self.bessel[0] - kappa * libm::j0(x) * self.bessel[1])
        };
        Ok((1.0 + left) / all)
    }
}

/// `K0(x)` and `K1(x)`, `int_0^inf exp(-x cosh t) cosh(n t) dt`, x > 0: the trapezoidal rule converges exponentially.
fn bessel_k(x: f64) -> [f64; 2] {
    let mut sums = [0.5 * (-x).exp(); 2];
    let mut t = STEP;
    loop {
        let cosh = t.cosh();
        let term = (-x * cosh).exp();
        sums[0] += term;
        sums[1] += term * cosh;
        if x * cosh > TAU * 120.0 {
            return sums.map(|s| s * STEP);
        }
        t += STEP;
    }
}

#[cfg(test)]
mod tests {
    use super::{Screened, bessel_k};

    #[test]
    fn modified_bessel_functions() {
        // Abramowitz and Stegun, tables 9.8 and 9.11, and 20-digit evaluations.
        for (x, k0, k1) in [
            (0.1, 2.427_069_024_702_017, 9.853_844_780_870_606),
            (1.0, 0.421_024_438_240_708_34, 0.601_907_230_197_234_6),
            (10.0, 1.778_006_231_616_765_2e-5, 1.864_877_345_382_558_5e-5),
        ] {
            let [a, b] = bessel_k(x);
            assert!((a / k0 - 1.0).abs() < 1e-13 && (b / k1 - 1.0).abs() < 1e-13, "{x}: {a} {b}");
        }
    }

    #[test]
    fn weak_screening_is_the_plain_kernel_and_a_constant() {
        // In one dimension exp(-kappa |x|)/(2 kappa) - 1/(2 kappa) tends to -|x|/2.
        let (l, k, kappa) = (1.5, 2.0, 1e-4);
        let weak = Screened::new(1, l, kappa).transform(k).expect("a value");
        let constant = (k * l).sin() / k / kappa;
        let (plain, rim) =
            (Screened::new(1, l, 0.0).transform(k).expect("a value"), Screened::rim(1, l).expect("one"));
        let plain = plain + rim * 2.0 * (k * l).sin() / k;
        assert!((weak - constant - plain).abs() < 1e-3, "{weak} {constant} {plain}");
    }
}
