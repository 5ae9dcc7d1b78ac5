//! Gauss-Legendre rules.

/// Newton steps from the first guess of an abscissa; three suffice.
const STEPS: usize = 6;

/// Abscissae and weights on [0, 1], exact for polynomials of degree `2 n - 1`.
pub(super) fn gauss(n: usize) -> Vec<(f64, f64)> {
    let point = |k: usize| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..STEPS {
            let (value, before) = legendre(n, x);
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(point).collect()
}

/// The Legendre polynomials of degree n and n - 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    (1..n).fold((x, 1.0), |(value, before), k| {
        let k = k as f64;
        (((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0), value)
    })
}

#[cfg(test)]
mod tests {
    use super::gauss;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in 1..=32 {
            let degree = 2 * n as i32 - 1;
            let sum: f64 = gauss(n).iter().map(|(x, w)| w * x.powi(degree)).sum();
            assert!((sum * f64::from(degree + 1) - 1.0).abs() < 1e-13, "{n}: {sum}");
        }
    }
}
