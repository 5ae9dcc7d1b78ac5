//! Traced curves, cut at corners and where they leave the boundary, and nodes spread evenly over what remains.

use super::corners::FEATURE_SEPARATION;
use super::curve::Polyline;
use super::manifold::onto;
use super::sampler::Sampler;
use crate::error::GeometryError;
use crate::vector::{axpy, distance, dot, sub};

/// Bisections that locate the end of an arc: from a step to a rounding error.
const BISECTIONS: usize = 60;

/// A point of a traced curve.
#[derive(Clone, Copy)]
struct Station<const D: usize> {
    point: [f64; D],
    /// Whether arcs end here: a corner, or where the curve leaves the boundary.
    stop: bool,
}

/// Puts nodes onto the parts of a curve that belong to the boundary.
pub(super) fn place<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    subset: &[usize],
    line: Polyline<D>,
) -> Result<(), GeometryError> {
    let mut closed = line.closed;
    let mut stations: Vec<Station<D>> =
        line.points.into_iter().map(|point| Station { point, stop: false }).collect();
    if stations.len() < 2 {
        return Ok(());
    }
    insert_corners(sampler, subset, &mut stations, closed);
    let mut valid = segment_validity(sampler, subset, &stations, closed);
    if closed {
        let n = stations.len();
        let start = stations.iter().position(|s| s.stop).or_else(|| valid.iter().position(|v| !v));
        if let Some(start) = start {
            stations.rotate_left(start);
            valid.rotate_left(start);
            stations.push(stations[0]);
            closed = false;
        } else {
            debug_assert_eq!(valid.len(), n);
            stations.push(stations[0]);
            return spread(sampler, subset, &stations, true);
        }
    }
    debug_assert!(!closed);
    cut(sampler, subset, &mut stations, &mut valid)?;
    let mut first = 0;
    for i in 1..stations.len() {
        let ends = stations[i].stop || i + 1 == stations.len() || valid[i] != valid[i - 1];
        if ends {
            if valid[i - 1] {
                spread(sampler, subset, &stations[first..=i], false)?;
            }
            first = i;
        }
    }
    Ok(())
}

/// Inserts the nodes placed so far that lie on the curve.
fn insert_corners<const D: usize>(
    sampler: &Sampler<'_, D>,
    subset: &[usize],
    stations: &mut Vec<Station<D>>,
    closed: bool,
) {
    let patches = sampler.pick(subset);
    for x in sampler.nodes.points() {
        if !patches.iter().all(|p| p.distance(x) <= sampler.tolerance) {
            continue;
        }
        let n = stations.len();
        let segments = if closed { n } else { n - 1 };
        let mut best = (f64::INFINITY, 0, 0.0, 0.0);
        for i in 0..segments {
            let (a, b) = (&stations[i].point, &stations[(i + 1) % n].point);
            let e = sub(b, a);
            let length = dot(&e, &e).sqrt();
            if length == 0.0 {
                continue;
            }
            let t = (dot(&sub(x, a), &e) / (length * length)).clamp(0.0, 1.0);
            let d = distance(x, &axpy(a, t, &e));
            if d < best.0 {
                best = (d, i, t, length);
            }
        }
        let (d, i, t, length) = best;
        if d > 0.5 * length + sampler.tolerance {
            continue;
        }
        let corner = Station { point: *x, stop: true };
        // Replacing a station that coincides avoids segments without a length.
        match t {
            t if t * length <= sampler.tolerance.max(1e-3 * length) => stations[i] = corner,
            t if (1.0 - t) * length <= sampler.tolerance.max(1e-3 * length) => stations[(i + 1) % n] = corner,
            _ => stations.insert(i + 1, corner),
        }
    }
}

/// For every segment, whether its midpoint belongs to the boundary.
fn segment_validity<const D: usize>(
    sampler: &Sampler<'_, D>,
    subset: &[usize],
    stations: &[Station<D>],
    closed: bool,
) -> Vec<bool> {
    let n = stations.len();
    (0..if closed { n } else { n - 1 })
        .map(|i| between(sampler, subset, &stations[i].point, &stations[(i + 1) % n].point, 0.5).1)
        .collect()
}

/// The point of the curve at a fraction of the way from `a` to `b`, and whether it belongs to the boundary.
fn between<const D: usize>(
    sampler: &Sampler<'_, D>,
    subset: &[usize],
    a: &[f64; D],
    b: &[f64; D],
    t: f64,
) -> ([f64; D], bool) {
    let e = sub(b, a);
    let chord = axpy(a, t, &e);
    match onto(&sampler.pick(subset), &chord, distance(a, b)) {
        Some(p) => (p, sampler.on_all(subset, &p)),
        None => (chord, false),
    }
}

/// Where the curve enters or leaves the boundary other than in a corner known already, finds that point and makes it
/// a node.
fn cut<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    subset: &[usize],
    stations: &mut [Station<D>],
    valid: &mut [bool],
) -> Result<(), GeometryError> {
    let mut i = 1;
    while i < valid.len() {
        if valid[i] == valid[i - 1] || stations[i].stop {
            i += 1;
            continue;
        }
        let entering = valid[i];
        // The change lies between the midpoints of the segments on the two sides.
        let (mut a, mut b) = (
            between(sampler, subset, &stations[i - 1].point, &stations[i].point, 0.5).0,
            between(sampler, subset, &stations[i].point, &stations[i + 1].point, 0.5).0,
        );
        for _ in 0..BISECTIONS {
            let (middle, inside) = between(sampler, subset, &a, &b, 0.5);
            if middle == a || middle == b {
                break;
            }
            if inside == entering { b = middle } else { a = middle }
        }
        let point = if entering { b } else { a };
        stations[i] = Station { point, stop: true };
        let h = sampler.spacing.at(&point)?;
        if !subset.is_empty()
            && sampler.on_all(subset, &point)
            && !sampler.nodes.conflicts(&point, h, FEATURE_SEPARATION)
        {
            sampler.push_boundary(point, h)?;
        }
        i += 1;
    }
    Ok(())
}

/// Divides an arc evenly with regard to the spacing, into the number of parts that comes nearest to it. The ends of an
/// open arc are left out.
fn spread<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    subset: &[usize],
    stations: &[Station<D>],
    closed: bool,
) -> Result<(), GeometryError> {
    let mut position = Vec::with_capacity(stations.len());
    let (mut total, mut last) = (0.0, sampler.spacing.at(&stations[0].point)?);
    position.push(0.0);
    for pair in stations.windows(2) {
        let h = sampler.spacing.at(&pair[1].point)?;
        total += distance(&pair[0].point, &pair[1].point) * 0.5 * (1.0 / last + 1.0 / h);
        last = h;
        position.push(total);
    }
    let parts = total.round().max(if closed { 3.0 } else { 1.0 }) as usize;
    let mut i = 0;
    for k in usize::from(!closed)..parts {
        let target = total * k as f64 / parts as f64;
        while i + 2 < stations.len() && position[i + 1] <= target {
            i += 1;
        }
        let t = (target - position[i]) / (position[i + 1] - position[i]).max(f64::MIN_POSITIVE);
        let (x, ok) = between(sampler, subset, &stations[i].point, &stations[i + 1].point, t);
        if !ok {
            continue;
        }
        let h = sampler.spacing.at(&x)?;
        if sampler.nodes.conflicts(&x, h, FEATURE_SEPARATION) {
            continue;
        }
        if subset.is_empty() {
            sampler.push(x, h)?;
        } else {
            sampler.push_boundary(x, h)?;
        }
    }
    Ok(())
}
