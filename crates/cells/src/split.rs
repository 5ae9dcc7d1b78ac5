//! A convex body divided by the planes of walls into parts that are wholly in the domain or out of it.
//!
//! All planes that a wall in the body lies in divide all of the body. So every face of a part that lies in such a plane is, as a
//! whole, a face of one other part, that on the other side of this plane and on the same side of all others: it is a piece of the
//! boundary where just one of the two is in the domain, and nothing is measured twice.

use crate::body::{Body, Measure, PLANE_TOLERANCE, Piece, Source, resize};
use crate::container::{MOST_WALLS, Wall};
use crate::interval::Interval;
use crate::polygon::Polygon;
use crate::polyhedron::Polyhedron;

/// Distance of two planes, relative to the size of the body, up to which they are one: beyond round-off of sums of lengths, and
/// nothing that a cell could resolve.
const SAME_PLANE: f64 = 1e-9;

/// The same, relative to coordinates: round-off of the planes themselves.
const SAME_OFFSET: f64 = 1e-14;

/// How far beyond a face it is asked what is there, relative to the size of the body, where the part beyond is too thin to be measured.
const BESIDE: f64 = 1e-7;

/// Volume, relative to the body's radius to the power D, up to which a part is none.
const NO_VOLUME: f64 = 1e-15;

/// A body that can be divided.
pub(crate) trait Solid: Default {
    /// Becomes another.
    fn assign(&mut self, other: &Self);
    /// Calls with all vertices.
    fn vertices(&self, each: impl FnMut([f64; 3]));
    /// Keeps the part where `normal . x <= offset`.
    fn keep(&mut self, normal: &[f64; 3], offset: f64, source: Source);
    /// Volume and first moment; appends the pieces of the surface.
    fn measure(&self, pieces: &mut Vec<Piece>) -> Measure;
}

impl Solid for Interval {
    fn assign(&mut self, other: &Self) {
        self.clone_from(other);
    }

    fn vertices(&self, mut each: impl FnMut([f64; 3])) {
        self.ends().into_iter().for_each(|x| each([x, 0.0, 0.0]));
    }

    fn keep(&mut self, normal: &[f64; 3], offset: f64, source: Source) {
        self.clip(normal[0], offset, source);
    }

    fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        Self::measure(self, pieces)
    }
}

impl Solid for Polygon {
    fn assign(&mut self, other: &Self) {
        Self::assign(self, other);
    }

    fn vertices(&self, mut each: impl FnMut([f64; 3])) {
        self.corners().for_each(|[x, y]| each([x, y, 0.0]));
    }

    fn keep(&mut self, normal: &[f64; 3], offset: f64, source: Source) {
        self.clip(resize(normal), offset, source);
    }

    fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        Self::measure(self, pieces)
    }
}

impl Solid for Polyhedron {
    fn assign(&mut self, other: &Self) {
        Self::assign(self, other);
    }

    fn vertices(&self, each: impl FnMut([f64; 3])) {
        self.corners().for_each(each);
    }

    fn keep(&mut self, normal: &[f64; 3], offset: f64, source: Source) {
        self.clip(*normal, offset, source);
    }

    fn measure(&self, pieces: &mut Vec<Piece>) -> Measure {
        Self::measure(self, pieces)
    }
}

/// A part of the body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<T> {
    /// Bit k is set for a part on the upper side of plane k.
    signs: u64,
    measure: Measure,
    /// Distance of the farthest vertex from the node.
    radius: f64,
    /// Where its pieces are, in the list of all.
    pieces: [usize; 2],
    /// What was asked of its centroid.
    of: T,
}

/// Bodies and their number among those that were ever made.
#[derive(Debug, Default)]
pub(crate) struct Pool<B> {
    bodies: Vec<(u64, B)>,
    live: usize,
}

/// Memory for divisions.
#[derive(Debug, Default)]
pub(crate) struct Division {
    /// Planes of walls that divide the body.
    planes: Vec<([f64; 3], f64)>,
    /// Planes of walls that a face of the body may lie in.
    touching: Vec<([f64; 3], f64)>,
    /// Distance up to which planes of the body at hand are one.
    same: f64,
    pieces: Vec<Piece>,
    intervals: Pool<Interval>,
    polygons: Pool<Polygon>,
    polyhedra: Pool<Polyhedron>,
}

