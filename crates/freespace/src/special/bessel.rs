//! Integrals and differences of Bessel functions.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::{ASYMPTOTIC, EULER, MILLER_MARGIN, SMALL};

/// `1 - J0(x)` without cancellation, x >= 0.
pub(crate) fn one_minus_j0(x: f64) -> f64 {
    if x >= SMALL { 1.0 - libm::j0(x) } else { series(x, |_| 1.0) }
}

/// `int_0^x (1 - J0(u))/u du` for x >= 0.
pub(crate) fn one_minus_j0_integral(x: f64) -> f64 {
    if x < SMALL {
        series(x, |k| 1.0 / (2.0 * k))
    } else if x < ASYMPTOTIC {
        neumann(x)
    } else {
        (x / 2.0).ln() + EULER + tail(x)
    }
}

/// `sum_{k > 0} (-1)^(k+1) (x/2)^2k / k!^2 weight(k)`.
fn series(x: f64, weight: impl Fn(f64) -> f64) -> f64 {
    let square = x * x / 4.0;
    let (mut power, mut sum, mut k) = (1.0, 0.0, 0.0);
    loop {
        k += 1.0;
        power *= square / (k * k);
        let sign = if k % 2.0 == 1.0 { 1.0 } else { -1.0 };
        let term = sign * power * weight(k);
        sum += term;
        if term.abs() <= f64::EPSILON / 8.0 * sum.abs() || sum.is_nan() {
            return sum;
        }
    }
}

/// `2/x sum_k (2k+3) H_(k+1) J_(2k+3)(x)` (Abramowitz and Stegun 11.1.20), H the harmonic numbers; the Bessel functions
/// come from Miller's recurrence, normalised by `J_0 + 2 (J_2 + J_4 + ...) = 1`.
fn neumann(x: f64) -> f64 {
    let start = (x as usize + MILLER_MARGIN) | 1;
    let mut harmonic: f64 = (1..=(start - 1) / 2).map(|k| 1.0 / k as f64).sum();
    let (mut above, mut here) = (0.0, 1e-150);
    let (mut sum, mut norm) = (0.0, 0.0);
    for n in (0..=start).rev() {
        if n == 0 {
            norm += here;
        } else if n % 2 == 0 {
            norm += 2.0 * here;
        } else if n >= 3 {
            sum += n as f64 * harmonic * here;
            harmonic -= 2.0 / (n - 1) as f64;
        }
        (above, here) = (here, 2.0 * n as f64 / x * here - above);
    }
    2.0 / x * sum / norm
}

/// Terms of the asymptotic series of [`tail`]: at 40 the last one is below 1e-16 of the first.
const TERMS: usize = 24;

/// `d_k` of [`tail`], from the coefficients `a_k = (-1)^k (2k-1)!!^2 / (k! 8^k)` of Hankel's expansion.
const COEFFICIENTS: [f64; TERMS] = {
    let mut coefficients = [1.0; TERMS];
    let (mut a, mut k) = (1.0, 1);
    while k < TERMS {
        let odd = (2 * k - 1) as f64;
        a *= -odd * odd / (8 * k) as f64;
        coefficients[k] = a - (k as f64 + 0.5) * coefficients[k - 1];
        k += 1;
    }
    coefficients
};

/// `int_x^inf J0(u)/u du = sqrt(2/pi) x^(-3/2) Re sum_k i^(k+1) d_k x^-k exp(i (x - pi/4))`: Hankel's expansion of J0 (Abramowitz and Stegun
/// 9.2.5) divided by u and integrated term by term, so that `d_k = a_k - (k + 1/2) d_(k-1)`.
fn tail(x: f64) -> f64 {
    let inverse = 1.0 / x;
    let (mut even, mut odd, mut power) = (0.0, 0.0, 1.0);
    for [first, second] in COEFFICIENTS.as_chunks::<2>().0 {
        even += first * power;
        odd += second * power * inverse;
        power *= -inverse * inverse;
        if power.abs() * second.abs() < f64::EPSILON / 64.0 {
            break;
        }
    }
    // Sine and cosine of x - pi/4, times the root of 2.
    let (sin, cos) = x.sin_cos();
    let root = FRAC_1_SQRT_2 * (2.0 / PI).sqrt() * inverse * inverse.sqrt();
    -root * (even * (sin - cos) + odd * (sin + cos))
}
