//! What a stencil looks like: figures that tell good nodes from bad ones.

use crate::{FitScratch, Functional, LocalFit, StencilError};

/// Figures about the stencil of a Laplacian-like operator at one node, all without unit, to be plotted node by node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StencilDiagnosis {
    /// Condition of the fit, see [`FitDiagnosis::condition`](crate::FitDiagnosis::condition).
    pub condition: f64,
    /// How exactly polynomials are reproduced: the largest difference over all monomials of the stencil applied to one
    /// and its exact value, relative to the sum of the absolute terms. Round-off for a sound stencil.
    pub residual: f64,
    /// Signs and size of the coefficients.
    pub signs: SignDiagnosis,
}

/// What the maximum principle asks of a row with negative diagonal: no other negative entry, and diagonal dominance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignDiagnosis {
    /// Largest negative coefficient off the centre, relative to the one at the centre; 0 for a positive stencil.
    pub wrong_sign: f64,
    /// The diagonal-dominance error sigma_i of Kraus et al. (2022), (23): 0 where the row is diagonally dominant.
    pub dominance_error: f64,
}

impl SignDiagnosis {
    /// Looks at a row that annihilates constants, given by its coefficients off the centre; the one at the centre is
    /// minus their sum, which carries no round-off of its own.
    ///
    /// Both figures are infinite where the centre has the wrong sign or none: that row is no diffusion at all.
    ///
    /// ```
    /// use meshless_stencils::SignDiagnosis;
    ///
    /// let good = SignDiagnosis::of_row(&[1.0, 1.0, 1.0, 1.0]);
    /// assert_eq!((good.wrong_sign, good.dominance_error), (0.0, 0.0));
    /// let poor = SignDiagnosis::of_row(&[2.0, 2.5, -0.5]);
    /// assert_eq!((poor.wrong_sign, poor.dominance_error), (0.125, 0.25));
    /// ```
    pub fn of_row<'a>(off_centre: impl IntoIterator<Item = &'a f64>) -> Self {
        let (mut sum, mut absolute, mut lowest) = (0.0, 0.0, 0.0_f64);
        for &c in off_centre {
            sum += c;
            absolute += c.abs();
            lowest = lowest.min(c);
        }
        if sum > 0.0 {
            Self { wrong_sign: -lowest / sum, dominance_error: (absolute / sum - 1.0).max(0.0) }
        } else {
            Self { wrong_sign: f64::INFINITY, dominance_error: f64::INFINITY }
        }
    }
}

impl<const D: usize> LocalFit<D> {
    /// Diagnoses `coefficients` of an operator that annihilates constants, on the support that `scratch` has factored;
    /// `centre` is the place of the node itself among the `offsets`.
    ///
    /// # Errors
    /// Lengths that are not that of the support.
    pub fn diagnose(
        &self,
        functional: &Functional<D>,
        offsets: &[[f64; D]],
        centre: usize,
        coefficients: &[f64],
        scratch: &mut FitScratch<D>,
    ) -> Result<StencilDiagnosis, StencilError> {
        let points = scratch.points();
        for (what, given) in [("offsets", offsets.len()), ("coefficients", coefficients.len())] {
            if given != points {
                return Err(StencilError::LengthMismatch { what, given, expected: points });
            }
        }
        if centre >= points {
            return Err(StencilError::NoSuchPoint { entry: centre, points });
        }
        let residual = self.residual(functional, offsets, coefficients, scratch);
        let signs = SignDiagnosis::of_row(coefficients[..centre].iter().chain(&coefficients[centre + 1..]));
        Ok(StencilDiagnosis { condition: scratch.condition(), residual, signs })
    }

    fn residual(
        &self,
        functional: &Functional<D>,
        offsets: &[[f64; D]],
        coefficients: &[f64],
        scratch: &mut FitScratch<D>,
    ) -> f64 {
        let (radius, exact) = scratch.moments_of(functional, self.monomials());
        let mut largest = 0.0_f64;
        for (exponents, &exact) in self.monomials().exponents().iter().zip(exact).skip(self.first()) {
            let (mut sum, mut absolute) = (0.0, exact.abs());
            for (x, c) in offsets.iter().zip(coefficients) {
                let term = (0..D).fold(*c, |t, k| t * (x[k] / radius).powi(i32::from(exponents[k])));
                sum += term;
                absolute += term.abs();
            }
            if absolute > 0.0 {
                largest = largest.max((sum - exact).abs() / absolute);
            }
        }
        largest
    }
}
