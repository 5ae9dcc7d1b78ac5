//! The local fit: one factorisation for all operators of a node.

use crate::{BasisValues, FitScratch, Functional, Monomials, StencilError};

/// A reproduction condition that is violated by more than this, relative to the largest moment, is not met.
pub const REPRODUCTION_TOLERANCE: f64 = 1e-8;

/// What a fit reproduces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitParams {
    /// Polynomials up to this degree are reproduced.
    pub degree: usize,
    /// Smallest diagonal entry of R, relative to the largest, that is taken as different from zero.
    pub rank_tolerance: f64,
    /// The polynomial passes through the value at the centre, which is then not among the points of the support;
    /// coefficients multiply the differences to that value.
    pub through_centre: bool,
}

impl Default for FitParams {
    fn default() -> Self {
        Self { degree: 2, rank_tolerance: 1e-11, through_centre: false }
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

    /// The first monomial that is fitted: a polynomial through the centre has no free constant.
    pub(crate) fn first(&self) -> usize {
        usize::from(self.params.through_centre)
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
        self.factor_with(offsets, weights, radius, 0, &|_| (), scratch)
    }

    /// Like [`Self::factor`], in a basis that is not that of the monomials: `edit` is given their values at the points
    /// and changes them; `extra` further functions come after the monomials, zero until `edit` sets them.
    ///
    /// [`Self::coefficients_for`] then takes the values of the operator on the functions of that basis, and
    /// [`Self::moments_at`] gives those on the monomials.
    ///
    /// # Errors
    /// Those of [`Self::factor`].
    pub fn factor_with(
        &self,
        offsets: &[[f64; D]],
        weights: &[f64],
        radius: f64,
        extra: usize,
        edit: &dyn Fn(&mut BasisValues<'_>),
        scratch: &mut FitScratch<D>,
    ) -> Result<FitDiagnosis, StencilError> {
        check(offsets, weights, radius)?;
        scratch.radius = radius;
        scratch.weights.clear();
        scratch.weights.extend_from_slice(weights);
        scratch.resize_moments(self.monomials.count() + extra);
        self.fill(offsets, extra, edit, scratch);
        if scratch.qr.factor(self.params.rank_tolerance) {
            let (rank, condition) = (scratch.qr.rank(), scratch.qr.condition());
            return Ok(FitDiagnosis { rank, condition, pivoted: false });
        }
        self.fill(offsets, extra, edit, scratch);
        scratch.qr.factor_pivoted(self.params.rank_tolerance);
        Ok(FitDiagnosis { rank: scratch.qr.rank(), condition: scratch.qr.condition(), pivoted: true })
    }

    /// Writes `W K^T` into the factorisation, and edits it.
    fn fill(
        &self,
        offsets: &[[f64; D]],
        extra: usize,
        edit: &dyn Fn(&mut BasisValues<'_>),
        scratch: &mut FitScratch<D>,
    ) {
        let (m, first) = (self.monomials.count(), self.first());
        scratch.qr.resize(offsets.len(), m - first + extra);
        let inverse = 1.0 / scratch.radius;
        if first == 0 {
            scratch.qr.column_mut(0).copy_from_slice(&scratch.weights);
        }
        // Every monomial is one of lower degree, which comes before it, times a coordinate.
        for (column, &(parent, axis)) in self.monomials.parents().iter().enumerate().skip(1) {
            if parent < first {
                let column = scratch.qr.column_mut(column - first);
                for ((value, weight), point) in column.iter_mut().zip(&scratch.weights).zip(offsets) {
                    *value = weight * point[axis] * inverse;
                }
            } else {
                scratch.qr.multiply_column(parent - first, column - first, offsets, axis, inverse);
            }
        }
        (m - first..m - first + extra).for_each(|column| scratch.qr.column_mut(column).fill(0.0));
        edit(&mut BasisValues { qr: &mut scratch.qr, weights: &scratch.weights });
    }

    /// Adds the values of an operator, taken at `at`, on the monomials of `x / radius` to `out`.
    ///
    /// # Errors
    /// [`StencilError::DegreeTooLow`] for an operator of an order above the degree, and a length that does not agree.
    pub fn moments_at(
        &self,
        functional: &Functional<D>,
        at: &[f64; D],
        radius: f64,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        functional.check(self.params.degree)?;
        check_length("moments", out.len(), self.monomials.count())?;
        functional.add_moments(&self.monomials, &at.map(|x| x / radius), radius, out);
        Ok(())
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

    /// Coefficients of the operator whose values on the monomials of `offset / radius` (or on the functions of the
    /// edited basis) are `moments`.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the support does not determine the operator.
    pub fn coefficients_for(
        &self,
        moments: &[f64],
        scratch: &mut FitScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        let (points, count) = (scratch.points(), scratch.qr.columns() + self.first());
        check_length("coefficients", out.len(), points)?;
        check_length("moments", moments.len(), count)?;
        let moments = &moments[self.first()..];
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
    /// functions, with the entry of the point at `centre` equal to 1.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the null space has no such vector: there are as many monomials as points.
    pub fn correction(
        &self,
        centre: usize,
        scratch: &mut FitScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        let points = scratch.points();
        check_length("entries", out.len(), points)?;
        if centre >= points {
            return Err(StencilError::NoSuchPoint { entry: centre, points });
        }
        // The null space of K is W times the complement of the columns of W K^T.
        scratch.qr.complement(centre, out);
        let remainder = out[centre];
        // The square of the length of what is left of the unit vector, which is known to round-off. It is small wherever
        // the centre outweighs the other points.
        if remainder.sqrt() <= REPRODUCTION_TOLERANCE {
            let (rank, monomials) = (scratch.qr.rank(), self.monomials.count());
            return Err(StencilError::Unresolvable { points, monomials, rank, remainder });
        }
        let own = remainder * scratch.weights[centre];
        out.iter_mut().zip(&scratch.weights).for_each(|(c, w)| *c *= w / own);
        // Exactly, whatever the division has rounded.
        out[centre] = 1.0;
        Ok(())
    }
}

fn check_length(what: &'static str, given: usize, expected: usize) -> Result<(), StencilError> {
    if given == expected { Ok(()) } else { Err(StencilError::LengthMismatch { what, given, expected }) }
}

fn check<const D: usize>(offsets: &[[f64; D]], weights: &[f64], radius: f64) -> Result<(), StencilError> {
    let points = offsets.len();
    check_length("weights", weights.len(), points)?;
    if points == 0 {
        return check_length("offsets", 0, 1);
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
