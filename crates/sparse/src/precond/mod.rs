//! Preconditioners: approximations of `A^-1` that are cheap to apply.

mod factors;
mod ilu0;
mod ilut;
mod jacobi;

pub use ilu0::ilu0;
pub use ilut::ilut;
pub use jacobi::Jacobi;

pub use factors::IncompleteLu;

use crate::csr::Csr;
use crate::multigrid::{HierarchyInfo, Multigrid, MultigridParams};
use crate::solver::SolveError;
use std::fmt::Debug;
use std::sync::Arc;

/// An approximation of `A^-1`. Set up once for a matrix whose rows are scaled, then applied any number of times.
/// Multigrid, too, is one of these.
pub trait Preconditioner: Debug + Send + Sync {
    /// Short name for reports.
    fn name(&self) -> String;
    /// `z = M^-1 r`. `scratch` has at least [`Preconditioner::scratch_len`] elements of any content.
    fn apply(&self, r: &[f64], z: &mut [f64], scratch: &mut [f64]);
    /// Elements of scratch that one application needs.
    fn scratch_len(&self) -> usize {
        0
    }
    /// Pivots that were replaced because they were almost zero.
    fn replaced_pivots(&self) -> usize {
        0
    }
    /// Whether it is one and the same linear map at every application. Short recurrences need that; GMRES becomes
    /// flexible where it is not so.
    fn is_linear(&self) -> bool {
        true
    }
    /// Adapts to a matrix of the same pattern with other values, keeping what may be kept. False where there is nothing to
    /// keep, and the preconditioner must be built anew.
    ///
    /// # Errors
    /// Those of building it.
    fn refresh(&mut self, _matrix: &Arc<Csr>) -> Result<bool, SolveError> {
        Ok(false)
    }
    /// The levels, of multigrid.
    fn hierarchy(&self) -> Option<&HierarchyInfo> {
        None
    }
}

/// Which preconditioner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum PreconditionerKind {
    /// None.
    None,
    /// The diagonal.
    Jacobi,
    /// Incomplete factors on the pattern of the matrix.
    #[default]
    Ilu0,
    /// Incomplete factors with dual threshold (Saad 1994).
    Ilut {
        /// Entries kept in a row of either factor beyond those of the matrix.
        fill: usize,
        /// Entries below this part of the norm of the row are dropped.
        drop: f64,
    },
    /// Algebraic multigrid.
    Multigrid(MultigridParams),
}

impl PreconditionerKind {
    /// The name used in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Jacobi => "Jacobi",
            Self::Ilu0 => "ILU(0)",
            Self::Ilut { .. } => "ILUT",
            Self::Multigrid(_) => "multigrid",
        }
    }

    /// Sets the preconditioner up. Only multigrid asks for the weights of rows, see [`Multigrid::new`].
    ///
    /// # Errors
    /// A matrix that is not square; those of [`Multigrid::new`].
    pub fn build(
        self,
        matrix: &Arc<Csr>,
        weights: Option<&[f64]>,
    ) -> Result<Box<dyn Preconditioner>, SolveError> {
        matrix.require_square()?;
        Ok(match self {
            Self::None => Box::new(NoPreconditioner),
            Self::Jacobi => Box::new(Jacobi::new(matrix)?),
            Self::Ilu0 => Box::new(ilu0(matrix)?),
            Self::Ilut { fill, drop } => Box::new(ilut(matrix, fill, drop)?),
            Self::Multigrid(params) => Box::new(Multigrid::new(Arc::clone(matrix), weights, &params)?),
        })
    }
}

#[derive(Debug)]
struct NoPreconditioner;

impl Preconditioner for NoPreconditioner {
    fn name(&self) -> String {
        "none".to_owned()
    }
    fn apply(&self, r: &[f64], z: &mut [f64], _: &mut [f64]) {
        z.copy_from_slice(r);
    }
}
