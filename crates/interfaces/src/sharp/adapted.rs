//! Polynomials that solve the equation where it is more than the Laplacian, up to the degree of the fit (quasi-Trefftz functions).
//!
//! In `z = (x - x_i)/R` the equation is `lap Q + b . grad Q - c Q = g` with `b = grad ln eta - R v / eta` and `c = R^2 r / eta`, of a velocity v and a
//! reaction r. To each harmonic polynomial h belongs one solution `Q = h + P` of the homogeneous equation, P the polynomial of least norm
//! whose Laplacian is `y = c (h + P) - b . grad (h + P)`, as far as polynomials of the degree of the fit can say so; and one P belongs to each source.
//! With samples on the unit ball this is one small linear system for y a stencil, with a right-hand side for each function.

use meshless_stencils::Qr;

use super::basis::{Basis, Jet};
use super::dense::{self, dot};
use super::particular::{inverse_laplacian, pseudo_inverse, samples};

/// Condition of the system beyond which the equation is too far from the Laplacian over a stencil for its functions to be found.
const LARGEST_CONDITION: f64 = 1e4;

/// How much a sample of `ln eta` may differ from the polynomial that stands for it: more is a jump or a singularity.
const LARGEST_MISFIT: f64 = 0.05;

/// What the functions of all stencils share.
#[derive(Debug, Clone)]
pub(super) struct Adapted<const D: usize> {
    /// Monomials of the polynomials P.
    pub(super) basis: Basis<D>,
    /// Where the diffusivity and the source are sampled.
    pub(super) samples: Vec<[f64; D]>,
    /// Harmonic polynomials, one a function.
    functions: usize,
    /// A row a monomial of y: its coefficient in the least-squares polynomial through samples.
    fit: Vec<f64>,
    /// A row a monomial of P: its coefficient for monomials of y.
    inverse: Vec<f64>,
    /// A row a monomial: its coefficient in the polynomial, one degree higher than y, through samples of `ln eta`.
    logarithm: Vec<f64>,
    /// A row a sample: the monomials of this polynomial, and their derivatives.
    values: Vec<f64>,
    slopes: [Vec<f64>; D],
    /// A row a sample: derivatives of P for the monomials of y, then those of the harmonic polynomials.
    derivatives: [Vec<f64>; D],
    /// The values of the same.
    undifferentiated: Vec<f64>,
}

/// The terms of lower order in the units of a stencil, at the samples; empty where there are none.
#[derive(Debug, Clone, Default)]
pub(super) struct LowerTerms<const D: usize> {
    /// `R v / eta`, a list for each axis.
    pub(super) velocity: Option<[Vec<f64>; D]>,
    /// `R^2 r / eta`.
    pub(super) reaction: Option<Vec<f64>>,
}

/// Memory of one thread.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    qr: Qr,
    /// `ln eta` at the samples, the polynomial through them, and one component of its gradient there.
    logarithm: Vec<f64>,
    polynomial: Vec<f64>,
    slope: Vec<f64>,
    /// `b . grad` of everything at the samples, and its coefficients.
    convected: Vec<f64>,
    fitted: Vec<f64>,
    right: Vec<f64>,
    solved: Vec<f64>,
    y: Vec<f64>,
    lacks: Vec<f64>,
}

