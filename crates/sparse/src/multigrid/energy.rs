//! Energy-minimising prolongation (L. N. Olson, J. B. Schroder and R. S. Tuminaro, SIAM J. Sci. Comput. 33, 2011).

use super::aggregation::Aggregates;
use super::prolongation;
use super::strength::Bonds;
use crate::csr::{Csr, for_each_row_of};
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::precond::Preconditioner;
use crate::solver::{Cycle, LinearOperator, cg_cycle, gmres_cycle};
use crate::vector::norm;

/// Steps of the Krylov method, as many as Olson et al. take.
const STEPS: usize = 4;

/// The prolongation whose columns have little energy: on the pattern of one Jacobi step, with rows that add up to 1, `A P` is
/// reduced by [`STEPS`] steps of a Krylov method for all columns at once; conjugate gradients where A is symmetric, which
/// minimise the sum of the energies `p . A p`, else GMRES, which minimises the residuals `D^-1 A p`. For a restriction of its
/// own the transpose is given.
///
/// # Errors
/// [`MatrixError::NotFinite`] where `D^-1 A` overflows.
pub(crate) fn minimized(a: &Csr, graph: &impl Bonds, aggregates: &Aggregates) -> Result<Csr, MatrixError> {
    let start = prolongation::smoothed(
        &DifferenceMatrix::from_csr(a)?,
        None,
        graph,
        aggregates,
        prolongation::Step::LONG,
    );
    let inverse: Vec<f64> = a.diagonal().into_iter().map(|d| if d == 0.0 { 1.0 } else { 1.0 / d }).collect();
    let symmetric = a.is_symmetric();
    let scaled = if symmetric { None } else { Some(a.row_scaled(&inverse)?) };
    let pattern = Pattern { a: scaled.as_ref().unwrap_or(a), p: &start };
    let mut residual = vec![0.0; start.nnz()];
    pattern.apply(start.values(), &mut residual);
    residual.iter_mut().for_each(|r| *r = -*r);
    let mut correction = vec![0.0; start.nnz()];
    if norm(&residual) > 0.0 {
        let scaling = RowScaling { inverse: symmetric.then_some(inverse), p: &start };
        let mut cycle = Cycle {
            a: &pattern,
            m: &scaling,
            target: 0.0,
            unit: 1.0,
            budget: STEPS,
            history: &mut Vec::new(),
            scratch: &mut [],
            products: 0,
            attempt: 0,
        };
        // What a cycle that breaks off has found serves as well.
        if symmetric {
            cg_cycle(&mut cycle, &mut residual, &mut correction);
        } else {
            gmres_cycle(&mut cycle, STEPS, &mut residual, &mut correction);
        }
    }
    let (offsets, indices, mut values) = start.into_parts();
    values.iter_mut().zip(&correction).for_each(|(p, d)| *p += d);
    Ok(Csr::from_trusted(aggregates.count, offsets, indices, values))
}

/// `A X` for matrices `X` of one pattern, cut down to that pattern, each row less its mean: so corrections have rows that add up
/// to nothing. Vectors hold the entries of `X`, row after row.
struct Pattern<'a> {
    a: &'a Csr,
    p: &'a Csr,
}

impl LinearOperator for Pattern<'_> {
    fn dim(&self) -> usize {
        self.p.nnz()
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        let (p, offsets) = (self.p, self.p.offsets());
        for_each_row_of(offsets, y, |i, y| {
            y.fill(0.0);
            let own = p.row(i).0;
            if own.len() < 2 {
                return;
            }
            let (columns, values) = self.a.row(i);
            for (&k, a_ik) in columns.iter().zip(values) {
                let k = k as usize;
                for (j, x) in p.row(k).0.iter().zip(&x[offsets[k]..offsets[k + 1]]) {
                    if let Ok(place) = own.binary_search(j) {
                        y[place] += a_ik * x;
                    }
                }
            }
            let mean = y.iter().sum::<f64>() / y.len() as f64;
            y.iter_mut().for_each(|y| *y -= mean);
        });
    }
}

/// Division by the diagonal, which is the same for all entries of a row; where that is none, nothing.
#[derive(Debug)]
struct RowScaling<'a> {
    inverse: Option<Vec<f64>>,
    p: &'a Csr,
}

impl Preconditioner for RowScaling<'_> {
    fn name(&self) -> String {
        "diagonal".to_owned()
    }

    fn apply(&self, r: &[f64], z: &mut [f64], _: &mut [f64]) {
        let Some(inverse) = &self.inverse else { return z.copy_from_slice(r) };
        let offsets = self.p.offsets();
        for_each_row_of(offsets, z, |i, z| {
            let r = &r[offsets[i]..offsets[i + 1]];
            z.iter_mut().zip(r).for_each(|(z, r)| *z = r * inverse[i]);
        });
    }
}
