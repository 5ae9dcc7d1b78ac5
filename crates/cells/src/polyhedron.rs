//! The cell in three dimensions: a polyhedron, given by its vertices and the loops of its faces.
//!
//! A cut first decides for every vertex whether it is inside. From there on only this decision counts: an edge with
//! one end inside gets one new vertex, shared by its two faces, and the new edges link to closed loops by themselves.
//! Whatever round-off does to the decisions, the surface stays closed.

use crate::body::{Measure, PLANE_TOLERANCE, Piece, Source};
use crate::root::{bracketed_root, largest_magnitude};

type Point = [f64; 3];

/// Mark of a vertex that a cut removes.
const REMOVED: u32 = u32::MAX;

/// Vertices and faces; a face is a loop of vertices, counter-clockwise seen from outside.
#[derive(Debug, Default)]
struct Surface {
    vertices: Vec<Point>,
    faces: Vec<Face>,
    /// The loops of all faces, one after the other.
    loops: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Face {
    source: Source,
    /// Where the loop starts in `loops`.
    start: u32,
    /// Length of the loop.
    len: u32,
}

/// A new vertex, on an edge with one end inside.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    inside: u32,
    outside: u32,
    /// Number of the new vertex.
    vertex: u32,
    /// The crossing that follows on the cap.
    next: u32,
}

/// A polyhedron around the node, which is the origin.
#[derive(Debug, Default)]
pub(crate) struct Polyhedron {
    surface: Surface,
    /// Result of the cut in progress.
    next: Surface,
    /// For each vertex its height above the cutting plane, or the value of the level set.
    heights: Vec<f64>,
    /// For each vertex its new number, or [`REMOVED`].
    renumbered: Vec<u32>,
    crossings: Vec<Crossing>,
}

impl Surface {
    fn clear(&mut self) {
        self.vertices.clear();
        self.faces.clear();
        self.loops.clear();
    }

    fn face(&self, face: &Face) -> &[u32] {
        &self.loops[face.start as usize..(face.start + face.len) as usize]
    }

    /// Makes a face of the vertices that were appended to `loops` since `start`.
    fn close_face(&mut self, source: Source, start: usize) {
        let len = self.loops.len() - start;
        if len > 0 {
            self.faces.push(Face { source, start: index(start), len: index(len) });
        }
    }
}

impl Polyhedron {
    pub(crate) fn reset(&mut self, lo: Point, hi: Point) {
        /// Faces of the box; bit `k` of a vertex's number says that it lies at the upper end of axis `k`.
        const BOX: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        self.surface.clear();
        for corner in 0..8_usize {
            self.surface
                .vertices
                .push(std::array::from_fn(|axis| if corner >> axis & 1 == 1 { hi[axis] } else { lo[axis] }));
        }
        for face in BOX {
            let start = self.surface.loops.len();
            self.surface.loops.extend(face);
            self.surface.close_face(Source::Start, start);
        }
    }

    pub(crate) fn radius(&self) -> f64 {
        self.surface.vertices.iter().map(|&v| dot(v, v)).fold(0.0, f64::max).sqrt()
    }

    /// Becomes another polyhedron.
    pub(crate) fn assign(&mut self, other: &Self) {
        let (own, other) = (&mut self.surface, &other.surface);
        own.vertices.clone_from(&other.vertices);
        own.faces.clone_from(&other.faces);
        own.loops.clone_from(&other.loops);
    }

    pub(crate) fn corners(&self) -> impl Iterator<Item = Point> {
        self.surface.vertices.iter().copied()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.surface.vertices.is_empty()
    }

    /// Keeps the part where `normal . x <= offset`, and says whether anything was cut away.
    pub(crate) fn clip(&mut self, normal: Point, offset: f64, source: Source) -> bool {
        let length = dot(normal, normal).sqrt();
        let mut any_outside = false;
        self.heights.clear();
        for &vertex in &self.surface.vertices {
            let height = dot(normal, vertex) - offset;
            let size = vertex[0].abs() + vertex[1].abs() + vertex[2].abs();
            let tolerance = PLANE_TOLERANCE * (offset.abs() + length * size);
            let height = if height > tolerance { height } else { height.min(0.0) };
            any_outside |= height > 0.0;
            self.heights.push(height);
        }
        if any_outside {
            let straight = |_: Point, _: Point, start: f64, end: f64| Some(start / (start - end));
            // A straight cut always finds its crossing.
            let _ = self.split(source, straight);
        }
        any_outside
    }

    /// Keeps the part where `level` is negative; the new face is spanned by the points found on the edges. Returns the
    /// largest magnitude of the level set at a vertex, `None` if it is not a number.
    pub(crate) fn cut(&mut self, level: impl Fn(Point) -> f64, source: Source) -> Option<f64> {
        self.heights.clear();
        self.heights.extend(self.surface.vertices.iter().map(|&vertex| level(vertex)));
        let largest = largest_magnitude(&self.heights)?;
        if self.heights.iter().any(|&height| height > 0.0) {
            self.split(source, |a, b, start, end| bracketed_root(start, end, |t| level(between(a, b, t))))?;
        }
        Some(largest)
    }

