//! Points and tangents of the set where several surfaces meet.

use super::patch::Patch;
use crate::vector::{axpy, distance, dot, max_abs, norm, normalized};

/// Newton steps towards the common points of several surfaces.
const STEPS: usize = 60;

/// Smallest pivot in the Gram matrix of unit normals: surfaces that meet at less than about this angle's square root
/// (2 degrees) are not taken to meet in an edge.
const PIVOT: f64 = 1e-3;

/// When Newton's method has settled, relative to the coordinates.
const SETTLED: f64 = 1e-14;

/// The point common to the patches near `x`, at most `reach` away; the shortest step that makes all linearised levels
/// zero, repeated.
pub(crate) fn onto<const D: usize>(patches: &[&Patch<'_, D>], x: &[f64; D], reach: f64) -> Option<[f64; D]> {
    let mut p = *x;
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let step = newton_step(patches, &p)?;
        p = axpy(&p, 1.0, &step);
        if distance(&p, x) > reach {
            return None;
        }
        let moved = norm(&step);
        let size = max_abs(&p).max(reach);
        if moved <= SETTLED * size || (moved <= 1e3 * SETTLED * size && moved >= 0.5 * last) {
            // Planes across an axis hold exactly.
            for (axis, coordinate) in patches.iter().filter_map(|patch| patch.axis_plane()) {
                p[axis] = coordinate;
            }
            return Some(p);
        }
        last = moved;
    }
    None
}

fn newton_step<const D: usize>(patches: &[&Patch<'_, D>], p: &[f64; D]) -> Option<[f64; D]> {
    let k = patches.len();
    let mut normals = [[0.0; D]; D];
    let mut lambda = [0.0; D];
    for (i, patch) in patches.iter().enumerate() {
        let g = patch.gradient(p);
        normals[i] = normalized(&g)?;
        lambda[i] = -patch.level(p) / norm(&g);
    }
    let mut gram = [[0.0; D]; D];
    for i in 0..k {
        for j in 0..k {
            gram[i][j] = dot(&normals[i], &normals[j]);
        }
    }
    // Symmetric and positive definite: elimination needs no exchange of rows.
    for i in 0..k {
        if gram[i][i].is_nan() || gram[i][i] <= PIVOT {
            return None;
        }
        for j in i + 1..k {
            let factor = gram[j][i] / gram[i][i];
            for c in i..k {
                gram[j][c] -= factor * gram[i][c];
            }
            lambda[j] -= factor * lambda[i];
        }
    }
    let mut step = [0.0; D];
    for i in (0..k).rev() {
        for c in i + 1..k {
            lambda[i] -= gram[i][c] * lambda[c];
        }
        lambda[i] /= gram[i][i];
        step = axpy(&step, lambda[i], &normals[i]);
    }
    crate::vector::is_finite(&step).then_some(step)
}

/// Unit tangent of the curve in which `D - 1` patches meet.
pub(crate) fn tangent<const D: usize>(patches: &[&Patch<'_, D>], p: &[f64; D]) -> Option<[f64; D]> {
    match D {
        1 => Some([1.0; D]),
        2 => {
            let n = patches[0].gradient(p);
            normalized(&std::array::from_fn(|i| if i == 0 { -n[1] } else { n[0] }))
        }
        _ => {
            let (a, b) = (normalized(&patches[0].gradient(p))?, normalized(&patches[1].gradient(p))?);
            normalized(&std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                a[j] * b[k] - a[k] * b[j]
            }))
        }
    }
}
