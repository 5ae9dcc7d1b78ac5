//! Which triangles share an edge, and whether the surface is closed.

use std::collections::HashMap;

use super::weld::Welded;
use crate::error::GeometryError;
use crate::vector::{dot, sub};

/// The neighbour of every triangle across its edge k, from corner k to the next.
///
/// # Errors
/// [`GeometryError::InvalidShape`] where an edge belongs to one triangle (the surface is open), to more than two, or to
/// two that run through it in the same direction (their outsides differ); with where it is.
pub(super) fn neighbors(welded: &Welded) -> Result<Vec<[u32; 3]>, GeometryError> {
    let mut edges: HashMap<[u32; 2], Vec<(u32, u8)>> = HashMap::with_capacity(3 * welded.triangles.len() / 2);
    for (t, triangle) in welded.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_default().push((t as u32, k as u8));
        }
    }
    let mut found = vec![[0; 3]; welded.triangles.len()];
    let mut bad: Vec<(u32, u8, Fault)> = Vec::new();
    for sides in edges.values() {
        match sides[..] {
            [(s, j), (t, k)] => {
                if start(welded, s, j) == start(welded, t, k) {
                    bad.push((s.min(t), if s < t { j } else { k }, Fault::Turned));
                }
                found[s as usize][j as usize] = t;
                found[t as usize][k as usize] = s;
            }
            [(t, k)] => bad.push((t, k, Fault::Open)),
            _ => bad.push((sides[0].0, sides[0].1, Fault::Shared(sides.len()))),
        }
    }
    // The map has no order: the fault of the triangle that comes first in the file is told.
    match bad.iter().min_by_key(|(t, k, _)| (*t, *k)) {
        None => Ok(found),
        Some(first) => Err(describe(welded, first, bad.len())),
    }
}

enum Fault {
    Open,
    Shared(usize),
    Turned,
}

fn start(welded: &Welded, triangle: u32, edge: u8) -> u32 {
    welded.triangles[triangle as usize][edge as usize]
}

fn describe(welded: &Welded, (t, k, fault): &(u32, u8, Fault), count: usize) -> GeometryError {
    let corner = |k: u8| welded.vertices[start(welded, *t, k % 3) as usize];
    let (a, b) = (corner(*k), corner(*k + 1));
    let number = welded.origin[*t as usize];
    let what = match fault {
        Fault::Open => "belongs to this triangle alone: the surface is open there".to_owned(),
        Fault::Shared(n) => {
            format!("belongs to {n} triangles: the surface does not tell inside from outside there")
        }
        Fault::Turned => "belongs to two triangles whose outsides differ".to_owned(),
    };
    let others = match count - 1 {
        0 => String::new(),
        more => format!(" (and {more} more such edges)"),
    };
    GeometryError::invalid(
        "surface",
        format!(
            "the edge from {a:?} to {b:?} of triangle {number} {what}{others}; mend it in the program that wrote it"
        ),
    )
}

/// Enclosed volume; negative where the triangles run clockwise as seen from outside.
pub(super) fn volume(welded: &Welded) -> f64 {
    let origin = welded.vertices[0];
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| sub(&welded.vertices[v as usize], &origin));
        dot(&a, &super::cross(&b, &c)) / 6.0
    };
    welded.triangles.iter().map(of).sum()
}
