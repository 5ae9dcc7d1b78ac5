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

/// The order over several clouds a spacing, and its standard error: the slope of the regression of `log error` on `log spacing`
/// over all of them. Errors of clouds of one spacing scatter about a common law; a method of order q has an order
/// below q less two standard errors in one of forty ladders.
///
/// ```
/// let (order, error) = meshless_tests::order::over_clouds(&[(0.2, vec![0.04, 0.05]), (0.1, vec![0.01, 0.0125])]);
/// assert!((order - 2.0).abs() < 1e-12 && error > 0.2 && error < 0.25);
/// ```
pub fn over_clouds(ladder: &[(f64, Vec<f64>)]) -> (f64, f64) {
    let all: Vec<(f64, f64)> =
        ladder.iter().flat_map(|(h, errors)| errors.iter().map(|&e| (*h, e))).collect();
    let order = observed(&all);
    let n = all.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| all.iter().map(of).sum::<f64>() / n;
    let (mx, my) = (mean(&|p| p.0.ln()), mean(&|p| p.1.ln()));
    let left: f64 = all.iter().map(|(h, e)| (e.ln() - my - order * (h.ln() - mx)).powi(2)).sum();
    let spread: f64 = all.iter().map(|(h, _)| (h.ln() - mx).powi(2)).sum();
    (order, (left / (n - 2.0) / spread).sqrt())
}
