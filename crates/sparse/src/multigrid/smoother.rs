//! Smoothers: cheap corrections of what coarse levels cannot see.

use super::SmootherKind;
use super::blocks::BlockIlu;
use super::chebyshev::Chebyshev;
use super::colored::Colored;
use crate::csr::for_each_row;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::parallel;
use crate::vector::axpy;

/// Rows of a block of Gauss-Seidel. Within a block the newest values count, beyond it those from before the sweep; so
/// blocks are independent, and their size, not the number of threads, decides about the result.
const BLOCK: usize = 4096;

/// Damping of Jacobi: optimal for eigenvalues of `D^-1 A` between 1/2 and 2.
const JACOBI_DAMPING: f64 = 0.7;

#[derive(Debug)]
pub(crate) enum Smoother {
    /// `omega / a_ii`
    Jacobi(Vec<f64>),
    /// `1 / a_ii`
    GaussSeidel(Vec<f64>),
    Colored(Colored),
    Chebyshev(Chebyshev),
    Ilu(BlockIlu),
}

/// The reciprocals of the diagonal, zero where that is zero.
pub(crate) fn reciprocals(a: &DifferenceMatrix) -> Vec<f64> {
    let reciprocal = |d: f64| if d == 0.0 { 0.0 } else { 1.0 / d };
    parallel::map_rows(a.n(), |i| reciprocal(a.diagonal(i)))
}

impl Smoother {
    /// `inverse` has the [`reciprocals`] of the diagonal.
    pub(crate) fn new(
        kind: SmootherKind,
        a: &DifferenceMatrix,
        mut inverse: Vec<f64>,
    ) -> Result<Self, MatrixError> {
        Ok(match kind {
            SmootherKind::Jacobi => {
                inverse.iter_mut().for_each(|d| *d *= JACOBI_DAMPING);
                Self::Jacobi(inverse)
            }
            SmootherKind::GaussSeidel => Self::GaussSeidel(inverse),
            SmootherKind::ColoredGaussSeidel => Self::Colored(Colored::new(a, inverse)),
            SmootherKind::Chebyshev => Self::Chebyshev(Chebyshev::new(a, inverse)),
            SmootherKind::Ilu0 => Self::Ilu(BlockIlu::new(&a.to_csr())?),
        })
    }

    /// The same for a matrix that is a product with the prolongation.
    pub(crate) fn of_coarse(
        kind: SmootherKind,
        a: &DifferenceMatrix,
        inverse: Vec<f64>,
    ) -> Result<Self, MatrixError> {
        match kind {
            SmootherKind::Ilu0 => Ok(Self::Ilu(BlockIlu::of_coarse(a.to_csr())?)),
            kind => Self::new(kind, a, inverse),
        }
    }

    /// Bytes that it keeps.
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Jacobi(d) | Self::GaussSeidel(d) => size_of_val(&**d),
            Self::Colored(colored) => colored.bytes(),
            Self::Chebyshev(chebyshev) => chebyshev.bytes(),
            Self::Ilu(lu) => lu.bytes(),
        }
    }

    /// A sweep from `x = 0`. `t` is scratch.
    pub(crate) fn first(&self, a: &DifferenceMatrix, b: &[f64], x: &mut [f64], t: &mut [f64]) {
        match self {
            Self::Jacobi(inverse) => for_each_row(x, |i, x| *x = inverse[i] * b[i]),
            Self::GaussSeidel(inverse) => forward_from_zero(a, inverse, b, x),
            Self::Colored(_) | Self::Chebyshev(_) => {
                x.fill(0.0);
                self.before(a, b, x, t);
            }
            Self::Ilu(lu) => lu.apply(b, x),
        }
    }

    /// Elements of scratch that a sweep over `n` rows needs.
    pub(crate) fn scratch_len(&self, n: usize) -> usize {
        if matches!(self, Self::Ilu(_) | Self::Chebyshev(_)) { 2 * n } else { n }
    }

    /// A further sweep before the coarse correction. `t` is scratch.
    pub(crate) fn before(&self, a: &DifferenceMatrix, b: &[f64], x: &mut [f64], t: &mut [f64]) {
        match self {
            Self::GaussSeidel(inverse) => sweep::<false>(a, inverse, b, x, t),
            Self::Colored(colored) => colored.sweep(a, b, x, t, false),
            _ => self.after(a, b, x, t),
        }
    }

    /// A sweep after the coarse correction, in the opposite direction where there is one.
    pub(crate) fn after(&self, a: &DifferenceMatrix, b: &[f64], x: &mut [f64], t: &mut [f64]) {
        match self {
            Self::Jacobi(inverse) => {
                let t = &mut t[..x.len()];
                a.residual(x, b, t);
                for_each_row(x, |i, x| *x += inverse[i] * t[i]);
            }
            Self::GaussSeidel(inverse) => sweep::<true>(a, inverse, b, x, t),
            Self::Colored(colored) => colored.sweep(a, b, x, t, true),
            Self::Chebyshev(chebyshev) => chebyshev.sweep(a, b, x, t),
            Self::Ilu(lu) => {
                let (r, z) = t.split_at_mut(x.len());
                a.residual(x, b, r);
                lu.apply(r, z);
                axpy(1.0, z, x);
            }
        }
    }
}

/// The first sweep of Gauss-Seidel, where all values are still zero.
fn forward_from_zero(a: &DifferenceMatrix, inverse: &[f64], b: &[f64], x: &mut [f64]) {
    parallel::for_each_part(x, BLOCK, &|block, x| {
        let first = block * BLOCK;
        for k in 0..x.len() {
            let i = first + k;
            let (columns, values) = a.row(i);
            let mut sum = b[i];
            for (&j, a_ij) in columns.iter().zip(values) {
                let j = j as usize;
                if j >= i {
                    break;
                }
                if j >= first {
                    sum -= a_ij * x[j - first];
                }
            }
            x[k] = sum * inverse[i];
        }
    });
}

/// A sweep of Gauss-Seidel, from the last row to the first if `BACKWARD`.
pub(super) fn sweep<const BACKWARD: bool>(
    a: &DifferenceMatrix,
    inverse: &[f64],
    b: &[f64],
    x: &mut [f64],
    old: &mut [f64],
) {
    let old = &mut old[..x.len()];
    old.copy_from_slice(x);
    let old = &*old;
    parallel::for_each_part(x, BLOCK, &|block, x| {
        let first = block * BLOCK;
        let rows = x.len();
        let mut relax = |k: usize| {
            let i = first + k;
            let (columns, values) = a.row(i);
            let mut sum = b[i];
            for (&j, a_ij) in columns.iter().zip(values) {
                let place = (j as usize).wrapping_sub(first);
                sum -= a_ij * if place < x.len() { x[place] } else { old[j as usize] };
            }
            // A row without a diagonal stays as it is.
            if inverse[i] != 0.0 {
                x[k] = sum * inverse[i];
            }
        };
        if BACKWARD {
            (0..rows).rev().for_each(&mut relax);
        } else {
            (0..rows).for_each(&mut relax);
        }
    });
}