    /// Drops the vertices of positive height. `crossing(inside, outside, height inside, height outside)` says how far
    /// from the inner to the outer end of an edge the cut lies, as a fraction of the edge.
    fn split(
        &mut self,
        source: Source,
        crossing: impl Fn(Point, Point, f64, f64) -> Option<f64>,
    ) -> Option<()> {
        self.next.clear();
        self.crossings.clear();
        self.renumbered.clear();
        for (&vertex, &height) in self.surface.vertices.iter().zip(&self.heights) {
            if height > 0.0 {
                self.renumbered.push(REMOVED);
            } else {
                self.renumbered.push(index(self.next.vertices.len()));
                self.next.vertices.push(vertex);
            }
        }
        for face in 0..self.surface.faces.len() {
            self.split_face(face, &crossing)?;
        }
        self.close_caps(source);
        std::mem::swap(&mut self.surface, &mut self.next);
        Some(())
    }

    /// Copies what is left of a face. Where the loop leaves the body it goes straight to where it enters again; the cap
    /// has the same edge the other way round.
    fn split_face(
        &mut self,
        face: usize,
        crossing: &impl Fn(Point, Point, f64, f64) -> Option<f64>,
    ) -> Option<()> {
        let face = self.surface.faces[face];
        let start = self.next.loops.len();
        let len = face.len as usize;
        // The last exit without an entry yet, and the entry that came before any exit.
        let (mut open_exit, mut first_entry) = (None, None);
        for k in 0..len {
            let a = self.surface.face(&face)[k];
            let b = self.surface.face(&face)[if k + 1 == len { 0 } else { k + 1 }];
            let new_a = self.renumbered[a as usize];
            let b_removed = self.renumbered[b as usize] == REMOVED;
            if new_a != REMOVED {
                self.next.loops.push(new_a);
                if b_removed {
                    let exit = self.crossing_on(a, b, crossing)?;
                    self.next.loops.push(self.crossings[exit].vertex);
                    open_exit = Some(exit);
                }
            } else if !b_removed {
                let entry = self.crossing_on(b, a, crossing)?;
                self.next.loops.push(self.crossings[entry].vertex);
                match open_exit.take() {
                    Some(exit) => self.crossings[entry].next = index(exit),
                    None => first_entry = Some(entry),
                }
            }
        }
        if let (Some(entry), Some(exit)) = (first_entry, open_exit) {
            self.crossings[entry].next = index(exit);
        }
        self.next.close_face(face.source, start);
        Some(())
    }

    /// The crossing on an edge: the one found from the edge's other face, or a new one.
    fn crossing_on(
        &mut self,
        inside: u32,
        outside: u32,
        crossing: &impl Fn(Point, Point, f64, f64) -> Option<f64>,
    ) -> Option<usize> {
        if let Some(known) = self.crossings.iter().position(|c| c.inside == inside && c.outside == outside) {
            return Some(known);
        }
        let (i, o) = (inside as usize, outside as usize);
        let (a, b) = (self.surface.vertices[i], self.surface.vertices[o]);
        let at = between(a, b, crossing(a, b, self.heights[i], self.heights[o])?);
        let vertex = index(self.next.vertices.len());
        self.next.vertices.push(at);
        self.crossings.push(Crossing { inside, outside, vertex, next: REMOVED });
        Some(self.crossings.len() - 1)
    }

    /// Links the crossings to loops: every edge has one face in which it leaves the body and one in which it enters,
    /// so that each crossing has one predecessor and one successor.
    fn close_caps(&mut self, source: Source) {
        for first in 0..self.crossings.len() {
            let start = self.next.loops.len();
            let mut at = first;
            while self.crossings[at].next != REMOVED {
                self.next.loops.push(self.crossings[at].vertex);
                at = std::mem::replace(&mut self.crossings[at].next, REMOVED) as usize;
            }
            self.next.close_face(source, start);
        }
    }

    /// Every face is a fan of triangles about the mean of its vertices: exact for a flat face, and the definition of
    /// the body for a curved one.
    pub(crate) fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        let mut measure = Measure { volume: 0.0, moment: [0.0; 3] };
        for face in &self.surface.faces {
            let corners = self.surface.face(face);
            let vertex = |k: usize| self.surface.vertices[corners[k % corners.len()] as usize];
            let mut apex = [0.0; 3];
            for k in 0..corners.len() {
                apex = add(apex, vertex(k));
            }
            apex = apex.map(|x| x / f64::from(face.len));
            let mut area = [0.0; 3];
            for k in 0..corners.len() {
                area = add(area, triangle(apex, vertex(k), vertex(k + 1)));
            }
            let (mut weight, mut weighted) = (0.0, [0.0; 3]);
            for k in 0..corners.len() {
                let (a, b) = (vertex(k), vertex(k + 1));
                let part = triangle(apex, a, b);
                let sum = add(apex, add(a, b));
                let volume = dot(part, apex) / 3.0;
                let projected = dot(part, area);
                measure.volume += volume;
                weight += projected;
                for axis in 0..3 {
                    measure.moment[axis] += 0.25 * volume * sum[axis];
                    weighted[axis] += projected * sum[axis] / 3.0;
                }
            }
            let centroid = if weight > 0.0 { weighted.map(|x| x / weight) } else { apex };
            pieces.push(Piece { source: face.source, area, centroid });
        }
        measure
    }
}

/// Vertices are counted in 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "a cell has some dozens of vertices")]
fn index(count: usize) -> u32 {
    count as u32
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Vector area of a triangle.
fn triangle(a: Point, b: Point, c: Point) -> Point {
    let (u, v) = ([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
    [0.5 * (u[1] * v[2] - u[2] * v[1]), 0.5 * (u[2] * v[0] - u[0] * v[2]), 0.5 * (u[0] * v[1] - u[1] * v[0])]
}

/// The point a fraction `t` of the way from `a` to `b`.
fn between(a: Point, b: Point, t: f64) -> Point {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])]
}
