//! Solving `A x = b`: factor or precondition once, solve for any number of right-hand sides.

use crate::direct::Direct;
use crate::krylov::{bicgstab, gmres};
use crate::vector::norm;
use crate::{Csr, Preconditioner, PreconditionerKind, SolveError};

/// Steps of iterative refinement of a direct solution at the most.
const REFINEMENTS: usize = 3;

/// Componentwise backward error that a direct solution is refined to: a few units of round-off.
const BACKWARD_ERROR: f64 = 1e-15;

/// Restarts of a Krylov method that bring less than this factor end it: it stagnates.
const STAGNATION: f64 = 0.5;

/// Cycles that may stagnate before the solver gives up.
const MAX_STAGNANT: usize = 3;

/// Which method solves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolverKind {
    /// Sparse LU with iterative refinement.
    Direct,
    /// BiCGStab(l), l >= 1.
    BiCgStab {
        /// Degree of the minimal-residual part: 1, 2 or 4.
        l: usize,
    },
    /// Restarted GMRES.
    Gmres {
        /// Products until a restart.
        restart: usize,
    },
}

/// How to solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverParams {
    /// The method.
    pub kind: SolverKind,
    /// Preconditioner of a Krylov method.
    pub preconditioner: PreconditionerKind,
    /// True residual, relative to the right-hand side of the scaled system, at which a Krylov method stops.
    pub tolerance: f64,
    /// Products with the matrix at the most.
    pub max_iterations: usize,
}

impl Default for SolverParams {
    fn default() -> Self {
        Self {
            kind: SolverKind::Direct,
            preconditioner: PreconditionerKind::Ilu0,
            tolerance: 1e-11,
            max_iterations: 4000,
        }
    }
}

impl SolverParams {
    /// Name of the solver with its preconditioner.
    pub fn name(&self) -> String {
        match self.kind {
            SolverKind::Direct => "direct".to_owned(),
            SolverKind::BiCgStab { l } => format!("bicgstab({l}) + {}", self.preconditioner.name()),
            SolverKind::Gmres { restart } => format!("gmres({restart}) + {}", self.preconditioner.name()),
        }
    }
}

/// What a solve came to.
#[derive(Debug, Clone, PartialEq)]
pub struct SolveInfo {
    /// Name of the solver with its preconditioner.
    pub name: String,
    /// Products with the matrix; for a direct solve 0.
    pub iterations: usize,
    /// True residual of the row-scaled system relative to its right-hand side.
    pub residual: f64,
    /// Componentwise backward error: the largest `|b - A x|_i / (|A| |x| + |b|)_i`.
    pub backward_error: f64,
}

/// A matrix with what its solver needs, rows scaled by their largest entries.
pub struct Prepared {
    matrix: Csr,
    scale: Vec<f64>,
    params: SolverParams,
    engine: Engine,
}

enum Engine {
    Direct(Box<Direct>),
    Krylov(Box<dyn Preconditioner>),
}

impl std::fmt::Debug for Prepared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Prepared")
            .field("unknowns", &self.matrix.nrows())
            .field("params", &self.params)
            .finish()
    }
}

impl Prepared {
    /// Scales, and factors or preconditions.
    ///
    /// # Errors
    /// A matrix that is not square, that has a row without entries or a value that is not finite, or that the direct
    /// solver finds singular.
    pub fn new(matrix: &Csr, params: &SolverParams) -> Result<Self, SolveError> {
        if matrix.nrows() != matrix.ncols() {
            return Err(SolveError::Shape {
                rows: matrix.nrows(),
                columns: matrix.ncols(),
                rhs: matrix.nrows(),
            });
        }
        let mut scale = Vec::with_capacity(matrix.nrows());
        for row in 0..matrix.nrows() {
            let largest = matrix.row(row).1.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            if largest == 0.0 {
                return Err(SolveError::ZeroRow { row });
            }
            if !largest.is_finite() {
                return Err(SolveError::NotFinite { row });
            }
            scale.push(1.0 / largest);
        }
        let matrix = matrix.row_scaled(&scale)?;
        let engine = match params.kind {
            SolverKind::Direct => Engine::Direct(Box::new(Direct::new(&matrix)?)),
            _ => Engine::Krylov(params.preconditioner.build(&matrix)?),
        };
        Ok(Self { matrix, scale, params: *params, engine })
    }

