//! Segments and circular arcs: where they are, where they meet.

use std::f64::consts::TAU;

use crate::vector::{axpy, distance, dot, sub};

/// A smooth curve in the plane.
#[derive(Clone, Debug)]
pub(crate) enum Curve {
    /// A straight line between two points.
    Segment {
        /// Its start.
        from: [f64; 2],
        /// Its end.
        to: [f64; 2],
    },
    /// An arc, counterclockwise.
    Arc {
        /// Of the circle.
        center: [f64; 2],
        /// Of the circle.
        radius: f64,
        /// Angle of its start.
        start: f64,
        /// How far round it goes, at most once.
        sweep: f64,
    },
}

impl Curve {
    /// The sides of a polygon.
    pub(super) fn closed(vertices: &[[f64; 2]]) -> Vec<Self> {
        let next = vertices.iter().cycle().skip(1);
        vertices.iter().zip(next).map(|(&from, &to)| Self::Segment { from, to }).collect()
    }

    /// A circle, which begins and ends at its rightmost point.
    pub(super) fn circle(center: [f64; 2], radius: f64) -> Self {
        Self::Arc { center, radius, start: 0.0, sweep: TAU }
    }

    pub(super) fn at(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Segment { from, to } => axpy(from, t, &sub(to, from)),
            Self::Arc { center, radius, start, sweep } => {
                let (sin, cos) = (start + t * sweep).sin_cos();
                axpy(center, *radius, &[cos, sin])
            }
        }
    }

    /// Unit vector along the curve.
    pub(super) fn along(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Segment { from, to } => {
                let length = distance(from, to);
                sub(to, from).map(|d| d / length)
            }
            Self::Arc { start, sweep, .. } => {
                let (sin, cos) = (start + t * sweep).sin_cos();
                [-sin, cos]
            }
        }
    }

    /// Unit normal to the left of the way along the curve.
    pub(super) fn left(&self, t: f64) -> [f64; 2] {
        let [x, y] = self.along(t);
        [-y, x]
    }

    /// Its curvature: positive where it bends to the left.
    pub(super) fn curvature(&self) -> f64 {
        match self {
            Self::Segment { .. } => 0.0,
            Self::Arc { radius, .. } => radius.recip(),
        }
    }

    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Segment { from, to } => distance(from, to),
            Self::Arc { radius, sweep, .. } => radius * sweep,
        }
    }

    /// A box that holds it, a little larger.
    pub(super) fn bounds(&self, margin: f64) -> [[f64; 2]; 2] {
        let (low, high) = match self {
            Self::Segment { from, to } => {
                ([from[0].min(to[0]), from[1].min(to[1])], [from[0].max(to[0]), from[1].max(to[1])])
            }
            Self::Arc { center, radius, .. } => (center.map(|c| c - radius), center.map(|c| c + radius)),
        };
        [low.map(|x| x - margin), high.map(|x| x + margin)]
    }

    /// How far along it, as a fraction, the point of it is that is nearest to one that lies on it.
    pub(super) fn place_of(&self, x: &[f64; 2]) -> f64 {
        match self {
            Self::Segment { from, to } => {
                let along = sub(to, from);
                (dot(&sub(x, from), &along) / dot(&along, &along)).clamp(0.0, 1.0)
            }
            Self::Arc { center, start, sweep, .. } => {
                let [dx, dy] = sub(x, center);
                let turn = (dy.atan2(dx) - start).rem_euclid(TAU);
                // Right before the start is the end of what does not reach there.
                if turn > *sweep && turn > 0.5 * (sweep + TAU) { 0.0 } else { (turn / sweep).min(1.0) }
            }
        }
    }

    /// Distance of a point.
    pub(super) fn distance(&self, x: &[f64; 2]) -> f64 {
        distance(&self.at(self.place_of(x)), x)
    }

    /// Where two curves cross, touch or begin to run along each other.
    pub(super) fn meets(&self, other: &Self, tolerance: f64) -> Vec<[f64; 2]> {
        let mut found = match (self, other) {
            (Self::Segment { from: a, to: b }, Self::Segment { from: c, to: d }) => lines(a, b, c, d),
            (Self::Segment { from, to }, Self::Arc { center, radius, .. })
            | (Self::Arc { center, radius, .. }, Self::Segment { from, to }) => {
                line_and_circle(from, to, center, *radius, tolerance)
            }
            (Self::Arc { center: a, radius: r, .. }, Self::Arc { center: b, radius: s, .. }) => {
                circles(a, *r, b, *s, tolerance)
            }
        };
        found.extend([0.0, 1.0].map(|t| self.at(t)));
        found.extend([0.0, 1.0].map(|t| other.at(t)));
        found.retain(|x| self.distance(x) <= tolerance && other.distance(x) <= tolerance);
        found
    }

    /// The pieces between places on it.
    pub(super) fn divided(&self, mut places: Vec<f64>, tolerance: f64) -> Vec<Self> {
        let least = tolerance / self.length();
        places.retain(|t| *t > least && *t < 1.0 - least);
        places.extend([0.0, 1.0]);
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a <= least);
        places.windows(2).map(|pair| self.part(pair[0], pair[1])).collect()
    }

    fn part(&self, s: f64, t: f64) -> Self {
        match self {
            Self::Segment { .. } => Self::Segment { from: self.at(s), to: self.at(t) },
            Self::Arc { center, radius, start, sweep } => Self::Arc {
                center: *center,
                radius: *radius,
                start: start + s * sweep,
                sweep: (t - s) * sweep,
            },
        }
    }
}

