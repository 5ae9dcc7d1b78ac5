//! Logarithms of many numbers.

use pulp::{Arch, Simd, WithSimd};

/// The bits of the root of one half.
const ROOT_OF_HALF: u64 = 0x3fe6_a09e_667f_3bcd;

/// The bits of one.
const ONE: u64 = 0x3ff0_0000_0000_0000;

/// The bits of a mantissa.
const MANTISSA: u64 = (1 << 52) - 1;

/// `2^52`, whose last bits are those of a small whole number that is added.
const WHOLE: u64 = 0x4330_0000_0000_0000;

/// `ln 2`, 32 bits of it, and the rest.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// Coefficients of `ln((1 + s)/(1 - s)) = 2s + s R(s^2)` for `|s| < 0.1716`, to `2^-58` (fdlibm, `e_log.c`).
const R: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];

/// Replaces positive normal numbers by their natural logarithms, to a unit of the last place; others by something.
pub(crate) fn logarithms(values: &mut [f64]) {
    Arch::new().dispatch(Each(values));
}

/// Each number, in vectors that the compiler makes of the loop.
struct Each<'a>(&'a mut [f64]);

impl WithSimd for Each<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.iter_mut().for_each(|x| *x = logarithm(*x));
    }
}

/// Without branches, so that there can be vectors of it.
#[inline(always)]
fn logarithm(x: f64) -> f64 {
    let shifted = x.to_bits().wrapping_add(ONE - ROOT_OF_HALF);
    let exponent = f64::from_bits((shifted >> 52) | WHOLE) - (4_503_599_627_370_496.0 + 1023.0);
    let f = f64::from_bits((shifted & MANTISSA) + ROOT_OF_HALF) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (R[1] + w * (R[3] + w * R[5]));
    let odd = z * (R[0] + w * (R[2] + w * (R[4] + w * R[6])));
    let half = 0.5 * f * f;
    exponent * LN_2[0] - ((half - (s * (half + (odd + even)) + exponent * LN_2[1])) - f)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_SQRT_2;

    use super::logarithms;

    #[test]
    fn as_the_library_to_the_last_place() {
        let mut all: Vec<f64> = (0..400_000).map(|i| 1e-300 * (f64::from(i) * 0.003_45).exp()).collect();
        all.extend([1.0, 1.0 + f64::EPSILON, 1.0 - f64::EPSILON / 2.0, 2.0, 0.5, FRAC_1_SQRT_2]);
        let mut ours = all.clone();
        logarithms(&mut ours);
        for (x, ours) in all.iter().zip(ours) {
            let library = x.ln();
            assert!((ours - library).abs() <= f64::EPSILON * library.abs(), "{x:e}: {ours:e} {library:e}");
        }
    }
}
