//! Cycles through the levels.

use super::{CycleKind, Multigrid};
use crate::vector::{axpy, dot, norm};

/// One inner iteration is enough where it reduces the residual to this part (Notay and Vassilevski, Numer. Linear Algebra
/// Appl. 15, 2008, section 4).
const INNER_ENOUGH: f64 = 0.25;

impl Multigrid {
    /// Elements of scratch for the levels from `level` on.
    pub(super) fn scratch_from(&self, level: usize) -> usize {
        let Some(this) = self.levels.get(level) else { return 0 };
        let (n, coarse) = (this.a.n(), this.p.ncols());
        let vectors = match self.params.cycle {
            CycleKind::V => 0,
            CycleKind::W => 2,
            CycleKind::K => 4,
        };
        this.smoother.scratch_len(n) + (2 + vectors) * coarse + self.scratch_from(level + 1)
    }

    /// One cycle for `A_level x = b` from `x = 0`.
    pub(super) fn cycle(&self, level: usize, b: &[f64], x: &mut [f64], scratch: &mut [f64]) {
        let Some(this) = self.levels.get(level) else { return self.coarse.solve(b, x) };
        let (n, coarse) = (this.a.n(), this.p.ncols());
        let (t, scratch) = scratch.split_at_mut(this.smoother.scratch_len(n));
        let (b_coarse, scratch) = scratch.split_at_mut(coarse);
        let (x_coarse, scratch) = scratch.split_at_mut(coarse);
        this.smoother.first(&this.a, b, x, t);
        for _ in 1..self.params.sweeps {
            this.smoother.before(&this.a, b, x, t);
        }
        let r = &mut t[..n];
        this.a.residual(x, b, r);
        if level == 0 {
            self.frame.weigh(r);
        }
        this.r.mul_vec(r, b_coarse);
        self.correct(level + 1, b_coarse, x_coarse, scratch);
        match level {
            0 => this.p.add_to(x_coarse, x, |i| self.frame.unit(i)),
            _ => this.p.add_to(x_coarse, x, |_| 1.0),
        }
        for _ in 0..self.params.sweeps {
            this.smoother.after(&this.a, b, x, t);
        }
    }

    /// The correction on a coarse level, as the kind of cycle has it.
    fn correct(&self, level: usize, b: &[f64], x: &mut [f64], scratch: &mut [f64]) {
        let Some(this) = self.levels.get(level) else { return self.coarse.solve(b, x) };
        let n = b.len();
        match self.params.cycle {
            CycleKind::V => self.cycle(level, b, x, scratch),
            CycleKind::W => {
                let (r, scratch) = scratch.split_at_mut(n);
                self.cycle(level, b, x, scratch);
                this.a.residual(x, b, r);
                let (d, scratch) = scratch.split_at_mut(n);
                self.cycle(level, r, d, scratch);
                axpy(1.0, d, x);
            }
            CycleKind::K => self.inner(level, b, x, scratch),
        }
    }

    /// At most two steps of the generalised conjugate residual method, preconditioned by a cycle.
    fn inner(&self, level: usize, b: &[f64], x: &mut [f64], scratch: &mut [f64]) {
        let (n, a) = (b.len(), &self.levels[level].a);
        let (v, scratch) = scratch.split_at_mut(n);
        let (w, scratch) = scratch.split_at_mut(n);
        let (d, scratch) = scratch.split_at_mut(n);
        let (r, scratch) = scratch.split_at_mut(n);
        self.cycle(level, b, x, scratch);
        a.mul_vec(x, v);
        let vv = dot(v, v);
        if vv == 0.0 || !vv.is_finite() {
            return;
        }
        let alpha = dot(v, b) / vv;
        r.copy_from_slice(b);
        axpy(-alpha, v, r);
        x.iter_mut().for_each(|x| *x *= alpha);
        if norm(r) <= INNER_ENOUGH * norm(b) {
            return;
        }
        self.cycle(level, r, d, scratch);
        a.mul_vec(d, w);
        let gamma = dot(w, v) / vv;
        axpy(-gamma, v, w);
        let ww = dot(w, w);
        if ww == 0.0 || !ww.is_finite() {
            return;
        }
        let beta = dot(w, r) / ww;
        // x holds alpha c, and the direction that belongs to w is d - gamma c.
        let kept = if alpha == 0.0 { 1.0 } else { 1.0 - beta * gamma / alpha };
        x.iter_mut().for_each(|x| *x *= kept);
        axpy(beta, d, x);
    }
}
