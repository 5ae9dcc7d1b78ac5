//! The exponential integral E1 and its entire part.

use super::EULER;

/// Where the continued fraction takes over from the series.
const SWITCH: f64 = 1.5;

/// `Ein(x) = int_0^x (1 - e^-t)/t dt = E1(x) + ln x + gamma` for x >= 0.
pub(crate) fn ein(x: f64) -> f64 {
    if x > SWITCH {
        return e1(x) + x.ln() + EULER;
    }
    // e^-x sum x^n/n! H_n: all terms are positive (Abramowitz and Stegun 5.1.11 times e^x).
    let (mut power, mut harmonic, mut sum, mut n) = (1.0, 0.0, 0.0, 0.0);
    loop {
        n += 1.0;
        power *= x / n;
        harmonic += 1.0 / n;
        let term = power * harmonic;
        sum += term;
        // Of no number there is no sum.
        if term <= f64::EPSILON / 8.0 * sum || sum.is_nan() {
            return (-x).exp() * sum;
        }
    }
}

/// `E1(x) = int_x^inf e^-t/t dt` for x > 0.
pub(crate) fn e1(x: f64) -> f64 {
    if x <= SWITCH {
        return ein(x) - x.ln() - EULER;
    }
    if x > 745.0 {
        return 0.0;
    }
    // Continued fraction (Abramowitz and Stegun 5.1.22) by Lentz's method.
    let mut b = x + 1.0;
    let mut c = f64::INFINITY;
    let mut d = 1.0 / b;
    let mut h = d;
    let mut n = 0.0;
    loop {
        n += 1.0;
        let a = -n * n;
        b += 2.0;
        d = 1.0 / (a * d + b);
        c = b + a / c;
        let factor = c * d;
        h *= factor;
        if (factor - 1.0).abs() <= f64::EPSILON || h.is_nan() {
            return h * (-x).exp();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{e1, ein};

    #[test]
    fn values_of_abramowitz_and_stegun() {
        // Tables 5.1 and 5.3, and 30-digit evaluations.
        for (x, value) in [
            (0.5, 0.559_773_594_776_160_8),
            (1.0, 0.219_383_934_395_520_3),
            (2.0, 4.890_051_070_806_112e-2),
            (10.0, 4.156_968_929_685_324e-6),
            (40.0, 1.036_773_261_451_656_8e-19),
        ] {
            assert!((e1(x) / value - 1.0).abs() < 5e-15, "E1({x}) = {} for {value}", e1(x));
        }
        assert!((ein(1e-6) / 9.999_997_500_000_555e-7 - 1.0).abs() < 1e-15);
        assert!((ein(2.0) / 1.319_263_356_169_54 - 1.0).abs() < 1e-14);
    }
}
