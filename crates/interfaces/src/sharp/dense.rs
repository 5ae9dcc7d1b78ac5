//! Products of small dense matrices and vectors, written so that the processor can form several terms side by side.

/// Rows of the right factor that are added at once.
const BLOCK: usize = 4;

/// A scalar product in four partial sums.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a4, a_rest) = a.as_chunks::<4>();
    let (b4, b_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in a4.iter().zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

/// `out <- A b` for a matrix in rows of the length of b.
pub(super) fn apply(a: &[f64], b: &[f64], out: &mut Vec<f64>) {
    out.clear();
    out.extend(a.chunks_exact(b.len()).map(|row| dot(row, b)));
}

/// `out <- A B` in rows, A of `inner` columns and B of `width`.
pub(super) fn multiply(a: &[f64], b: &[f64], inner: usize, width: usize, out: &mut Vec<f64>) {
    out.clear();
    out.resize(a.len() / inner * width, 0.0);
    for (row, factors) in out.chunks_exact_mut(width).zip(a.chunks_exact(inner)) {
        add_combination(factors, b, row);
    }
}

/// `out += f^T B` for B in rows of the length of `out`.
pub(super) fn add_combination(factors: &[f64], b: &[f64], out: &mut [f64]) {
    let width = out.len();
    let (blocks, rest) = factors.as_chunks::<BLOCK>();
    let mut rows = b.chunks_exact(BLOCK * width);
    for (f, four) in blocks.iter().zip(&mut rows) {
        let (first, second) = four.split_at(2 * width);
        let ((r0, r1), (r2, r3)) = (first.split_at(width), second.split_at(width));
        for ((((entry, b0), b1), b2), b3) in out.iter_mut().zip(r0).zip(r1).zip(r2).zip(r3) {
            *entry += (f[0] * b0 + f[1] * b1) + (f[2] * b2 + f[3] * b3);
        }
    }
    for (f, row) in rest.iter().zip(rows.remainder().chunks_exact(width)) {
        out.iter_mut().zip(row).for_each(|(entry, b)| *entry += f * b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_definition() {
        for inner in [1, 3, 4, 7, 9] {
            let a: Vec<f64> = (0..2 * inner).map(|k| (k as f64 * 0.7).sin()).collect();
            let b: Vec<f64> = (0..5 * inner).map(|k| (k as f64 * 1.3).cos()).collect();
            let (mut product, mut applied) = (Vec::new(), Vec::new());
            multiply(&a, &b, inner, 5, &mut product);
            for (row, column) in [(0, 0), (0, 4), (1, 2)] {
                let expected: f64 = (0..inner).map(|k| a[row * inner + k] * b[k * 5 + column]).sum();
                assert!((product[row * 5 + column] - expected).abs() < 1e-14);
            }
            apply(&a, &b[..inner], &mut applied);
            let expected: f64 = (0..inner).map(|k| a[inner + k] * b[k]).sum();
            assert!((applied[1] - expected).abs() < 1e-14);
        }
    }
}
