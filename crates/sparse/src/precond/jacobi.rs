//! The diagonal.

use super::Preconditioner;
use crate::csr::Csr;
use crate::error::MatrixError;

/// Division by the diagonal; rows without one are left as they are.
#[derive(Debug)]
pub struct Jacobi {
    inverse: Vec<f64>,
    replaced: usize,
}

impl Jacobi {
    /// Takes the diagonal of a matrix.
    ///
    /// # Errors
    /// [`MatrixError::NotSquare`].
    pub fn new(matrix: &Csr) -> Result<Self, MatrixError> {
        matrix.require_square()?;
        let diagonal = matrix.diagonal();
        let replaced = diagonal.iter().filter(|&&d| d == 0.0).count();
        Ok(Self {
            inverse: diagonal.iter().map(|&d| if d == 0.0 { 1.0 } else { 1.0 / d }).collect(),
            replaced,
        })
    }
}

impl Preconditioner for Jacobi {
    fn name(&self) -> String {
        "Jacobi".to_owned()
    }
    fn apply(&self, r: &[f64], z: &mut [f64], _: &mut [f64]) {
        for ((z, r), d) in z.iter_mut().zip(r).zip(&self.inverse) {
            *z = r * d;
        }
    }
    fn replaced_pivots(&self) -> usize {
        self.replaced
    }
}
