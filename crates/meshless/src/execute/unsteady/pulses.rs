//! Data that change for a short while: no step may pass over what its stages do not see.

use meshless_geometry::Cloud;

use crate::scene::Scene;

/// Intervals of the whole time at whose ends data are looked at.
const INTERVALS: usize = 2048;

/// Nodes at which they are looked at, about.
const PLACES: usize = 64;

/// How far data may be from the parabola through the stages of a step, over their largest value.
const UNSEEN: f64 = 1e-2;

/// Place of the middle stage of TR-BDF2 in its step.
const MIDDLE: f64 = 2.0 - std::f64::consts::SQRT_2;

/// Values of the data over time.
pub(super) struct Pulses {
    /// Length of an interval.
    interval: f64,
    /// Of every expression at every place that it changes at: its values over its largest.
    series: Vec<Vec<f64>>,
}

impl Pulses {
    /// Looks at the expressions of a scene that depend on `t`, at some of the nodes.
    pub(super) fn new<const D: usize>(scene: &Scene, cloud: &Cloud<D>) -> Self {
        let end = scene.time.as_ref().map_or(0.0, |time| time.end);
        let interval = end / INTERVALS as f64;
        let stride = cloud.points().len().div_ceil(PLACES).max(1);
        let places: Vec<[f64; D]> = cloud.points().iter().copied().step_by(stride).collect();
        let mut series = Vec::new();
        for field in scene.changing_data() {
            let mut values = vec![0.0; places.len()];
            let mut over_time = vec![Vec::with_capacity(INTERVALS + 1); places.len()];
            for k in 0..=INTERVALS {
                field.expr.eval_points(&places, &[interval * k as f64], &mut values);
                over_time.iter_mut().zip(&values).for_each(|(all, &value)| all.push(value));
            }
            // What is no number at a place need not be one there: conditions count on their faces only.
            over_time.retain(|all| all.iter().all(|x| x.is_finite()) && all.iter().any(|&x| x != all[0]));
            let largest = over_time.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
            over_time.iter_mut().flatten().for_each(|x| *x /= largest);
            series.extend(over_time);
        }
        Self { interval, series }
    }

    /// How far to go from `t` towards `target` when the next step has this length, or is not known yet: to the target, unless
    /// the step would pass over something.
    pub(super) fn reach(&self, t: f64, step: f64, target: f64) -> f64 {
        let rest = target - t;
        let step = if step > 0.0 { step.min(rest) } else { FIRST * rest };
        if self.is_seen(t, step) {
            return target;
        }
        // Two intervals have a sample between them, and what is shorter is left to the error estimate.
        let least = 2.0 * self.interval;
        let (mut clear, mut blind) = (0.0, step);
        while blind - clear > 0.5 * self.interval {
            let middle = 0.5 * (clear + blind);
            if self.is_seen(t, middle) { clear = middle } else { blind = middle }
        }
        let reach = t + clear.max(least);
        if reach < target { reach } else { target }
    }

    /// Whether all data in a step are near the parabolas through what its stages see.
    fn is_seen(&self, t: f64, step: f64) -> bool {
        let at = |all: &[f64], t: f64| {
            let place = (t / self.interval).clamp(0.0, INTERVALS as f64);
            let k = (place as usize).min(INTERVALS - 1);
            all[k] + (place - k as f64) * (all[k + 1] - all[k])
        };
        let first = (t / self.interval).ceil() as usize;
        let last = (((t + step) / self.interval).floor() as usize).min(INTERVALS);
        self.series.iter().all(|all| {
            let [a, m, b] = [0.0, MIDDLE, 1.0].map(|s| at(all, t + s * step));
            // a + s (slope + s bend) through the middle and the end.
            let bend = ((m - a) / MIDDLE - (b - a)) / (MIDDLE - 1.0);
            let slope = b - a - bend;
            (first..=last).all(|k| {
                let s = (self.interval * k as f64 - t) / step;
                (all[k] - a - s * (slope + s * bend)).abs() <= UNSEEN
            })
        })
    }
}

/// Part of what is left that the first step is not longer than.
const FIRST: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::{INTERVALS, Pulses};

    fn pulses(data: impl Fn(f64) -> f64) -> Pulses {
        let interval = 1.0 / INTERVALS as f64;
        Pulses { interval, series: vec![(0..=INTERVALS).map(|k| data(interval * k as f64)).collect()] }
    }

    #[test]
    fn what_the_stages_see_does_not_shorten_a_step() {
        assert_eq!(pulses(|t| t * t - t).reach(0.1, 0.9, 1.0), 1.0);
        assert_eq!(pulses(|t| (3.0 * t).sin()).reach(0.0, 0.2, 1.0), 1.0);
        assert_eq!(Pulses { interval: 0.1, series: Vec::new() }.reach(0.0, 1.0, 1.0), 1.0);
    }

    #[test]
    fn a_step_ends_before_a_pulse() {
        for width in [0.2, 0.02, 0.002] {
            let pulse = pulses(|t| f64::from(u8::from((t - 0.5).abs() < 0.5 * width)));
            let reach = pulse.reach(0.1, 0.8, 1.0);
            let start = 0.5 - 0.5 * width;
            assert!(reach <= start && reach > start - 0.002, "{width}: {reach}");
            // Across its start by steps of two samples.
            let next = pulse.reach(reach, 0.8, 1.0);
            assert!(next > start && next < reach + 0.002, "{width}: {next}");
        }
    }

    #[test]
    fn the_first_step_is_short_enough() {
        let reach = pulses(|t| (-((t - 0.05) / 0.01).powi(2)).exp()).reach(0.0, 0.0, 1.0);
        assert!(reach < 0.05, "{reach}");
    }
}
