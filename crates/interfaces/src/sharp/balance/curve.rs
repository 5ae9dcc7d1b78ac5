//! Smooth pieces of surfaces in the plane, cut where something that is asked of their points changes.

use meshless_geometry::{Aabb, Shape};

/// Steps of a walk along a piece, over the spacing: what changes twice within a step may be missed, and a cell with a face missing is
/// found by its not being closed.
const STEP: f64 = 0.1;

/// Bisections of a step: down to round-off.
const BISECTIONS: usize = 50;

/// Changes within one step at most: more are noise.
const CHANGES: usize = 16;

/// A level set and its gradient.
pub(super) type Level<'a> = dyn Fn(&[f64; 2]) -> (f64, [f64; 2]) + Sync + 'a;

/// Length of a chord of a level set, over the spacing.
const CHORD: f64 = 0.5;

/// Steps of Newton's method onto a level set.
const NEWTON_STEPS: usize = 20;

/// Newton's steps shorter than this, over the length of the chord, are the last.
const LAST_STEP: f64 = 1e-15;

/// Chords of one level set at most.
const MOST_CHORDS: usize = 100_000;

/// A straight piece, one of a circle, or one of a level set.
#[derive(Clone, Copy)]
pub(super) enum Curve<'a> {
    /// From a point along a vector; the normal times the length.
    Segment { from: [f64; 2], along: [f64; 2], normal: [f64; 2] },
    /// What a level set is over a chord.
    Level { from: [f64; 2], along: [f64; 2], level: &'a Level<'a> },
    /// Part of a circle between two angles.
    Arc { center: [f64; 2], radius: f64, from: f64, turn: f64 },
}

/// A part of a curve between two parameters on which what was asked is the same.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<K> {
    pub(super) between: [f64; 2],
    pub(super) key: K,
}

impl Curve<'_> {
    /// From one point to another, the normal to the right.
    pub(super) fn between(a: [f64; 2], b: [f64; 2]) -> Self {
        let along = [b[0] - a[0], b[1] - a[1]];
        Self::Segment { from: a, along, normal: [along[1], -along[0]] }
    }

    /// The point at a parameter from 0 to 1, and the normal there times the length to a unit of the parameter.
    pub(super) fn at(&self, t: f64) -> ([f64; 2], [f64; 2]) {
        match self {
            Self::Segment { from, along, normal } => {
                ([from[0] + t * along[0], from[1] + t * along[1]], *normal)
            }
            Self::Level { from, along, level } => {
                let length = along[0].hypot(along[1]);
                let across = [along[1] / length, -along[0] / length];
                let mut x = [from[0] + t * along[0], from[1] + t * along[1]];
                let mut tangent = *along;
                for _ in 0..NEWTON_STEPS {
                    let (value, slope) = level(&x);
                    let steep = slope[0] * across[0] + slope[1] * across[1];
                    let step = -value / steep;
                    // A chord that is no graph leaves a cell open.
                    if !step.is_finite() || step.abs() > length {
                        break;
                    }
                    x = [x[0] + step * across[0], x[1] + step * across[1]];
                    let rise = -(slope[0] * along[0] + slope[1] * along[1]) / steep;
                    tangent = [along[0] + rise * across[0], along[1] + rise * across[1]];
                    if step.abs() <= LAST_STEP * length {
                        break;
                    }
                }
                (x, [tangent[1], -tangent[0]])
            }
            Self::Arc { center, radius, from, turn } => {
                let (sin, cos) = (from + t * turn).sin_cos();
                let length = radius * turn;
                ([center[0] + radius * cos, center[1] + radius * sin], [length * cos, length * sin])
            }
        }
    }

    fn length(&self) -> f64 {
        match self {
            Self::Segment { along, .. } | Self::Level { along, .. } => along[0].hypot(along[1]),
            Self::Arc { radius, turn, .. } => radius * turn.abs(),
        }
    }

    /// Cuts a part of the curve where a key changes, by bisection; the spacing at a point tells how closely to look.
    pub(super) fn split<K: PartialEq + Copy>(
        &self,
        [first, last]: [f64; 2],
        spacing: impl Fn(&[f64; 2]) -> f64,
        key: impl Fn(&[f64; 2], &[f64; 2]) -> K,
    ) -> Vec<Piece<K>> {
        let length = self.length();
        // The ends may be corners, of which nothing is asked.
        let beside = f64::EPSILON.sqrt() * (last - first);
        let ask = |t: f64| {
            let (x, normal) = self.at(t.clamp(first + beside, last - beside));
            let size = normal[0].hypot(normal[1]);
            key(&x, &normal.map(|n| n / size))
        };
        let mut pieces = Vec::new();
        let (mut begin, mut t, mut current) = (first, first, ask(first));
        while t < last {
            let step = STEP * spacing(&self.at(t).0) / length;
            let next = if step.is_finite() && step > 0.0 { (t + step).min(last) } else { last };
            let there = ask(next);
            for _ in 0..CHANGES {
                if there == current {
                    break;
                }
                let (mut low, mut high) = (t.max(begin), next);
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (low + high);
                    if ask(middle) == current { low = middle } else { high = middle }
                }
                pieces.push(Piece { between: [begin, high], key: current });
                (begin, current) = (high, ask((high + f64::EPSILON.sqrt() * step).min(next)));
            }
            t = next;
        }
        pieces.push(Piece { between: [begin, last], key: current });
        pieces.retain(|piece| piece.between[1] > piece.between[0]);
        pieces
    }
}

