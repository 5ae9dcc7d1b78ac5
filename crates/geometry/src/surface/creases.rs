//! Edges of the part: chains of the triangulation's edges between faces of different directions.

use std::collections::{BTreeMap, BTreeSet};

use super::TriangleSurface;
use crate::vector::{dot, normalized, sub};

/// Cosine of the turn beyond which two creases meet in a corner: 30 degrees.
const CORNER_TURN: f64 = 0.866;

/// A chain of creases.
#[derive(Debug, Clone)]
pub(crate) struct CreaseLine {
    pub(crate) vertices: Vec<u32>,
    pub(crate) closed: bool,
}

impl TriangleSurface {
    pub(super) fn find_creases(&mut self) {
        let mut ends: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for t in 0..self.triangles.len() {
            for k in 0..3 {
                if self.is_crease(t as u32, k) {
                    let (a, b) = (self.triangles[t][k], self.triangles[t][(k + 1) % 3]);
                    // The triangle on the other side adds the way back.
                    ends.entry(a).or_default().push(b);
                }
            }
        }
        let is_corner = |v: u32| match ends[&v][..] {
            [a, b] => {
                let at = &self.vertices[v as usize];
                let into = normalized(&sub(at, &self.vertices[a as usize]));
                let out = normalized(&sub(&self.vertices[b as usize], at));
                into.zip(out).is_none_or(|(i, o)| dot(&i, &o) < CORNER_TURN)
            }
            _ => true,
        };
        let corners: BTreeSet<u32> = ends.keys().copied().filter(|&v| is_corner(v)).collect();
        let mut lines = Vec::new();
        let mut used: BTreeSet<[u32; 2]> = BTreeSet::new();
        // From the corners first; what remains is closed.
        for start in corners.iter().chain(ends.keys()) {
            for &second in &ends[start] {
                if used.contains(&[*start, second]) {
                    continue;
                }
                let mut vertices = vec![*start];
                let (mut from, mut to) = (*start, second);
                loop {
                    used.extend([[from, to], [to, from]]);
                    if to == *start {
                        break;
                    }
                    vertices.push(to);
                    if corners.contains(&to) {
                        break;
                    }
                    let Some(&next) = ends[&to].iter().find(|&&next| next != from) else { break };
                    (from, to) = (to, next);
                }
                let closed = to == *start && !corners.contains(start);
                if to == *start && !closed {
                    vertices.push(to);
                }
                lines.push(CreaseLine { vertices, closed });
            }
        }
        self.corners = corners.into_iter().collect();
        self.lines = lines;
    }
}
