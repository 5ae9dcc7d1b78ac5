//! Preconditioners: approximate inverses that a Krylov method applies.

use crate::ilu::Ilu0;
use crate::{Csr, SolveError};

/// Which preconditioner to build.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PreconditionerKind {
    /// None.
    None,
    /// The inverse of the diagonal.
    Jacobi,
    /// Incomplete LU without fill.
    #[default]
    Ilu0,
}

/// An approximate inverse. A new kind – multigrid – is a new implementation, and nothing else changes.
pub trait Preconditioner: Sync + Send {
    /// `x = M^-1 x`
    fn apply(&self, x: &mut [f64]);
}

struct Identity;

impl Preconditioner for Identity {
    fn apply(&self, _x: &mut [f64]) {}
}

struct Jacobi {
    inverse: Vec<f64>,
}

impl Preconditioner for Jacobi {
    fn apply(&self, x: &mut [f64]) {
        x.iter_mut().zip(&self.inverse).for_each(|(x, d)| *x *= d);
    }
}

impl Preconditioner for Ilu0 {
    fn apply(&self, x: &mut [f64]) {
        self.solve_in_place(x);
    }
}

impl PreconditionerKind {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Jacobi => "Jacobi",
            Self::Ilu0 => "ILU(0)",
        }
    }

    pub(crate) fn build(self, matrix: &Csr) -> Result<Box<dyn Preconditioner>, SolveError> {
        match self {
            Self::None => Ok(Box::new(Identity)),
            Self::Jacobi => {
                let diagonal = matrix.diagonal();
                match diagonal.iter().position(|&d| d == 0.0) {
                    Some(row) => Err(SolveError::ZeroRow { row }),
                    None => Ok(Box::new(Jacobi { inverse: diagonal.iter().map(|d| 1.0 / d).collect() })),
                }
            }
            Self::Ilu0 => Ok(Box::new(Ilu0::new(matrix)?)),
        }
    }
}
