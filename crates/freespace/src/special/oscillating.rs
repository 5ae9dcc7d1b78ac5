//! J0 of many large numbers, by its modulus and its phase.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_4};

use pulp::{Arch, Simd, WithSimd};

use super::one_minus_j0;

/// From here on the series, of [`TERMS`] terms, reach round-off.
const FAR: f64 = 64.0;

/// Terms of the series in `1/x^2`.
const TERMS: usize = 6;

/// Numbers that are worked on together.
const BLOCK: usize = 128;

/// `M^2 pi x / 2 = sum_k MODULUS_k x^-2k` with `MODULUS_k = (-1)^k (2k-1)!!^3 / (k! 8^k)` (Abramowitz and Stegun 9.2.28).
const MODULUS: [f64; TERMS] = {
    let mut coefficients = [1.0; TERMS];
    let mut k = 1;
    while k < TERMS {
        let odd = (2 * k - 1) as f64;
        coefficients[k] = -coefficients[k - 1] * odd * odd * odd / (8 * k) as f64;
        k += 1;
    }
    coefficients
};

/// `theta = x - pi/4 + sum_k PHASE_k x^(1-2k)`, k from 1: the derivative of theta is `2 / (pi x M^2)`.
const PHASE: [f64; TERMS] = {
    let (mut reciprocal, mut coefficients) = ([1.0; TERMS], [0.0; TERMS]);
    let mut k = 1;
    while k < TERMS {
        let (mut sum, mut j) = (0.0, 1);
        while j <= k {
            sum -= MODULUS[j] * reciprocal[k - j];
            j += 1;
        }
        reciprocal[k] = sum;
        coefficients[k] = -sum / (2 * k - 1) as f64;
        k += 1;
    }
    coefficients
};

/// Of the sine, `sum_k SINE_k t^(2k + 1)`, to round-off for `|t| <= pi/2`.
const SINE: [f64; 11] = {
    let mut coefficients = [1.0; 11];
    let mut k = 1;
    while k < 11 {
        coefficients[k] = -coefficients[k - 1] / (2 * k * (2 * k + 1)) as f64;
        k += 1;
    }
    coefficients
};

/// Pi, 33 bits of it, and the rest.
const PARTS_OF_PI: [f64; 2] = [3.141_592_653_468_251_2, 1.215_420_101_301_238_4e-10];

/// `3 2^51`: adding it leaves whole numbers, their parity in the last bit.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Replaces squares of numbers s by `(1 - J0(x))/x^2` at `x = scale s`, to the round-off that x has.
pub(crate) fn one_minus_j0_ratios(scale: f64, squares: &mut [f64]) {
    let (mut kept, near) = ([0.0; BLOCK], (FAR / scale).powi(2));
    for squares in squares.chunks_mut(BLOCK) {
        let kept = &mut kept[..squares.len()];
        kept.copy_from_slice(squares);
        Arch::new().dispatch(Each { scale, values: squares });
        if kept.iter().map(|square| u64::from(*square < near)).sum::<u64>() == 0 {
            continue;
        }
        for (ratio, square) in squares.iter_mut().zip(kept).filter(|(_, square)| **square < near) {
            let x = scale * square.sqrt();
            *ratio = if x < 1e-10 { 0.25 } else { one_minus_j0(x) / (x * x) };
        }
    }
}

/// Up to [`BLOCK`] large numbers, in vectors that the compiler makes of the loops. Each loop is short, so that a processor works on several
/// turns of it at once.
struct Each<'a> {
    scale: f64,
    values: &'a mut [f64],
}

impl WithSimd for Each<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scale, values } = self;
        let (mut inverse, mut modulus) = ([0.0; BLOCK], [0.0; BLOCK]);
        for (x, inverse) in values.iter_mut().zip(&mut inverse) {
            *x = scale * x.sqrt();
            *inverse = 1.0 / *x;
        }
        for (modulus, inverse) in modulus.iter_mut().zip(&inverse[..values.len()]) {
            *modulus = (2.0 * FRAC_1_PI * inverse * polynomial(&MODULUS, inverse * inverse)).sqrt();
        }
        for (x, inverse) in values.iter_mut().zip(&inverse) {
            *x = cosine_of_phase(*x, *inverse);
        }
        for ((value, inverse), modulus) in values.iter_mut().zip(&inverse).zip(&modulus) {
            *value = (1.0 - modulus * *value) * (inverse * inverse);
        }
    }
}

/// `cos theta`, the sine of a quarter of a turn more.
#[inline(always)]
fn cosine_of_phase(x: f64, inverse: f64) -> f64 {
    let rest = x.mul_add(polynomial(&PHASE, inverse * inverse), FRAC_PI_4);
    let shifted = (x + rest).mul_add(FRAC_1_PI, WHOLE);
    let turns = shifted - WHOLE;
    let t = turns.mul_add(-PARTS_OF_PI[1], turns.mul_add(-PARTS_OF_PI[0], x)) + rest;
    let sine = t * polynomial(&SINE, t * t);
    f64::from_bits(sine.to_bits() ^ (shifted.to_bits() << 63))
}

/// The lowest power first: two sums of every second power, which do not wait for each other.
#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let (square, mut k) = (x * x, N & !1);
    let (mut even, mut odd): (f64, f64) = (if N % 2 == 1 { coefficients[N - 1] } else { 0.0 }, 0.0);
    while k > 0 {
        k -= 2;
        even = even.mul_add(square, coefficients[k]);
        odd = odd.mul_add(square, coefficients[k + 1]);
    }
    x.mul_add(odd, even)
}

#[cfg(test)]
mod tests {
    use super::{FAR, one_minus_j0, one_minus_j0_ratios};

    /// The phase is known as well as x is.
    #[test]
    fn as_one_by_one() {
        let scale = 1.7;
        let x = |i: u32| if i < 1000 { 0.04 * f64::from(i) } else { FAR + 0.37 * f64::from(i - 1000) };
        let squares: Vec<f64> = (0..60_000).map(|i| (x(i) / scale).powi(2)).collect();
        let mut ratios = squares.clone();
        one_minus_j0_ratios(scale, &mut ratios);
        for (square, ratio) in squares.iter().zip(ratios) {
            let x = scale * square.sqrt();
            let value = if x > 0.0 { one_minus_j0(x) / (x * x) } else { 0.25 };
            let error = (ratio - value).abs();
            assert!(error <= 1e-15 * value * (1.0 + 0.3 * x.sqrt()), "{x}: {error:e} of {value:e}");
        }
    }
}
