//! Vector kernels whose results do not depend on the number of threads.

use crate::parallel;

/// Elements that are added in one go. Sums run over blocks of this size, whatever the number of threads.
const BLOCK: usize = 4096;

/// Elements from which a vector is worth sharing among threads.
const PARALLEL_FROM: usize = 8 * BLOCK;

/// Independent partial sums within a block, for the sake of vector instructions.
const LANES: usize = 8;

/// A number of single or double precision.
pub(crate) trait Real: Copy + Into<f64> + Sync {}

impl<T: Copy + Into<f64> + Sync> Real for T {}

fn block_dot<T: Real>(x: &[f64], y: &[T]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (x_lanes, x_rest) = x.as_chunks::<LANES>();
    let (y_lanes, y_rest) = y.as_chunks::<LANES>();
    for (a, b) in x_lanes.iter().zip(y_lanes) {
        for k in 0..LANES {
            lanes[k] += a[k] * b[k].into();
        }
    }
    lanes.iter().sum::<f64>() + x_rest.iter().zip(y_rest).map(|(a, &b)| a * b.into()).sum::<f64>()
}

/// `x . y`
pub(crate) fn dot<T: Real>(x: &[f64], y: &[T]) -> f64 {
    if x.len() < PARALLEL_FROM {
        return x.chunks(BLOCK).zip(y.chunks(BLOCK)).map(|(a, b)| block_dot(a, b)).sum();
    }
    let mut sums = vec![0.0; x.len().div_ceil(BLOCK)];
    parallel::for_each_part(&mut sums, 1, &|k, sum| {
        let block = k * BLOCK..x.len().min((k + 1) * BLOCK);
        sum[0] = block_dot(&x[block.clone()], &y[block]);
    });
    sums.iter().sum()
}

/// Euclidean norm. Overflows beyond 1e154: the systems that come here have scaled rows.
pub(crate) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Largest absolute value; NaN if there is one.
pub(crate) fn norm_max(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if v.abs() > m || v.is_nan() { v.abs() } else { m })
}

fn update<T: Real>(y: &mut [f64], x: &[T], f: impl Fn(&mut f64, f64) + Sync) {
    let step = |(y, x): (&mut [f64], &[T])| y.iter_mut().zip(x).for_each(|(y, &x)| f(y, x.into()));
    if y.len() < PARALLEL_FROM {
        step((y, x));
    } else {
        parallel::for_each_part(y, BLOCK, &|k, y| {
            let own = k * BLOCK..k * BLOCK + y.len();
            step((y, &x[own]));
        });
    }
}

/// `y += alpha x`
pub(crate) fn axpy<T: Real>(alpha: f64, x: &[T], y: &mut [f64]) {
    update(y, x, |y, x| *y += alpha * x);
}

/// `y = x + beta y`
pub(crate) fn xpby(x: &[f64], beta: f64, y: &mut [f64]) {
    update(y, x, |y, x| *y = x + beta * *y);
}

/// A bit without pattern (the finaliser of splitmix64), for vectors that know nothing of a problem.
pub(crate) fn mixed_bit(i: u64) -> bool {
    let mut z = i.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_and_short_sums_agree_with_exact_ones() {
        for n in [0, 1, 7, 4095, 4097, PARALLEL_FROM + 3] {
            let x: Vec<f64> = (0..n).map(|i| (i % 13) as f64).collect();
            let exact: u64 = (0..n as u64).map(|i| (i % 13) * (i % 13)).sum();
            assert_eq!(dot(&x, &x), exact as f64);
        }
    }

    #[test]
    fn updates_agree_with_loops() {
        let n = PARALLEL_FROM + 5;
        let x: Vec<f64> = (0..n).map(|i| i as f64).collect();
        let mut y = vec![1.0; n];
        axpy(2.0, &x, &mut y);
        xpby(&x, 3.0, &mut y);
        assert!(y.iter().enumerate().all(|(i, &y)| y == i as f64 + 3.0 * (1.0 + 2.0 * i as f64)));
    }

    #[test]
    fn a_nan_is_not_swallowed() {
        assert!(norm_max(&[1.0, f64::NAN, 2.0]).is_nan());
        assert_eq!(norm_max(&[1.0, -3.0, 2.0]), 3.0);
    }
}
