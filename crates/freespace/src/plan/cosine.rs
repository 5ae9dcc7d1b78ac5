//! Cosine transforms of arrays that are even in every direction.

use rayon::prelude::*;
use realfft::RealToComplex;
use rustfft::num_complex::Complex;
use std::sync::Arc;

use super::real::Real;

/// Lines gathered at once from a strided array, and entries of a piece of a plane that one task works on.
const LINES: usize = 16;
const PIECE: usize = 128;

/// Transforms of one length: `X_k = x_0 + (-1)^k x_n + 2 sum x_j cos(pi j k / n)`, n + 1 numbers each (DCT-I), which is the
/// discrete Fourier transform of the even continuation with period 2n.
struct Cosine {
    plan: Arc<dyn RealToComplex<f64>>,
    period: usize,
}

struct Scratch {
    even: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    inner: Vec<Complex<f64>>,
    lines: Vec<f64>,
}

impl Cosine {
    fn new(half: usize) -> Self {
        let period = (2 * (half - 1)).max(1);
        Self { plan: f64::real(period).0, period }
    }

    fn scratch(&self) -> Scratch {
        Scratch {
            even: vec![0.0; self.period],
            spectrum: self.plan.make_output_vec(),
            inner: self.plan.make_scratch_vec(),
            lines: vec![0.0; LINES * self.half()],
        }
    }

    fn half(&self) -> usize {
        self.period / 2 + 1
    }

    fn line(&self, line: &mut [f64], scratch: &mut Scratch) {
        if self.period < 2 {
            return;
        }
        scratch.even[..line.len()].copy_from_slice(line);
        for j in line.len()..self.period {
            scratch.even[j] = line[self.period - j];
        }
        let outcome =
            self.plan.process_with_scratch(&mut scratch.even, &mut scratch.spectrum, &mut scratch.inner);
        debug_assert!(outcome.is_ok(), "the buffers were made for this length");
        for (value, transformed) in line.iter_mut().zip(&scratch.spectrum) {
            *value = transformed.re;
        }
    }

    /// Transforms the columns of `rows`, pieces of equal width that lie one below the other.
    fn columns(&self, rows: &mut [&mut [f64]], scratch: &mut Scratch) {
        let half = rows.len();
        let width = rows.first().map_or(0, |r| r.len());
        let mut lines = std::mem::take(&mut scratch.lines);
        for first in (0..width).step_by(LINES) {
            let count = LINES.min(width - first);
            for (j, row) in rows.iter().enumerate() {
                for (c, value) in row[first..first + count].iter().enumerate() {
                    lines[c * half + j] = *value;
                }
            }
            lines.chunks_exact_mut(half).take(count).for_each(|line| self.line(line, scratch));
            for (j, row) in rows.iter_mut().enumerate() {
                for (c, value) in row[first..first + count].iter_mut().enumerate() {
                    *value = lines[c * half + j];
                }
            }
        }
        scratch.lines = lines;
    }
}

/// Transforms an array of `shape`, the last direction running fastest, along the directions with `along`.
pub(super) fn transform(values: &mut [f64], shape: [usize; 3], along: [bool; 3]) {
    let [nx, ny, nz] = shape;
    let cosines = shape.map(Cosine::new);
    values.par_chunks_mut(ny * nz).for_each_init(
        || (cosines[1].scratch(), cosines[2].scratch()),
        |(for_y, for_z), plane| {
            if along[2] {
                plane.chunks_exact_mut(nz).for_each(|line| cosines[2].line(line, for_z));
            }
            if along[1] && ny > 1 {
                let mut rows: Vec<&mut [f64]> = plane.chunks_exact_mut(nz).collect();
                cosines[1].columns(&mut rows, for_y);
            }
        },
    );
    if !along[0] || nx < 2 {
        return;
    }
    let mut pieces: Vec<Vec<&mut [f64]>> =
        (0..(ny * nz).div_ceil(PIECE)).map(|_| Vec::with_capacity(nx)).collect();
    for plane in values.chunks_exact_mut(ny * nz) {
        for (rows, piece) in pieces.iter_mut().zip(plane.chunks_mut(PIECE)) {
            rows.push(piece);
        }
    }
    pieces
        .par_iter_mut()
        .for_each_init(|| cosines[0].scratch(), |scratch, rows| cosines[0].columns(rows, scratch));
}

#[cfg(test)]
mod tests {
    use super::transform;

    #[test]
    fn twice_is_the_period_times_the_array() {
        let shape = [5, 4, 7];
        let before: Vec<f64> = (0..140).map(|i| f64::from(i * i % 23) - 7.0).collect();
        let mut values = before.clone();
        transform(&mut values, shape, [true; 3]);
        transform(&mut values, shape, [true; 3]);
        let period = 8.0 * 6.0 * 12.0;
        assert!(values.iter().zip(&before).all(|(v, b)| (v / period - b).abs() < 1e-12));
    }

    #[test]
    fn a_line_is_a_sum_of_cosines() {
        let line = [3.0, -1.0, 2.0, 5.0];
        let mut values = line;
        transform(&mut values, [1, 1, 4], [true; 3]);
        for (k, value) in values.iter().enumerate() {
            let cosine = |j: usize| (std::f64::consts::PI * (j * k) as f64 / 3.0).cos();
            let sum =
                line[0] * cosine(0) + line[3] * cosine(3) + 2.0 * (line[1] * cosine(1) + line[2] * cosine(2));
            assert!((value - sum).abs() < 1e-13);
        }
    }
}
