//! IDR(s) with biorthogonality: M. B. van Gijzen and P. Sonneveld, ACM Trans. Math. Softw. 38 (2011) 5, preconditioned from the
//! right. Each cycle of the recurrence is `s + 1` products, and `2 s + 3` vectors are kept beside those of the shadow space.

use super::krylov::{Cycle, CycleEnd};
use crate::vector::{axpy, dot, mixed_bit, norm};

/// Below this cosine between the residual and its product the minimising step is lengthened, as the authors do (section 3.2).
const LEAST_COSINE: f64 = 0.7;

/// A pivot below this part of the sizes of what it is the product of has vanished.
const PIVOT_FLOOR: f64 = 1e-14;

/// A recurrence whose residual grew by this factor has lost its digits and starts anew.
const GROWTH_LIMIT: f64 = 1e8;

/// One run of IDR(s) for `A d = r` from `d = 0`.
pub(crate) fn idr_cycle(cycle: &mut Cycle<'_>, s: usize, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
    let s = s.min(r.len());
    let start = norm(r);
    let mut state = State::new(s, r.len(), cycle.attempt);
    loop {
        match state.step(cycle, r, d) {
            Some(end) => return end,
            None => {
                let size = norm(r);
                if size.is_nan() || size > GROWTH_LIMIT * start {
                    return CycleEnd::BreakDown("the residual of the recurrence grew without bound");
                }
            }
        }
    }
}

struct State {
    /// Orthonormal vectors that know nothing of the problem.
    shadow: Vec<Vec<f64>>,
    /// `g_k = A u_k`
    g: Vec<Vec<f64>>,
    u: Vec<Vec<f64>>,
    /// `m[i][k] = shadow_i . g_k`, lower triangular.
    m: Vec<Vec<f64>>,
    omega: f64,
    v: Vec<f64>,
    t: Vec<f64>,
}

impl State {
    fn new(s: usize, n: usize, attempt: usize) -> Self {
        let zeros = || vec![vec![0.0; n]; s];
        let mut m = vec![vec![0.0; s]; s];
        (0..s).for_each(|k| m[k][k] = 1.0);
        let (v, t) = (vec![0.0; n], vec![0.0; n]);
        Self { shadow: shadow_space(s, n, attempt), g: zeros(), u: zeros(), m, omega: 1.0, v, t }
    }

    /// One cycle through the shadow space. Why it ended, if it did.
    fn step(&mut self, cycle: &mut Cycle<'_>, r: &mut [f64], d: &mut [f64]) -> Option<CycleEnd> {
        let s = self.shadow.len();
        let mut f: Vec<f64> = self.shadow.iter().map(|p| dot(p, r)).collect();
        for k in 0..s {
            if cycle.is_spent() {
                return Some(CycleEnd::Budget);
            }
            self.direction(cycle, k, &f, r);
            let floor = PIVOT_FLOOR * norm(&self.g[k]);
            let pivot = self.m[k][k];
            if pivot.is_nan() || pivot.abs() <= floor {
                return Some(CycleEnd::BreakDown("a direction became orthogonal to the shadow space"));
            }
            let beta = f[k] / pivot;
            axpy(-beta, &self.g[k], r);
            axpy(beta, &self.u[k], d);
            if let Some(end) = ended(cycle, r) {
                return Some(end);
            }
            f[k] = 0.0;
            (k + 1..s).for_each(|i| f[i] -= beta * self.m[i][k]);
        }
        if cycle.is_spent() {
            return Some(CycleEnd::Budget);
        }
        self.minimise(cycle, r, d)
    }

    /// The next direction `u_k` with `g_k = A u_k`, orthogonal to the shadow vectors before `k`.
    fn direction(&mut self, cycle: &mut Cycle<'_>, k: usize, f: &[f64], r: &[f64]) {
        let s = self.shadow.len();
        let mut c = f[k..].to_vec();
        for i in 0..c.len() {
            for j in 0..i {
                c[i] -= self.m[k + i][k + j] * c[j];
            }
            c[i] /= self.m[k + i][k + i];
        }
        self.t.copy_from_slice(r);
        for (c, g) in c.iter().zip(&self.g[k..]) {
            axpy(-c, g, &mut self.t);
        }
        cycle.precondition(&self.t, &mut self.v);
        // u_k enters its own successor.
        let factor = c[0];
        self.u[k].iter_mut().for_each(|u| *u *= factor);
        let (own, others) = self.u[k..].split_at_mut(1);
        for (c, u) in c[1..].iter().zip(&*others) {
            axpy(*c, u, &mut own[0]);
        }
        axpy(self.omega, &self.v, &mut own[0]);
        cycle.a.apply(&self.u[k], &mut self.g[k]);
        cycle.products += 1;
        for i in 0..k {
            let alpha = dot(&self.shadow[i], &self.g[k]) / self.m[i][i];
            let (before, own) = self.g.split_at_mut(k);
            axpy(-alpha, &before[i], &mut own[0]);
            let (before, own) = self.u.split_at_mut(k);
            axpy(-alpha, &before[i], &mut own[0]);
        }
        (k..s).for_each(|i| self.m[i][k] = dot(&self.shadow[i], &self.g[k]));
    }

    /// The step into the next space: the residual as short as its own product makes it.
    fn minimise(&mut self, cycle: &mut Cycle<'_>, r: &mut [f64], d: &mut [f64]) -> Option<CycleEnd> {
        cycle.apply(r, &mut self.v, &mut self.t);
        let (rr, tt, tr) = (norm(r), norm(&self.t), dot(&self.t, r));
        let cosine = (tr / (rr * tt)).abs();
        self.omega = tr / (tt * tt);
        if self.omega.is_nan() || cosine <= PIVOT_FLOOR {
            return Some(CycleEnd::BreakDown("the residual became orthogonal to its product"));
        }
        if cosine < LEAST_COSINE {
            self.omega *= LEAST_COSINE / cosine;
        }
        axpy(-self.omega, &self.t, r);
        axpy(self.omega, &self.v, d);
        ended(cycle, r)
    }
}

fn ended(cycle: &mut Cycle<'_>, r: &[f64]) -> Option<CycleEnd> {
    let size = norm(r);
    cycle.record(size);
    (size <= cycle.target).then_some(CycleEnd::Claimed)
}

/// `s` orthonormal vectors of `n` elements, others at every attempt.
fn shadow_space(s: usize, n: usize, attempt: usize) -> Vec<Vec<f64>> {
    let sign = |i: usize, k: usize| {
        let seed = (i as u64) << 16 | (attempt as u64 & 0xff) << 8 | k as u64;
        if mixed_bit(seed) { 1.0 } else { -1.0 }
    };
    let mut space: Vec<Vec<f64>> = Vec::with_capacity(s);
    for k in 0..s {
        let mut p: Vec<f64> = (0..n).map(|i| sign(i, k)).collect();
        for _pass in 0..2 {
            for q in &space {
                let component = dot(q, &p);
                axpy(-component, q, &mut p);
            }
        }
        let length = norm(&p);
        if length > PIVOT_FLOOR.sqrt() {
            p.iter_mut().for_each(|p| *p /= length);
            space.push(p);
        }
    }
    space
}
