//! GMRES (Saad and Schultz 1986), preconditioned from the right, flexible where the
//! preconditioner changes (Saad, SIAM J. Sci. Comput. 14, 1993), by modified Gram-Schmidt with a second pass where
//! the first one cancelled (Daniel, Gragg, Kaufman and Stewart 1976).

use super::krylov::{Cycle, CycleEnd};
use crate::vector::{axpy, dot, norm};

/// A vector that orthogonalisation shortens below this factor is orthogonalised again; 1/sqrt(2) is the usual
/// choice, with which two passes suffice.
const REORTHOGONALISE_BELOW: f64 = 0.717;

/// A new direction shorter than this, relative to what was orthogonalised, is rounding: the space is exhausted.
const EXHAUSTED: f64 = 1e-15;

/// One cycle of at most `restart` steps for `A d = r` from `d = 0`. `r` is overwritten.
pub(crate) fn gmres_cycle(cycle: &mut Cycle<'_>, restart: usize, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
    let n = r.len();
    let beta = norm(r);
    let mut basis = vec![scaled(r, 1.0 / beta)];
    let mut triangle = Triangle::new(beta);
    let flexible = !cycle.m.is_linear();
    let mut directions = Vec::new();
    let mut z = vec![0.0; n];
    let mut end = CycleEnd::Restart;
    while triangle.columns.len() < restart {
        if cycle.is_spent() {
            end = CycleEnd::Budget;
            break;
        }
        let mut w = vec![0.0; n];
        if flexible {
            cycle.precondition(&basis[basis.len() - 1], &mut z);
            directions.push(rounded(&mut z));
            cycle.multiply(&z, &mut w);
        } else {
            cycle.apply(&basis[basis.len() - 1], &mut z, &mut w);
        }
        let before = norm(&w);
        let mut column = orthogonalise(&basis, &mut w, before);
        let length = norm(&w);
        let exhausted = length.is_nan() || length <= EXHAUSTED * before;
        column.push(if exhausted { 0.0 } else { length });
        let size = triangle.push(column);
        cycle.record(size);
        if size <= cycle.target {
            end = CycleEnd::Claimed;
            break;
        }
        if exhausted {
            end = CycleEnd::BreakDown("the Krylov space is exhausted: the matrix seems singular");
            break;
        }
        basis.push(scaled(&w, 1.0 / length));
    }
    if flexible {
        for (y, direction) in triangle.solve().iter().zip(&directions) {
            z.iter_mut().zip(direction).for_each(|(z, &x)| *z = f64::from(x));
            axpy(*y, &z, d);
        }
        return end;
    }
    r.fill(0.0);
    for (y, v) in triangle.solve().iter().zip(&basis) {
        axpy(*y, v, r);
    }
    cycle.precondition(r, d);
    end
}

/// Rounds a direction to single precision, in which it is kept: a preconditioner that changes from step to step may do that, too,
/// as products are made with what is left.
fn rounded(z: &mut [f64]) -> Vec<f32> {
    let single = z.iter().map(|&z| z as f32).collect::<Vec<f32>>();
    z.iter_mut().zip(&single).for_each(|(z, &x)| *z = f64::from(x));
    single
}

fn scaled(x: &[f64], factor: f64) -> Vec<f64> {
    x.iter().map(|x| x * factor).collect()
}

/// Removes the components of `w` along the basis and gives them.
fn orthogonalise(basis: &[Vec<f64>], w: &mut [f64], before: f64) -> Vec<f64> {
    let mut column = vec![0.0; basis.len()];
    let mut length = before;
    for _pass in 0..2 {
        for (h, v) in column.iter_mut().zip(basis) {
            let component = dot(w, v);
            axpy(-component, v, w);
            *h += component;
        }
        let shortened = norm(w);
        if shortened >= REORTHOGONALISE_BELOW * length {
            break;
        }
        length = shortened;
    }
    column
}

/// The Hessenberg matrix, triangular by Givens rotations, with its right-hand side.
struct Triangle {
    columns: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    rhs: Vec<f64>,
}

impl Triangle {
    fn new(beta: f64) -> Self {
        Self { columns: Vec::new(), rotations: Vec::new(), rhs: vec![beta] }
    }

    /// Appends a column of the Hessenberg matrix and gives the norm of the residual.
    fn push(&mut self, mut h: Vec<f64>) -> f64 {
        let k = self.columns.len();
        for (i, &(c, s)) in self.rotations.iter().enumerate() {
            (h[i], h[i + 1]) = (c * h[i] + s * h[i + 1], c * h[i + 1] - s * h[i]);
        }
        let length = h[k].hypot(h[k + 1]);
        let (c, s) = if length == 0.0 { (1.0, 0.0) } else { (h[k] / length, h[k + 1] / length) };
        h[k] = length;
        h.truncate(k + 1);
        let g = self.rhs[k];
        self.rhs[k] = c * g;
        self.rhs.push(-s * g);
        self.rotations.push((c, s));
        self.columns.push(h);
        (s * g).abs()
    }

    /// Back substitution; a zero pivot, which only a singular matrix gives, leaves its direction out.
    fn solve(&self) -> Vec<f64> {
        let k = self.columns.len();
        let mut y = self.rhs[..k].to_vec();
        for j in (0..k).rev() {
            let pivot = self.columns[j][j];
            y[j] = if pivot == 0.0 { 0.0 } else { y[j] / pivot };
            for i in 0..j {
                y[i] -= self.columns[j][i] * y[j];
            }
        }
        y
    }
}
