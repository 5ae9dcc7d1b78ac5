//! Which levels bound the bands, and what they are called.

use crate::ticks::{label, labels, multiples, power_of_ten, step_for};

/// A logarithmic picture shows no more than this many decades below the largest value: what lies below is round-off.
const DECADES: f64 = 16.0;

/// The scale of the colours.
pub(super) struct Levels {
    /// Lowest and highest value.
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// Bounds between the bands, ascending.
    pub(super) inner: Vec<f64>,
    step: f64,
    log: bool,
}

impl Levels {
    /// About `count` bands for the finite ones of `values`; `None` if there are none.
    pub(super) fn new(values: &[f64], count: usize, log: bool) -> Option<Self> {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let (lo, hi) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        if lo > hi {
            return None;
        }
        let (mut inner, mut step) = (Vec::new(), 0.0);
        // A field that varies by round-off only is constant.
        if hi - lo > 1e-12 * lo.abs().max(hi.abs()) && (hi - lo).is_finite() {
            step = step_for(hi - lo, count.clamp(1, 100));
            inner = multiples(lo, hi, step);
            inner.retain(|&level| level > lo && level < hi);
        }
        Some(Self { lo, hi, inner, step, log })
    }

    /// Number of bands.
    pub(super) fn bands(&self) -> usize {
        self.inner.len() + 1
    }

    /// The labels of the colour bar, `(level, text)`, and their common factor. A constant field has one label; a
    /// logarithmic scale has labels at the decades if there are several.
    pub(super) fn labels(&self) -> (Vec<(f64, String)>, String) {
        let shown = |value: f64| if self.log { 10_f64.powf(value) } else { value };
        if self.inner.is_empty() {
            return (vec![(self.lo, label(shown(self.lo)))], String::new());
        }
        if !self.log {
            let labels = labels(&self.inner, self.step);
            return (self.inner.iter().copied().zip(labels.texts).collect(), labels.factor);
        }
        let whole = |level: &f64| (level - level.round()).abs() < 1e-9;
        let decades: Vec<f64> = self.inner.iter().copied().filter(whole).collect();
        let labelled = if decades.len() > 1 {
            decades.into_iter().map(|level| (level, power_of_ten(level.round() as i32))).collect()
        } else {
            self.inner.iter().map(|&level| (level, label(shown(level)))).collect()
        };
        (labelled, String::new())
    }
}

/// The values to draw: decimal logarithms if `log`, where the lowest positive value stands for what has none.
pub(super) fn shown(values: &[f64], log: bool) -> Vec<f64> {
    if !log {
        return values.iter().map(|&v| if v.is_finite() { v } else { f64::NAN }).collect();
    }
    let positive = values.iter().copied().filter(|v| v.is_finite() && *v > 0.0);
    let (lo, hi) = positive.fold((f64::INFINITY, 0.0), |(lo, hi), v| (f64::min(lo, v), f64::max(hi, v)));
    let floor = lo.log10().max(hi.log10() - DECADES);
    let shown =
        |v: f64| if v.is_finite() && floor.is_finite() { v.max(0.0).log10().max(floor) } else { f64::NAN };
    values.iter().map(|&v| shown(v)).collect()
}