/// What is left of a body in the domain.
#[derive(Debug)]
pub(crate) struct Kept {
    pub(crate) measure: Measure,
    /// Distance of the farthest vertex from the node.
    pub(crate) radius: f64,
    /// How far out of all parts that are kept the node is; zero in one of them.
    pub(crate) outside: f64,
}

impl Division {
    /// Finds the planes of the walls that may lie in the body of a node at `center`: whether there are not too many of them.
    pub(crate) fn find<'w, const D: usize>(
        &mut self,
        center: &[f64; D],
        body: &Body<'_>,
        walls: impl Iterator<Item = &'w Wall<D>>,
    ) -> bool {
        let (lo, hi) = body.extent();
        let radius = body.radius();
        let margin = SAME_PLANE * radius;
        let magnitude = center.iter().fold(radius, |m, x| m.max(x.abs()));
        let same = margin + SAME_OFFSET * magnitude;
        self.same = same;
        self.planes.clear();
        self.touching.clear();
        for wall in walls {
            let near = (0..D).all(|k| {
                wall.min[k] - center[k] <= hi[k] + margin && wall.max[k] - center[k] >= lo[k] - margin
            });
            if !near {
                continue;
            }
            let height = wall.normal.iter().zip(center).map(|(n, x)| n * x).sum::<f64>() - wall.offset;
            let plane: ([f64; 3], f64) = (resize(&wall.normal), -height);
            let [least, most] = body.heights(&plane.0, plane.1);
            let list = if least < -same && most > same {
                &mut self.planes
            } else if least.abs() <= same || most.abs() <= same {
                &mut self.touching
            } else {
                continue;
            };
            if !list.iter().any(|known| are_one(known, &plane, same)) {
                list.push(plane);
            }
        }
        self.planes.len() <= MOST_WALLS
    }

    /// Divides a body by the planes that were found, and asks at the centroid of every part, given from the node, what it is of.
    pub(crate) fn divide<T: Copy>(&mut self, body: &Body<'_>, of: impl Fn([f64; 3]) -> T) -> Vec<Part<T>> {
        let Self { planes, pieces, intervals, polygons, polyhedra, .. } = self;
        pieces.clear();
        match body {
            Body::Interval(body) => intervals.divide::<T, 1>(body, planes, pieces, of),
            Body::Polygon(body) => polygons.divide::<T, 2>(body, planes, pieces, of),
            Body::Polyhedron(body) => polyhedra.divide::<T, 3>(body, planes, pieces, of),
        }
    }

    /// What is left of a body that is divided, of the parts that nothing is `beyond`: appends the pieces of its surface, and to
    /// `walls` the number of each of them on a wall.
    pub(crate) fn keep(
        &mut self,
        body: &Body<'_>,
        beyond: impl Fn([f64; 3]) -> Option<u16>,
        pieces: &mut Vec<Piece>,
        walls: &mut Vec<u16>,
    ) -> Kept {
        let parts = self.divide(body, &beyond);
        let mut kept =
            Kept { measure: Measure { volume: 0.0, moment: [0.0; 3] }, radius: 0.0, outside: f64::INFINITY };
        for part in parts.iter().filter(|part| part.of.is_none()) {
            kept.measure.volume += part.measure.volume;
            (0..3).for_each(|k| kept.measure.moment[k] += part.measure.moment[k]);
            kept.radius = kept.radius.max(part.radius);
            let mut outside = 0.0_f64;
            for piece in &self.pieces[part.pieces[0]..part.pieces[1]] {
                let size = piece.area.iter().map(|a| a * a).sum::<f64>().sqrt();
                if size <= 0.0 {
                    continue;
                }
                let height = (0..3).map(|k| piece.area[k] * piece.centroid[k]).sum::<f64>() / size;
                outside = outside.max(-height);
                let step = BESIDE * part.radius / size;
                let beside = || std::array::from_fn(|k| piece.centroid[k] + step * piece.area[k]);
                let number = match piece.source {
                    Source::Wall(plane) => {
                        let other = parts.iter().find(|other| other.signs == part.signs ^ (1 << plane));
                        let number = other.map_or_else(|| beyond(beside()), |other| other.of);
                        if number.is_none() {
                            continue;
                        }
                        number
                    }
                    // A bisector of two nodes may lie in a wall that is half-way between them.
                    _ if self.touches(piece, size) => beyond(beside()),
                    _ => None,
                };
                match number {
                    Some(number) => {
                        // Some dozens of walls at most.
                        pieces.push(Piece { source: Source::Wall(walls.len() as u32), ..*piece });
                        walls.push(number);
                    }
                    None => pieces.push(*piece),
                }
            }
            kept.outside = kept.outside.min(outside);
        }
        kept
    }
}

