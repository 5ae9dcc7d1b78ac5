//! Kernels of a source smeared out by a Gaussian and polynomials.

use std::f64::consts::{FRAC_1_SQRT_2, LN_2, PI, SQRT_2};

use super::Radial;
use super::laguerre::laguerre;
use crate::error::FreeSpaceError;
use crate::special::{EULER, e1, ein, logarithms};

/// Largest order that there are kernels of.
pub(crate) const MAX_ORDER: usize = 20;

/// `x = r^2 / 2 sigma^2` beyond which `e^-x` times the polynomials of the highest order is below 1e-20 of the kernel.
const FAR: f64 = 90.0;

/// Values that are computed together.
const BLOCK: usize = 64;

/// Where E1 and ln take over from the entire function Ein.
const ENTIRE: f64 = 1.5;

/// The Green's function of the density `zeta_m(r) = (2 pi sigma^2)^(-D/2) e^-x L_(m/2-1)^(D/2)(x)`, `x = r^2 / 2 sigma^2`:
/// of `-lap` convolved with a kernel whose moments up to m - 1 vanish.
///
/// Hejlesen and Walther (2016), eqs. 12 to 16, for any even order by
/// `G_(m+2) - G_m = (sigma^2/m) (2 pi sigma^2)^(-D/2) e^-x L_(m/2-1)^(D/2-1)(x)`; their value at the origin in three
/// dimensions has a misprint. In one dimension the singular function is `-|r|/2`, in two `-ln(r)/2 pi`.
///
/// ```
/// use meshless_freespace::{Gaussian, Radial};
///
/// let kernel = Gaussian::<3>::new(10, 0.1)?;
/// // Far away nothing is left of the regularisation.
/// assert!((kernel.value(2.0) * 4.0 * std::f64::consts::PI * 2.0 - 1.0).abs() < 1e-15);
/// # Ok::<(), meshless_freespace::FreeSpaceError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian<const D: usize> {
    order: usize,
    sigma: f64,
}

pub(super) fn check_order(order: usize) -> Result<(), FreeSpaceError> {
    if (2..=MAX_ORDER).contains(&order) && order.is_multiple_of(2) {
        Ok(())
    } else {
        Err(FreeSpaceError::Order { order })
    }
}

/// `zeta_m^(s) = exp(-s^2/2) sum_{j < m/2} (s^2/2)^j / j!`, what a Gaussian kernel leaves of a wave number.
pub(crate) fn passed(order: usize, s: f64) -> f64 {
    let x = s * s / 2.0;
    let (mut term, mut sum) = (1.0, 0.0);
    for j in 0..order / 2 {
        sum += term;
        term *= x / (j + 1) as f64;
    }
    (-x).exp() * sum
}