impl<const D: usize> Adapted<D> {
    /// For harmonic polynomials up to a degree and y up to another.
    pub(super) fn new(harmonic: &Basis<D>, degree: usize) -> Self {
        let (right, basis) = (Basis::complete(degree), Basis::complete(degree + 2));
        let samples = samples(right.len());
        let inverse = inverse_laplacian(&right, &basis);
        let (count, functions, n) = (right.len(), harmonic.len(), samples.len());
        let width = count + functions;
        let mut derivatives: [Vec<f64>; D] = std::array::from_fn(|_| vec![0.0; n * width]);
        let mut undifferentiated = vec![0.0; n * width];
        let (mut monomials, mut harmonics) = (Jet::default(), Jet::default());
        for (k, z) in samples.iter().enumerate() {
            basis.evaluate(z, &mut monomials);
            harmonic.evaluate(z, &mut harmonics);
            for (axis, table) in derivatives.iter_mut().enumerate() {
                let row = &mut table[k * width..(k + 1) * width];
                for (gradient, factors) in monomials.gradients.iter().zip(inverse.chunks_exact(count)) {
                    row.iter_mut().zip(factors).for_each(|(entry, factor)| *entry += gradient[axis] * factor);
                }
                row[count..].iter_mut().zip(&harmonics.gradients).for_each(|(entry, g)| *entry = g[axis]);
            }
            let row = &mut undifferentiated[k * width..(k + 1) * width];
            for (value, factors) in monomials.values.iter().zip(inverse.chunks_exact(count)) {
                row.iter_mut().zip(factors).for_each(|(entry, factor)| *entry += value * factor);
            }
            row[count..].copy_from_slice(&harmonics.values);
        }
        let through = Basis::complete(degree + 1);
        let logarithm = pseudo_inverse(&through, &samples);
        let (values, slopes) = tables(&through, &samples);
        let fit = pseudo_inverse(&right, &samples);
        Self {
            basis,
            functions,
            fit,
            inverse,
            logarithm,
            values,
            slopes,
            derivatives,
            undifferentiated,
            samples,
        }
    }

    /// The functions of a stencil with these diffusivities and terms of lower order at the samples, and the particular parts of `sources` there: a row a
    /// monomial of P with its coefficient in each function, then one after the other the coefficients for the sources. False where the
    /// diffusivity is no smooth positive function.
    pub(super) fn solve(
        &self,
        (eta, lower): (&[f64], &LowerTerms<D>),
        sources: &[&[f64]],
        scratch: &mut Scratch,
        out: &mut Vec<f64>,
    ) -> bool {
        if !eta.iter().all(|eta| eta.is_finite() && *eta > 0.0) || !self.convect(eta, scratch) {
            return false;
        }
        self.add_lower_terms(lower, &mut scratch.convected);
        let (n, width) = (self.samples.len(), self.functions + self.fit.len() / self.samples.len());
        let count = width - self.functions;
        let Scratch { qr, convected, fitted, right, solved, y, lacks, .. } = scratch;
        dense::multiply(&self.fit, convected, n, width, fitted);
        qr.resize(count, count);
        for column in 0..count {
            let entries = qr.column_mut(column);
            entries.iter_mut().zip(fitted.chunks_exact(width)).for_each(|(entry, row)| *entry = row[column]);
            entries[column] += 1.0;
        }
        if !qr.factor(1.0 / LARGEST_CONDITION) {
            return false;
        }
        // A row a monomial of y, a column a function.
        solved.resize(count * self.functions, 0.0);
        y.resize(count, 0.0);
        for function in 0..self.functions {
            right.clear();
            right.extend(fitted.chunks_exact(width).map(|row| -row[count + function]));
            qr.apply_transpose(right);
            qr.back_substitute(right, y);
            let column = solved.iter_mut().skip(function).step_by(self.functions);
            column.zip(y.iter()).for_each(|(entry, y)| *entry = *y);
        }
        dense::multiply(&self.inverse, solved, count, self.functions, out);
        for source in sources {
            dense::apply(&self.fit, source, right);
            qr.apply_transpose(right);
            qr.back_substitute(right, y);
            dense::apply(&self.inverse, y, lacks);
            out.extend_from_slice(lacks);
        }
        true
    }

