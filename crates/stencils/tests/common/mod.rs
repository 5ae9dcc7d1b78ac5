//! Supports, and a dense reference for their stencils.

use meshless_stencils::{Functional, Monomials};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// A support: offsets, the centre first, positive weights, and the radius.
#[derive(Debug, Clone)]
pub(crate) struct Support<const D: usize> {
    pub(crate) offsets: Vec<[f64; D]>,
    pub(crate) weights: Vec<f64>,
    pub(crate) radius: f64,
}

/// Random supports with about `room` times as many points as there are monomials.
pub(crate) fn support<const D: usize>(degree: usize, room: f64) -> impl Strategy<Value = Support<D>> {
    let count = (room * Monomials::<D>::new(degree).count() as f64) as usize + 2;
    let points = prop::collection::vec(prop::array::uniform::<_, D>(-1.0..1.0_f64), count);
    let weights = prop::collection::vec(0.05..1.0_f64, count + 1);
    (points, weights, -3.0..3.0_f64).prop_map(|(points, weights, size)| {
        let radius = 10_f64.powf(size);
        let mut offsets = vec![[0.0; D]];
        offsets.extend(points.iter().map(|x| x.map(|c| radius * c)));
        Support { offsets, weights, radius }
    })
}

/// `W K^T` in scaled monomials, written out.
pub(crate) fn weighted_moments<const D: usize>(support: &Support<D>, degree: usize) -> DMatrix<f64> {
    let exponents = Monomials::<D>::new(degree).exponents().to_vec();
    DMatrix::from_fn(support.offsets.len(), exponents.len(), |j, m| {
        let power = |k: usize| (support.offsets[j][k] / support.radius).powi(i32::from(exponents[m][k]));
        support.weights[j] * (0..D).map(power).product::<f64>()
    })
}

/// Exact value of an operator at the centre on the physical monomial `x^exponents`, by hand.
pub(crate) fn exact<const D: usize>(functional: &Functional<D>, exponents: &[u8; D]) -> f64 {
    let total: u8 = exponents.iter().sum();
    let only = |axis: usize, power: u8| total == power && exponents[axis] == power;
    match *functional {
        Functional::Value => f64::from(u8::from(total == 0)),
        Functional::ValueAt(x) => (0..D).map(|k| x[k].powi(i32::from(exponents[k]))).product(),
        Functional::Partial(axis) => f64::from(u8::from(only(axis, 1))),
        Functional::Second(a, b) if a == b => 2.0 * f64::from(u8::from(only(a, 2))),
        Functional::Second(a, b) => f64::from(u8::from(total == 2 && exponents[a] == 1 && exponents[b] == 1)),
        Functional::Laplacian => (0..D).map(|k| 2.0 * f64::from(u8::from(only(k, 2)))).sum(),
        Functional::Directional(v) => (0..D).map(|k| v[k] * f64::from(u8::from(only(k, 1)))).sum(),
        Functional::Diffusion { eta, gradient } => {
            eta * exact(&Functional::Laplacian, exponents)
                + exact(&Functional::Directional(gradient), exponents)
        }
        Functional::Derivative(orders) if orders == *exponents => {
            orders.iter().map(|&o| (1..=o).map(f64::from).product::<f64>()).product()
        }
        Functional::Derivative(_) => 0.0,
    }
}

/// The stencil by the definition, with the pseudo-inverse: `c = W ((W K^T)^T)^+ b`; and the condition number.
pub(crate) fn reference<const D: usize>(
    support: &Support<D>,
    degree: usize,
    functional: &Functional<D>,
) -> (DVector<f64>, f64) {
    let exponents = Monomials::<D>::new(degree).exponents().to_vec();
    let b = DVector::from_iterator(
        exponents.len(),
        exponents.iter().map(|e| {
            let total: i32 = e.iter().map(|&p| i32::from(p)).sum();
            exact(functional, e) / support.radius.powi(total)
        }),
    );
    let a = weighted_moments(support, degree).transpose();
    let svd = a.svd(true, true);
    let condition = svd.singular_values.max() / svd.singular_values.min();
    let y = svd.solve(&b, 1e-13 * svd.singular_values.max()).expect("both factors");
    let c = DVector::from_iterator(y.len(), y.iter().zip(&support.weights).map(|(y, w)| y * w));
    (c, condition)
}
