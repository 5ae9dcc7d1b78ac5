//! The coarsest level, solved directly.

use crate::csr::Csr;
use crate::solver::{Factors, Scaled, SolveError};

/// A row sum below this part of the diagonal is none: what is left of a pure Neumann problem after all coarsening.
const NO_ROW_SUM: f64 = 1e-13;

/// Part of its diagonal that is added to a matrix that cannot be factorised otherwise: large enough for pivots, too small
/// to matter to the first digits, which are all that a preconditioner needs.
const SHIFT: f64 = 1e-7;

/// Factors of the coarsest matrix.
#[derive(Debug)]
pub(crate) struct Coarse {
    scaled: Scaled,
    factors: Factors,
}

impl Coarse {
    /// What stands here until there is a coarsest level.
    pub(crate) fn trivial() -> Result<Self, SolveError> {
        let (scaled, factors) = Factors::new(&Csr::identity(1))?;
        Ok(Self { scaled, factors })
    }

    /// Factorises the matrix. A connected part that has only the constant as its null space gets a multiple of the matrix
    /// of ones added, which makes it regular and changes nothing for right-hand sides that have a solution; any other
    /// singular matrix is shifted.
    pub(crate) fn new(a: &Csr, row_sums: &[f64]) -> Result<Self, SolveError> {
        let floating = floating_parts(a, row_sums);
        let a = if floating.is_empty() { a.clone() } else { with_ones(a, &floating)? };
        match Factors::new(&a) {
            Ok((scaled, factors)) => Ok(Self { scaled, factors }),
            Err(SolveError::Singular { .. } | SolveError::EmptyRow { .. }) => {
                let (scaled, factors) = Factors::new(&shifted(&a)?)?;
                Ok(Self { scaled, factors })
            }
            Err(error) => Err(error),
        }
    }

    pub(crate) fn solve(&self, b: &[f64], x: &mut [f64]) {
        let mut scaled = self.scaled.rhs(b);
        self.factors.apply(&mut scaled);
        x.copy_from_slice(&self.scaled.unscale(scaled));
    }
}

/// Connected parts of the matrix without any row sum.
fn floating_parts(a: &Csr, row_sums: &[f64]) -> Vec<Vec<u32>> {
    let n = a.nrows();
    let reverse = a.transpose();
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
            let size = a.row(i).1.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            held |= row_sums[i].abs() > NO_ROW_SUM * size;
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