fn cross(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn lines(a: &[f64; 2], b: &[f64; 2], c: &[f64; 2], d: &[f64; 2]) -> Vec<[f64; 2]> {
    let (u, v, w) = (sub(b, a), sub(d, c), sub(c, a));
    let turn = cross(&u, &v);
    let t = cross(&w, &v) / turn;
    // Parallels meet in ends only, which are looked at anyhow.
    if t.is_finite() { vec![axpy(a, t, &u)] } else { Vec::new() }
}

fn line_and_circle(
    from: &[f64; 2],
    to: &[f64; 2],
    center: &[f64; 2],
    radius: f64,
    tolerance: f64,
) -> Vec<[f64; 2]> {
    let along = sub(to, from);
    let length = distance(from, to);
    let unit = along.map(|x| x / length);
    let foot = axpy(from, dot(&sub(center, from), &unit), &unit);
    let away = distance(&foot, center);
    if away > radius + tolerance {
        return Vec::new();
    }
    let half = (radius * radius - away * away).max(0.0).sqrt();
    [-half, half].map(|t| axpy(&foot, t, &unit)).to_vec()
}

fn circles(a: &[f64; 2], r: f64, b: &[f64; 2], s: f64, tolerance: f64) -> Vec<[f64; 2]> {
    let d = distance(a, b);
    if d <= tolerance || d > r + s + tolerance || d < (r - s).abs() - tolerance {
        return Vec::new();
    }
    let unit = sub(b, a).map(|x| x / d);
    let along = 0.5 * (d + (r - s) * (r + s) / d);
    let half = (r * r - along * along).max(0.0).sqrt();
    let foot = axpy(a, along, &unit);
    [-half, half].map(|t| axpy(&foot, t, &[-unit[1], unit[0]])).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_meet_where_they_do() {
        let circle = Curve::circle([0.0, 0.0], 1.0);
        let line = Curve::Segment { from: [-2.0, 0.6], to: [2.0, 0.6] };
        let mut found = line.meets(&circle, 1e-12);
        found.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(found.len(), 2);
        assert!((found[0][0] + 0.8).abs() < 1e-12 && (found[1][0] - 0.8).abs() < 1e-12);
        assert!((circle.at(circle.place_of(&found[0]))[0] + 0.8).abs() < 1e-12);
        let other = Curve::circle([1.0, 0.0], 1.0);
        assert!(circle.meets(&other, 1e-12).iter().all(|x| (x[0] - 0.5).abs() < 1e-12));
        let beside = Curve::Segment { from: [0.0, 0.6], to: [3.0, 0.6] };
        assert_eq!(line.meets(&beside, 1e-12).len(), 2, "ends on each other");
    }

    #[test]
    fn pieces_add_up() {
        for curve in [Curve::circle([0.3, 0.1], 2.0), Curve::Segment { from: [0.0, 0.0], to: [3.0, 4.0] }] {
            let pieces = curve.divided(vec![0.25, 0.250_000_000_000_1, 0.9, 1e-14], 1e-9);
            assert_eq!(pieces.len(), 3);
            let total: f64 = pieces.iter().map(Curve::length).sum();
            assert!((total - curve.length()).abs() < 1e-12);
            assert!(distance(&pieces[1].at(0.0), &curve.at(0.25)) < 1e-12);
        }
    }
}
