//! BiCGStab(l): G. L. G. Sleijpen and D. R. Fokkema, "BiCGstab(l) for linear equations involving unsymmetric
//! matrices with complex spectrum", ETNA 1 (1993) 11-32, algorithm of figure 3.1, preconditioned from the right.

use super::krylov::{Cycle, CycleEnd};
use crate::vector::{axpy, dot, mixed_bit, norm, xpby};

/// Two vectors whose cosine is below this are orthogonal to working precision.
const COSINE_FLOOR: f64 = 1e-14;

/// A recurrence whose residual grew by this factor has lost its digits and starts anew.
const GROWTH_LIMIT: f64 = 1e8;

/// A residual that orthogonalisation shortens below this depends on those before it: the space is exhausted up to
/// what a restart repairs.
const DEPENDENT: f64 = 1e-10;

/// One run of BiCGStab(l) for `A d = r` from `d = 0`. The shadow residual is the first `r`, mixed with one that knows
/// nothing of the problem where a cycle before this one failed.
pub(crate) fn bicgstab_cycle(cycle: &mut Cycle<'_>, l: usize, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
    let mut state = State::new(l, r);
    if cycle.attempt > 0 {
        let size = state.shadow_norm / (r.len() as f64).sqrt();
        for (i, s) in state.shadow.iter_mut().enumerate() {
            *s += if mixed_bit((i as u64) << 8 | cycle.attempt as u64) { size } else { -size };
        }
        state.shadow_norm = norm(&state.shadow);
    }
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
        let start = norm(&self.r[0]);
        loop {
            if cycle.is_spent() {
                return CycleEnd::Budget;
            }
            let (steps, mut broken) = self.bicg_part(cycle);
            // Even a step that broke off has residuals to minimise over.
            broken = broken.or(self.minimise(steps).err());
            let size = norm(&self.r[0]);
            cycle.record(size);
            if size <= cycle.target || (steps < self.l && broken.is_none()) {
                return CycleEnd::Claimed;
            }
            if let Some(what) = broken {
                return CycleEnd::BreakDown(what);
            }
            if size.is_nan() || size > GROWTH_LIMIT * start {
                return CycleEnd::BreakDown("the residual of the recurrence grew without bound");
            }
        }
    }

    /// `l` steps of BiCG, or fewer, and then why.
    fn bicg_part(&mut self, cycle: &mut Cycle<'_>) -> (usize, Option<&'static str>) {
        self.rho *= -self.omega;
        for j in 0..self.l {
            let rho = dot(&self.r[j], &self.shadow);
            if rho.abs() <= COSINE_FLOOR * self.shadow_norm * norm(&self.r[j]) || self.rho == 0.0 {
                return (j, Some("the residual became orthogonal to the shadow residual"));
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
                return (j, Some("the search direction became orthogonal to the shadow residual"));
            }
            self.alpha = rho / sigma;
            for i in 0..=j {
                axpy(-self.alpha, &self.u[i + 1], &mut self.r[i]);
            }
            axpy(self.alpha, &self.u[0], &mut self.y);
            let (known, next) = self.r.split_at_mut(j + 1);
            cycle.apply(&known[j], &mut self.z, &mut next[0]);
            if norm(&self.r[0]) <= cycle.target {
                return (j + 1, None);
            }
        }
        (self.l, None)
    }

    /// The polynomial of degree `steps` that minimises the residual, by modified Gram-Schmidt on `r_1 .. r_steps`; of a
    /// lower degree where they are dependent, which is an error that only a restart mends.
    fn minimise(&mut self, steps: usize) -> Result<(), &'static str> {
        let mut l = steps;
        let mut dependent = false;
        let mut tau = vec![vec![0.0; l + 1]; l + 1];
        let (mut sigma, mut first) = (vec![0.0; l + 1], vec![0.0; l + 1]);
        for j in 1..=steps {
            let (before, rest) = self.r.split_at_mut(j);
            let length = norm(&rest[0]);
            for i in 1..j {
                tau[i][j] = dot(&rest[0], &before[i]) / sigma[i];
                axpy(-tau[i][j], &before[i], &mut rest[0]);
            }
            sigma[j] = dot(&rest[0], &rest[0]);
            if sigma[j].sqrt() <= DEPENDENT * length || !sigma[j].is_finite() {
                (l, dependent) = (j - 1, true);
                break;
            }
            first[j] = dot(&before[0], &rest[0]) / sigma[j];
        }
        if l > 0 {
            self.apply_polynomial(l, &tau, &first);
        }
        if dependent {
            return Err("the residuals became linearly dependent");
        }
        if self.omega == 0.0 {
            return Err("the minimising polynomial lost its leading coefficient");
        }
        Ok(())
    }

    /// Applies the polynomial of degree `l` to solution, residual and direction.
    fn apply_polynomial(&mut self, l: usize, tau: &[Vec<f64>], first: &[f64]) {
        let mut gamma = first.to_vec();
        for j in (1..l).rev() {
            gamma[j] = first[j] - (j + 1..=l).map(|i| tau[j][i] * gamma[i]).sum::<f64>();
        }
        self.omega = gamma[l];
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
    }
}
