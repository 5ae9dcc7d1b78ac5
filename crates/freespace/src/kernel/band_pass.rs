//! What a finer mesh adds to a coarser one.

use std::f64::consts::{PI, SQRT_2};

use super::{Gaussian, Radial, Smooth};
use crate::error::FreeSpaceError;
use crate::special::{e1, ein};

/// Below this `x = r^2 / 2 sigma^2` differences of E1 are taken between entire functions.
const NEAR: f64 = 0.5;

/// `G_m(r; sigma) - G_m(r; a sigma)`, the kernel of the wave numbers that a mesh refined by `a` adds (Hejlesen and Walther
/// 2016, eqs. 21 and 22). It decays like `exp(-r^2 / 2 a^2 sigma^2)` and is accurate relative to itself in that tail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandPass<const D: usize> {
    fine: Gaussian<D>,
    coarse: Gaussian<D>,
    ratio: f64,
}

impl<const D: usize> BandPass<D> {
    /// The difference of the kernels with smoothing radii `sigma` and `ratio * sigma`.
    ///
    /// # Errors
    /// As for [`Gaussian::new`], or a ratio that is not above 1.
    pub fn new(order: usize, sigma: f64, ratio: f64) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "kernels have one, two or three dimensions") };
        if !(ratio > 1.0 && ratio.is_finite()) {
            return Err(FreeSpaceError::Invalid {
                what: "refinement ratio",
                value: ratio,
                expected: "above 1 and finite",
            });
        }
        let (fine, coarse) = (Gaussian::new(order, sigma)?, Gaussian::new(order, ratio * sigma)?);
        Ok(Self { fine, coarse, ratio })
    }

    /// It varies like the finer of the two kernels.
    pub(crate) fn smooth(&self) -> Option<Smooth> {
        let error = 4e-16 * self.value(0.0).abs();
        Some(Smooth { width: 0.4 * self.fine.sigma(), error })
    }

    /// The distance beyond which the kernel is below `tolerance` times its value at the origin.
    pub fn reach(&self, tolerance: f64) -> f64 {
        let least = tolerance.max(f64::MIN_POSITIVE) * self.value(0.0).abs();
        let step = self.coarse.sigma() / 16.0;
        // The polynomials of the highest order end within 40 smoothing radii of the coarse kernel for any tolerance.
        let steps = (1..=640).rev().find(|&i| self.value(f64::from(i) * step).abs() > least);
        f64::from(steps.unwrap_or(0) + 1) * step
    }

    /// `G_2` of the fine kernel less that of the coarse one.
    fn second_order(&self, r: f64) -> f64 {
        let (x, y) = (self.fine.scaled(r), self.coarse.scaled(r));
        match D {
            1 => {
                // r (erfc + ...) of each: the parts that do not decay, -r/2, cancel exactly.
                let part = |k: &Gaussian<D>, x: f64| {
                    let rho = r / k.sigma();
                    0.5 * k.sigma() * (rho * libm::erfc(rho / SQRT_2) - (2.0 / PI).sqrt() * (-x).exp())
                };
                part(&self.fine, x) - part(&self.coarse, y)
            }
            2 if x < NEAR => (self.ratio.ln() - 0.5 * (ein(x) - ein(y))) / (2.0 * PI),
            2 => 0.5 * (e1(y) - e1(x)) / (2.0 * PI),
            _ if r / self.fine.sigma() < f64::MIN_POSITIVE => {
                (2.0 / PI).sqrt() * (1.0 - 1.0 / self.ratio) / (4.0 * PI * self.fine.sigma())
            }
            _ => {
                let (u, v) = (x.sqrt(), y.sqrt());
                let difference =
                    if u < NEAR { libm::erf(u) - libm::erf(v) } else { libm::erfc(v) - libm::erfc(u) };
                difference / (4.0 * PI * r)
            }
        }
    }
}

impl<const D: usize> Radial for BandPass<D> {
    fn value(&self, r: f64) -> f64 {
        let (x, y) = (self.fine.scaled(r), self.coarse.scaled(r));
        self.second_order(r) + self.fine.polynomial(x) * (-x).exp() - self.coarse.polynomial(y) * (-y).exp()
    }
}
