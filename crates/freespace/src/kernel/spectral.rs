//! All wave numbers below a limit and none above.

use std::f64::consts::{LN_2, PI};

use super::{Radial, Smooth};
use crate::error::FreeSpaceError;
use crate::special::{EULER, one_minus_j0, one_minus_j0_integral, sine_integral};

/// The Green's function without its wave numbers above `1/sigma`: the limit of infinite order.
///
/// One dimension `-(r Si(rho) + sigma cos rho)/pi`, two
/// `-(1/2 pi) [int_0^rho (1 - J0(u))/u du + ln(2 sigma) - gamma]`, three `Si(rho)/(2 pi^2 r)`, `rho = r/sigma`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectral<const D: usize> {
    sigma: f64,
}

impl<const D: usize> Spectral<D> {
    /// The kernel of the wave numbers up to `1/sigma`; a mesh of spacing h resolves up to `pi/h`.
    ///
    /// # Errors
    /// A sigma that is not positive and finite.
    pub fn new(sigma: f64) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "kernels have one, two or three dimensions") };
        FreeSpaceError::unless_positive("smoothing radius", sigma)?;
        Ok(Self { sigma })
    }

    /// It oscillates with the wave number `1/sigma`; in two dimensions about a logarithm.
    pub(crate) fn smooth(&self) -> Option<Smooth> {
        let error = if D == 2 { 3e-16 } else { 0.0 };
        (D > 1).then_some(Smooth { width: 1.5 * PI * self.sigma, error })
    }

    /// The derivative of the kernel with respect to the distance.
    pub fn slope(&self, r: f64) -> f64 {
        let rho = r / self.sigma;
        match D {
            1 => -sine_integral(rho) / PI,
            _ if rho < f64::MIN_POSITIVE => 0.0,
            2 => -one_minus_j0(rho) / (2.0 * PI * r),
            _ => sine_less_its_integral(rho) / (2.0 * PI * PI * r * r),
        }
    }
}

/// `sin u - Si u`, which is `-u^3 / 9` near zero.
fn sine_less_its_integral(u: f64) -> f64 {
    if u > 1.0 {
        return u.sin() - sine_integral(u);
    }
    let (mut power, mut sum) = (u, 0.0);
    for n in 1..12 {
        let odd = f64::from(2 * n + 1);
        power *= -u * u / (odd * (odd - 1.0));
        sum += power * (1.0 - 1.0 / odd);
    }
    sum
}

impl<const D: usize> Radial for Spectral<D> {
    fn value(&self, r: f64) -> f64 {
        let rho = r / self.sigma;
        match D {
            1 => -(r * sine_integral(rho) + self.sigma * rho.cos()) / PI,
            2 => -(one_minus_j0_integral(rho) + LN_2 + self.sigma.ln() - EULER) / (2.0 * PI),
            _ if rho < f64::MIN_POSITIVE => 1.0 / (2.0 * PI * PI * self.sigma),
            _ => sine_integral(rho) / (2.0 * PI * PI * r),
        }
    }
}