    /// `b . grad` of P for each monomial of y and of each harmonic polynomial, at the samples.
    fn convect(&self, eta: &[f64], scratch: &mut Scratch) -> bool {
        let n = self.samples.len();
        let Scratch { logarithm, polynomial, slope, convected, .. } = scratch;
        logarithm.clear();
        logarithm.extend(eta.iter().map(|e| (e / eta[0]).ln()));
        dense::apply(&self.logarithm, logarithm, polynomial);
        let misfit = |(row, value): (&[f64], &f64)| (dot(row, polynomial) - value).abs();
        let rows = self.values.chunks_exact(polynomial.len()).zip(logarithm.iter());
        if rows.map(misfit).any(|m| m > LARGEST_MISFIT) {
            return false;
        }
        convected.clear();
        convected.resize(self.derivatives[0].len(), 0.0);
        let width = convected.len() / n;
        for (slopes, derivatives) in self.slopes.iter().zip(&self.derivatives) {
            dense::apply(slopes, polynomial, slope);
            let rows = convected.chunks_exact_mut(width).zip(derivatives.chunks_exact(width));
            for ((row, derivative), slope) in rows.zip(slope.iter()) {
                row.iter_mut().zip(derivative).for_each(|(entry, d)| *entry += slope * d);
            }
        }
        true
    }
}

impl<const D: usize> Adapted<D> {
    /// Adds `-v . grad - r` of the same to `b . grad`.
    fn add_lower_terms(&self, lower: &LowerTerms<D>, convected: &mut [f64]) {
        let width = convected.len() / self.samples.len();
        let mut subtract = |factors: &[f64], table: &[f64]| {
            let rows = convected.chunks_exact_mut(width).zip(table.chunks_exact(width));
            for ((row, entries), factor) in rows.zip(factors) {
                row.iter_mut().zip(entries).for_each(|(sum, entry)| *sum -= factor * entry);
            }
        };
        for (velocity, derivatives) in lower.velocity.iter().flatten().zip(&self.derivatives) {
            subtract(velocity, derivatives);
        }
        if let Some(reaction) = &lower.reaction {
            subtract(reaction, &self.undifferentiated);
        }
    }
}

