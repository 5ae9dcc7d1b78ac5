//! Least squares under linear constraints, and what functionals of the solution look like.

use crate::StencilError;
use crate::fit::REPRODUCTION_TOLERANCE;
use crate::qr::Qr;

/// Smallest diagonal entry of R, relative to the largest, that is taken as different from zero.
const RANK_TOLERANCE: f64 = 1e-11;

/// A least-squares problem with equality constraints: `min sum_p w_p^2 (a_p . z - u_p)^2` under `c_k . z = d_k`.
///
/// The unknowns z are coefficients of whatever is fitted, one polynomial or several that are coupled by the constraints.
/// What is wanted is never z itself but functionals `v . z`, as linear combinations of the data:
/// `v . z = sum_p e_p u_p + sum_k f_k d_k`. Both factorisations (of the constraints, and of the observations on the null
/// space of the constraints) reveal the rank: constraints may depend on each other, and z need not be determined as
/// long as `v . z` is. The method is that of the null space (Golub and Van Loan, *Matrix Computations*, 4th ed., 6.2.2).
///
/// The struct is the memory of one thread: nothing is allocated once it has grown.
///
/// ```
/// use meshless_stencils::ConstrainedFit;
///
/// // A parabola a + b x + c x^2 with slope d at 0, through values at -1, 1 and 2.
/// let mut fit = ConstrainedFit::default();
/// fit.clear(3);
/// for x in [-1.0, 1.0, 2.0_f64] {
///     fit.observe(1.0).copy_from_slice(&[1.0, x, x * x]);
/// }
/// fit.constrain().copy_from_slice(&[0.0, 1.0, 0.0]);
/// fit.factor();
/// let (mut e, mut f) = ([0.0; 3], [0.0; 1]);
/// fit.functional(&[1.0, 0.0, 0.0], &mut e, &mut f)?;
/// // For u = 4 + 5 x + 6 x^2 the value at 0 is 4.
/// let value = e[0] * 5.0 + e[1] * 15.0 + e[2] * 38.0 + f[0] * 5.0;
/// assert!((value - 4.0).abs() < 1e-12);
/// # Ok::<(), meshless_stencils::StencilError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct ConstrainedFit {
    unknowns: usize,
    /// Rows `a_p`, one after the other.
    observations: Vec<f64>,
    weights: Vec<f64>,
    /// Rows `c_k`, one after the other.
    constraints: Vec<f64>,
    constraint_count: usize,
    outer: Qr,
    inner: Qr,
    rotated: Vec<f64>,
    z: Vec<f64>,
    solved: Vec<f64>,
    remainder: f64,
}

impl ConstrainedFit {
    /// Forgets everything; the next problem has this many unknowns.
    pub fn clear(&mut self, unknowns: usize) {
        self.unknowns = unknowns;
        self.observations.clear();
        self.weights.clear();
        self.constraints.clear();
        self.constraint_count = 0;
    }

    /// Adds an observation of this weight, and returns its row, zeros, to be filled.
    pub fn observe(&mut self, weight: f64) -> &mut [f64] {
        self.weights.push(weight);
        append(&mut self.observations, self.unknowns)
    }

    /// Adds a constraint, and returns its row, zeros, to be filled; rows should be of about the same size.
    pub fn constrain(&mut self) -> &mut [f64] {
        self.constraint_count += 1;
        append(&mut self.constraints, self.unknowns)
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Number of observations.
    pub fn observations(&self) -> usize {
        self.weights.len()
    }

    /// Number of constraints.
    pub fn constraints(&self) -> usize {
        self.constraint_count
    }

    /// Factors constraints and observations.
    pub fn factor(&mut self) {
        let m = self.unknowns;
        self.outer.resize(m, self.constraint_count);
        for (k, row) in self.constraints.chunks_exact(m).enumerate() {
            self.outer.column_mut(k).copy_from_slice(row);
        }
        self.outer.factor_pivoted(RANK_TOLERANCE);
        self.fill();
        if !self.inner.factor(RANK_TOLERANCE) {
            self.fill();
            self.inner.factor_pivoted(RANK_TOLERANCE);
        }
    }

    /// Writes the weighted observations in terms of the null space of the constraints into the inner factorisation.
    fn fill(&mut self) {
        let (m, fixed) = (self.unknowns, self.outer.rank());
        self.inner.resize(self.weights.len(), m - fixed);
        self.rotated.resize(m, 0.0);
        for (p, (row, weight)) in self.observations.chunks_exact(m).zip(&self.weights).enumerate() {
            self.rotated.copy_from_slice(row);
            self.outer.apply_transpose(&mut self.rotated);
            for (column, value) in self.rotated[fixed..].iter().enumerate() {
                self.inner.column_mut(column)[p] = weight * value;
            }
        }
    }

    /// What was left of the reproduction of the last functional, relative to its largest entry: not zero where the data do not
    /// determine all unknowns.
    pub fn remainder(&self) -> f64 {
        self.remainder
    }

    /// The functional `v . z` in terms of the data: `on_observations[p]` multiplies `u_p`, `on_constraints[k]`
    /// multiplies `d_k`. Call [`ConstrainedFit::factor`] before.
    ///
    /// # Errors
    /// [`StencilError::Unresolvable`] where the data do not determine it, and lengths that do not agree.
    pub fn functional(
        &mut self,
        v: &[f64],
        on_observations: &mut [f64],
        on_constraints: &mut [f64],
    ) -> Result<(), StencilError> {
        let (m, fixed, points) = (self.unknowns, self.outer.rank(), self.weights.len());
        check("unknowns", v.len(), m)?;
        check("observations", on_observations.len(), points)?;
        check("constraints", on_constraints.len(), self.constraint_count)?;
        self.rotated.clear();
        self.rotated.extend_from_slice(v);
        self.outer.apply_transpose(&mut self.rotated);
        self.z.resize(m, 0.0);
        let remainder =
            self.inner.least_norm(&self.rotated[fixed..], &mut self.z[..m - fixed], on_observations);
        on_observations.iter_mut().zip(&self.weights).for_each(|(e, w)| *e *= w);
        let scale = v.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        self.remainder = if remainder > 0.0 { remainder / scale } else { 0.0 };
        if remainder > REPRODUCTION_TOLERANCE * scale || on_observations.iter().any(|e| !e.is_finite()) {
            let rank = fixed + self.inner.rank();
            return Err(StencilError::Unresolvable {
                points,
                monomials: m,
                rank,
                remainder: remainder / scale,
            });
        }
        // What the observations leave of v lies in the span of the constraints.
        self.rotated.copy_from_slice(v);
        for (row, e) in self.observations.chunks_exact(m).zip(on_observations.iter()) {
            self.rotated.iter_mut().zip(row).for_each(|(r, a)| *r -= e * a);
        }
        self.outer.apply_transpose(&mut self.rotated);
        self.solved.resize(self.constraint_count, 0.0);
        self.outer.back_substitute(&self.rotated, &mut self.solved);
        on_constraints.copy_from_slice(&self.solved);
        Ok(())
    }
}

fn append(rows: &mut Vec<f64>, length: usize) -> &mut [f64] {
    let start = rows.len();
    rows.resize(start + length, 0.0);
    &mut rows[start..]
}

fn check(what: &'static str, given: usize, expected: usize) -> Result<(), StencilError> {
    if given == expected { Ok(()) } else { Err(StencilError::LengthMismatch { what, given, expected }) }
}
