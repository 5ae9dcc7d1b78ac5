//! The coarsest level, solved directly.

use super::SmootherKind;
use super::smoother::{Smoother, reciprocals};
use super::strength;
use crate::csr::Csr;
use crate::difference::DifferenceMatrix;
use crate::solver::{Factors, Scaled, SolveError};
use std::sync::Arc;

/// A row sum below this part of the diagonal is none: what is left of a pure Neumann problem after all coarsening.
const NO_ROW_SUM: f64 = 1e-13;

/// Part of its diagonal that is added to a matrix that cannot be factorised otherwise: large enough for pivots, too small
/// to matter to the first digits, which are all that a preconditioner needs.
const SHIFT: f64 = 1e-7;

/// Sweeps that stand for a solution where every row is dominated by its diagonal: each shrinks the error tenfold.
const SWEEPS: usize = 4;

/// How the coarsest level is solved.
#[derive(Debug)]
pub(crate) enum Coarse {
    /// By the factors of its matrix.
    Factored(Scaled, Factors),
    /// By Gauss-Seidel: a level that is still large because nothing in it needs a coarser one, as in short time steps.
    Relaxed(Arc<DifferenceMatrix>, Smoother),
}

impl Coarse {
    /// What stands here until there is a coarsest level.
    pub(crate) fn trivial() -> Result<Self, SolveError> {
        let (scaled, factors) = Factors::new(&Csr::identity(1))?;
        Ok(Self::Factored(scaled, factors))
    }

    /// Factorises the matrix, unless it has more than `small` unknowns and relaxation solves it. A connected part that has only
    /// the constant as its null space gets a multiple of the matrix of ones added, which makes it regular and changes
    /// nothing for right-hand sides that have a solution; any other singular matrix is shifted.
    pub(crate) fn new(a: &Arc<DifferenceMatrix>, small: usize) -> Result<Self, SolveError> {
        if a.n() > small && strength::all_settled(a) {
            return Ok(Self::Relaxed(
                Arc::clone(a),
                Smoother::new(SmootherKind::GaussSeidel, a, reciprocals(a))?,
            ));
        }
        let floating = floating_parts(a);
        let a = a.to_csr();
        let a = if floating.is_empty() { a } else { with_ones(&a, &floating)? };
        match Factors::new(&a) {
            Ok((scaled, factors)) => Ok(Self::Factored(scaled, factors)),
            Err(SolveError::Singular { .. } | SolveError::EmptyRow { .. }) => {
                let (scaled, factors) = Factors::new(&shifted(&a)?)?;
                Ok(Self::Factored(scaled, factors))
            }
            Err(error) => Err(error),
        }
    }

    pub(crate) fn solve(&self, b: &[f64], x: &mut [f64]) {
        match self {
            Self::Factored(scaled, factors) => {
                let mut y = scaled.rhs(b);
                factors.apply(&mut y);
                x.copy_from_slice(&scaled.unscale(y));
            }
            Self::Relaxed(a, smoother) => {
                let mut t = vec![0.0; smoother.scratch_len(b.len())];
                smoother.first(a, b, x, &mut t);
                (1..SWEEPS).for_each(|_| smoother.after(a, b, x, &mut t));
            }
        }
    }
}

/// Connected parts of the matrix without any row sum.
pub(crate) fn floating_parts(a: &DifferenceMatrix) -> Vec<Vec<u32>> {
    let n = a.n();
    let reverse = a.off_diagonal().transpose();
    let mut seen = vec![false; n];
    let mut parts = Vec::new();
    for start in 0..n {
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        let mut part = vec![start as u32];
        let mut next = 0;
        let mut held = false;
        while next < part.len() {
            let i = part[next] as usize;
            next += 1;
            let size = a.row(i).1.iter().fold(a.diagonal(i).abs(), |m, v| m.max(v.abs()));
            held |= a.row_sum(i).abs() > NO_ROW_SUM * size;
            for (columns, values) in [a.row(i), reverse.row(i)] {
                for (&j, &v) in columns.iter().zip(values) {
                    if v != 0.0 && !std::mem::replace(&mut seen[j as usize], true) {
                        part.push(j);
                    }
                }
            }
        }
        if !held {
            parts.push(part);
        }
    }
    parts
}

fn with_ones(a: &Csr, parts: &[Vec<u32>]) -> Result<Csr, SolveError> {
    let mut part_of = vec![usize::MAX; a.nrows()];
    for (k, part) in parts.iter().enumerate() {
        part.iter().for_each(|&i| part_of[i as usize] = k);
    }
    Ok(Csr::from_rows(a.nrows(), a.ncols(), |i, row| {
        let (columns, values) = a.row(i);
        columns.iter().zip(values).for_each(|(&j, &v)| row.push(j as usize, v));
        if let Some(part) = parts.get(part_of[i]) {
            let diagonal = a.get(i, i);
            let one = if diagonal == 0.0 { 1.0 } else { diagonal / part.len() as f64 };
            part.iter().for_each(|&j| row.push(j as usize, one));
        }
    })?)
}

fn shifted(a: &Csr) -> Result<Csr, SolveError> {
    Ok(Csr::from_rows(a.nrows(), a.ncols(), |i, row| {
        let (columns, values) = a.row(i);
        columns.iter().zip(values).for_each(|(&j, &v)| row.push(j as usize, v));
        let size = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let sign = if a.get(i, i) < 0.0 { -1.0 } else { 1.0 };
        row.push(i, if size == 0.0 { 1.0 } else { SHIFT * size * sign });
    })?)
}
