//! Normals of faces, of edges, and of vertices weighted by the angles about them.

use super::closest::Part;
use super::{TriangleSurface, normal_of};
use crate::vector::{axpy, distance, dot, normalized, sub};

/// Height of a triangle over its longest edge, below which its normal is that of rounding and its neighbour's is taken.
const SLIVER: f64 = 1e-7;

impl TriangleSurface {
    pub(super) fn find_normals(&mut self) {
        self.face_normals = (0..self.triangles.len()).map(|t| self.face_normal(t)).collect();
        self.vertex_normals = vec![[0.0; 3]; self.vertices.len()];
        for t in 0..self.triangles.len() {
            for k in 0..3 {
                let v = self.triangles[t][k] as usize;
                self.vertex_normals[v] =
                    axpy(&self.vertex_normals[v], self.angle(t, k), &self.face_normals[t]);
            }
        }
        for n in &mut self.vertex_normals {
            *n = normalized(n).unwrap_or([0.0, 0.0, 1.0]);
        }
        self.corner_normals =
            (0..self.triangles.len()).map(|t| std::array::from_fn(|k| self.group_normal(t, k))).collect();
    }

    fn corners_of(&self, t: usize) -> [&[f64; 3]; 3] {
        self.triangles[t].map(|v| &self.vertices[v as usize])
    }

    /// The normal of a triangle; of a sliver that of its neighbour across the longest edge, and so on.
    fn face_normal(&self, first: usize) -> [f64; 3] {
        let mut t = first;
        for _ in 0..16 {
            let corners = self.corners_of(t);
            let edge = |k: usize| distance(corners[k], corners[(k + 1) % 3]);
            let longest = (0..3).fold(0, |best, k| if edge(k) > edge(best) { k } else { best });
            let (e, f) = (
                sub(corners[(longest + 1) % 3], corners[longest]),
                sub(corners[(longest + 2) % 3], corners[longest]),
            );
            let twice_area = crate::vector::norm(&super::cross(&e, &f));
            match normal_of(corners) {
                Some(n) if twice_area > SLIVER * edge(longest) * edge(longest) => return n,
                _ => t = self.neighbors[t][longest] as usize,
            }
        }
        normal_of(self.corners_of(first)).unwrap_or([0.0, 0.0, 1.0])
    }

    /// Angle of a triangle at one of its corners.
    fn angle(&self, t: usize, k: usize) -> f64 {
        let corners = self.corners_of(t);
        let a = sub(corners[(k + 1) % 3], corners[k]);
        let b = sub(corners[(k + 2) % 3], corners[k]);
        match (normalized(&a), normalized(&b)) {
            (Some(a), Some(b)) => dot(&a, &b).clamp(-1.0, 1.0).acos(),
            _ => 0.0,
        }
    }

    /// Whether the edge from corner k is a crease.
    pub(super) fn is_crease(&self, t: u32, k: usize) -> bool {
        let other = self.neighbors[t as usize][k];
        dot(&self.face_normals[t as usize], &self.face_normals[other as usize]) < self.crease_cosine
    }

    /// The triangles about corner k of t, each with its own number of that corner, beginning with t.
    pub(super) fn around(&self, t: u32, k: usize) -> Vec<(u32, usize)> {
        let mut found = vec![(t, k)];
        let (mut at, mut corner) = (t, k);
        while let Some((next, j)) = self.turn(at, corner, true).filter(|next| next.0 != t) {
            (at, corner) = (next, j);
            found.push((at, corner));
            if found.len() > self.triangles.len() {
                break;
            }
        }
        found
    }

    /// The next triangle about corner k: across the edge that ends there (`forward`) or begins there.
    fn turn(&self, t: u32, k: usize, forward: bool) -> Option<(u32, usize)> {
        let vertex = self.triangles[t as usize][k];
        let other = self.neighbors[t as usize][if forward { (k + 2) % 3 } else { k }];
        self.triangles[other as usize].iter().position(|&v| v == vertex).map(|j| (other, j))
    }

    /// Angle-weighted mean over the triangles about a corner that no crease parts from this one.
    fn group_normal(&self, t: usize, k: usize) -> [f64; 3] {
        let mut sum = axpy(&[0.0; 3], self.angle(t, k), &self.face_normals[t]);
        let own = (t as u32, k);
        let mut closed = false;
        for forward in [true, false] {
            let (mut at, mut corner) = own;
            while !closed && !self.is_crease(at, if forward { (corner + 2) % 3 } else { corner }) {
                let Some((next, j)) = self.turn(at, corner, forward) else { break };
                if next == own.0 {
                    closed = true;
                    break;
                }
                (at, corner) = (next, j);
                sum = axpy(&sum, self.angle(at as usize, corner), &self.face_normals[at as usize]);
            }
        }
        normalized(&sum).unwrap_or(self.face_normals[t])
    }

    /// The pseudonormal that tells inside from outside.
    pub(super) fn part_normal(&self, t: u32, part: Part) -> [f64; 3] {
        let own = self.face_normals[t as usize];
        match part {
            Part::Face => own,
            Part::Edge(k) => {
                let other = self.face_normals[self.neighbors[t as usize][k as usize] as usize];
                normalized(&axpy(&own, 1.0, &other)).unwrap_or(own)
            }
            Part::Corner(k) => self.vertex_normals[self.triangles[t as usize][k as usize] as usize],
        }
    }

    /// The normal between those at the corners of a triangle.
    pub(super) fn interpolated(&self, t: u32, weights: &[f64; 3]) -> [f64; 3] {
        let sum = (0..3).fold([0.0; 3], |sum, k| axpy(&sum, weights[k], &self.corner_normals[t as usize][k]));
        normalized(&sum).unwrap_or(self.face_normals[t as usize])
    }

    pub(super) fn surface_normal(&self, t: u32, part: Part, weights: &[f64; 3]) -> [f64; 3] {
        if self.smooth { self.interpolated(t, weights) } else { self.part_normal(t, part) }
    }
}
