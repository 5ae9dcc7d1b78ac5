//! Sparse systems in difference form: assembly, elimination, floating constants, direct and Krylov solvers.
//!
//! - [`Csr`]: compressed rows with 32-bit columns, built from rows in parallel; products in parallel.
//! - [`DifferenceMatrix`]: rows as `sum_j a_ij (u_j - u_i) + r_i u_i`, which keeps what ten orders of magnitude of contrast
//!   would round away; elimination of prescribed values; signs and sums ([`MatrixReport`]).
//! - [`solve`] and [`Prepared`]: sparse LU or `L L^T` with refinement, BiCGStab(l), GMRES, IDR(s), conjugate gradients, all stopped by
//!   the true residual; [`Preconditioner`]s.
//! - [`Multigrid`]: algebraic multigrid by smoothed aggregation or after Ruge and Stüben, as a preconditioner; for matrices that
//!   are not symmetric, and coefficients that jump by ten orders of magnitude.
//! - [`clusters`], [`Split`], [`Bordered`]: the constants of stiff regions that nothing prescribed holds, as unknowns of
//!   their own; [`pure_neumann`] for problems that nothing holds at all.
//!
//! Results do not depend on the number of threads: sums run over blocks of fixed size.
//!
//! This crate is *not* for dense systems beyond a few rows, for eigenvalues, for complex numbers, or for matrices that
//! are spread over several machines; and it knows nothing of nodes' positions.
//!
//! ```
//! use meshless_sparse::{DifferenceMatrix, SolverParams, solve};
//!
//! // -u'' = 2 on (0, 1) with u = 0 at both ends, on six nodes.
//! let a = -25.0; // -1 / h^2
//! let rows = DifferenceMatrix::from_rows(6, |i, row| {
//!     if i > 0 {
//!         row.push(i - 1, a);
//!     }
//!     if i < 5 {
//!         row.push(i + 1, a);
//!     }
//! })?;
//! let known: Vec<_> = (0..6).map(|i| (i == 0 || i == 5).then_some(0.0)).collect();
//! let reduced = rows.eliminate(&known, &[2.0; 6])?;
//! assert!(reduced.matrix.report(None)?.is_m_matrix);
//!
//! let (u, info) = solve(&reduced.matrix.to_csr(), &reduced.rhs, &SolverParams::default())?;
//! assert!((u[0] - 0.2 * 0.8).abs() < 1e-15 && info.backward_error < 1e-15);
//! # Ok::<(), meshless_sparse::SolveError>(())
//! ```

mod csr;
mod difference;
mod error;
mod floating;
mod market;
mod multigrid;
mod parallel;
mod precond;
mod solver;
mod vector;

pub use csr::{Csr, RowBuilder};
pub use difference::{DifferenceMatrix, MatrixReport, Reduced, WrongSign};
pub use error::MatrixError;
pub use floating::{
    Bordered, BorderedSolution, ChainLink, Cluster, ComponentInfo, DEFAULT_THRESHOLD, GroupUnknowns,
    NeumannSolution, PreparedBordered, Split, clusters, pure_neumann,
};
pub use market::{MarketError, read_matrix_market, write_matrix_market};
pub use multigrid::{
    Candidate, Coarsening, CycleKind, HierarchyInfo, Multigrid, MultigridParams, ProlongationKind,
    Restriction, SmootherKind, StrengthKind,
};
pub use precond::{IncompleteLu, Jacobi, Preconditioner, PreconditionerKind, ilu0, ilut};
pub use solver::{
    AUTO_DIRECT_MAX, AUTO_RESTART, Criterion, DEFAULT_TOLERANCE, LinearOperator, Prepared, SolveError,
    SolveInfo, SolverKind, SolverParams, solve,
};
