//! Polynomials in `z = (x - x_i) / R`, with first derivatives and Laplacians.

use meshless_stencils::Monomials;

use super::harmonic;
use super::params::MAX_ORDER;

/// One more than the highest degree of a basis: the order, and what particular parts and their samples have more.
const POWERS: usize = MAX_ORDER[0] + 5;

/// Values of all polynomials of a basis at one point.
#[derive(Debug, Clone, Default)]
pub(super) struct Jet<const D: usize> {
    pub(super) values: Vec<f64>,
    pub(super) gradients: Vec<[f64; D]>,
    /// Not for harmonic polynomials, which have none.
    pub(super) laplacians: Vec<f64>,
}

/// A basis. The constant comes first and the D coordinates after it, in every form.
#[derive(Debug, Clone)]
pub(super) enum Basis<const D: usize> {
    /// All polynomials up to a degree.
    Complete {
        /// The degree.
        degree: usize,
        /// Exponents of the monomials.
        exponents: Vec<[u8; D]>,
    },
    /// The harmonic ones among them.
    Harmonic {
        /// The degree.
        degree: usize,
    },
}

impl<const D: usize> Basis<D> {
    pub(super) fn complete(degree: usize) -> Self {
        Self::Complete { degree, exponents: Monomials::new(degree).exponents().to_vec() }
    }

    pub(super) fn harmonic(degree: usize) -> Self {
        Self::Harmonic { degree }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::Complete { exponents, .. } => exponents.len(),
            Self::Harmonic { degree } => harmonic::count::<D>(*degree),
        }
    }

    /// Writes values, gradients and Laplacians at z.
    pub(super) fn evaluate(&self, z: &[f64; D], jet: &mut Jet<D>) {
        jet.values.resize(self.len(), 0.0);
        jet.gradients.resize(self.len(), [0.0; D]);
        match self {
            Self::Harmonic { degree } => harmonic::evaluate(*degree, z, jet),
            Self::Complete { degree, exponents } => {
                jet.laplacians.resize(self.len(), 0.0);
                evaluate_monomials(*degree, exponents, z, jet);
            }
        }
    }

    /// Writes values, and slopes of harmonic polynomials, at z: what rows of values need.
    pub(super) fn evaluate_values(&self, z: &[f64; D], jet: &mut Jet<D>) {
        let Self::Complete { degree, exponents } = self else { return self.evaluate(z, jet) };
        jet.values.clear();
        let mut powers = [[1.0; POWERS]; D];
        for (table, &x) in powers.iter_mut().zip(z) {
            for e in 1..=*degree {
                table[e] = table[e - 1] * x;
            }
        }
        let value = |exponents: &[u8; D]| {
            powers.iter().zip(exponents).map(|(table, &e)| table[e as usize]).product::<f64>()
        };
        jet.values.extend(exponents.iter().map(value));
    }
}

fn evaluate_monomials<const D: usize>(degree: usize, exponents: &[[u8; D]], z: &[f64; D], jet: &mut Jet<D>) {
    // Powers of every coordinate with their first and second derivatives.
    let mut tables = [[[0.0; POWERS]; 3]; D];
    for (table, &x) in tables.iter_mut().zip(z) {
        let [value, first, second] = table;
        value[0] = 1.0;
        for e in 1..=degree {
            value[e] = value[e - 1] * x;
            first[e] = e as f64 * value[e - 1];
            second[e] = e as f64 * first[e - 1];
        }
    }
    for (m, exponents) in exponents.iter().enumerate() {
        let factor = |axis: usize, order: usize| tables[axis][order][exponents[axis] as usize];
        let product = |derived: usize, order: usize| -> f64 {
            (0..D).map(|axis| factor(axis, if axis == derived { order } else { 0 })).product()
        };
        jet.values[m] = product(D, 0);
        jet.gradients[m] = std::array::from_fn(|axis| product(axis, 1));
        jet.laplacians[m] = (0..D).map(|axis| product(axis, 2)).sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const D: usize>(basis: &Basis<D>, z: [f64; D]) {
        let step = 1e-5;
        let (mut jet, mut near) = (Jet::default(), Jet::default());
        basis.evaluate(&z, &mut jet);
        let mut laplacian = vec![0.0; basis.len()];
        for axis in 0..D {
            let mut sides = [-1.0, 1.0].map(|sign| {
                let mut at = z;
                at[axis] += sign * step;
                basis.evaluate(&at, &mut near);
                (near.values.clone(), near.gradients.clone())
            });
            let (after, before) = (std::mem::take(&mut sides[1]), std::mem::take(&mut sides[0]));
            for m in 0..basis.len() {
                let slope = (after.0[m] - before.0[m]) / (2.0 * step);
                // Second differences of this step leave about 1e-9 times the third derivative.
                assert!((slope - jet.gradients[m][axis]).abs() < 1e-6, "{m} {axis}");
                laplacian[m] += (after.1[m][axis] - before.1[m][axis]) / (2.0 * step);
            }
        }
        for m in 0..basis.len() {
            let expected = if matches!(basis, Basis::Harmonic { .. }) { 0.0 } else { jet.laplacians[m] };
            assert!((laplacian[m] - expected).abs() < 1e-6, "{m}: {} {expected}", laplacian[m]);
        }
        assert_eq!(jet.values[0], 1.0);
        assert_eq!(jet.values[1..=D], z);
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        check(&Basis::complete(6), [0.3, -0.7]);
        check(&Basis::complete(4), [0.3, -0.7, 0.2]);
        check(&Basis::harmonic(8), [0.4, -0.6]);
        check(&Basis::harmonic(6), [0.4, -0.5, 0.3]);
        check(&Basis::harmonic(4), [0.4]);
    }

    #[test]
    fn harmonic_polynomials_are_independent() {
        assert_eq!(Basis::<2>::harmonic(6).len(), 13);
        assert_eq!(Basis::<3>::harmonic(6).len(), 49);
        // Their Gram matrix on scattered points of the unit ball has full rank.
        let basis = Basis::<3>::harmonic(6);
        let mut qr = meshless_stencils::Qr::default();
        let rows = 300;
        qr.resize(rows, basis.len());
        let mut jet = Jet::default();
        for row in 0..rows {
            let turn = |k: f64| 2.0 * (row as f64 * k).fract() - 1.0;
            basis.evaluate(&[turn(0.819_172), turn(0.671_044), turn(0.549_7)], &mut jet);
            for m in 0..basis.len() {
                qr.column_mut(m)[row] = jet.values[m];
            }
        }
        assert!(qr.factor(1e-3));
    }
}
