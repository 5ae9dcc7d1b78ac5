//! Particular solutions: a polynomial whose Laplacian is that of the source over a stencil.

use meshless_stencils::Qr;

use super::basis::{Basis, Jet};
use super::dense;

/// Samples of the source for each coefficient of the polynomial that it is fitted by.
const SAMPLES_PER_COEFFICIENT: usize = 3;

/// Irrational steps of the sequence of samples: powers of the inverse of the number `g > 1` with `g^4 = g + 1`, one more
/// power than there are coordinates so that three dimensions have a good one, too (Kronecker sequence).
const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];

/// A matrix from samples of a right-hand side g on the unit ball to a polynomial P with `lap P = g`.
#[derive(Debug, Clone)]
pub(super) struct Particular<const D: usize> {
    /// Monomials of the polynomial P.
    pub(super) basis: Basis<D>,
    /// Where g is sampled.
    pub(super) samples: Vec<[f64; D]>,
    /// One row of `samples.len()` factors for each monomial.
    matrix: Vec<f64>,
}

impl<const D: usize> Particular<D> {
    /// For right-hand sides that are fitted by polynomials of `degree`; P has two degrees more.
    pub(super) fn new(degree: usize) -> Self {
        let (right, basis) = (Basis::<D>::complete(degree), Basis::<D>::complete(degree + 2));
        let samples = samples(right.len());
        let fit = pseudo_inverse(&right, &samples);
        let inverse = inverse_laplacian(&right, &basis);
        let (count, n) = (right.len(), samples.len());
        let mut matrix = vec![0.0; basis.len() * n];
        for (row, factors) in matrix.chunks_exact_mut(n).zip(inverse.chunks_exact(count)) {
            for (factor, fitted) in factors.iter().zip(fit.chunks_exact(n)).filter(|(f, _)| **f != 0.0) {
                row.iter_mut().zip(fitted).for_each(|(entry, value)| *entry += factor * value);
            }
        }
        Self { basis, samples, matrix }
    }

    /// The coefficients of P for samples of the right-hand side.
    pub(super) fn solve(&self, values: &[f64], out: &mut Vec<f64>) {
        dense::apply(&self.matrix, values, out);
    }
}

/// Points of the unit ball for polynomials of so many coefficients: evenly scattered, denser towards its surface, where
/// polynomials are hardest to hold.
pub(super) fn samples<const D: usize>(coefficients: usize) -> Vec<[f64; D]> {
    let count = SAMPLES_PER_COEFFICIENT * coefficients;
    let mut points = Vec::with_capacity(count);
    let mut index = 0.0;
    while points.len() < count {
        index += 1.0;
        let x: [f64; D] = std::array::from_fn(|k| 2.0 * (0.5 + index * STEPS[k]).fract() - 1.0);
        let radius = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        if radius <= 1.0 && radius > 0.0 {
            let outward = (std::f64::consts::FRAC_PI_2 * radius).sin() / radius;
            points.push(x.map(|x| x * outward));
        }
    }
    points
}

/// Rows: the coefficients of the least-squares polynomial; columns: the samples.
pub(super) fn pseudo_inverse<const D: usize>(basis: &Basis<D>, samples: &[[f64; D]]) -> Vec<f64> {
    let mut qr = Qr::default();
    qr.resize(samples.len(), basis.len());
    let mut jet = Jet::default();
    for (row, z) in samples.iter().enumerate() {
        basis.evaluate(z, &mut jet);
        for m in 0..basis.len() {
            qr.column_mut(m)[row] = jet.values[m];
        }
    }
    rows_of_inverse(&mut qr, samples.len())
}

/// Rows: the coefficients of P of least norm; columns: those of `lap P`.
pub(super) fn inverse_laplacian<const D: usize>(right: &Basis<D>, basis: &Basis<D>) -> Vec<f64> {
    let (Basis::Complete { exponents: from, .. }, Basis::Complete { exponents: to, .. }) = (basis, right)
    else {
        return Vec::new();
    };
    let mut qr = Qr::default();
    qr.resize(from.len(), to.len());
    for m in 0..to.len() {
        qr.column_mut(m).fill(0.0);
    }
    for (row, exponents) in from.iter().enumerate() {
        for axis in (0..D).filter(|&axis| exponents[axis] >= 2) {
            let mut lower = *exponents;
            lower[axis] -= 2;
            let e = f64::from(exponents[axis]);
            if let Some(place) = to.iter().position(|other| *other == lower) {
                qr.column_mut(place)[row] += e * (e - 1.0);
            }
        }
    }
    // The pseudo-inverse of a wide matrix of full rank is the transposed one of its transpose.
    let rows = rows_of_inverse(&mut qr, from.len());
    (0..from.len() * to.len()).map(|k| rows[(k % to.len()) * from.len() + k / to.len()]).collect()
}

fn rows_of_inverse(qr: &mut Qr, rows: usize) -> Vec<f64> {
    qr.factor_pivoted(f64::EPSILON);
    let columns = qr.columns();
    let (mut z, mut unit) = (vec![0.0; columns], vec![0.0; columns]);
    let mut inverse = vec![0.0; rows * columns];
    for (m, row) in inverse.chunks_exact_mut(rows).enumerate() {
        unit.fill(0.0);
        unit[m] = 1.0;
        qr.least_norm(&unit, &mut z, row);
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_laplacian_of_the_particular_part_is_the_source() {
        let particular = Particular::<2>::new(6);
        let source = |[x, y]: [f64; 2]| 1.0 - 3.0 * x * y + x.powi(4) * y * y - 2.0 * y.powi(3);
        let values: Vec<f64> = particular.samples.iter().map(|&z| source(z)).collect();
        let mut coefficients = Vec::new();
        particular.solve(&values, &mut coefficients);
        let mut jet = Jet::default();
        for z in [[0.2, 0.3], [-0.8, 0.1], [0.5, -0.7]] {
            particular.basis.evaluate(&z, &mut jet);
            let laplacian: f64 = coefficients.iter().zip(&jet.laplacians).map(|(c, l)| c * l).sum();
            // The condition of monomials of degree 6 on the disc costs two digits.
            assert!((laplacian - source(z)).abs() < 1e-12, "{laplacian}");
        }
    }

    #[test]
    fn samples_lie_in_the_ball() {
        let points = samples::<3>(70);
        assert!(points.iter().all(|x| x.iter().map(|x| x * x).sum::<f64>() <= 1.0 + 1e-12));
    }
}