impl Division {
    /// Whether a piece of the body's own surface, of this size, lies in a wall.
    fn touches(&self, piece: &Piece, size: f64) -> bool {
        let normal = piece.area.map(|a| a / size);
        let offset: f64 = (0..3).map(|k| normal[k] * piece.centroid[k]).sum();
        matches!(piece.source, Source::Candidate(_))
            && self.touching.iter().any(|plane| are_one(plane, &(normal, offset), self.same))
    }
}

/// Whether two planes, each a unit normal and the offset along it, are one over the body at hand.
fn are_one(a: &([f64; 3], f64), b: &([f64; 3], f64), same: f64) -> bool {
    let sign = (0..3).map(|k| a.0[k] * b.0[k]).sum::<f64>().signum();
    let turned = (0..3).map(|k| (a.0[k] - sign * b.0[k]).abs()).fold(0.0, f64::max);
    turned <= SAME_PLANE && (a.1 - sign * b.1).abs() <= same
}

impl<T> Part<T> {
    /// What was asked of it, and its volume.
    pub(crate) fn volume(&self) -> (&T, f64) {
        (&self.of, self.measure.volume)
    }
}

/// The least and the largest height of a body's vertices above a plane.
pub(crate) fn heights(body: &impl Solid, normal: &[f64; 3], offset: f64) -> [f64; 2] {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    body.vertices(|x| {
        let height: f64 = (0..3).map(|k| normal[k] * x[k]).sum::<f64>() - offset;
        (least, most) = (least.min(height), most.max(height));
    });
    [least, most]
}

/// Whether a body has vertices below and above a plane, by more than round-off.
fn sides(body: &impl Solid, normal: &[f64; 3], offset: f64) -> [bool; 2] {
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let mut found = [false; 2];
    body.vertices(|x| {
        let height: f64 = (0..3).map(|k| normal[k] * x[k]).sum::<f64>() - offset;
        let size: f64 = x.iter().map(|x| x.abs()).sum();
        let tolerance = PLANE_TOLERANCE * (offset.abs() + length * size);
        found[0] |= height < -tolerance;
        found[1] |= height > tolerance;
    });
    found
}

impl<B: Solid> Pool<B> {
    fn add(&mut self) -> usize {
        if self.live == self.bodies.len() {
            self.bodies.push((0, B::default()));
        }
        self.live += 1;
        self.live - 1
    }

    /// Divides a body by planes; the parts have their bodies in the pool, pieces on plane k have the source `Wall(k)`.
    fn divide<T, const D: usize>(
        &mut self,
        body: &B,
        planes: &[([f64; 3], f64)],
        pieces: &mut Vec<Piece>,
        of: impl Fn([f64; 3]) -> T,
    ) -> Vec<Part<T>> {
        self.live = 0;
        let first = self.add();
        self.bodies[first].0 = 0;
        self.bodies[first].1.assign(body);
        for (plane, (normal, offset)) in (0_u32..).zip(planes) {
            for old in 0..self.live {
                match sides(&self.bodies[old].1, normal, *offset) {
                    [true, true] => {
                        let new = self.add();
                        let (head, tail) = self.bodies.split_at_mut(new);
                        let (below, above) = (&mut head[old], &mut tail[0]);
                        above.0 = below.0 | 1 << plane;
                        above.1.assign(&below.1);
                        above.1.keep(&normal.map(|n| -n), -offset, Source::Wall(plane));
                        below.1.keep(normal, *offset, Source::Wall(plane));
                    }
                    [false, true] => self.bodies[old].0 |= 1 << plane,
                    [_, false] => {}
                }
            }
        }
        let mut parts = Vec::with_capacity(self.live);
        for (signs, body) in &self.bodies[..self.live] {
            let mut radius = 0.0_f64;
            body.vertices(|x| radius = radius.max(x.iter().map(|x| x * x).sum()));
            let radius = radius.sqrt();
            let start = pieces.len();
            let measure = body.measure(pieces);
            // Also what is no number is left out.
            if measure.volume > NO_VOLUME * radius.powi(D as i32) {
                let centroid = measure.moment.map(|m| m / measure.volume);
                let pieces = [start, pieces.len()];
                parts.push(Part { signs: *signs, measure, radius, pieces, of: of(centroid) });
            } else {
                pieces.truncate(start);
            }
        }
        parts
    }
}