/// The surface of a primitive within a box; `None` where it is not made of straight and round pieces.
pub(super) fn curves(shape: &Shape<2>, bounds: &Aabb<2>) -> Option<Vec<Curve<'static>>> {
    match shape {
        Shape::Box(b) => {
            let ([x0, y0], [x1, y1]) = (b.min, b.max);
            let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
            Some((0..4).map(|k| Curve::between(corners[k], corners[(k + 1) % 4])).collect())
        }
        Shape::Polygon(polygon) => {
            let v = polygon.vertices();
            let ccw = polygon.area() > 0.0;
            let edge = |k: usize| {
                let (a, b) = (v[k], v[(k + 1) % v.len()]);
                if ccw { Curve::between(a, b) } else { Curve::between(b, a) }
            };
            Some((0..v.len()).map(edge).collect())
        }
        Shape::Ball(ball) => Some(vec![Curve::Arc {
            center: *ball.center(),
            radius: ball.radius(),
            from: 0.0,
            turn: std::f64::consts::TAU,
        }]),
        Shape::HalfSpace(h) => {
            let (n, middle) = (*h.normal(), bounds.center());
            let height = h.offset() - (n[0] * middle[0] + n[1] * middle[1]);
            let reach = bounds.diameter();
            let at = |s: f64| [middle[0] + height * n[0] - s * n[1], middle[1] + height * n[1] + s * n[0]];
            Some(vec![Curve::between(at(-reach), at(reach))])
        }
        _ => None,
    }
}

/// A level set in chords that begin and end on it, from any of its points on.
pub(super) fn trace<'a>(
    level: &'a Level<'a>,
    starts: &[[f64; 2]],
    bounds: &Aabb<2>,
    spacing: impl Fn(&[f64; 2]) -> f64,
) -> Vec<Curve<'a>> {
    let mut curves = Vec::new();
    // Where chords begin, and how long they are.
    let mut known: Vec<([f64; 2], f64)> = Vec::new();
    let apart = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let within =
        |x: &[f64; 2], by: f64| (0..2).all(|k| x[k] > bounds.min[k] - by && x[k] < bounds.max[k] + by);
    for start in starts {
        if known.iter().any(|(x, size)| apart(x, start) <= 0.75 * size) {
            continue;
        }
        'ways: for way in [1.0, -1.0] {
            let mut x = *start;
            for steps in 0.. {
                let size = CHORD * spacing(&x);
                if curves.len() > MOST_CHORDS || !within(&x, 2.0 * size) || !size.is_finite() {
                    break;
                }
                known.push((x, size));
                let (_, slope) = level(&x);
                let length = slope[0].hypot(slope[1]);
                let mut next = [x[0] - way * size * slope[1] / length, x[1] + way * size * slope[0] / length];
                for _ in 0..NEWTON_STEPS {
                    let (value, slope) = level(&next);
                    let square = slope[0] * slope[0] + slope[1] * slope[1];
                    let step = slope.map(|s| -value * s / square);
                    next = [next[0] + step[0], next[1] + step[1]];
                    if step[0].hypot(step[1]) <= LAST_STEP * size {
                        break;
                    }
                }
                // Lost at a kink, or where the set ends.
                if apart(&x, &next).is_nan() || apart(&x, &next) > 2.0 * size {
                    break;
                }
                let closes = steps > 1 && apart(start, &next) < 0.75 * size;
                let to = if closes { *start } else { next };
                let along = [way * (to[0] - x[0]), way * (to[1] - x[1])];
                curves.push(Curve::Level { from: if way > 0.0 { x } else { to }, along, level });
                if closes {
                    break 'ways;
                }
                x = next;
            }
        }
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_cut_where_the_key_changes() {
        let circle = Curve::Arc { center: [0.0; 2], radius: 1.0, from: 0.0, turn: std::f64::consts::TAU };
        let quadrant = |x: &[f64; 2], _: &[f64; 2]| (x[0] > 0.3, x[1] > -0.2);
        let pieces = circle.split([0.0, 1.0], |_| 0.5, quadrant);
        assert_eq!(pieces.len(), 5);
        let cut = circle.at(pieces[0].between[1]).0;
        assert!((cut[0] - 0.3).abs() < 1e-14);
        let whole: f64 = pieces.iter().map(|p| p.between[1] - p.between[0]).sum();
        assert!((whole - 1.0).abs() < 1e-14);
    }
}
