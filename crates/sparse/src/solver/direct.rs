//! Sparse factorisation. The only file that names faer.

use super::krylov::Residuals;
use super::scaling::Scaled;
use super::{Criterion, SolveError, SolveInfo};
use crate::csr::Csr;
use crate::vector::{mixed_bit, norm, norm_max};
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, Lu, SymbolicLlt, SymbolicLu};
use faer::sparse::linalg::{LltError, LuError};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Side};

/// Refinement stops at a componentwise backward error of four units in the last place: no further step improves it.
const BACKWARD_ERROR_TARGET: f64 = 4.0 * f64::EPSILON;

/// A refinement step must at least halve the backward error, or it is the last (Higham 2002, section 12.1).
const REFINEMENT_GAIN: f64 = 0.5;

/// Refinement steps at most: one or two are the rule, five the limit LAPACK uses.
const REFINEMENT_STEPS: usize = 5;

/// Scaled matrices with a larger (estimated) condition number count as singular: no digit would be right.
const SINGULAR_CONDITION: f64 = 0.1 / f64::EPSILON;

/// The factors of a matrix.
pub(crate) struct Factors {
    kind: Kind,
    condition: f64,
}

enum Kind {
    Lu(Box<Lu<usize, f64>>),
    Llt(Llt<usize, f64>),
}

impl std::fmt::Debug for Factors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factors").field("name", &self.name()).field("condition", &self.condition).finish()
    }
}

impl Factors {
    /// Scales and factorises: `L L^T` if the matrix is symmetric with a positive diagonal and turns out positive
    /// definite, `L U` otherwise.
    pub(crate) fn new(matrix: &Csr) -> Result<(Scaled, Self), SolveError> {
        if matrix.is_symmetric()
            && let Some(scaled) = Scaled::symmetric(matrix)?
            && let Some(kind) = factorise_llt(&scaled.matrix)?
            && let Ok(factors) = Self::checked(kind, &scaled.matrix)
        {
            return Ok((scaled, factors));
        }
        Self::lu(matrix)
    }

    /// Scales and factorises by `L U`.
    pub(crate) fn lu(matrix: &Csr) -> Result<(Scaled, Self), SolveError> {
        let scaled = Scaled::rows(matrix)?;
        let kind = factorise_lu(&scaled.matrix)?;
        let factors = Self::checked(kind, &scaled.matrix)?;
        Ok((scaled, factors))
    }

    /// Estimates the condition number by two steps of inverse iteration from a vector of mixed signs: a lower bound
    /// that is near the truth wherever one direction is far less determined than the others, which is the case
    /// that matters.
    fn checked(kind: Kind, matrix: &Csr) -> Result<Self, SolveError> {
        let mut factors = Self { kind, condition: 0.0 };
        let n = matrix.nrows();
        let largest_row =
            (0..n).map(|i| matrix.row(i).1.iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max);
        let mut z: Vec<f64> = (0..n as u64).map(|i| if mixed_bit(i) { 1.0 } else { -1.0 }).collect();
        for _step in 0..2 {
            factors.apply(&mut z);
            let size = norm_max(&z);
            if !size.is_finite() {
                let row = z.iter().position(|z| !z.is_finite()).unwrap_or(0);
                return Err(SolveError::Singular { row, condition: f64::INFINITY });
            }
            factors.condition = factors.condition.max(size * largest_row);
            if factors.condition > SINGULAR_CONDITION {
                let row = z.iter().position(|z| z.abs() == size).unwrap_or(0);
                return Err(SolveError::Singular { row, condition: factors.condition });
            }
            z.iter_mut().for_each(|z| *z /= size);
        }
        Ok(factors)
    }

    /// Estimate from below of the condition number of the scaled matrix.
    pub(crate) fn condition(&self) -> f64 {
        self.condition
    }

