//! Generalised Laguerre polynomials.

/// The values `L_0^(a)(x), L_1^(a)(x), ...` by `(n+1) L_(n+1) = (2n+1+a-x) L_n - (n+a) L_(n-1)`.
pub(super) fn laguerre(a: f64, x: f64) -> impl Iterator<Item = f64> {
    let (mut before, mut here, mut n) = (0.0, 1.0, 0.0);
    std::iter::from_fn(move || {
        let value = here;
        (before, here) = (here, ((2.0 * n + 1.0 + a - x) * here - (n + a) * before) / (n + 1.0));
        n += 1.0;
        Some(value)
    })
}
