//! Discretisation-corrected particle strength exchange: one operator, one kernel, any derivative, any order.

use crate::{FitParams, FitScratch, Functional, LocalFit, StencilError};

/// A DC-PSE operator (Schrader, Reboux, Sbalzarini, J. Comput. Phys. 229, 2010; Fiétier et al., (4.1) to (4.5)).
///
/// The operator for the derivative of order beta is
/// `eps^-|beta| sum_p (u_p ± u) eta(z_p)` with `z_p = (x - x_p) / eps`, '+' for odd and '-' for even `|beta|`, and the
/// kernel `eta(z) = (sum_gamma a_gamma z^gamma) exp(-|z|^2)`, whose coefficients solve the discrete moment conditions
/// `sum_gamma A_alpha,gamma a_gamma = (-1)^|beta| beta! delta_alpha,beta` with
/// `A_alpha,gamma = sum_p z_p^(alpha+gamma) exp(-|z_p|^2)`, for all `|alpha|, |gamma| <= |beta| + m - 1`, without the
/// constant where `|beta|` is even. The order is m.
///
/// That is the derivative of the least-squares polynomial of degree `|beta| + m - 1` with the weight `exp(-|z|^2)` on
/// squared residuals: through the value at the point for even `|beta|`, with the point as one among the others for odd.
/// So it is computed as such, by an orthogonal factorisation that never forms `A`, whose condition is the square of
/// what is factored here.
#[derive(Debug, Clone)]
pub struct DcPse<const D: usize> {
    functional: Functional<D>,
    fit: LocalFit<D>,
    even: bool,
}

/// Memory of one thread.
#[derive(Debug, Clone)]
pub struct DcPseScratch<const D: usize> {
    fit: FitScratch<D>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
}

impl<const D: usize> DcPse<D> {
    /// The operator for a partial derivative, of this order on any cloud.
    pub fn derivative(orders: [u8; D], order: usize) -> Self {
        Self::new(Functional::Derivative(orders), order)
    }

    /// The Laplacian, of this order on any cloud.
    pub fn laplacian(order: usize) -> Self {
        Self::new(Functional::Laplacian, order)
    }

    fn new(functional: Functional<D>, order: usize) -> Self {
        let degree = (functional.order() + order.max(1)).saturating_sub(1);
        let even = functional.order().is_multiple_of(2);
        let fit = LocalFit::new(FitParams { degree, through_centre: even, ..FitParams::default() });
        Self { functional, fit, even }
    }

    /// Degree of the polynomials for which the operator is exact.
    pub fn degree(&self) -> usize {
        self.fit.monomials().degree()
    }

    /// Neighbours that a support should have. Measured on lattices and on clouds perturbed by half a spacing: twice as
    /// many as monomials where those are few, 2.5 times as many in three dimensions.
    pub fn support(&self) -> usize {
        let monomials = self.fit.monomials().count();
        if D == 3 { monomials * 5 / 2 } else { 2 * monomials }
    }

    /// Memory for supports of up to `max_neighbors`; larger ones work and make it grow.
    pub fn scratch(&self, max_neighbors: usize) -> DcPseScratch<D> {
        DcPseScratch {
            fit: self.fit.scratch(max_neighbors + 1),
            offsets: Vec::with_capacity(max_neighbors + 1),
            weights: Vec::with_capacity(max_neighbors + 1),
        }
    }

    /// Coefficients of the operator on the value at the point, which comes first, and on the values at the neighbours.
    ///
    /// `offsets` are the `x_p - x`, without that of the point itself; `epsilon` is the width of the kernel, a length.
    /// For even derivatives the first coefficient is minus the sum of the others.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the neighbours do not determine the operator: the factorisation reveals the
    /// rank, so that a lattice on which some kernel coefficients are undetermined, but not the operator, is no error.
    pub fn stencil(
        &self,
        offsets: &[[f64; D]],
        epsilon: f64,
        scratch: &mut DcPseScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        if out.len() != offsets.len() + 1 {
            return Err(StencilError::LengthMismatch {
                what: "coefficients",
                given: out.len(),
                expected: offsets.len() + 1,
            });
        }
        let DcPseScratch { fit, offsets: own, weights } = scratch;
        own.clear();
        weights.clear();
        if !self.even {
            own.push([0.0; D]);
            weights.push(1.0);
        }
        let mut reach = 0.0_f64;
        for offset in offsets {
            let squared = offset.iter().map(|x| x * x).sum::<f64>();
            own.push(*offset);
            // The square of this is the kernel's weight.
            weights.push((-0.5 * squared / (epsilon * epsilon)).exp());
            reach = reach.max(squared.sqrt());
        }
        let reach = if reach > 0.0 { reach } else { epsilon };
        self.fit.factor(own, weights, reach, fit)?;
        if self.even {
            self.fit.coefficients(&self.functional, fit, &mut out[1..])?;
            out[0] = -out[1..].iter().sum::<f64>();
            Ok(())
        } else {
            self.fit.coefficients(&self.functional, fit, out)
        }
    }
}
