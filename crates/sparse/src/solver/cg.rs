//! Conjugate gradients (Hestenes and Stiefel 1952), preconditioned.

use super::krylov::{Cycle, CycleEnd};
use crate::vector::{axpy, dot, norm, xpby};

/// One run of conjugate gradients for `A d = r` from `d = 0`. `r` is overwritten.
pub(crate) fn cg_cycle(cycle: &mut Cycle<'_>, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
    let n = r.len();
    let (mut z, mut p, mut q) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut rho = 0.0;
    loop {
        if cycle.is_spent() {
            return CycleEnd::Budget;
        }
        cycle.precondition(r, &mut z);
        let rho_new = dot(r, &z);
        if rho_new <= 0.0 || !rho_new.is_finite() {
            return CycleEnd::BreakDown("the preconditioner is not positive definite");
        }
        let beta = if rho == 0.0 { 0.0 } else { rho_new / rho };
        xpby(&z, beta, &mut p);
        rho = rho_new;
        cycle.a.apply(&p, &mut q);
        cycle.products += 1;
        let curvature = dot(&p, &q);
        if curvature <= 0.0 || !curvature.is_finite() {
            return CycleEnd::BreakDown("the matrix is not positive definite");
        }
        let alpha = rho / curvature;
        axpy(alpha, &p, d);
        axpy(-alpha, &q, r);
        let size = norm(r);
        cycle.record(size);
        if size <= cycle.target {
            return CycleEnd::Claimed;
        }
    }
}
