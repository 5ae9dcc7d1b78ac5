//! BiCGStab(l): G. L. G. Sleijpen and D. R. Fokkema, "BiCGstab(l) for linear equations involving unsymmetric
//! matrices with complex spectrum", ETNA 1 (1993) 11-32, algorithm of figure 3.1, preconditioned from the right.

use super::krylov::{Cycle, CycleEnd};
use crate::vector::{axpy, dot, norm, xpby};

/// Two vectors whose cosine is below this are orthogonal to working precision.
const COSINE_FLOOR: f64 = 1e-14;

/// A recurrence whose residual grew by this factor has lost its digits and starts anew.
const GROWTH_LIMIT: f64 = 1e8;

/// One run of BiCGStab(l) for `A d = r` from `d = 0`. `r` is overwritten; the shadow residual is the first `r`.
pub(crate) fn bicgstab_cycle(cycle: &mut Cycle<'_>, l: usize, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
    let mut state = State::new(l, r);
    let end = state.run(cycle);
    // The recurrences run in y with d = M^-1 y.
    cycle.precondition(&state.y, d);
    end
}

struct State {
    l: usize,
    shadow: Vec<f64>,
    shadow_norm: f64,
    y: Vec<f64>,
    /// Residuals `r_0 .. r_l` and directions `u_0 .. u_l`, the higher ones products with the operator.
    r: Vec<Vec<f64>>,
    u: Vec<Vec<f64>>,
    z: Vec<f64>,
    rho: f64,
    alpha: f64,
    omega: f64,
}

impl State {
    fn new(l: usize, r: &[f64]) -> Self {
        let zeros = vec![0.0; r.len()];
        let mut residuals = vec![zeros.clone(); l + 1];
        residuals[0].copy_from_slice(r);
        Self {
            l,
            shadow: r.to_vec(),
            shadow_norm: norm(r),
            y: zeros.clone(),
            r: residuals,
            u: vec![zeros.clone(); l + 1],
            z: zeros,
            rho: 1.0,
            alpha: 0.0,
            omega: 1.0,
        }
    }

    fn run(&mut self, cycle: &mut Cycle<'_>) -> CycleEnd {
        let start = self.shadow_norm;
        loop {
            if cycle.is_spent() {
                return CycleEnd::Budget;
            }
            let step = self.bicg_part(cycle).and_then(|()| self.minimise());
            let size = norm(&self.r[0]);
            cycle.record(size);
            if let Err(what) = step {
                return CycleEnd::BreakDown(what);
            }
            if size <= cycle.target {
                return CycleEnd::Claimed;
            }
            if size.is_nan() || size > GROWTH_LIMIT * start {
                return CycleEnd::BreakDown("the residual of the recurrence grew without bound");
            }
        }
    }

    /// `l` steps of BiCG.
    fn bicg_part(&mut self, cycle: &mut Cycle<'_>) -> Result<(), &'static str> {
        self.rho *= -self.omega;
        for j in 0..self.l {
            let rho = dot(&self.r[j], &self.shadow);
            if rho.abs() <= COSINE_FLOOR * self.shadow_norm * norm(&self.r[j]) || self.rho == 0.0 {
                return Err("the residual became orthogonal to the shadow residual");
            }
            let beta = self.alpha * rho / self.rho;
            self.rho = rho;
            for i in 0..=j {
                xpby(&self.r[i], -beta, &mut self.u[i]);
            }
            let (known, next) = self.u.split_at_mut(j + 1);
            cycle.apply(&known[j], &mut self.z, &mut next[0]);
            let sigma = dot(&next[0], &self.shadow);
            if sigma.abs() <= COSINE_FLOOR * self.shadow_norm * norm(&next[0]) {
                return Err("the search direction became orthogonal to the shadow residual");
            }
            self.alpha = rho / sigma;
            for i in 0..=j {
                axpy(-self.alpha, &self.u[i + 1], &mut self.r[i]);
            }
            axpy(self.alpha, &self.u[0], &mut self.y);
            let (known, next) = self.r.split_at_mut(j + 1);
            cycle.apply(&known[j], &mut self.z, &mut next[0]);
        }
        Ok(())
    }

    /// The polynomial of degree `l` that minimises the residual, by modified Gram-Schmidt on `r_1 .. r_l`.
    fn minimise(&mut self) -> Result<(), &'static str> {
        let l = self.l;
        let mut tau = vec![vec![0.0; l + 1]; l + 1];
        let (mut sigma, mut first) = (vec![0.0; l + 1], vec![0.0; l + 1]);
        for j in 1..=l {
            let (before, rest) = self.r.split_at_mut(j);
            for i in 1..j {
                tau[i][j] = dot(&rest[0], &before[i]) / sigma[i];
                axpy(-tau[i][j], &before[i], &mut rest[0]);
            }
            sigma[j] = dot(&rest[0], &rest[0]);
            if sigma[j] == 0.0 || !sigma[j].is_finite() {
                // The Krylov space is exhausted: the BiCG part has the solution, or there is none in it.
                return Err("the residuals became linearly dependent");
            }
            first[j] = dot(&before[0], &rest[0]) / sigma[j];
        }
        let mut gamma = first.clone();
        for j in (1..l).rev() {
            gamma[j] = first[j] - (j + 1..=l).map(|i| tau[j][i] * gamma[i]).sum::<f64>();
        }
        self.omega = gamma[l];
        if self.omega == 0.0 {
            return Err("the minimising polynomial lost its leading coefficient");
        }
        let (r0, rest) = self.r.split_at_mut(1);
        let (u0, u) = self.u.split_at_mut(1);
        axpy(gamma[1], &r0[0], &mut self.y);
        for j in 1..l {
            let second = gamma[j + 1] + (j + 1..l).map(|i| tau[j][i] * gamma[i + 1]).sum::<f64>();
            axpy(second, &rest[j - 1], &mut self.y);
        }
        for j in 1..=l {
            axpy(-first[j], &rest[j - 1], &mut r0[0]);
            axpy(-gamma[j], &u[j - 1], &mut u0[0]);
        }
        Ok(())
    }
}
