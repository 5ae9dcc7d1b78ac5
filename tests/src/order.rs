//! The observed order of convergence.

/// Least-squares slope of `log error` against `log spacing`.
///
/// ```
/// let order = meshless_tests::order::observed(&[(0.4, 0.16), (0.2, 0.04), (0.1, 0.01)]);
/// assert!((order - 2.0).abs() < 1e-12);
/// ```
pub fn observed(ladder: &[(f64, f64)]) -> f64 {
    let n = ladder.len() as f64;
    let (xs, ys): (Vec<f64>, Vec<f64>) = ladder.iter().map(|&(h, e)| (h.ln(), e.ln())).unzip();
    let (mx, my) = (xs.iter().sum::<f64>() / n, ys.iter().sum::<f64>() / n);
    let covariance: f64 = xs.iter().zip(&ys).map(|(x, y)| (x - mx) * (y - my)).sum();
    covariance / xs.iter().map(|x| (x - mx) * (x - mx)).sum::<f64>()
}
