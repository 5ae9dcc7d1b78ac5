//! Curves in which surfaces meet, traced in steps much finer than the spacing.

use super::arcs;
use super::manifold::{onto, tangent};
use super::patch::Patch;
use super::sampler::{BoundaryCell, Sampler, for_each_subset};
use crate::aabb::Aabb;
use crate::cloud::Spacing;
use crate::error::GeometryError;
use crate::spatial_hash::SpatialHash;
use crate::vector::{axpy, distance, dot, scale, sub};
use std::collections::BTreeMap;

/// Step of the tracing, relative to the spacing.
const STEP: f64 = 0.125;

/// A step whose tangent turns by more than this (cosine, 30 degrees) is halved, up to [`HALVINGS`] times.
const TURN: f64 = 0.866;

/// Beyond this, the curve is taken to have a kink and is followed around it.
const HALVINGS: usize = 5;

/// A traced curve.
pub(super) struct Polyline<const D: usize> {
    pub(super) points: Vec<[f64; D]>,
    /// Whether the last point is joined to the first.
    pub(super) closed: bool,
}

pub(super) fn sample<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    cells: &[BoundaryCell<D>],
    lattice: bool,
) -> Result<(), GeometryError> {
    for k in 0..sampler.patches.len() {
        for polyline in own_lines(sampler, k) {
            arcs::place(sampler, &[k], polyline)?;
        }
    }
    // Points of the curves traced so far, so that every curve is traced once.
    let mut traced: BTreeMap<Vec<usize>, SpatialHash<D>> = BTreeMap::new();
    for entry in cells.iter().filter(|entry| entry.near.len() + 1 >= D) {
        for_each_subset(&entry.near, D - 1, &mut |subset| {
            if (lattice && sampler.covered_by_lattice(subset))
                || subset.iter().any(|&k| sampler.patches[k].polygon().is_some())
            {
                return Ok(());
            }
            let reach = 2.0 * entry.cell.half_diagonal();
            let Some(start) = onto(&sampler.pick(subset), &entry.cell.center, reach) else { return Ok(()) };
            // Seeds off the boundary would only find what others find, or nothing.
            if !sampler.on_all(subset, &start) {
                return Ok(());
            }
            let h = sampler.spacing.at(&start)?;
            let known = traced.entry(subset.to_vec()).or_insert_with(SpatialHash::new);
            if known.nearest(&start, 2.0 * STEP * h, None).is_some() {
                return Ok(());
            }
            let Some(polyline) =
                trace(&sampler.pick(subset), sampler.spacing, &sampler.domain.bounds(), start, h)
            else {
                return Ok(());
            };
            for p in &polyline.points {
                known.insert(*p, h);
            }
            arcs::place(sampler, subset, polyline)
        })?;
    }
    Ok(())
}

/// The line from one end of the bounds to the other, in 1-D.
pub(super) fn sample_line<const D: usize>(sampler: &mut Sampler<'_, D>) -> Result<(), GeometryError> {
    let bounds = sampler.domain.bounds();
    let mut points = vec![bounds.min];
    let (mut x, end) = (bounds.min, bounds.max[0]);
    while x[0] < end {
        let h = sampler.spacing.at(&x).or_else(|_| sampler.spacing.at(&bounds.center()))?;
        x[0] = (x[0] + STEP * h).min(end);
        points.push(x);
    }
    arcs::place(sampler, &[], Polyline { points, closed: false })
}

/// The outline of a polygon, or the creases of a surface of triangles, in steps and with their vertices.
fn own_lines<const D: usize>(sampler: &Sampler<'_, D>, k: usize) -> Vec<Polyline<D>> {
    let patch = &sampler.patches[k];
    let mut lines: Vec<(Vec<[f64; D]>, bool)> = Vec::new();
    if let Some(polygon) = patch.polygon() {
        lines.push((polygon.vertices().iter().map(|v| std::array::from_fn(|i| v[i])).collect(), true));
    }
    if let Some(surface) = patch.triangles() {
        let creases = surface.crease_lines();
        lines.extend(creases.map(|(vertices, closed)| {
            (vertices.iter().map(|v| std::array::from_fn(|i| v[i])).collect(), closed)
        }));
    }
    lines.into_iter().map(|(vertices, closed)| in_steps(sampler, &vertices, closed)).collect()
}

