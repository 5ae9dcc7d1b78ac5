//! What a chart shows and where: visible points in axis coordinates, ranges, ticks, reference lines.

use super::{Axis, Chart, Scale, Series};
use crate::ticks::{labels, linear_ticks, log_ticks, minus};

/// Room beside the outermost points, as a fraction of the range.
const MARGIN: f64 = 0.06;

/// Room at the right for the labels of reference lines, as a fraction of the range.
const REFERENCE_ROOM: f64 = 0.12;

/// How far below the data a reference line passes, in decades.
const REFERENCE_GAP: f64 = 0.25;

/// A point in axis coordinates: decimal logarithms on logarithmic axes.
pub(super) type Place = (f64, f64);

/// One axis, ready to be drawn.
#[derive(Clone)]
pub(super) struct Range {
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// Ticks with labels.
    pub(super) labelled: Vec<(f64, String)>,
    /// Ticks without.
    pub(super) minor: Vec<f64>,
    /// Factor that all labels have in common, empty if none.
    pub(super) factor: String,
}

/// A dashed line of a given order.
pub(super) struct Reference {
    pub(super) from: Place,
    pub(super) to: Place,
    pub(super) label: String,
}

/// Everything that is drawn, in axis coordinates.
pub(super) struct Frame {
    pub(super) x: Range,
    pub(super) y: Range,
    /// For each series the runs of visible points.
    pub(super) runs: Vec<Vec<Vec<Place>>>,
    pub(super) references: Vec<Reference>,
}

impl Frame {
    /// `None` if no point is visible.
    pub(super) fn new(chart: &Chart, x_ticks: usize, y_ticks: usize) -> Option<Self> {
        let runs: Vec<_> = chart.series.iter().map(|series| visible_runs(series, chart)).collect();
        let places: Vec<Place> = runs.iter().flatten().flatten().copied().collect();
        let (x_lo, x_hi) = extent(places.iter().map(|p| p.0))?;
        let (mut y_lo, y_hi) = extent(places.iter().map(|p| p.1))?;
        let both_log = chart.x.scale == Scale::Log && chart.y.scale == Scale::Log;
        let mut references = Vec::new();
        if both_log && x_hi > x_lo {
            let orders = chart.reference_slopes.iter().copied().filter(|order| order.is_finite());
            references = orders.filter_map(|order| reference(order, &places, x_lo, x_hi)).collect();
            // Room for the flattest of them; a steep one may leave the chart.
            let lowest = references.iter().map(|r| r.from.1.min(r.to.1)).fold(f64::INFINITY, f64::min);
            y_lo = y_lo.min(lowest.max(y_lo - 0.35 * (y_hi - y_lo) - REFERENCE_GAP));
        }
        let room = if references.is_empty() { 0.0 } else { REFERENCE_ROOM * (x_hi - x_lo) };
        let x = range(&chart.x, x_lo, x_hi + room, x_ticks);
        let y = range(&chart.y, y_lo, y_hi, y_ticks);
        references.iter_mut().for_each(|line| line.clip_below(y.lo));
        Some(Self { x, y, runs, references })
    }
}

impl Reference {
    /// Shortens the line to what lies above `lowest`.
    fn clip_below(&mut self, lowest: f64) {
        let (a, b) = (self.from, self.to);
        let crossing = |t: f64| (a.0 + t * (b.0 - a.0), lowest);
        let t = (lowest - a.1) / (b.1 - a.1);
        if a.1 < lowest && b.1 > lowest {
            self.from = crossing(t);
        } else if b.1 < lowest && a.1 > lowest {
            self.to = crossing(t);
        }
    }
}

/// The line of the given order that passes below all points, none if it leaves the range of numbers.
fn reference(order: f64, places: &[Place], x_lo: f64, x_hi: f64) -> Option<Reference> {
    let lowest = places.iter().map(|p| p.1 - order * p.0).fold(f64::INFINITY, f64::min) - REFERENCE_GAP;
    let at = |x: f64| (x, lowest + order * x);
    let (from, to) = (at(x_lo), at(x_hi));
    let finite = from.1.is_finite() && to.1.is_finite();
    finite.then(|| Reference { from, to, label: format!("slope {}", minus(&order.to_string())) })
}

fn visible_runs(series: &Series, chart: &Chart) -> Vec<Vec<Place>> {
    let place = |&(x, y): &(f64, f64)| Some((coordinate(&chart.x, x)?, coordinate(&chart.y, y)?));
    let places: Vec<Option<Place>> = series.points.iter().map(place).collect();
    places
        .split(Option::is_none)
        .map(|run| run.iter().copied().flatten().collect())
        .filter(|run: &Vec<_>| !run.is_empty())
        .collect()
}

/// Where a value lies on an axis, `None` if it cannot be shown.
fn coordinate(axis: &Axis, value: f64) -> Option<f64> {
    match axis.scale {
        Scale::Linear => Some(value).filter(|v| v.is_finite()),
        Scale::Log => Some(value.log10()).filter(|v| value > 0.0 && v.is_finite()),
    }
}

fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, v| match range {
        None => Some((v, v)),
        Some((lo, hi)) => Some((f64::min(lo, v), f64::max(hi, v))),
    })
}

/// The axis from a little below `lo` to a little above `hi`, with ticks.
fn range(axis: &Axis, lo: f64, hi: f64, target: usize) -> Range {
    let smallest = match axis.scale {
        Scale::Log => 0.5,
        Scale::Linear => 1e-9 * lo.abs().max(hi.abs()).max(1e-290),
    };
    // Half of each before adding: the difference of two huge numbers may overflow.
    let (middle, half) = (0.5 * lo + 0.5 * hi, (0.5 * hi - 0.5 * lo).max(0.5 * smallest));
    let half = half * (1.0 + 2.0 * MARGIN);
    let (lo, hi) = (middle - half, middle + half);
    match axis.scale {
        Scale::Linear => {
            let (ticks, step) = linear_ticks(lo, hi, target);
            let labels = labels(&ticks, step);
            let factor = labels.factor;
            Range {
                lo,
                hi,
                labelled: ticks.into_iter().zip(labels.texts).collect(),
                minor: Vec::new(),
                factor,
            }
        }
        Scale::Log => {
            let ticks = log_ticks(lo, hi, target);
            Range { lo, hi, labelled: ticks.labelled, minor: ticks.minor, factor: String::new() }
        }
    }
}
