//! The foot of a point on the zero set of a function that need not be a distance.

use crate::projection::{Projection, ProjectionError};
use crate::vector::{axpy, distance, dot, is_finite, max_abs, norm, normalized, scale, sub};

/// How exactly points are put onto a surface: a length relative to the larger of the reach and the coordinates.
/// A few units of rounding of a well-scaled level set.
pub const SURFACE_TOLERANCE: f64 = 1e-13;

/// How closely the normal of a projection must point at the projected point: the sine of the angle between them.
const ANGLE_TOLERANCE: f64 = 1e-10;

/// Newton steps before bisection takes over. Convergence is quadratic: ten suffice from within half a radius of
/// curvature; steep functions (exponentials) need more.
const NEWTON_STEPS: usize = 60;

/// Steps that slide a point of the surface towards the nearest one.
const SLIDE_STEPS: usize = 60;

/// A step of sliding, relative to the tangential offset, below which no nearer point is expected.
const SHORTEST_SLIDE: f64 = 1e-4;

/// Intervals of the search for a change of sign along a line.
const SEARCH_INTERVALS: usize = 32;

/// Bisection halves an interval of the search until it is a rounding error long.
const BISECTION_STEPS: usize = 100;

pub(crate) type Level<'a, const D: usize> = &'a dyn Fn(&[f64; D]) -> f64;
pub(crate) type Gradient<'a, const D: usize> = &'a dyn Fn(&[f64; D]) -> [f64; D];

pub(crate) fn project<const D: usize>(
    level: Level<'_, D>,
    gradient: Gradient<'_, D>,
    x: &[f64; D],
    reach: f64,
) -> Result<Projection<D>, ProjectionError> {
    let start = level(x);
    if !start.is_finite() {
        return Err(ProjectionError::NotFinite { at: x.to_vec() });
    }
    let tolerance = SURFACE_TOLERANCE * reach.min(f64::MAX).max(max_abs(x));
    let far = |p: &[f64; D]| distance(p, x) > reach;
    let mut point = match onto_surface(level, gradient, x, reach, tolerance) {
        Some(p) if !far(&p) => slide(level, gradient, x, &p, tolerance),
        _ => bisect(level, gradient, x, reach)
            .and_then(|p| onto_surface(level, gradient, &p, reach, tolerance).or(Some(p)))
            .map(|p| slide(level, gradient, x, &p, tolerance))
            .filter(|p| !far(p))
            .ok_or_else(|| ProjectionError::OutOfReach { at: x.to_vec(), reach, level: start })?,
    };
    // One more step costs little and leaves the level at rounding.
    if let Some(p) = newton_step(level, gradient, &point).filter(|p| level(p).abs() <= level(&point).abs()) {
        point = p;
    }
    let Some(normal) = normalized(&gradient(&point)) else {
        return Err(ProjectionError::FlatGradient { at: point.to_vec() });
    };
    Ok(Projection { point, normal, distance: distance(x, &point).copysign(start) })
}

fn newton_step<const D: usize>(
    level: Level<'_, D>,
    gradient: Gradient<'_, D>,
    p: &[f64; D],
) -> Option<[f64; D]> {
    let g = gradient(p);
    let n = normalized(&g)?;
    let q = axpy(p, -level(p) / norm(&g), &n);
    is_finite(&q).then_some(q)
}

/// Newton's method along the gradient; `None` where it leaves the ball of radius `2 reach`, meets a flat gradient or
/// does not settle.
pub(crate) fn onto_surface<const D: usize>(
    level: Level<'_, D>,
    gradient: Gradient<'_, D>,
    x: &[f64; D],
    reach: f64,
    tolerance: f64,
) -> Option<[f64; D]> {
    let mut p = *x;
    for _ in 0..NEWTON_STEPS {
        let q = newton_step(level, gradient, &p)?;
        let moved = distance(&p, &q);
        p = q;
        if moved <= tolerance {
            return Some(p);
        }
        if distance(&p, x) > 2.0 * reach {
            return None;
        }
    }
    None
}