    /// Solves for one right-hand side.
    ///
    /// # Errors
    /// A right-hand side that is not finite or has another length, an iteration that does not reach its tolerance.
    pub fn solve(&self, rhs: &[f64]) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        let n = self.matrix.nrows();
        if rhs.len() != n {
            return Err(SolveError::Shape { rows: n, columns: n, rhs: rhs.len() });
        }
        if let Some(row) = rhs.iter().position(|b| !b.is_finite()) {
            return Err(SolveError::NotFinite { row });
        }
        let b: Vec<f64> = rhs.iter().zip(&self.scale).map(|(b, s)| b * s).collect();
        let (x, iterations) = match &self.engine {
            Engine::Direct(lu) => (self.refine(lu, &b)?, 0),
            Engine::Krylov(preconditioner) => self.iterate(&**preconditioner, &b)?,
        };
        let mut r = vec![0.0; n];
        self.matrix.residual(&x, &b, &mut r);
        let size = norm(&b);
        let residual = if size > 0.0 { norm(&r) / size } else { norm(&r) };
        let backward_error = self.matrix.backward_error(&x, &b);
        Ok((x, SolveInfo { name: self.params.name(), iterations, residual, backward_error }))
    }

    fn refine(&self, lu: &Direct, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut x = b.to_vec();
        lu.solve_in_place(&mut x);
        let mut error = self.matrix.backward_error(&x, b);
        for _ in 0..REFINEMENTS {
            if error <= BACKWARD_ERROR {
                break;
            }
            let mut correction = vec![0.0; b.len()];
            self.matrix.residual(&x, b, &mut correction);
            lu.solve_in_place(&mut correction);
            let refined: Vec<f64> = x.iter().zip(&correction).map(|(x, c)| x + c).collect();
            let next = self.matrix.backward_error(&refined, b);
            if !(next < error) {
                break;
            }
            x = refined;
            error = next;
        }
        if x.iter().all(|v| v.is_finite()) {
            Ok(x)
        } else {
            Err(SolveError::Singular { detail: "a pivot vanished".to_owned() })
        }
    }

    fn iterate(
        &self,
        preconditioner: &dyn Preconditioner,
        b: &[f64],
    ) -> Result<(Vec<f64>, usize), SolveError> {
        let mut x = vec![0.0; b.len()];
        let mut best = (f64::INFINITY, x.clone());
        let target = self.params.tolerance * norm(b);
        let (mut r, mut iterations, mut stagnant) = (b.to_vec(), 0, 0);
        loop {
            let size = norm(&r);
            if size <= target {
                return Ok((x, iterations));
            }
            stagnant = if size < STAGNATION * best.0 { 0 } else { stagnant + 1 };
            if size < best.0 {
                best = (size, x.clone());
            }
            if stagnant > MAX_STAGNANT || iterations >= self.params.max_iterations || !size.is_finite() {
                return Err(SolveError::NoConvergence {
                    solver: self.params.name(),
                    residual: best.0 / norm(b),
                    iterations,
                    tolerance: self.params.tolerance,
                });
            }
            let left = self.params.max_iterations - iterations;
            let outcome = match self.params.kind {
                SolverKind::Gmres { restart } => {
                    gmres(&self.matrix, preconditioner, &r, &mut x, restart.clamp(1, left), target)
                }
                SolverKind::BiCgStab { l } => {
                    bicgstab(&self.matrix, preconditioner, &r, &mut x, l.max(1), target, left)
                }
                SolverKind::Direct => bicgstab(&self.matrix, preconditioner, &r, &mut x, 1, target, left),
            };
            iterations += outcome.iterations.max(1);
            if outcome.broke_down && x.iter().any(|v| !v.is_finite()) {
                x.clone_from(&best.1);
            }
            self.matrix.residual(&x, b, &mut r);
        }
    }
}
