//! The local fit: one factorisation for all operators of a node.

use crate::{FitScratch, Functional, Monomials, StencilError};

/// A reproduction condition that is violated by more than this, relative to the largest moment, is not met.
pub const REPRODUCTION_TOLERANCE: f64 = 1e-8;

/// What a fit reproduces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitParams {
    /// Polynomials up to this degree are reproduced.
    pub degree: usize,
    /// Smallest diagonal entry of R, relative to the largest, that is taken as different from zero.
    pub rank_tolerance: f64,
}

impl Default for FitParams {
    fn default() -> Self {
        Self { degree: 2, rank_tolerance: 1e-11 }
    }
}

/// Least-squares fits of one degree.
///
/// Coefficients c of an operator on the values at the points of a support are the ones of least weighted norm that
/// are exact for polynomials (Kraus et al. 2022, (10)): with K the matrix of monomials, W that of the weights and b the
/// operator applied to the monomials, `c = W^2 K^T (K W^2 K^T)^-1 b`. Equivalently they apply the operator to the
/// weighted least-squares polynomial. With `W K^T = Q R`, `c = W Q R^-T b`: the normal equations are never formed.
#[derive(Debug, Clone)]
pub struct LocalFit<const D: usize> {
    params: FitParams,
    monomials: Monomials<D>,
}

/// What the factorisation of a support says about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitDiagnosis {
    /// Rank of the moment matrix.
    pub rank: usize,
    /// Largest over smallest diagonal entry of R: a lower bound of the condition number, mostly within a factor of 10.
    pub condition: f64,
    /// Whether the plain factorisation was not safe.
    pub pivoted: bool,
}

impl<const D: usize> LocalFit<D> {
    /// Fits with these parameters.
    pub fn new(params: FitParams) -> Self {
        Self { params, monomials: Monomials::new(params.degree) }
    }

    /// The monomials that are reproduced.
    pub fn monomials(&self) -> &Monomials<D> {
        &self.monomials
    }

    /// Memory for supports of up to `max_points` points; larger ones work and make it grow.
    pub fn scratch(&self, max_points: usize) -> FitScratch<D> {
        FitScratch::new(max_points, self.monomials.count())
    }

    /// Factors the fit over points at `offsets` from the centre, with positive `weights`, in units of `radius`.
    ///
    /// # Errors
    /// Values that are not finite or not positive, and lengths that do not agree. A support that is too small is no
    /// error yet: an operator that it does determine has coefficients.
    pub fn factor(
        &self,
        offsets: &[[f64; D]],
        weights: &[f64],
        radius: f64,
        scratch: &mut FitScratch<D>,
    ) -> Result<FitDiagnosis, StencilError> {
        check(offsets, weights, radius)?;
        scratch.radius = radius;
        scratch.weights.clear();
        scratch.weights.extend_from_slice(weights);
        self.fill(offsets, scratch);
        if scratch.qr.factor(self.params.rank_tolerance) {
            let (rank, condition) = (scratch.qr.rank(), scratch.qr.condition());
            return Ok(FitDiagnosis { rank, condition, pivoted: false });
        }
        self.fill(offsets, scratch);
        scratch.qr.factor_pivoted(self.params.rank_tolerance);
        Ok(FitDiagnosis { rank: scratch.qr.rank(), condition: scratch.qr.condition(), pivoted: true })
    }

    /// Writes `W K^T` into the factorisation.
    fn fill(&self, offsets: &[[f64; D]], scratch: &mut FitScratch<D>) {
        let m = self.monomials.count();
        scratch.qr.resize(offsets.len(), m);
        let inverse = 1.0 / scratch.radius;
        scratch.qr.column_mut(0).copy_from_slice(&scratch.weights);
        // Every monomial is one of lower degree, which comes before it, times a coordinate.
        for (column, &(parent, axis)) in self.monomials.parents().iter().enumerate().skip(1) {
            scratch.qr.multiply_column(parent, column, offsets, axis, inverse);
        }
    }

    /// Coefficients of an operator, one for each offset, in physical units.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the support does not determine the operator, and
    /// [`StencilError::DegreeTooLow`] where no support of this fit could.
    pub fn coefficients(
        &self,
        functional: &Functional<D>,
        scratch: &mut FitScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        functional.check(self.params.degree)?;
        let mut moments = std::mem::take(&mut scratch.moments);
        functional.moments(&self.monomials, scratch.radius, &mut moments);
        let outcome = self.coefficients_for(&moments, scratch, out);
        scratch.moments = moments;
        outcome
    }

    /// Coefficients of the operator whose values on the monomials of `offset / radius` are `moments`.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the support does not determine the operator.
    pub fn coefficients_for(
        &self,
        moments: &[f64],
        scratch: &mut FitScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        let points = scratch.weights.len();
        if out.len() != points {
            return Err(StencilError::LengthMismatch { what: "coefficients", given: out.len(), points });
        }
        let remainder = scratch.qr.least_norm(moments, &mut scratch.z, out);
        out.iter_mut().zip(&scratch.weights).for_each(|(c, w)| *c *= w);
        let scale = moments.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        if remainder > REPRODUCTION_TOLERANCE * scale || out.iter().any(|c| !c.is_finite()) {
            let (rank, monomials) = (scratch.qr.rank(), self.monomials.count());
            return Err(StencilError::Unresolvable { points, monomials, rank, remainder: remainder / scale });
        }
        Ok(())
    }

    /// The correction vector of Kraus et al. (2022), (18): of least weighted norm in the null space of the test
    /// functions, with the entry of `centre`, a point at the centre, equal to 1.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the null space has no such vector.
    pub fn correction(
        &self,
        centre: usize,
        scratch: &mut FitScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        // The projection of the unit vector e onto the null space, in the weighted inner product: W (I - Q Q^T) e.
        let points = scratch.weights.len();
        let own_weight = scratch.weights[centre];
        let mut moments = std::mem::take(&mut scratch.moments);
        Functional::Value.moments(&self.monomials, scratch.radius, &mut moments);
        moments.iter_mut().for_each(|m| *m *= own_weight);
        let outcome = self.coefficients_for(&moments, scratch, out);
        scratch.moments = moments;
        outcome?;
        out.iter_mut().for_each(|c| *c = -*c);
        out[centre] += own_weight;
        let own = out[centre];
        if own <= REPRODUCTION_TOLERANCE * own_weight {
            let (rank, monomials) = (scratch.qr.rank(), self.monomials.count());
            return Err(StencilError::Unresolvable { points, monomials, rank, remainder: own });
        }
        out.iter_mut().for_each(|c| *c /= own);
        Ok(())
    }
}

fn check<const D: usize>(offsets: &[[f64; D]], weights: &[f64], radius: f64) -> Result<(), StencilError> {
    let points = offsets.len();
    if weights.len() != points {
        return Err(StencilError::LengthMismatch { what: "weights", given: weights.len(), points });
    }
    if points == 0 {
        return Err(StencilError::LengthMismatch { what: "offsets", given: 0, points: 1 });
    }
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(StencilError::Invalid { what: "radius", entry: 0, value: radius });
    }
    for (entry, (offset, &weight)) in offsets.iter().zip(weights).enumerate() {
        if let Some(&value) = offset.iter().find(|x| !x.is_finite()) {
            return Err(StencilError::Invalid { what: "offset", entry, value });
        }
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(StencilError::Invalid { what: "weight", entry, value: weight });
        }
    }
    Ok(())
}
