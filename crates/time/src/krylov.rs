//! A space `v, D v, D^2 v, ...` and the eigenvalues of D that it knows of (Arnoldi's method; Saad, "Numerical methods for large
//! eigenvalue problems", section 6.2).

use crate::complex::Complex;
use crate::hessenberg::{eigenvalues, eigenvector};

/// A new direction below this part of its image is rounding: the space is invariant.
const INVARIANT: f64 = 1e-12;

/// An orthonormal basis, and D in it.
///
/// Lengths are those of the unknowns with du/dt: what follows from these by an algebraic row may be hundreds of times as large.
#[derive(Debug)]
pub(crate) struct Krylov {
    weights: Vec<f64>,
    basis: Vec<Vec<f64>>,
    /// `columns[j][i]`: component of the image of `basis[j]` along `basis[i]`, i to j + 1.
    columns: Vec<Vec<f64>>,
}

/// What is nearly an eigenvalue of D.
#[derive(Debug)]
pub(crate) struct Pair {
    pub(crate) value: Complex,
    /// The eigenvector in the basis, of length 1.
    vector: Vec<Complex>,
    /// `|D y - value y|` for the eigenvector y of length 1.
    pub(crate) residual: f64,
}

impl Krylov {
    /// The space of a vector that is finite and not zero, with the weights of all unknowns, 0 or 1.
    pub(crate) fn new(mut start: Vec<f64>, weights: Vec<f64>) -> Option<Self> {
        let size = product(&weights, &start, &start).sqrt();
        (size > 0.0 && size.is_finite()).then(|| {
            start.iter_mut().for_each(|x| *x /= size);
            Self { weights, basis: vec![start], columns: Vec::new() }
        })
    }

    /// How many times D was applied.
    pub(crate) fn len(&self) -> usize {
        self.columns.len()
    }

    /// What D is to be applied to next; `None` where nothing new would come of it.
    pub(crate) fn next(&self) -> Option<&[f64]> {
        self.basis.get(self.columns.len()).map(Vec::as_slice)
    }

    /// Takes up the image of [`next`](Self::next).
    pub(crate) fn extend(&mut self, mut image: Vec<f64>) {
        let norm = |x: &[f64]| product(&self.weights, x, x).sqrt();
        let size = norm(&image);
        let mut column = vec![0.0; self.basis.len()];
        // Once is not enough where the image is nearly in the space.
        for _ in 0..2 {
            for (q, h) in self.basis.iter().zip(&mut column) {
                let part = product(&self.weights, q, &image);
                image.iter_mut().zip(q).for_each(|(x, q)| *x -= part * q);
                *h += part;
            }
        }
        let rest = norm(&image);
        column.push(rest);
        self.columns.push(column);
        if rest > INVARIANT * size && rest.is_finite() {
            image.iter_mut().for_each(|x| *x /= rest);
            self.basis.push(image);
        }
    }

    /// What is nearly an eigenvalue.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = Pair> + '_ {
        let beyond = self.columns.last().and_then(|column| column.last()).copied().unwrap_or(0.0);
        eigenvalues(&self.columns).into_iter().map(move |value| {
            let vector = eigenvector(&self.columns, value);
            let residual = beyond * vector.last().map_or(0.0, |y| y.abs());
            Pair { value, vector, residual }
        })
    }

    /// The eigenvector of a pair.
    pub(crate) fn vector(&self, pair: &Pair) -> Vec<Complex> {
        let at = |i: usize| {
            let parts = self.basis.iter().zip(&pair.vector);
            parts.fold(Complex::ZERO, |sum, (q, y)| sum + y.scaled(q[i]))
        };
        (0..self.weights.len()).map(at).collect()
    }

    /// Where the eigenvector of a pair is largest, of the unknowns with du/dt.
    pub(crate) fn place(&self, pair: &Pair) -> usize {
        let sizes = self.vector(pair).into_iter().zip(&self.weights).map(|(x, weight)| weight * x.abs());
        sizes.enumerate().fold((0, 0.0), |most, (i, size)| if size > most.1 { (i, size) } else { most }).0
    }

    /// `D^m v`, m times applied, over its size: what the fastest decaying parts are gone from.
    pub(crate) fn last(&self) -> Vec<f64> {
        let mut x = vec![0.0; self.basis.len()];
        x[0] = 1.0;
        for _ in 0..self.columns.len() {
            let mut image = vec![0.0; x.len()];
            for (column, x) in self.columns.iter().zip(&x) {
                image.iter_mut().zip(column).for_each(|(y, h)| *y += h * x);
            }
            let size = image.iter().map(|x| x * x).sum::<f64>().sqrt();
            if size > 0.0 {
                x = image.into_iter().map(|x| x / size).collect();
            }
        }
        let mut out = vec![0.0; self.basis[0].len()];
        for (q, x) in self.basis.iter().zip(&x) {
            out.iter_mut().zip(q).for_each(|(out, q)| *out += x * q);
        }
        out
    }
}

fn product(weights: &[f64], x: &[f64], y: &[f64]) -> f64 {
    weights.iter().zip(x).zip(y).map(|((w, x), y)| w * x * y).sum()
}
