//! Values of a basis at the points of a support, to be changed before they are factored.

use crate::qr::Qr;

/// The values of the functions of a basis at the points of a support, in the order of
/// [`Monomials::exponents`](crate::Monomials::exponents); see [`LocalFit::factor_with`](crate::LocalFit::factor_with).
#[derive(Debug)]
pub struct BasisValues<'a> {
    pub(crate) qr: &'a mut Qr,
    pub(crate) weights: &'a [f64],
}

impl BasisValues<'_> {
    /// Adds to the value of a function at a point.
    ///
    /// # Panics
    /// For a function or a point out of range.
    pub fn add(&mut self, function: usize, point: usize, value: f64) {
        self.qr.column_mut(function)[point] += self.weights[point] * value;
    }

    /// Multiplies a function, so that all are of about the same size.
    ///
    /// # Panics
    /// For a function out of range.
    pub fn scale(&mut self, function: usize, factor: f64) {
        self.qr.column_mut(function).iter_mut().for_each(|value| *value *= factor);
    }
}
