//! The sine integral.

use super::{ASYMPTOTIC, MILLER_MARGIN, SMALL};

/// `Si(x) = int_0^x sin t / t dt` for x >= 0.
pub(crate) fn sine_integral(x: f64) -> f64 {
    if x < SMALL {
        power_series(x)
    } else if x < ASYMPTOTIC {
        by_spherical_bessel(x)
    } else {
        asymptotic(x)
    }
}

fn power_series(x: f64) -> f64 {
    let (mut term, mut sum, mut k) = (x, x, 1.0);
    loop {
        term *= -x * x / ((k + 1.0) * (k + 2.0));
        k += 2.0;
        sum += term / k;
        if (term / k).abs() <= f64::EPSILON / 8.0 * sum.abs() {
            return sum;
        }
    }
}

/// `Si(x) = x sum_n j_n(x/2)^2` (Abramowitz and Stegun 5.2.15): only positive terms; the spherical Bessel functions come
/// from Miller's recurrence, normalised by `sum (2n+1) j_n^2 = 1`.
fn by_spherical_bessel(x: f64) -> f64 {
    let z = x / 2.0;
    let start = z as usize + MILLER_MARGIN;
    let (mut above, mut here) = (0.0, 1e-100);
    let (mut sum, mut norm) = (0.0, 0.0);
    for n in (0..=start).rev() {
        let square = here * here;
        sum += square;
        norm += (2 * n + 1) as f64 * square;
        (above, here) = (here, (2 * n + 1) as f64 / z * here - above);
    }
    x * sum / norm
}

/// `pi/2 - f cos x - g sin x` (Abramowitz and Stegun 5.2.8, 5.2.34 and 5.2.35).
fn asymptotic(x: f64) -> f64 {
    let (mut f, mut g) = (0.0, 0.0);
    let (mut term, mut k) = (1.0 / x, 0.0);
    while term.abs() > f64::EPSILON / 8.0 / x && k < x {
        f += term;
        let next = term * (k + 1.0) / x;
        g += next;
        term = -next * (k + 2.0) / x;
        k += 2.0;
    }
    let (sin, cos) = x.sin_cos();
    std::f64::consts::FRAC_PI_2 - f * cos - g * sin
}

#[cfg(test)]
mod tests {
    use super::sine_integral;

    #[test]
    fn values_to_the_last_digits() {
        for (x, value) in [
            (0.5, 0.493_107_418_043_066_7),
            (1.0, 0.946_083_070_367_183),
            (2.0, 1.605_412_976_802_694_8),
            (10.0, 1.658_347_594_218_874),
            (100.0, 1.562_225_466_889_056_3),
        ] {
            assert!((sine_integral(x) / value - 1.0).abs() < 2e-15, "Si({x}) = {}", sine_integral(x));
        }
    }
}