impl<const D: usize> Gaussian<D> {
    /// The kernel of even order 2 to 20 and smoothing radius `sigma`, a length.
    ///
    /// # Errors
    /// [`FreeSpaceError::Order`], or a sigma that is not positive and finite.
    pub fn new(order: usize, sigma: f64) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "kernels have one, two or three dimensions") };
        check_order(order)?;
        FreeSpaceError::unless_positive("smoothing radius", sigma)?;
        Ok(Self { order, sigma })
    }

    /// Order m.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Smoothing radius, a length.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// The density whose potential this is, `-lap G = zeta`, at distance `r`.
    pub fn density(&self, r: f64) -> f64 {
        let x = self.scaled(r);
        let last = laguerre(D as f64 / 2.0, x).nth(self.order / 2 - 1).unwrap_or(1.0);
        self.height() * (-x).exp() * last
    }

    /// `x = r^2 / 2 sigma^2`.
    pub(super) fn scaled(&self, r: f64) -> f64 {
        let rho = r / self.sigma;
        rho * rho / 2.0
    }

    /// `(2 pi sigma^2)^(-D/2)`
    fn height(&self) -> f64 {
        (2.0 * PI).powf(-(D as f64) / 2.0) * self.sigma.powi(-(D as i32))
    }

    /// `G_m - G_2` at x, without the factor `e^-x`.
    pub(super) fn polynomial(&self, x: f64) -> f64 {
        // Order 2j + 2 adds sigma^2 / 2j L_(j-1).
        let terms = laguerre(D as f64 / 2.0 - 1.0, x).zip(1..self.order / 2);
        let sum: f64 = terms.map(|(l, j)| l / (2 * j) as f64).sum();
        self.sigma * self.sigma * self.height() * sum
    }

    /// The derivative of the kernel with respect to the distance. Of the terms of a higher order,
    /// `d/dx [L_n^(a)(x) e^-x] = -L_n^(a+1)(x) e^-x`.
    pub fn slope(&self, r: f64) -> f64 {
        let (x, rho) = (self.scaled(r), r / self.sigma);
        let second = match D {
            1 => -0.5 * libm::erf(rho * FRAC_1_SQRT_2),
            _ if rho < f64::MIN_POSITIVE => 0.0,
            2 => libm::expm1(-x) / (2.0 * PI * r),
            _ => -enclosed(rho) / (4.0 * PI * r * r),
        };
        let terms = laguerre(D as f64 / 2.0, x).zip(1..self.order / 2);
        let sum: f64 = terms.map(|(l, j)| l / (2 * j) as f64).sum();
        second - r * self.height() * (-x).exp() * sum
    }

    /// `G_2`
    fn second_order(&self, r: f64, x: f64) -> f64 {
        let rho = r / self.sigma;
        match D {
            1 => -0.5 * self.sigma * (rho * libm::erf(rho * FRAC_1_SQRT_2) + (2.0 / PI).sqrt() * (-x).exp()),
            2 if x < ENTIRE => -(self.sigma.ln() + 0.5 * (LN_2 - EULER + ein(x))) / (2.0 * PI),
            2 => -(r.ln() + 0.5 * e1(x)) / (2.0 * PI),
            _ if rho < f64::MIN_POSITIVE => (2.0 / PI).sqrt() / (4.0 * PI * self.sigma),
            _ => libm::erf(rho / SQRT_2) / (4.0 * PI * r),
        }
    }
}

/// `erf(rho/sqrt 2) - sqrt(2/pi) rho e^(-rho^2/2)`, what a Gaussian in space has within rho.
fn enclosed(rho: f64) -> f64 {
    let (x, height) = (rho * rho / 2.0, (2.0 / PI).sqrt());
    if rho > 1.0 {
        return libm::erf(rho * FRAC_1_SQRT_2) - height * rho * (-x).exp();
    }
    let (mut term, mut sum, mut odd) = (rho.powi(3) / 3.0, 0.0, 3.0);
    while sum + term > sum {
        sum += term;
        odd += 2.0;
        term *= rho * rho / odd;
    }
    height * (-x).exp() * sum
}

impl<const D: usize> Radial for Gaussian<D> {
    fn value(&self, r: f64) -> f64 {
        let x = self.scaled(r);
        if x > FAR {
            return match D {
                1 => -0.5 * r,
                2 => -r.ln() / (2.0 * PI),
                _ => 1.0 / (4.0 * PI * r),
            };
        }
        self.second_order(r, x) + self.polynomial(x) * (-x).exp()
    }

    /// Most points of a mesh are so far away that nothing is left of the regularisation.
    fn values(&self, unit: f64, squares: &mut [f64]) {
        let far = 2.0 * FAR * (self.sigma / unit).powi(2);
        let mut singular = [0.0; BLOCK];
        for squares in squares.chunks_mut(BLOCK) {
            let singular = &mut singular[..squares.len()];
            singular.copy_from_slice(squares);
            match D {
                1 => singular.iter_mut().for_each(|s| *s = -0.5 * unit * s.sqrt()),
                2 => {
                    let of_unit = unit.ln();
                    logarithms(singular);
                    singular.iter_mut().for_each(|s| *s = -(of_unit + 0.5 * *s) / (2.0 * PI));
                }
                _ => singular.iter_mut().for_each(|s| *s = 1.0 / (4.0 * PI * unit * s.sqrt())),
            }
            for (square, singular) in squares.iter_mut().zip(singular) {
                *square = if *square > far { *singular } else { self.value(unit * square.sqrt()) };
            }
        }
    }
}
