//! One matrix, prepared for any number of right-hand sides.

use super::chain::Chain;
use super::diagnosis::diagnosed;
use super::direct::Factors;
use super::krylov::{Method, iterate};
use super::scaling::Scaled;
use super::{AUTO_DIRECT_MAX, SolveError, SolveInfo, SolverKind, SolverParams};
use crate::csr::Csr;
use crate::difference::{DifferenceMatrix, ScaledRows};
use crate::error::MatrixError;
use crate::multigrid::{HierarchyInfo, Multigrid};
use crate::precond::{Preconditioner, PreconditionerKind};
use std::sync::Arc;

/// Solves `A x = b` once.
///
/// # Errors
/// [`SolveError`] says what is wrong with the system, or how far the method came.
pub fn solve(matrix: &Csr, rhs: &[f64], params: &SolverParams) -> Result<(Vec<f64>, SolveInfo), SolveError> {
    Prepared::new(matrix, params)?.solve(rhs)
}

/// A scaled matrix with its factors or its preconditioner.
///
/// ```
/// use meshless_sparse::{Prepared, SolverKind, SolverParams, read_matrix_market};
///
/// let file = "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n2 1 -1\n2 2 2\n3 2 -1\n3 3 2\n";
/// let a = read_matrix_market(file.as_bytes())?; // a file: `BufReader::new(File::open(path)?)`
/// let params = SolverParams { kind: SolverKind::Multigrid, tolerance: 1e-10, ..SolverParams::default() };
/// let mut prepared = Prepared::new(&a, &params)?;
/// let solutions = prepared.solve_all(&[vec![1.0, 0.0, 1.0], vec![0.0, 2.0, 0.0]])?;
/// assert!((solutions[0].0[1] - 1.0).abs() < 1e-9 && solutions[1].1.residual <= 1e-10);
///
/// // Other values in the same pattern, as in time steps: the levels stay.
/// prepared.refresh(&a.row_scaled(&[2.0, 2.0, 2.0])?)?;
/// assert!((prepared.solve(&[1.0, 0.0, 1.0])?.0[1] - 0.5).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Prepared {
    engine: Engine,
    params: SolverParams,
}

#[derive(Debug)]
enum Engine {
    Direct(Scaled, Factors),
    Krylov(Scaled, Method, Box<dyn Preconditioner>),
    Multigrid(Box<Chain>),
}

/// Multigrid with the rows that it was made for.
pub(crate) struct Levels<'a> {
    pub(crate) rows: ScaledRows<'a>,
    pub(crate) multigrid: &'a Multigrid,
}

impl Prepared {
    /// Scales the matrix and factorises it, or sets the preconditioner up.
    ///
    /// # Errors
    /// [`SolveError::BadParameter`], a matrix that is not square or has an empty row, and, for the direct method,
    /// a singular matrix or one too large to factorise.
    pub fn new(matrix: &Csr, params: &SolverParams) -> Result<Self, SolveError> {
        check(params)?;
        let method = match params.kind {
            SolverKind::Auto if matrix.nrows() <= AUTO_DIRECT_MAX => None,
            SolverKind::Auto | SolverKind::Multigrid => {
                return Self::multigrid(Arc::new(DifferenceMatrix::from_csr(matrix)?), None, params);
            }
            SolverKind::Direct => None,
            SolverKind::BiCgStab { l } => Some(Method::BiCgStab { l }),
            SolverKind::Gmres { restart } => Some(Method::Gmres { restart }),
            SolverKind::Idr { s } => Some(Method::Idr { s }),
            SolverKind::Cg => Some(Method::Cg),
        };
        let Some(method) = method else {
            let (scaled, factors) = Factors::new(matrix)?;
            return Ok(Self { engine: Engine::Direct(scaled, factors), params: *params });
        };
        let scaled = if method == Method::Cg {
            Scaled::symmetric(matrix)?.ok_or_else(|| not_positive(matrix))?
        } else {
            Scaled::rows(matrix)?
        };
        let weights = scaled.weights();
        let preconditioner = params.preconditioner.build(&scaled.matrix, weights.as_deref())?;
        if !preconditioner.is_linear() && !matches!(method, Method::Gmres { .. }) {
            return Err(not_flexible(method));
        }
        Ok(Self { engine: Engine::Krylov(scaled, method, preconditioner), params: *params })
    }

    /// The same for rows in difference form. Multigrid shares them with whoever has them.
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn of_rows(rows: Arc<DifferenceMatrix>, params: &SolverParams) -> Result<Self, SolveError> {
        match params.kind {
            SolverKind::Auto if rows.n() > AUTO_DIRECT_MAX => Self::multigrid(rows, None, params),
            SolverKind::Multigrid => Self::multigrid(rows, None, params),
            _ => Self::new(&rows.to_csr(), params),
        }
    }

    /// GMRES with multigrid for rows that are multiplied by factors; by those that make their largest entries alike where none
    /// are given.
    pub(crate) fn multigrid(
        rows: Arc<DifferenceMatrix>,
        factors: Option<Vec<f64>>,
        params: &SolverParams,
    ) -> Result<Self, SolveError> {
        check(params)?;
        let factors = factors.unwrap_or_else(|| rows.balancing_factors());
        let chain = Chain::new(rows, factors, params)?;
        Ok(Self { engine: Engine::Multigrid(Box::new(chain)), params: *params })
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        match &self.engine {
            Engine::Direct(scaled, _) | Engine::Krylov(scaled, ..) => scaled.matrix.nrows(),
            Engine::Multigrid(chain) => chain.n(),
        }
    }

