//! BiCGStab(l), preconditioned from the right.
//!
//! G. L. G. Sleijpen, D. R. Fokkema, "BiCGstab(l) for linear equations involving unsymmetric matrices with complex
//! spectrum", ETNA 1 (1993), algorithm 3.1 with the modified Gram-Schmidt of the minimal-residual part.

use super::Outcome;
use crate::vector::{axpy, dot, norm};
use crate::{Csr, Preconditioner};

/// Adds to `x` a correction that takes the residual from `r` to below `target`, with at most about `limit` products.
pub(crate) fn bicgstab(
    matrix: &Csr,
    preconditioner: &dyn Preconditioner,
    r: &[f64],
    x: &mut [f64],
    l: usize,
    target: f64,
    limit: usize,
) -> Outcome {
    let n = r.len();
    let product = |v: &[f64], out: &mut [f64], work: &mut Vec<f64>| {
        work.clear();
        work.extend_from_slice(v);
        preconditioner.apply(work);
        matrix.mul_vec(work, out);
    };
    let mut work = Vec::with_capacity(n);
    let shadow = r.to_vec();
    // Residuals r_0 .. r_l and directions u_0 .. u_l.
    let mut rs = vec![vec![0.0; n]; l + 1];
    let mut us = vec![vec![0.0; n]; l + 1];
    rs[0].copy_from_slice(r);
    // The iterate in the preconditioned variable.
    let mut y = vec![0.0; n];
    let (mut rho, mut alpha, mut omega) = (1.0, 0.0, 1.0);
    let mut outcome = Outcome { iterations: 0, broke_down: false };
    while outcome.iterations < limit && norm(&rs[0]) > target {
        rho *= -omega;
        for j in 0..l {
            let rho_next = dot(&rs[j], &shadow);
            let beta = alpha * rho_next / rho;
            rho = rho_next;
            for i in 0..=j {
                us[i].iter_mut().zip(&rs[i]).for_each(|(u, r)| *u = r - beta * *u);
            }
            let (head, tail) = us.split_at_mut(j + 1);
            product(&head[j], &mut tail[0], &mut work);
            alpha = rho / dot(&us[j + 1], &shadow);
            if !(alpha.is_finite() && beta.is_finite()) {
                outcome.broke_down = true;
                break;
            }
            for i in 0..=j {
                axpy(-alpha, &us[i + 1], &mut rs[i]);
            }
            let (head, tail) = rs.split_at_mut(j + 1);
            product(&head[j], &mut tail[0], &mut work);
            axpy(alpha, &us[0], &mut y);
            outcome.iterations += 2;
        }
        if outcome.broke_down {
            break;
        }
        match minimal_residual(&mut rs, &mut us, &mut y, l) {
            Some(last) => omega = last,
            None => {
                outcome.broke_down = true;
                break;
            }
        }
    }
    preconditioner.apply(&mut y);
    axpy(1.0, &y, x);
    outcome
}

/// The minimal-residual part; returns omega, or `None` where it breaks down.
fn minimal_residual(rs: &mut [Vec<f64>], us: &mut [Vec<f64>], y: &mut [f64], l: usize) -> Option<f64> {
    let mut tau = vec![vec![0.0; l + 1]; l + 1];
    let mut sigma = vec![0.0; l + 1];
    let mut gamma_prime = vec![0.0; l + 1];
    for j in 1..=l {
        for i in 1..j {
            let factor = dot(&rs[j], &rs[i]) / sigma[i];
            tau[i][j] = factor;
            let (head, tail) = rs.split_at_mut(j);
            axpy(-factor, &head[i], &mut tail[0]);
        }
        sigma[j] = dot(&rs[j], &rs[j]);
        gamma_prime[j] = dot(&rs[0], &rs[j]) / sigma[j];
    }
    if gamma_prime[1..].iter().any(|g| !g.is_finite()) || gamma_prime[l] == 0.0 {
        return None;
    }
    let mut gamma = vec![0.0; l + 1];
    gamma[l] = gamma_prime[l];
    for j in (1..l).rev() {
        gamma[j] = gamma_prime[j] - (j + 1..=l).map(|i| tau[j][i] * gamma[i]).sum::<f64>();
    }
    let mut gamma_second = vec![0.0; l + 1];
    for j in 1..l {
        gamma_second[j] = gamma[j + 1] + (j + 1..l).map(|i| tau[j][i] * gamma[i + 1]).sum::<f64>();
    }
    axpy(gamma[1], &rs[0], y);
    update(rs, l, gamma_prime[l]);
    update(us, l, gamma[l]);
    for j in 1..l {
        update(us, j, gamma[j]);
        axpy(gamma_second[j], &rs[j], y);
        update(rs, j, gamma_prime[j]);
    }
    Some(gamma[l])
}

/// `v_0 -= factor v_k`
fn update(vectors: &mut [Vec<f64>], k: usize, factor: f64) {
    let (head, tail) = vectors.split_at_mut(k);
    axpy(-factor, &tail[0], &mut head[0]);
}
