//! Integrals over regions: of sources by their surfaces, of what is known at the nodes by these.
//!
//! With `div F = f` the integral of f over a region is that of `F . n` over its surface: `F = f x / D` for a constant, else the
//! integral of f along an axis. Where f is not smooth beyond its region, so that the latter does not converge, and for what is known at
//! nodes only, the mean over the nodes times the volume serves.

use meshless_geometry::gauss;
use meshless_interfaces::{Field, Problem};

use super::surfaces::Surfaces;

/// Points along a line, one number after the other until two agree.
const LINE_POINTS: [usize; 4] = [8, 16, 32, 64];

/// How closely two of them must agree, over the sum of the sizes of the parts.
const AGREE: f64 = 1e-9;

/// The part of a source that lines must see of what nodes see: narrow ones lie between the lines, which then agree on nothing.
const MISSED: f64 = 0.5;

/// Ratio of the measures of nodes beyond which a cloud is graded, not only at its boundary; and what of an integral over the nodes is in doubt then:
/// powers of the spacing are the measures of nodes in the mean only.
const GRADED: f64 = 16.0;
const IN_GRADED: f64 = 0.1;

/// How much of the volume by the nodes that by the surfaces may differ before it is not believed.
const PLAUSIBLE: f64 = 0.5;

/// An integral with the error that is to be expected of it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Content {
    pub(super) value: f64,
    pub(super) doubt: f64,
    /// The integral of the size.
    pub(super) size: f64,
}

impl Content {
    /// Adds a part.
    pub(super) fn add(&mut self, part: f64) {
        self.value += part;
        self.size += part.abs();
    }
}

/// A region as its surface has it.
pub(super) struct Body<const D: usize> {
    /// Points with the normal out of it times the area.
    points: Vec<([f64; D], [f64; D])>,
    center: [f64; D],
    volume: f64,
}

impl<const D: usize> Body<D> {
    /// Those of all regions.
    pub(super) fn all(problem: &Problem<'_, D>, surfaces: &Surfaces<D>, measures: &[f64]) -> Vec<Self> {
        let mut points = vec![Vec::new(); problem.regions.len()];
        for wall in &surfaces.walls {
            let e = &wall.element;
            points[wall.region as usize].push((e.at, e.normal.map(|n| e.area * n)));
        }
        for seam in &surfaces.seams {
            let e = &seam.element;
            points[seam.between[0] as usize].push((e.at, e.normal.map(|n| e.area * n)));
            points[seam.between[1] as usize].push((e.at, e.normal.map(|n| -e.area * n)));
        }
        let nodal = |label: usize| -> f64 {
            let own = problem.labels.iter().zip(measures).filter(|(l, _)| **l as usize == label);
            own.map(|(_, measure)| measure).sum()
        };
        points.into_iter().enumerate().map(|(label, points)| Self::new(points, nodal(label))).collect()
    }

    fn new(points: Vec<([f64; D], [f64; D])>, nodal: f64) -> Self {
        let center = std::array::from_fn(|k| {
            let ends = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (x, _)| {
                (low.min(x[k]), high.max(x[k]))
            });
            0.5 * (ends.0 + ends.1)
        });
        let out = |(x, n): &([f64; D], [f64; D])| (0..D).map(|k| (x[k] - center[k]) * n[k]).sum::<f64>();
        let volume = points.iter().map(out).sum::<f64>() / D as f64;
        let plausible = (volume - nodal).abs() <= PLAUSIBLE * nodal;
        Self { points, center, volume: if plausible { volume } else { nodal } }
    }

    /// The integral of a source.
    pub(super) fn source(&self, field: &Field<D>, own: impl FnOnce() -> Vec<(f64, f64)>) -> Content {
        match field.as_constant() {
            Some(value) => {
                let value = value * self.volume;
                Content { value, doubt: 0.0, size: value.abs() }
            }
            None => {
                let own = own();
                let seen = MISSED * self.nodal(&own).size;
                (0..D).find_map(|axis| self.along(field, axis, seen)).unwrap_or_else(|| self.nodal(&own))
            }
        }
    }

    /// The integral of a function by its integrals along an axis from the middle of the region; `None` where they do not converge, or
    /// to less of its size than `seen`, which the nodes see.
    fn along(&self, field: &Field<D>, axis: usize, seen: f64) -> Option<Content> {
        let mut before: Option<f64> = None;
        let mut values = Vec::new();
        for points in LINE_POINTS {
            let rule = gauss(points);
            let on_lines = self.points.iter().flat_map(|(x, _)| {
                let start = self.center[axis];
                rule.iter().map(move |(t, _)| {
                    let mut at = *x;
                    at[axis] = start + t * (x[axis] - start);
                    at
                })
            });
            let places: Vec<[f64; D]> = on_lines.collect();
            values.resize(places.len(), 0.0);
            field.eval(&places, &mut values);
            let (mut sum, mut size, mut whole) = (0.0, 0.0, 0.0);
            for ((x, n), values) in self.points.iter().zip(values.chunks(points)) {
                let mean: f64 = values.iter().zip(&rule).map(|(value, (_, w))| value * w).sum();
                let part = mean * (x[axis] - self.center[axis]) * n[axis];
                let mean: f64 = values.iter().zip(&rule).map(|(value, (_, w))| value.abs() * w).sum();
                whole += (mean * (x[axis] - self.center[axis]) * n[axis]).abs();
                sum += part;
                size += part.abs();
            }
            if !size.is_finite() {
                return None;
            }
            if let Some(before) = before
                && (sum - before).abs() <= AGREE * size
                && whole >= seen
            {
                return Some(Content { value: sum, doubt: (sum - before).abs(), size: whole });
            }
            before = Some(sum);
        }
        None
    }

    /// The integral of what is known at nodes: its mean over those of the region times the volume. How much two halves of the nodes
    /// differ tells how good that is.
    pub(super) fn nodal(&self, own: &[(f64, f64)]) -> Content {
        let size = {
            let (volume, sum) =
                own.iter().fold((0.0, 0.0), |(all, sum), (m, value)| (all + m, sum + m * value.abs()));
            if volume > 0.0 { sum / volume * self.volume.abs() } else { 0.0 }
        };
        let mean = |first: usize, step: usize| {
            let some = || own.iter().skip(first).step_by(step);
            let volume: f64 = some().map(|(measure, _)| measure).sum();
            if volume > 0.0 {
                some().map(|(measure, value)| measure * value).sum::<f64>() / volume
            } else {
                0.0
            }
        };
        let halves = if own.len() > 1 { (mean(0, 2) - mean(1, 2)).abs() } else { mean(0, 1).abs() };
        let (least, most) =
            own.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), (m, _)| (least.min(*m), most.max(*m)));
        let of_graded = if most > GRADED * least { IN_GRADED * size } else { 0.0 };
        let doubt = (halves * self.volume.abs()).max(of_graded);
        Content { value: mean(0, 1) * self.volume, doubt, size }
    }
}