    fn name(&self) -> &'static str {
        match self.kind {
            Kind::Lu(_) => "sparse LU",
            Kind::Llt(_) => "sparse LL^T",
        }
    }

    /// `x` becomes `A^-1 x`, without refinement.
    pub(crate) fn apply(&self, x: &mut [f64]) {
        let n = x.len();
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        match &self.kind {
            Kind::Lu(lu) => lu.solve_in_place_with_conj(Conj::No, x),
            Kind::Llt(llt) => llt.solve_in_place_with_conj(Conj::No, x),
        }
    }

    /// Solves and refines until the componentwise backward error stagnates.
    pub(crate) fn solve_refined(
        &self,
        matrix: &dyn Residuals,
        b: &[f64],
    ) -> Result<(Vec<f64>, SolveInfo), SolveError> {
        let mut x = b.to_vec();
        self.apply(&mut x);
        let mut backward_error = matrix.backward_error(&x, b);
        let mut history = vec![backward_error];
        let mut residual = vec![0.0; b.len()];
        for _step in 0..REFINEMENT_STEPS {
            if backward_error <= BACKWARD_ERROR_TARGET {
                break;
            }
            matrix.residual(&x, b, &mut residual);
            self.apply(&mut residual);
            let refined: Vec<f64> = x.iter().zip(&residual).map(|(x, d)| x + d).collect();
            let error = matrix.backward_error(&refined, b);
            if error < backward_error {
                x = refined;
                history.push(error);
            }
            let gained = error <= REFINEMENT_GAIN * backward_error;
            backward_error = backward_error.min(error);
            if !gained {
                break;
            }
        }
        if let Some(row) = x.iter().position(|x| !x.is_finite()) {
            return Err(SolveError::Singular { row, condition: f64::INFINITY });
        }
        matrix.residual(&x, b, &mut residual);
        let size = norm(b);
        let info = SolveInfo {
            name: self.name().to_owned(),
            iterations: history.len() - 1,
            residual: if size == 0.0 { norm(&residual) } else { norm(&residual) / size },
            backward_error,
            criterion: Criterion::RoundOff,
            history,
            replaced_pivots: 0,
            condition: Some(self.condition),
        };
        Ok((x, info))
    }
}

/// Rows of the transpose, which are the columns of the matrix.
struct Columns {
    n: usize,
    transpose: Csr,
    rows: Vec<usize>,
}

impl Columns {
    fn new(matrix: &Csr) -> Self {
        let transpose = matrix.transpose();
        let rows = transpose.indices().iter().map(|&i| i as usize).collect();
        Self { n: matrix.nrows(), transpose, rows }
    }

    fn view(&self) -> SparseColMatRef<'_, usize, f64> {
        let pattern =
            SymbolicSparseColMatRef::new_checked(self.n, self.n, self.transpose.offsets(), None, &self.rows);
        SparseColMatRef::new(pattern, self.transpose.values())
    }
}

fn out_of_memory(n: usize) -> impl Fn(FaerError) -> SolveError {
    move |_| SolveError::OutOfMemory { n }
}

fn factorise_lu(matrix: &Csr) -> Result<Kind, SolveError> {
    let columns = Columns::new(matrix);
    let view = columns.view();
    let symbolic = SymbolicLu::try_new(view.symbolic()).map_err(out_of_memory(columns.n))?;
    match Lu::try_new_with_symbolic(symbolic, view) {
        Ok(lu) => Ok(Kind::Lu(Box::new(lu))),
        Err(LuError::SymbolicSingular { index }) => {
            Err(SolveError::Singular { row: index, condition: f64::INFINITY })
        }
        Err(LuError::Generic(_)) => Err(SolveError::OutOfMemory { n: columns.n }),
    }
}

/// None if the matrix is not positive definite.
fn factorise_llt(matrix: &Csr) -> Result<Option<Kind>, SolveError> {
    let columns = Columns::new(matrix);
    let view = columns.view();
    let symbolic = SymbolicLlt::try_new(view.symbolic(), Side::Lower).map_err(out_of_memory(columns.n))?;
    match Llt::try_new_with_symbolic(symbolic, view, Side::Lower) {
        Ok(llt) => Ok(Some(Kind::Llt(llt))),
        Err(LltError::Numeric(_)) => Ok(None),
        Err(LltError::Generic(_)) => Err(SolveError::OutOfMemory { n: columns.n }),
    }
}