    /// Solves for one right-hand side. For `b = 0` the answer is 0, at once.
    ///
    /// # Errors
    /// [`SolveError`] says what is wrong with the right-hand side, or how far the method came.
    pub fn solve(&self, rhs: &[f64]) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        MatrixError::check_length("right-hand side", rhs.len(), self.n())?;
        MatrixError::check_finite("right-hand side", rhs)?;
        let (scaled, solved) = match &self.engine {
            Engine::Multigrid(chain) => return chain.solve(rhs, &self.params),
            Engine::Direct(scaled, factors) => {
                (scaled, factors.solve_refined(&*scaled.matrix, &scaled.rhs(rhs)))
            }
            Engine::Krylov(scaled, method, m) => {
                let a = &*scaled.matrix;
                let solved = iterate(*method, a, m.as_ref(), &scaled.rhs(rhs), &self.params);
                let why = |error| match DifferenceMatrix::from_csr(a) {
                    Ok(rows) => diagnosed(error, &rows),
                    Err(_) => error,
                };
                (scaled, solved.map_err(why))
            }
        };
        match solved {
            Ok((x, info)) => Ok((scaled.unscale(x), info)),
            Err(error) => Err(unscale_best(scaled, error)),
        }
    }

    /// Prepares for a matrix of the same pattern with other values. Multigrid keeps its levels and computes their matrices
    /// anew, which is a fraction of its set-up, as long as the rows keep their shapes; all else is built again.
    ///
    /// # Errors
    /// Those of [`Prepared::new`]. What was prepared before is lost then.
    pub fn refresh(&mut self, matrix: &Csr) -> Result<(), SolveError> {
        MatrixError::check_length("rows of the matrix", matrix.nrows(), self.n())?;
        let kept = match &mut self.engine {
            Engine::Direct(..) | Engine::Krylov(_, Method::Cg, _) => false,
            Engine::Krylov(scaled, _, m) => {
                let renewed = scaled.renewed(matrix)?;
                let kept = m.refresh(&renewed.matrix)?;
                if kept {
                    *scaled = renewed;
                }
                kept
            }
            Engine::Multigrid(chain) => {
                chain.refresh(Arc::new(DifferenceMatrix::from_csr(matrix)?), &self.params)?;
                true
            }
        };
        if !kept {
            *self = Self::new(matrix, &self.params)?;
        }
        Ok(())
    }

    /// Solves for several right-hand sides, one after the other.
    ///
    /// # Errors
    /// Those of [`Prepared::solve`], for the first that fails.
    pub fn solve_all(&self, rhs: &[Vec<f64>]) -> Result<Vec<(Vec<f64>, SolveInfo)>, SolveError> {
        rhs.iter().map(|b| self.solve(b)).collect()
    }

    /// The levels, where the preconditioner is multigrid.
    #[must_use]
    pub fn hierarchy(&self) -> Option<&HierarchyInfo> {
        match &self.engine {
            Engine::Direct(..) => None,
            Engine::Krylov(_, _, m) => m.hierarchy(),
            Engine::Multigrid(chain) => chain.hierarchy(),
        }
    }

    /// The levels to precondition with, where GMRES with multigrid is in charge and has not failed.
    pub(crate) fn levels(&self) -> Option<Levels<'_>> {
        match &self.engine {
            Engine::Multigrid(chain) => chain.levels(),
            _ => None,
        }
    }
}

fn unscale_best(scaled: &Scaled, mut error: SolveError) -> SolveError {
    if let SolveError::NoConvergence { best, .. } | SolveError::BreakDown { best, .. } = &mut error {
        *best = scaled.unscale(std::mem::take(best));
    }
    error
}

fn not_flexible(method: Method) -> SolveError {
    SolveError::BadParameter {
        what: "the number of inner iterations of the preconditioner",
        value: 2.0,
        expected: match method {
            Method::Cg => "conjugate gradients need a linear preconditioner: take the V or W cycle, or GMRES",
            Method::Idr { .. } => "IDR(s) needs a linear preconditioner: take the V or W cycle, or GMRES",
            _ => "BiCGStab(l) needs a linear preconditioner: take the V or W cycle, or GMRES",
        },
    }
}

fn not_positive(matrix: &Csr) -> SolveError {
    let diagonal = matrix.diagonal();
    let row = diagonal.iter().position(|&d| d <= 0.0).unwrap_or(0);
    SolveError::BadParameter {
        what: "a diagonal entry of the matrix",
        value: diagonal.get(row).copied().unwrap_or(f64::NAN),
        expected: "conjugate gradients need a symmetric positive definite matrix",
    }
}

fn check(params: &SolverParams) -> Result<(), SolveError> {
    let bad = |what, value, expected| Err(SolveError::BadParameter { what, value, expected });
    if !(params.tolerance > 0.0 && params.tolerance < 1.0) {
        return bad("the tolerance", params.tolerance, "it must lie between 0 and 1");
    }
    if let Some(e) = params.backward_error
        && !(e > 0.0 && e < 1.0)
    {
        return bad("the backward error", e, "it must lie between 0 and 1");
    }
    match params.kind {
        SolverKind::BiCgStab { l } if !(1..=8).contains(&l) => {
            return bad("the degree l of BiCGStab(l)", l as f64, "it must lie between 1 and 8");
        }
        SolverKind::Idr { s } if !(1..=16).contains(&s) => {
            return bad("the shadow space of IDR(s)", s as f64, "its dimension must lie between 1 and 16");
        }
        SolverKind::Gmres { restart: 0 } => {
            return bad("the restart length of GMRES", 0.0, "it must be at least 1");
        }
        _ => {}
    }
    if let PreconditionerKind::Ilut { drop, .. } = params.preconditioner
        && !(0.0..1.0).contains(&drop)
    {
        return bad("the drop tolerance of ILUT", drop, "it must lie in [0, 1)");
    }
    Ok(())
}
