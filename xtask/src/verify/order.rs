//! Observed orders of convergence.

/// Order between two successive rungs of a ladder: `ln(e1/e0) / ln(h1/h0)`.
pub(crate) fn between(coarse: (f64, f64), fine: (f64, f64)) -> Option<f64> {
    let order = (fine.1 / coarse.1).ln() / (fine.0 / coarse.0).ln();
    order.is_finite().then_some(order)
}

/// Order over a whole ladder of `(spacing, error)`: slope of the least-squares line through the logarithms.
///
/// Needs two rungs at least; rungs with a vanishing or non-finite error make it undefined.
pub(crate) fn fit(ladder: &[(f64, f64)]) -> Option<f64> {
    if ladder.len() < 2 {
        return None;
    }
    let n = ladder.len() as f64;
    let logs: Vec<(f64, f64)> = ladder.iter().map(|&(h, e)| (h.ln(), e.ln())).collect();
    let mean_x = logs.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = logs.iter().map(|p| p.1).sum::<f64>() / n;
    let xy: f64 = logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    let xx: f64 = logs.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
    let slope = xy / xx;
    slope.is_finite().then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::{between, fit};

    #[test]
    fn exact_powers_give_their_exponent() {
        for order in [0.0, 1.0, 2.5] {
            let ladder: Vec<(f64, f64)> =
                (0..5).map(|k| 0.2 * 0.5_f64.powi(k)).map(|h| (h, 3.0 * h.powf(order))).collect();
            assert!(fit(&ladder).is_some_and(|q| (q - order).abs() < 1e-12));
            assert!(between(ladder[1], ladder[2]).is_some_and(|q| (q - order).abs() < 1e-12));
        }
    }

    #[test]
    fn the_fit_weighs_all_rungs() {
        // ln e = 0, 0, 1 over ln h = 0, 1, 2: the line through them rises by 1/2.
        let ladder = [(1.0, 1.0), (1.0_f64.exp(), 1.0), (2.0_f64.exp(), 1.0_f64.exp())];
        assert!(fit(&ladder).is_some_and(|q| (q - 0.5).abs() < 1e-12));
    }

    #[test]
    fn an_order_needs_two_rungs_with_errors() {
        assert_eq!(fit(&[(0.1, 1.0)]), None);
        assert_eq!(fit(&[(0.1, 1.0), (0.05, 0.0)]), None);
        assert_eq!(between((0.1, f64::NAN), (0.05, 1.0)), None);
    }
}
