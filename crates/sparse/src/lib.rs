//! Sparse systems in difference form: assembly, elimination, floating constants, direct and Krylov solvers.
//!
//! - [`Csr`]: compressed rows with indices of four bytes; parallel product; as `sprs` sees it without a copy.
//! - [`DifferenceMatrix`]: rows as off-diagonal entries and row sums, which keeps what ten orders of magnitude of
//!   contrast would round away.
//! - [`Prepared`]: factor or precondition once, solve many times; sparse LU with refinement, BiCGStab(l), GMRES; stopped
//!   by the true residual, with what was reached in every error.
//! - [`floating_clusters`] and [`Split`]: the constants of stiff regions that touch no prescribed value.
//!
//! **Not for** dense or distributed systems, and not for eigenvalues.
//!
//! # Example
//!
//! ```
//! use meshless_sparse::{DifferenceMatrix, Prepared, SolverParams};
//!
//! // -u'' = 2 on (0, 1) with u(0) = u(1) = 0, on four inner nodes.
//! let h: f64 = 0.2;
//! let rows = DifferenceMatrix::from_rows(6, |i, row| {
//!     if i > 0 { row.push(i - 1, -1.0 / (h * h)); }
//!     if i < 5 { row.push(i + 1, -1.0 / (h * h)); }
//! })?;
//! let known: Vec<Option<f64>> = (0..6).map(|i| (i == 0 || i == 5).then_some(0.0)).collect();
//! let reduced = rows.eliminate(&known, &[2.0; 6])?;
//! let (u, info) = Prepared::new(&reduced.matrix.to_csr(), &SolverParams::default())?.solve(&reduced.rhs)?;
//! assert!((u[0] - 0.2 * 0.8).abs() < 1e-14 && info.residual < 1e-14);
//! # Ok::<(), meshless_sparse::SolveError>(())
//! ```

mod csr;
mod difference;
mod error;
mod floating;
mod market;
mod precond;
mod solver;
mod vector;

pub use csr::{Csr, RowBuilder};
pub use difference::{DifferenceMatrix, MatrixReport, Reduced, WrongSign};
pub use error::MatrixError;
pub use floating::{
    Bordered, BorderedSolution, ChainLink, Cluster, ComponentInfo, DEFAULT_THRESHOLD, GroupUnknowns,
    NeumannSolution, Split, clusters, pure_neumann,
};
pub use market::{MarketError, read_matrix_market, write_matrix_market};
pub use precond::{IncompleteLu, Jacobi, Preconditioner, PreconditionerKind, ilu0, ilut};
pub use solver::{
    AUTO_DIRECT_MAX, AUTO_RESTART, DEFAULT_TOLERANCE, LinearOperator, Prepared, SolveError, SolveInfo,
    SolverKind, SolverParams, solve,
};