/// A row a sample: values and derivatives of the polynomials there.
fn tables<const D: usize>(basis: &Basis<D>, samples: &[[f64; D]]) -> (Vec<f64>, [Vec<f64>; D]) {
    let mut values = Vec::new();
    let mut slopes: [Vec<f64>; D] = std::array::from_fn(|_| Vec::new());
    let mut jet = Jet::default();
    for z in samples {
        basis.evaluate(z, &mut jet);
        values.extend_from_slice(&jet.values);
        for (axis, table) in slopes.iter_mut().enumerate() {
            table.extend(jet.gradients.iter().map(|g| g[axis]));
        }
    }
    (values, slopes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left of the equation at a point with `eta = exp(k . z)`, for the functions up to a degree and a source.
    fn residual<const D: usize>(degree: usize, up_to: usize, k: [f64; D], z: [f64; D]) -> f64 {
        let harmonic = Basis::<D>::harmonic(degree);
        let (adapted, counted) = (Adapted::new(&harmonic, degree), Basis::<D>::harmonic(up_to).len());
        let along = |z: &[f64; D]| (0..D).map(|a| k[a] * z[a]).sum::<f64>();
        let eta: Vec<f64> = adapted.samples.iter().map(|z| along(z).exp()).collect();
        let source: Vec<f64> = adapted.samples.iter().map(|z| 1.0 - z[0]).collect();
        let mut coefficients = Vec::new();
        let lower = LowerTerms::default();
        assert!(adapted.solve((&eta, &lower), &[&source], &mut Scratch::default(), &mut coefficients));
        let (mut own, mut jet) = (Jet::default(), Jet::default());
        harmonic.evaluate(&z, &mut own);
        adapted.basis.evaluate(&z, &mut jet);
        let mut worst = 0.0_f64;
        let (functions, source) = coefficients.split_at(adapted.basis.len() * harmonic.len());
        let of_function = |f: usize| functions.iter().copied().skip(f).step_by(harmonic.len()).collect();
        let all = (0..harmonic.len()).map(of_function).chain([source.to_vec()]);
        for (function, p) in all.enumerate() {
            let p: Vec<f64> = p;
            // Values and slopes at the centre are those of the harmonic polynomial.
            assert!(p[..=D].iter().all(|c| c.abs() < 1e-14), "{:?}", &p[..=D]);
            let mut left = if function < harmonic.len() { 0.0 } else { z[0] - 1.0 };
            for (m, c) in p.iter().enumerate() {
                left += c * (jet.laplacians[m] + along(&jet.gradients[m]));
            }
            left += own.gradients.get(function).map_or(0.0, along);
            if !(counted..harmonic.len()).contains(&function) {
                worst = worst.max(left.abs());
            }
        }
        worst
    }

    #[test]
    fn functions_solve_the_equation_as_well_as_their_degree_allows() {
        for scale in [1.0, 0.5, 0.25] {
            let sizes = [
                residual(6, 6, [0.3 * scale, -0.2 * scale], [0.3, 0.4]),
                residual(4, 4, [0.2 * scale, 0.1 * scale, -0.2 * scale], [0.3, -0.5, 0.2]),
                residual(4, 4, [0.3 * scale], [0.6]),
            ];
            assert!(sizes.iter().all(|size| *size < 1e-2 * scale), "{scale}: {sizes:?}");
        }
        // The more terms the same functions may have, the better they solve it.
        let by_degree = [4, 6, 8].map(|degree| residual(degree, 4, [0.2, 0.1], [0.2, 0.3]));
        assert!(by_degree[1] < 0.1 * by_degree[0] && by_degree[2] < 0.1 * by_degree[1], "{by_degree:?}");
    }

    /// A stream and a reaction: `lap Q - v . grad Q - r Q` of every function, at a point.
    #[test]
    fn terms_of_lower_order_are_solved_for() {
        let left = |scale: f64, degree: usize| {
            let harmonic = Basis::<2>::harmonic(4);
            let adapted = Adapted::new(&harmonic, degree);
            let n = adapted.samples.len();
            let (v, r) = ([0.3 * scale, -0.2 * scale], 0.4 * scale);
            let lower = LowerTerms { velocity: Some(v.map(|v| vec![v; n])), reaction: Some(vec![r; n]) };
            let mut p = Vec::new();
            assert!(adapted.solve((&vec![2.0; n], &lower), &[], &mut Scratch::default(), &mut p));
            let (mut own, mut jet, z) = (Jet::default(), Jet::default(), [0.3, -0.4]);
            harmonic.evaluate(&z, &mut own);
            adapted.basis.evaluate(&z, &mut jet);
            let along = |g: &[f64; 2]| v[0] * g[0] + v[1] * g[1];
            let of = |f: usize| -> f64 {
                let start = -along(&own.gradients[f]) - r * own.values[f];
                p.iter().skip(f).step_by(harmonic.len()).enumerate().fold(start, |sum, (m, c)| {
                    sum + c * (jet.laplacians[m] - along(&jet.gradients[m]) - r * jet.values[m])
                })
            };
            (0..harmonic.len()).map(|f| of(f).abs()).fold(0.0, f64::max)
        };
        assert!(left(1.0, 4) < 1e-2 && left(0.5, 4) < 5e-3, "{:e} {:e}", left(1.0, 4), left(0.5, 4));
        assert!(left(1.0, 8) < 0.1 * left(1.0, 4), "{:e}", left(1.0, 8));
    }

    #[test]
    fn a_jump_is_not_taken_for_a_smooth_function() {
        let adapted = Adapted::new(&Basis::<2>::harmonic(4), 4);
        let eta: Vec<f64> = adapted.samples.iter().map(|z| if z[0] < 0.1 { 1.0 } else { 2.0 }).collect();
        let lower = LowerTerms::default();
        assert!(!adapted.solve((&eta, &lower), &[], &mut Scratch::default(), &mut Vec::new()));
        let eta: Vec<f64> = adapted.samples.iter().map(|z| z[0]).collect();
        assert!(!adapted.solve((&eta, &lower), &[], &mut Scratch::default(), &mut Vec::new()));
    }
}
