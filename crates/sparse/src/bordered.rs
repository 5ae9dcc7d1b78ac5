//! A sparse system with a few extra unknowns and equations.

use crate::{Csr, Prepared, SolveError, SolveInfo, SolverParams};

/// `[A B; C D] [w; c] = [b; g]` with a sparse nonsingular A and few extra unknowns c.
///
/// Solved by elimination with the Schur complement `S = D - C A^-1 B`, one solve with A for each extra unknown, and one
/// step of refinement of the whole.
#[derive(Debug, Clone)]
pub struct Bordered {
    /// The large block.
    pub a: Csr,
    /// Columns of B by their entries (row, value).
    pub columns: Vec<Vec<(u32, f64)>>,
    /// Rows of C by their entries (column, value).
    pub rows: Vec<Vec<(u32, f64)>>,
    /// D, by rows.
    pub corner: Vec<Vec<f64>>,
    /// b.
    pub rhs: Vec<f64>,
    /// g.
    pub extra: Vec<f64>,
}

impl Bordered {
    /// The unknowns w, the extra unknowns c, and what the solves with A came to.
    ///
    /// # Errors
    /// Those of the solver, and a singular Schur complement.
    pub fn solve(&self, params: &SolverParams) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        let prepared = Prepared::new(&self.a, params)?;
        let mut iterations = 0;
        let mut solve = |rhs: &[f64]| -> Result<(Vec<f64>, SolveInfo), SolveError> {
            let (x, info) = prepared.solve(rhs)?;
            iterations += info.iterations;
            Ok((x, info))
        };
        let n = self.rhs.len();
        let responses = self
            .columns
            .iter()
            .map(|column| {
                let mut dense = vec![0.0; n];
                column.iter().for_each(|&(i, v)| dense[i as usize] += v);
                solve(&dense).map(|(x, _)| x)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let schur: Vec<Vec<f64>> = (self.rows.iter().zip(&self.corner))
            .map(|(row, corner)| responses.iter().zip(corner).map(|(x, d)| d - sparse_dot(row, x)).collect())
            .collect();
        let mut once = |b: &[f64], g: &[f64]| -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
            let (mut w, info) = solve(b)?;
            let right = self.rows.iter().zip(g).map(|(row, g)| g - sparse_dot(row, &w)).collect();
            let c = solve_dense(schur.clone(), right)?;
            for (factor, response) in c.iter().zip(&responses) {
                w.iter_mut().zip(response).for_each(|(w, r)| *w -= factor * r);
            }
            Ok((w, c, info))
        };
        let (mut w, mut c, mut info) = once(&self.rhs, &self.extra)?;
        let (r, s) = self.residual(&w, &c);
        if r.iter().chain(&s).any(|v| *v != 0.0) {
            // A residual of round-off may be too small for a Krylov method to reduce further: then it stays as it is.
            if let Ok((dw, dc, _)) = once(&r, &s) {
                w.iter_mut().zip(dw).for_each(|(w, d)| *w += d);
                c.iter_mut().zip(dc).for_each(|(c, d)| *c += d);
            }
        }
        info.iterations = iterations;
        Ok((w, c, info))
    }

    fn residual(&self, w: &[f64], c: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut r = vec![0.0; w.len()];
        self.a.residual(w, &self.rhs, &mut r);
        for (column, value) in self.columns.iter().zip(c) {
            column.iter().for_each(|&(i, v)| r[i as usize] -= v * value);
        }
        let s = (self.rows.iter().zip(&self.corner).zip(&self.extra))
            .map(|((row, corner), g)| {
                g - sparse_dot(row, w) - corner.iter().zip(c).map(|(d, c)| d * c).sum::<f64>()
            })
            .collect();
        (r, s)
    }
}

fn sparse_dot(row: &[(u32, f64)], x: &[f64]) -> f64 {
    row.iter().map(|&(j, v)| v * x[j as usize]).sum()
}

/// Gaussian elimination with partial pivoting, rows scaled by their largest entries.
fn solve_dense(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Result<Vec<f64>, SolveError> {
    let n = b.len();
    for (row, b) in a.iter_mut().zip(&mut b) {
        let largest = row.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        if largest > 0.0 {
            row.iter_mut().for_each(|v| *v /= largest);
            *b /= largest;
        }
    }
    for k in 0..n {
        let pivot = (k..n).fold(k, |p, i| if a[i][k].abs() > a[p][k].abs() { i } else { p });
        a.swap(k, pivot);
        b.swap(k, pivot);
        if !(a[k][k].abs() > f64::EPSILON) {
            let detail = format!("the constant of part {k} is not determined by its surroundings");
            return Err(SolveError::Singular { detail });
        }
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let (head, tail) = a.split_at_mut(i);
            tail[0][k..].iter_mut().zip(&head[k][k..]).for_each(|(v, p)| *v -= factor * p);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - sum) / a[k][k];
    }
    Ok(b)
}
