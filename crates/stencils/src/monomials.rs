//! Monomials up to a degree, and what derivatives do to them.

/// The monomials `z^alpha` with `|alpha| <= degree` in D variables, by degree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Monomials<const D: usize> {
    degree: usize,
    exponents: Vec<[u8; D]>,
    parents: Vec<(usize, usize)>,
}

impl<const D: usize> Monomials<D> {
    /// All monomials of at most this degree; there are `binomial(degree + D, D)`.
    pub fn new(degree: usize) -> Self {
        let mut exponents = Vec::new();
        for total in 0..=degree {
            append(total, 0, &mut [0; D], &mut exponents);
        }
        let parents = exponents.iter().map(|e| parent(e, &exponents)).collect();
        Self { degree, exponents, parents }
    }

    /// The highest degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Number of monomials.
    pub fn count(&self) -> usize {
        self.exponents.len()
    }

    /// The exponents, by degree; the constant is first.
    pub fn exponents(&self) -> &[[u8; D]] {
        &self.exponents
    }

    /// For every monomial one of lower degree and the axis whose coordinate makes up the difference; the constant is
    /// its own parent.
    pub(crate) fn parents(&self) -> &[(usize, usize)] {
        &self.parents
    }

    /// Writes the values at z to `out`, one a monomial.
    pub fn evaluate(&self, z: &[f64; D], out: &mut [f64]) {
        for (value, exponents) in out.iter_mut().zip(&self.exponents) {
            *value = (0..D).map(|k| z[k].powi(i32::from(exponents[k]))).product();
        }
    }

    /// Adds `factor` times the derivative of order `order` at z of every monomial to `out`.
    pub fn add_derivative(&self, order: &[u8; D], z: &[f64; D], factor: f64, out: &mut [f64]) {
        for (value, exponents) in out.iter_mut().zip(&self.exponents) {
            let mut product = factor;
            for k in 0..D {
                if exponents[k] < order[k] {
                    product = 0.0;
                    break;
                }
                let remaining = exponents[k] - order[k];
                product *= falling(exponents[k], order[k]) * z[k].powi(i32::from(remaining));
            }
            *value += product;
        }
    }
}

fn parent<const D: usize>(exponents: &[u8; D], all: &[[u8; D]]) -> (usize, usize) {
    let Some(axis) = exponents.iter().position(|&e| e > 0) else { return (0, 0) };
    let mut lower = *exponents;
    lower[axis] -= 1;
    (all.iter().position(|e| *e == lower).unwrap_or(0), axis)
}

/// `n (n - 1) ... (n - k + 1)`.
fn falling(n: u8, k: u8) -> f64 {
    (n - k + 1..=n).map(f64::from).product()
}

fn append<const D: usize>(total: usize, axis: usize, current: &mut [u8; D], out: &mut Vec<[u8; D]>) {
    if axis + 1 == D {
        current[axis] = total as u8;
        out.push(*current);
        return;
    }
    for exponent in (0..=total).rev() {
        current[axis] = exponent as u8;
        append(total - exponent, axis + 1, current, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_binomials() {
        assert_eq!(Monomials::<1>::new(4).count(), 5);
        assert_eq!(Monomials::<2>::new(4).count(), 15);
        assert_eq!(Monomials::<3>::new(4).count(), 35);
        assert_eq!(Monomials::<2>::new(1).exponents(), [[0, 0], [1, 0], [0, 1]]);
    }

    #[test]
    fn derivatives_of_x3_y2() {
        let monomials = Monomials::<2>::new(5);
        let place = monomials.exponents().iter().position(|e| *e == [3, 2]).unwrap();
        let mut out = vec![0.0; monomials.count()];
        monomials.add_derivative(&[2, 1], &[2.0, 3.0], 10.0, &mut out);
        assert_eq!(out[place], 10.0 * 6.0 * 2.0 * 2.0 * 3.0);
    }
}
