//! Solving `A x = b`: what may be asked for, what comes back, what can go wrong.

mod bicgstab;
mod cg;
mod chain;
mod diagnosis;
mod direct;
mod error;
mod gmres;
mod idr;
mod krylov;
mod prepared;
mod scaling;

pub(crate) use cg::cg_cycle;
pub(crate) use chain::{PATIENCE, levels_of};
pub(crate) use direct::Factors;
pub use error::SolveError;
pub(crate) use gmres::gmres_cycle;
pub use krylov::LinearOperator;
pub(crate) use krylov::{Cycle, Method, NEAR, ROUND_OFF, Residuals, iterate};
pub(crate) use prepared::Levels;
pub use prepared::{Prepared, solve};
pub(crate) use scaling::{Scaled, reciprocal_power};

use crate::precond::PreconditionerKind;

/// Unknowns up to which [`SolverKind::Auto`] factorises. Direct solution of planar problems is the fastest up to a
/// few tens of thousands of unknowns, and it is the most robust at any size.
pub const AUTO_DIRECT_MAX: usize = 20_000;

/// Default of [`SolverParams::tolerance`], near what rounding leaves of a residual.
pub const DEFAULT_TOLERANCE: f64 = 1e-12;

/// Vectors that [`SolverKind::Multigrid`] lets GMRES keep: more than a solve that goes well needs.
pub const AUTO_RESTART: usize = 60;

/// How to solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SolverKind {
    /// [`SolverKind::Direct`] up to [`AUTO_DIRECT_MAX`] unknowns, [`SolverKind::Multigrid`] above.
    #[default]
    Auto,
    /// Sparse factorisation, `L L^T` of a symmetric matrix with a positive diagonal that has one and `L U`
    /// otherwise, with iterative refinement.
    Direct,
    /// GMRES with [`AUTO_RESTART`] vectors, preconditioned by multigrid: with the parameters of
    /// [`SolverParams::preconditioner`], if it is multigrid, else by the default levels, or, where convection outweighs diffusion, by
    /// levels with [`SmootherKind::Ilu0`](crate::SmootherKind::Ilu0) and [`Restriction::Own`](crate::Restriction::Own). A matrix that multigrid does not get along with is left
    /// to BiCGStab(2) with ILU(0), and so are all further right-hand sides.
    Multigrid,
    /// BiCGStab(l), Sleijpen and Fokkema, ETNA 1 (1993): short recurrences, `2 l` products in a step, for any matrix.
    /// `l` is 1 to 8; 1 is van der Vorst's BiCGStab, 2 copes with complex eigenvalues.
    BiCgStab {
        /// Degree of the minimising polynomial.
        l: usize,
    },
    /// GMRES, Saad and Schultz (1986), with right preconditioning: never breaks down, keeps `restart` vectors.
    Gmres {
        /// Vectors kept before a restart.
        restart: usize,
    },
    /// IDR(s), van Gijzen and Sonneveld, ACM Trans. Math. Softw. 38 (2011): short recurrences, `s + 1` products in a cycle, for
    /// any matrix. `s` is 1 to 16; larger ones come nearer to GMRES and keep `3 s` vectors.
    Idr {
        /// Dimension of the shadow space.
        s: usize,
    },
    /// Conjugate gradients, for symmetric positive definite matrices only.
    Cg,
}

/// What to solve with, and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverParams {
    /// Method.
    pub kind: SolverKind,
    /// Preconditioner of the iterative methods.
    pub preconditioner: PreconditionerKind,
    /// Stop at a true residual `|b - A x|_2 / |b|_2` of this, after the rows have been scaled to a largest entry
    /// near 1 (symmetric scaling for conjugate gradients). It is recomputed, never taken from a recurrence.
    pub tolerance: f64,
    /// Also require this componentwise backward error ([`Csr::backward_error`](crate::Csr::backward_error)).
    pub backward_error: Option<f64>,
    /// Largest number of products with the matrix.
    pub max_iterations: usize,
    /// Unknowns up to which [`SolverKind::Auto`] and [`SolverKind::Multigrid`] factorise in the end what nothing else solves.
    pub direct_max: usize,
}

impl Default for SolverParams {
    fn default() -> Self {
        Self {
            kind: SolverKind::Auto,
            preconditioner: PreconditionerKind::Ilu0,
            tolerance: DEFAULT_TOLERANCE,
            backward_error: None,
            max_iterations: 2000,
            direct_max: AUTO_DIRECT_MAX,
        }
    }
}

/// What ended a solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criterion {
    /// The true residual met the tolerance.
    Residual,
    /// Rounding alone is left of the residual: the componentwise backward error is at a few tens of units in the last place, and
    /// further steps do not improve it. Direct solves end so, by refinement; an iterative one does where the tolerance, which is
    /// relative to the right-hand side, is beyond what numbers of 16 digits allow for this matrix.
    RoundOff,
}

impl Criterion {
    /// The name used in reports.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Residual => "residual",
            Self::RoundOff => "round-off",
        }
    }
}

/// How a system was solved.
#[derive(Debug, Clone, PartialEq)]
pub struct SolveInfo {
    /// Method and preconditioner.
    pub name: String,
    /// Products with the matrix; refinement steps of the direct method.
    pub iterations: usize,
    /// True residual `|b - A x|_2 / |b|_2` of the scaled system.
    pub residual: f64,
    /// Componentwise backward error, which does not depend on how rows are scaled.
    pub backward_error: f64,
    /// What ended it.
    pub criterion: Criterion,
    /// Relative residual after each step, as the recurrence has it; the last is the true one.
    pub history: Vec<f64>,
    /// Pivots that the incomplete factorisation had to replace because they were almost zero.
    pub replaced_pivots: usize,
    /// Estimate (from below) of the condition number of the scaled matrix, by the direct method.
    pub condition: Option<f64>,
}
