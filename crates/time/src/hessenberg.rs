//! Eigenvalues and eigenvectors of small upper Hessenberg matrices, by the QR algorithm with single shifts (Golub & Van Loan,
//! section 7.5).

use crate::complex::Complex;

/// Most QR steps for one eigenvalue; a handful is usual.
const MOST_STEPS: usize = 60;

/// Every so many steps the shift is another one, which ends cycles.
const EXCEPTIONAL: usize = 10;

/// The eigenvalues of a matrix given by its columns, of which the j-th has the rows 0 to j + 1, the last one a row that does not count.
/// Those that were not found are left out.
pub(crate) fn eigenvalues(columns: &[Vec<f64>]) -> Vec<Complex> {
    let n = columns.len();
    let entry = |i: usize, j: usize| columns[j].get(i).copied().unwrap_or(0.0);
    let mut a: Vec<Vec<Complex>> =
        (0..n).map(|i| (0..n).map(|j| Complex::real(entry(i, j))).collect()).collect();
    let (mut found, mut end, mut steps) = (Vec::with_capacity(n), n, 0);
    while end > 0 {
        let last = end - 1;
        let small = |i: usize| a[i][i - 1].abs() <= f64::EPSILON * (a[i][i].abs() + a[i - 1][i - 1].abs());
        let begin = (1..end).rev().find(|&i| small(i)).unwrap_or(0);
        if begin == last {
            found.push(a[last][last]);
            (end, steps) = (last, 0);
            continue;
        }
        steps += 1;
        if steps > MOST_STEPS {
            break;
        }
        let shift = match steps % EXCEPTIONAL {
            0 => a[last][last] + Complex::real(a[last][last - 1].abs()),
            _ => wilkinson(&a, last),
        };
        qr_step(&mut a, begin, end, shift);
    }
    found
}

/// The eigenvalue of the last two rows and columns that is nearer to the last diagonal entry.
fn wilkinson(a: &[Vec<Complex>], last: usize) -> Complex {
    let (p, q) = (a[last - 1][last - 1], a[last][last]);
    let half = (p - q).scaled(0.5);
    let root = (half * half + a[last - 1][last] * a[last][last - 1]).sqrt();
    let mean = (p + q).scaled(0.5);
    let (one, other) = (mean + root, mean - root);
    if (one - q).abs() < (other - q).abs() { one } else { other }
}

/// `A - shift = Q R`, then `R Q + shift`, for the rows and columns from `begin` to `end`.
fn qr_step(a: &mut [Vec<Complex>], begin: usize, end: usize, shift: Complex) {
    (begin..end).for_each(|i| a[i][i] = a[i][i] - shift);
    let mut rotations = Vec::with_capacity(end - begin);
    for k in begin..end - 1 {
        let (x, y) = (a[k][k], a[k + 1][k]);
        let size = x.abs().hypot(y.abs());
        let (c, s) = match size > 0.0 {
            true => (x.scaled(1.0 / size), y.scaled(1.0 / size)),
            false => (Complex::real(1.0), Complex::ZERO),
        };
        for j in k..end {
            let (x, y) = (a[k][j], a[k + 1][j]);
            a[k][j] = c.conj() * x + s.conj() * y;
            a[k + 1][j] = c * y - s * x;
        }
        rotations.push((c, s));
    }
    for (k, (c, s)) in (begin..).zip(rotations) {
        for row in &mut a[begin..(k + 2).min(end)] {
            let (x, y) = (row[k], row[k + 1]);
            row[k] = x * c + y * s;
            row[k + 1] = y * c.conj() - x * s.conj();
        }
    }
    (begin..end).for_each(|i| a[i][i] = a[i][i] + shift);
}

/// The eigenvector of an eigenvalue, of length 1; no entry below the diagonal may be zero.
pub(crate) fn eigenvector(columns: &[Vec<f64>], value: Complex) -> Vec<Complex> {
    let n = columns.len();
    let mut y = vec![Complex::ZERO; n];
    y[n - 1] = Complex::real(1.0);
    for i in (1..n).rev() {
        let sum = (i..n).fold(Complex::ZERO, |sum, j| sum + y[j].scaled(columns[j][i]));
        y[i - 1] = (value * y[i] - sum).scaled(1.0 / columns[i - 1][i]);
        let size = y.iter().map(|y| y.abs().powi(2)).sum::<f64>().sqrt();
        y.iter_mut().for_each(|y| *y = y.scaled(1.0 / size));
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns as they come from the Krylov method, with a last row that does not count.
    fn matrix(n: usize, seed: f64) -> Vec<Vec<f64>> {
        let entry = |i: usize, j: usize| ((i * 31 + j * 17 + 1) as f64 * 0.618 * seed).fract() - 0.4;
        (0..n).map(|j| (0..j + 2).map(|i| entry(i, j) + f64::from(u8::from(i == j + 1))).collect()).collect()
    }

    #[test]
    fn pairs_are_pairs() {
        for n in 1..=20 {
            for seed in 1..=20 {
                let columns = matrix(n, f64::from(seed));
                let values = eigenvalues(&columns);
                assert_eq!(values.len(), n, "seed {seed}");
                for value in values {
                    let y = eigenvector(&columns, value);
                    for i in 0..n {
                        let terms = (i.max(1) - 1..n).map(|j| y[j].scaled(columns[j][i]));
                        let sum = terms.fold(Complex::ZERO, |sum, x| sum + x);
                        let defect = (sum - value * y[i]).abs();
                        assert!(defect < 1e-8, "{n}, seed {seed}, row {i}: {defect:e}");
                    }
                }
            }
        }
    }

    /// The companion matrix of `(x - 1)(x - 2)(x^2 + 1)`.
    #[test]
    fn eigenvalues_of_a_companion_matrix() {
        let columns = vec![
            vec![3.0, 1.0],
            vec![-3.0, 0.0, 1.0],
            vec![3.0, 0.0, 0.0, 1.0],
            vec![-2.0, 0.0, 0.0, 0.0, 1.0],
        ];
        let found = eigenvalues(&columns);
        for (re, im) in [(1.0, 0.0), (2.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            assert!(
                found.iter().any(|x| (*x - Complex { re, im }).abs() < 1e-12),
                "{re} + {im} i: {found:?}"
            );
        }
    }
}
