//! Restarted GMRES, preconditioned from the right.
//!
//! Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986); the Arnoldi vectors are orthogonalised twice.

use super::Outcome;
use crate::vector::{axpy, dot, norm};
use crate::{Csr, Preconditioner};

/// Adds to `x` a correction that takes the residual from `r` to below `target`: one cycle of at most `restart` products.
pub(crate) fn gmres(
    matrix: &Csr,
    preconditioner: &dyn Preconditioner,
    r: &[f64],
    x: &mut [f64],
    restart: usize,
    target: f64,
) -> Outcome {
    let n = r.len();
    let beta = norm(r);
    let mut basis: Vec<Vec<f64>> = vec![r.iter().map(|v| v / beta).collect()];
    let mut h: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut g = vec![beta];
    let mut outcome = Outcome { iterations: 0, broke_down: false };
    for k in 0..restart {
        let mut work = basis[k].clone();
        preconditioner.apply(&mut work);
        let mut w = vec![0.0; n];
        matrix.mul_vec(&work, &mut w);
        outcome.iterations += 1;
        let mut column = vec![0.0; k + 2];
        for _ in 0..2 {
            for (i, v) in basis.iter().enumerate() {
                let projection = dot(&w, v);
                column[i] += projection;
                axpy(-projection, v, &mut w);
            }
        }
        let length = norm(&w);
        column[k + 1] = length;
        for (i, &(c, s)) in rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            column[i] = c * a + s * b;
            column[i + 1] = c * b - s * a;
        }
        let hypotenuse = column[k].hypot(column[k + 1]);
        if hypotenuse == 0.0 || !hypotenuse.is_finite() {
            outcome.broke_down = true;
            break;
        }
        let (c, s) = (column[k] / hypotenuse, column[k + 1] / hypotenuse);
        column[k] = hypotenuse;
        rotations.push((c, s));
        g.push(-s * g[k]);
        g[k] *= c;
        h.push(column);
        if g[k + 1].abs() <= target || length == 0.0 {
            break;
        }
        w.iter_mut().for_each(|v| *v /= length);
        basis.push(w);
    }
    let m = h.len();
    let mut y = vec![0.0; m];
    for i in (0..m).rev() {
        let sum: f64 = (i + 1..m).map(|j| h[j][i] * y[j]).sum();
        y[i] = (g[i] - sum) / h[i][i];
    }
    let mut correction = vec![0.0; n];
    y.iter().zip(&basis).for_each(|(factor, v)| axpy(*factor, v, &mut correction));
    preconditioner.apply(&mut correction);
    axpy(1.0, &correction, x);
    outcome
}