/// A polyline with further points between its vertices.
fn in_steps<const D: usize>(sampler: &Sampler<'_, D>, vertices: &[[f64; D]], closed: bool) -> Polyline<D> {
    let mut points = Vec::new();
    let fallback = sampler.domain.bounds().diameter() / 64.0;
    let segments = if closed { vertices.len() } else { vertices.len() - 1 };
    for (i, a) in vertices.iter().enumerate().take(segments) {
        let b = &vertices[(i + 1) % vertices.len()];
        let (length, edge) = (distance(a, b), sub(b, a));
        let mut t = 0.0;
        while t < 1.0 {
            let x = axpy(a, t, &edge);
            points.push(x);
            // Parts of the outline may lie outside of the domain, where the spacing need not be defined.
            let h = sampler.spacing.at(&x).unwrap_or(fallback);
            t += (STEP * h / length).max(1e-6);
            if 1.0 - t < 0.25 * STEP * h / length {
                break;
            }
        }
    }
    if !closed {
        points.extend(vertices.last());
    }
    Polyline { points, closed }
}

fn trace<const D: usize>(
    patches: &[&Patch<'_, D>],
    spacing: &Spacing<D>,
    bounds: &Aabb<D>,
    start: [f64; D],
    h: f64,
) -> Option<Polyline<D>> {
    let t = tangent(patches, &start)?;
    let (mut points, closed) = march(patches, spacing, bounds, start, t, h);
    if closed {
        return Some(Polyline { points, closed });
    }
    let (backward, _) = march(patches, spacing, bounds, start, scale(-1.0, &t), h);
    points.reverse();
    points.extend_from_slice(&backward[1..]);
    Some(Polyline { points, closed: false })
}

/// Follows a curve until it closes or leaves the bounds; the first point beyond them is included.
fn march<const D: usize>(
    patches: &[&Patch<'_, D>],
    spacing: &Spacing<D>,
    bounds: &Aabb<D>,
    start: [f64; D],
    direction: [f64; D],
    mut h: f64,
) -> (Vec<[f64; D]>, bool) {
    let mut points = vec![start];
    let (mut p, mut t) = (start, direction);
    let most = 1_000_000;
    while points.len() < most {
        h = spacing.at(&p).unwrap_or(h);
        let Some((q, tq)) = step_along(patches, &p, &t, STEP * h) else { break };
        let moved = distance(&p, &q);
        if points.len() > 3 && distance(&q, &start) <= 0.6 * moved.max(STEP * h) {
            // A point beyond the start would make the closing segment run backwards.
            if dot(&sub(&q, &start), &direction) < 0.0 {
                points.push(q);
            }
            return (points, true);
        }
        points.push(q);
        if !bounds.contains(&q, 0.0) {
            break;
        }
        (p, t) = (q, tq);
    }
    (points, false)
}

/// One step along a curve, shortened where it bends; the point and the tangent there.
fn step_along<const D: usize>(
    patches: &[&Patch<'_, D>],
    p: &[f64; D],
    t: &[f64; D],
    step: f64,
) -> Option<([f64; D], [f64; D])> {
    let mut length = step;
    let mut last = None;
    for _ in 0..=HALVINGS {
        if let Some(q) = onto(patches, &axpy(p, length, t), length)
            && let Some(tq) = tangent(patches, &q)
        {
            let tq = if dot(&tq, t) < 0.0 { scale(-1.0, &tq) } else { tq };
            let moved = distance(p, &q);
            if moved > 0.3 * length && moved < 1.7 * length {
                if dot(&tq, t) > TURN {
                    return Some((q, tq));
                }
                // A longer step gets around a kink where a shorter one would stay on it.
                last = last.or(Some((q, tq)));
            }
        }
        length *= 0.5;
    }
    last.map(|(q, _)| {
        // Around a kink the chord, not the tangent before it, tells which way to go on.
        let chord = crate::vector::normalized(&sub(&q, p)).unwrap_or(*t);
        let tq = tangent(patches, &q).unwrap_or(chord);
        (q, if dot(&tq, &chord) < 0.0 { scale(-1.0, &tq) } else { tq })
    })
}