/// Moves `p` along the surface until `x - p` is normal to it, never away from `x`. The length of each step comes from
/// the change that the last one made (Barzilai and Borwein 1988), which makes up for the curvature of the surface.
fn slide<const D: usize>(
    level: Level<'_, D>,
    gradient: Gradient<'_, D>,
    x: &[f64; D],
    p: &[f64; D],
    tolerance: f64,
) -> [f64; D] {
    let tangential = |p: &[f64; D]| {
        let n = normalized(&gradient(p))?;
        let away = sub(x, p);
        Some(axpy(&away, -dot(&away, &n), &n))
    };
    let (mut p, mut best) = (*p, distance(x, p));
    let Some(mut t) = tangential(&p) else { return p };
    let mut length = 1.0;
    for _ in 0..SLIDE_STEPS {
        if norm(&t) <= (ANGLE_TOLERANCE * best).max(tolerance) || length < SHORTEST_SLIDE {
            break;
        }
        let trial = onto_surface(level, gradient, &axpy(&p, length, &t), best.max(tolerance), tolerance);
        let next = trial.and_then(|q| tangential(&q).map(|tq| (q, tq, distance(x, &q))));
        match next {
            // Near the foot distances agree to rounding; there the tangential part tells which point is better.
            Some((q, tq, d))
                if d <= best * (1.0 + 4.0 * f64::EPSILON) && (d < best || norm(&tq) < norm(&t)) =>
            {
                let (moved, change) = (sub(&q, &p), sub(&t, &tq));
                let curvature = dot(&moved, &change);
                length =
                    if curvature > 0.0 { (dot(&moved, &moved) / curvature).clamp(0.1, 10.0) } else { 1.0 };
                (p, t, best) = (q, tq, d);
            }
            _ => length *= 0.5,
        }
    }
    p
}

/// A point of the surface from the change of sign that is nearest to `x` on the lines through it along the gradient
/// and the axes.
fn bisect<const D: usize>(
    level: Level<'_, D>,
    gradient: Gradient<'_, D>,
    x: &[f64; D],
    reach: f64,
) -> Option<[f64; D]> {
    if !reach.is_finite() {
        return None;
    }
    let start = level(x);
    let mut directions: Vec<[f64; D]> = normalized(&gradient(x)).into_iter().collect();
    directions.extend((0..D).map(|i| crate::vector::axis_vector(i, 1.0)));
    let mut best: Option<f64> = None;
    let mut found = None;
    for d in directions.iter().flat_map(|d| [*d, scale(-1.0, d)]) {
        let at = |t: f64| level(&axpy(x, t, &d));
        let step = reach / SEARCH_INTERVALS as f64;
        let Some(k) = (1..=SEARCH_INTERVALS).find(|&k| at(step * k as f64) * start <= 0.0) else { continue };
        let (mut low, mut high) = (step * (k - 1) as f64, step * k as f64);
        for _ in 0..BISECTION_STEPS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if at(middle) * start > 0.0 { low = middle } else { high = middle }
        }
        if best.is_none_or(|b| high < b) {
            best = Some(high);
            found = Some(axpy(x, high, &d));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::level_set::LevelSet;

    fn foot(f: impl LevelSet<2>, x: [f64; 2], reach: f64) -> Result<Projection<2>, ProjectionError> {
        project(&|y| f.value(y), &|y| f.gradient(y), &x, reach)
    }

    #[test]
    fn bisection_helps_where_the_gradient_misleads() {
        // Almost flat away from the circle: a Newton step from here leads a thousand radii away.
        let f = |x: &[f64; 2]| ((x[0] * x[0] + x[1] * x[1] - 1.0) * 20.0).tanh();
        let p = foot(f, [1.3, 0.4], 1.0).unwrap();
        let r = 1.3_f64.hypot(0.4);
        assert!((p.distance - (r - 1.0)).abs() < 1e-9);
        assert!((p.point[0] - 1.3 / r).abs() < 1e-8);
    }

    #[test]
    fn points_without_a_foot_are_told_why() {
        let circle = |x: &[f64; 2]| x[0] * x[0] + x[1] * x[1] - 1.0;
        assert!(matches!(foot(circle, [3.0, 0.0], 1.0), Err(ProjectionError::OutOfReach { .. })));
        let never = |x: &[f64; 2]| x[0] * x[0] + 1.0;
        assert!(matches!(foot(never, [0.3, 0.0], 1.0), Err(ProjectionError::OutOfReach { .. })));
        let bad = |x: &[f64; 2]| (x[0] - 1.0).sqrt();
        assert!(matches!(foot(bad, [0.0, 0.0], 1.0), Err(ProjectionError::NotFinite { .. })));
    }
}
