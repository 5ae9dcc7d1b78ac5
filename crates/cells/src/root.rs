//! A level set on the edges of a cell: its size, and its root on one of them.

/// Change of the parameter between two steps, as a fraction of the edge, at which a root counts as found: a few units
/// in the last place, so that the cells on both sides of an edge find the same point to round-off.
const ROOT_TOLERANCE: f64 = 4.0 * f64::EPSILON;

/// Steps of the secant kind before plain bisection takes over; a simple root needs fewer than ten.
const SECANT_STEPS: usize = 30;

/// Bisections that bring any bracket within the edge below the tolerance.
const BISECTIONS: usize = 60;

/// The largest magnitude of numbers; `None` if one is not a number.
pub(crate) fn largest_magnitude(values: &[f64]) -> Option<f64> {
    values.iter().try_fold(0.0_f64, |largest, value| (!value.is_nan()).then(|| largest.max(value.abs())))
}

/// Finds `t` in `[0, 1]` where `value` changes sign, given `start = value(0) <= 0 < end = value(1)`.
///
/// Regula falsi with the Illinois weighting (Dowell & Jarratt 1971, BIT 11), followed by bisection in hard cases. `None`
/// if a value is not a number.
pub(crate) fn bracketed_root(start: f64, end: f64, mut value: impl FnMut(f64) -> f64) -> Option<f64> {
    let (mut lo, mut f_lo) = (0.0, start);
    let (mut hi, mut f_hi) = (1.0, end);
    if f_lo == 0.0 {
        return Some(lo);
    }
    let mut moved = std::cmp::Ordering::Equal;
    let mut last = f64::INFINITY;
    for step in 0..SECANT_STEPS + BISECTIONS {
        let secant = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
        let t = if step < SECANT_STEPS && secant >= lo && secant <= hi { secant } else { 0.5 * (lo + hi) };
        if (t - last).abs() <= ROOT_TOLERANCE || hi - lo <= ROOT_TOLERANCE {
            return Some(t);
        }
        last = t;
        let f = value(t);
        // An end that stays for the second time in a row loses half its weight.
        match f.partial_cmp(&0.0)? {
            std::cmp::Ordering::Equal => return Some(t),
            std::cmp::Ordering::Less => {
                (lo, f_lo) = (t, f);
                if moved.is_lt() {
                    f_hi *= 0.5;
                }
                moved = std::cmp::Ordering::Less;
            }
            std::cmp::Ordering::Greater => {
                (hi, f_hi) = (t, f);
                if moved.is_gt() {
                    f_lo *= 0.5;
                }
                moved = std::cmp::Ordering::Greater;
            }
        }
    }
    Some(0.5 * (lo + hi))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(f: impl Fn(f64) -> f64) -> f64 {
        bracketed_root(f(0.0), f(1.0), f).unwrap()
    }

    #[test]
    fn finds_roots_of_every_kind() {
        let third = 1.0 / 3.0;
        assert!((root(|t| t - third) - third).abs() < 1e-15);
        assert!((root(|t| t * t - 0.5) - 0.5_f64.sqrt()).abs() < 1e-15);
        assert!((root(|t| (20.0 * t).exp() - 1000.0) - 1000_f64.ln() / 20.0).abs() < 1e-15);
        assert!((root(|t| if t < third { -1.0 } else { 1e-9 }) - third).abs() < 1e-15);
        assert!((root(|t| if t < third { f64::NEG_INFINITY } else { f64::INFINITY }) - third).abs() < 1e-15);
        // A triple root: the function is flat, so its zero is sharp only to the cube root of the smallest number.
        assert!((root(|t| (t - third).powi(3)) - third).abs() < 1e-9);
        assert!(root(|t| t).abs() == 0.0);
    }

    #[test]
    fn not_a_number_is_reported() {
        assert_eq!(bracketed_root(-1.0, 1.0, |_| f64::NAN), None);
    }
}
