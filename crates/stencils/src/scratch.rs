//! The memory of a fit.

use crate::qr::Qr;
use crate::{Functional, Monomials};

/// Memory of one thread, and the factorisation that it holds; see [`LocalFit::scratch`](crate::LocalFit::scratch).
///
/// Columns lie one after the other, a monomial each, so that every inner loop runs along the points.
#[derive(Debug, Clone)]
pub struct FitScratch<const D: usize> {
    pub(crate) qr: Qr,
    pub(crate) weights: Vec<f64>,
    pub(crate) moments: Vec<f64>,
    pub(crate) z: Vec<f64>,
    pub(crate) radius: f64,
}

impl<const D: usize> FitScratch<D> {
    pub(crate) fn new(max_points: usize, monomials: usize) -> Self {
        let mut qr = Qr::default();
        qr.resize(max_points.max(1), monomials);
        let weights = Vec::with_capacity(max_points);
        Self { qr, weights, moments: vec![0.0; monomials], z: vec![0.0; monomials], radius: 1.0 }
    }

    /// Room for the values of an operator on so many functions.
    pub(crate) fn resize_moments(&mut self, functions: usize) {
        self.moments.resize(functions, 0.0);
        self.z.resize(functions, 0.0);
    }

    /// Points of the support that was factored last.
    pub fn points(&self) -> usize {
        self.weights.len()
    }

    /// Its condition, see [`FitDiagnosis::condition`](crate::FitDiagnosis::condition).
    pub fn condition(&self) -> f64 {
        self.qr.condition()
    }

    /// Its radius, and the values of a functional on the scaled monomials.
    pub(crate) fn moments_of(
        &mut self,
        functional: &Functional<D>,
        monomials: &Monomials<D>,
    ) -> (f64, &[f64]) {
        functional.moments(monomials, self.radius, &mut self.moments);
        (self.radius, &self.moments)
    }
}
