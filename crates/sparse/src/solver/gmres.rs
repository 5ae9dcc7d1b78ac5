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

/// Vectors are kept in single precision once the residual is below this many targets: what rounding a vector adds in the end is 6e-8
/// of the residual before the step that gave it (Simoncini and Szyld, SIAM J. Sci. Comput. 25, 2003, for inexact products).
const SINGLE_BELOW: f64 = 2e5;

/// One cycle of at most `restart` steps for `A d = r` from `d = 0`. `r` is overwritten.
pub(crate) fn gmres_cycle(cycle: &mut Cycle<'_>, restart: usize, r: &mut [f64], d: &mut [f64]) -> CycleEnd {
    let beta = norm(r);
    let mut basis = Vec::new();
    let mut triangle = Triangle::new(beta);
    let flexible = !cycle.m.is_linear();
    let mut directions = Vec::new();
    let mut w = r.to_vec();
    let mut length = beta;
    let (mut size, mut size_before) = (beta, f64::INFINITY);
    let end = loop {
        if triangle.columns.len() == restart {
            break CycleEnd::Restart;
        }
        if cycle.is_spent() {
            break CycleEnd::Budget;
        }
        basis.push(Kept::normalised(&mut w, length, size_before <= SINGLE_BELOW * cycle.target));
        cycle.precondition(&w, r);
        if flexible {
            directions.push(rounded(r));
        }
        cycle.multiply(r, &mut w);
        let before = norm(&w);
        let mut column = orthogonalise(&basis, &mut w, before);
        length = norm(&w);
        let exhausted = length.is_nan() || length <= EXHAUSTED * before;
        column.push(if exhausted { 0.0 } else { length });
        size_before = std::mem::replace(&mut size, triangle.push(column));
        cycle.record(size);
        if size <= cycle.target {
            break CycleEnd::Claimed;
        }
        if exhausted {
            break CycleEnd::BreakDown("the Krylov space is exhausted: the matrix seems singular");
        }
    };
    drop(w);
    let combination = triangle.solve();
    if flexible {
        drop(basis);
        for (y, direction) in combination.iter().zip(&directions) {
            axpy(*y, direction, d);
        }
        return end;
    }
    r.fill(0.0);
    combination.iter().zip(&basis).for_each(|(y, v)| v.add_to(*y, r));
    drop(basis);
    cycle.precondition(r, d);
    end
}

/// A vector of the basis.
enum Kept {
    Double(Vec<f64>),
    Single(Vec<f32>),
}

impl Kept {
    /// Makes `w` a vector of length 1, as it is kept.
    fn normalised(w: &mut [f64], length: f64, single: bool) -> Self {
        let factor = 1.0 / length;
        w.iter_mut().for_each(|w| *w *= factor);
        if single { Self::Single(rounded(w)) } else { Self::Double(w.to_vec()) }
    }

    fn dot(&self, w: &[f64]) -> f64 {
        match self {
            Self::Double(v) => dot(w, v),
            Self::Single(v) => dot(w, v),
        }
    }

    /// `y += alpha v`
    fn add_to(&self, alpha: f64, y: &mut [f64]) {
        match self {
            Self::Double(v) => axpy(alpha, v, y),
            Self::Single(v) => axpy(alpha, v, y),
        }
    }
}

/// Rounds a vector to single precision, in which it is kept. As for directions: a preconditioner that changes from step to step may do
/// that, too, as products are made with what is left.
fn rounded(z: &mut [f64]) -> Vec<f32> {
    let single = z.iter().map(|&z| z as f32).collect::<Vec<f32>>();
    z.iter_mut().zip(&single).for_each(|(z, &x)| *z = f64::from(x));
    single
}

/// Removes the components of `w` along the basis and gives them.
fn orthogonalise(basis: &[Kept], w: &mut [f64], before: f64) -> Vec<f64> {
    let mut column = vec![0.0; basis.len()];
    let mut length = before;
    for _pass in 0..2 {
        for (h, v) in column.iter_mut().zip(basis) {
            let component = v.dot(w);
            v.add_to(-component, w);
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
