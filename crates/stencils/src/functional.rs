//! Linear functionals of a function near a point.

use crate::{Monomials, StencilError};

/// What a stencil approximates; in physical units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Functional<const D: usize> {
    /// The value at the centre.
    Value,
    /// The value at an offset from the centre.
    ValueAt([f64; D]),
    /// The partial derivative along an axis.
    Partial(usize),
    /// The second derivative along two axes.
    Second(usize, usize),
    /// Any partial derivative.
    Derivative([u8; D]),
    /// The Laplacian.
    Laplacian,
    /// The derivative along a vector, which need not be of unit length.
    Directional([f64; D]),
    /// `eta lap u + gradient . grad u`, which is `div(eta grad u)` if `gradient` is that of eta.
    Diffusion {
        /// The diffusivity.
        eta: f64,
        /// Its gradient.
        gradient: [f64; D],
    },
}

impl<const D: usize> Functional<D> {
    /// The highest order of the derivatives in it.
    pub fn order(&self) -> usize {
        match self {
            Self::Value | Self::ValueAt(_) => 0,
            Self::Partial(_) | Self::Directional(_) => 1,
            Self::Second(..) | Self::Laplacian | Self::Diffusion { .. } => 2,
            Self::Derivative(orders) => orders.iter().map(|&o| usize::from(o)).sum(),
        }
    }

    /// Whether polynomials to `degree` in D variables say anything about it.
    pub(crate) fn check(&self, degree: usize) -> Result<(), StencilError> {
        let axis = match *self {
            Self::Partial(axis) => axis,
            Self::Second(a, b) => a.max(b),
            _ => 0,
        };
        if axis >= D {
            return Err(StencilError::NoSuchAxis { functional: format!("{self:?}"), dimension: D });
        }
        if self.order() > degree {
            let functional = format!("{self:?}");
            return Err(StencilError::DegreeTooLow { functional, order: self.order(), degree });
        }
        Ok(())
    }

    /// Moments of the functional: its values on the monomials of `(x - centre) / radius`.
    pub(crate) fn moments(&self, monomials: &Monomials<D>, radius: f64, out: &mut [f64]) {
        out.fill(0.0);
        self.add_moments(monomials, &[0.0; D], radius, out);
    }

    /// Adds its values, taken at `origin` in units of the radius, on the monomials of `x / radius`.
    pub(crate) fn add_moments(
        &self,
        monomials: &Monomials<D>,
        origin: &[f64; D],
        radius: f64,
        out: &mut [f64],
    ) {
        let mut add = |order: [u8; D], at: &[f64; D], factor: f64| {
            let total: i32 = order.iter().map(|&o| i32::from(o)).sum();
            monomials.add_derivative(&order, at, factor * radius.powi(-total), out);
        };
        match *self {
            Self::Value => add([0; D], origin, 1.0),
            Self::ValueAt(offset) => {
                add([0; D], &std::array::from_fn(|k| origin[k] + offset[k] / radius), 1.0);
            }
            Self::Partial(axis) => add(unit(axis, 1), origin, 1.0),
            Self::Second(a, b) if a == b => add(unit(a, 2), origin, 1.0),
            Self::Second(a, b) => {
                let mut order = unit(a, 1);
                order[b] = 1;
                add(order, origin, 1.0);
            }
            Self::Derivative(order) => add(order, origin, 1.0),
            Self::Laplacian => (0..D).for_each(|k| add(unit(k, 2), origin, 1.0)),
            Self::Directional(v) => (0..D).for_each(|k| add(unit(k, 1), origin, v[k])),
            Self::Diffusion { eta, gradient } => {
                for k in 0..D {
                    add(unit(k, 2), origin, eta);
                    add(unit(k, 1), origin, gradient[k]);
                }
            }
        }
    }
}

fn unit<const D: usize>(axis: usize, value: u8) -> [u8; D] {
    std::array::from_fn(|k| if k == axis { value } else { 0 })
}
