//! The singular Green's function, cut off at a radius.

use std::f64::consts::{PI, SQRT_2};

use crate::error::FreeSpaceError;
use crate::special::{one_minus_j0, one_minus_j0_ratios};

/// The Fourier transform of the singular Green's function times the indicator of the ball of radius L (Vico, Greengard and
/// Ferrando 2016). Where no two points are farther apart than L, it acts as the Green's function itself; being smooth
/// in Fourier space, it may be sampled there with any period that the box and L fit into together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truncated<const D: usize> {
    radius: f64,
}

impl<const D: usize> Truncated<D> {
    /// Cut off at `radius`, a length.
    ///
    /// # Errors
    /// A radius that is not positive and finite.
    pub fn new(radius: f64) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "kernels have one, two or three dimensions") };
        FreeSpaceError::unless_positive("radius of truncation", radius)?;
        Ok(Self { radius })
    }

    /// Value at the wave number `k >= 0`.
    ///
    /// 3-D `2 (sin(Lk/2)/k)^2`, 2-D `(1 - J0(Lk))/k^2 - L ln L J1(Lk)/k`, 1-D `(1 - cos Lk)/k^2 - L sin(Lk)/k`.
    pub fn transform(&self, k: f64) -> f64 {
        let l = self.radius;
        let x = l * k;
        if x < 1e-10 {
            return match D {
                1 => -0.5 * l * l,
                2 => 0.25 * l * l * (1.0 - 2.0 * l.ln()),
                _ => 0.5 * l * l,
            };
        }
        match D {
            1 => 2.0 * ((0.5 * x).sin() / k).powi(2) - l * x.sin() / k,
            2 => one_minus_j0(x) / (k * k) - l * l.ln() * libm::j1(x) / k,
            _ => (SQRT_2 * (0.5 * x).sin() / k).powi(2),
        }
    }

    /// The singular Green's function of a line and of the plane where it is cut off, in space nothing. Without it the rest begins there with
    /// zero, and its transform falls faster: like `k^-2` on a line, and is only J0 in the plane.
    pub(crate) fn rim(&self) -> f64 {
        match D {
            1 => -0.5 * self.radius,
            2 => -self.radius.ln() / (2.0 * PI),
            _ => 0.0,
        }
    }

    /// The transform of the singular Green's function less [`Self::rim`], times the indicator of the ball.
    pub(crate) fn transform_above_rim(&self, k: f64) -> f64 {
        let (x, square) = (self.radius * k, self.radius * self.radius);
        match D {
            1 if x < 1e-10 => 0.5 * square,
            1 => 2.0 * ((0.5 * x).sin() / k).powi(2),
            2 if x < 1e-10 => 0.25 * square,
            2 => one_minus_j0(x) / (x * x) * square,
            _ => self.transform(k),
        }
    }

    /// The same for squares of wave numbers in units of `unit` squared, in place.
    pub(crate) fn transforms_above_rim(&self, unit: f64, squares: &mut [f64]) {
        if D != 2 {
            return squares.iter_mut().for_each(|s| *s = self.transform_above_rim(unit * s.sqrt()));
        }
        let (scale, square) = (self.radius * unit, self.radius * self.radius);
        one_minus_j0_ratios(scale, squares);
        squares.iter_mut().for_each(|s| *s *= square);
    }

    /// Checks that the box and the radius fit into each period.
    ///
    /// # Errors
    /// [`FreeSpaceError::Period`] for the first direction in which images of the source would reach the box.
    pub fn check_period(&self, sides: [f64; D], periods: [f64; D]) -> Result<(), FreeSpaceError> {
        for axis in 0..D {
            let needed = sides[axis] + self.radius;
            // Both are sums of multiples of the spacing.
            if periods[axis] < needed * (1.0 - 1e-12) {
                return Err(FreeSpaceError::Period { axis, period: periods[axis], needed });
            }
        }
        Ok(())
    }
}
