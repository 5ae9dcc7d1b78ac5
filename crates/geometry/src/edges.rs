//! Straight edges in space: where planes of regions and of the boundary meet, with what is round them.
//!
//! Across an edge all is as at a [`Vertex`] of the plane at right angles to it. Edges of cylinders and of other curved surfaces are
//! not here, and those of triangulated surfaces neither.

use std::f64::consts::{PI, TAU};

use crate::aabb::Aabb;
use crate::domain::{Domain, FaceId};
use crate::planar::{Ray, Vertex};
use crate::region::RegionMap;
use crate::shape::Shape;
use crate::surface::cross;
use crate::vector::{axis_vector, axpy, distance, dot, norm, normalized, scale, sub};

/// Points nearer than this to each other are one, over the diameter of the domain: rounding of what users write.
const SAME: f64 = 1e-9;

/// How far from an edge what is round it is told, over its length.
const BESIDE: f64 = 1e-4;

/// Angle below which two planes are one, or one that leads on without a bend, in radians.
const STRAIGHT_ON: f64 = 1e-7;

/// Planes beyond which no edges are looked for.
const MOST_PLANES: usize = 600;

/// Places along a piece of an edge at which it is looked whether the same is round it, and halvings to where that changes.
const PLACES: usize = 16;
const HALVINGS: usize = 40;

/// What else there is round an edge is looked for in directions that are no farther apart than this angle, and beside the rays of a
/// sector, in parts of its angle; at places along the edge, over half its length; with so much between two distances.
const BETWEEN: f64 = PI / 12.0;
const BESIDE_RAYS: f64 = 0.005;
const STATIONS: [f64; 3] = [-0.9, 0.0, 0.9];
const FARTHER: f64 = 1.1;

/// A point with three directions at right angles to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The point.
    pub at: [f64; 3],
    /// The directions, of length 1: two across, the third along.
    pub axes: [[f64; 3]; 3],
}

impl Frame {
    /// That of the coordinates.
    pub const COORDINATES: Self =
        Self { at: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    /// The point with these coordinates across and along, in the plane without the last one.
    pub fn place<const D: usize>(&self, across: [f64; 2], along: f64) -> [f64; D] {
        let xi = [across[0], across[1], along];
        std::array::from_fn(|k| self.at[k] + (0..3).map(|axis| xi[axis] * self.axes[axis][k]).sum::<f64>())
    }

    /// Coordinates of a point across and along.
    pub fn coordinates<const D: usize>(&self, x: &[f64; D]) -> ([f64; 2], f64) {
        let along = |axis: usize| (0..D).map(|k| (x[k] - self.at[k]) * self.axes[axis][k]).sum::<f64>();
        ([along(0), along(1)], if D > 2 { along(2) } else { 0.0 })
    }

    /// The vector with these components across and along.
    pub fn vector<const D: usize>(&self, across: [f64; 2], along: f64) -> [f64; D] {
        let xi = [across[0], across[1], along];
        std::array::from_fn(|k| (0..3).map(|axis| xi[axis] * self.axes[axis][k]).sum())
    }
}

/// A straight piece of an edge along which the same is round it.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Its middle, and the directions across and along.
    pub frame: Frame,
    /// Half its length.
    pub half_length: f64,
    /// Whether it ends at a plane of the boundary at right angles to it, at the lower end and at the upper one.
    pub at_wall: [bool; 2],
    /// What is round it, in coordinates across.
    pub around: Vertex,
}

/// A plane of a primitive.
struct Plane {
    normal: [f64; 3],
    offset: f64,
    bounds: Aabb<3>,
    face: Option<FaceId>,
}

/// All straight edges of a scene in space at which a plane has a bend or more than one of them meet; none in other dimensions, and where
/// there are more than some hundreds of planes.
pub fn edges<const D: usize>(domain: &Domain<D>, regions: &RegionMap<D>) -> Vec<Edge> {
    let planes = if D == 3 { planes(domain, regions) } else { Vec::new() };
    if planes.len() > MOST_PLANES {
        return Vec::new();
    }
    let tolerance = SAME * domain.bounds().diameter();
    let label = |x: &[f64; 3]| {
        let x: [f64; D] = std::array::from_fn(|k| x[k]);
        domain.contains(&x, 0.0).then(|| regions.label(&x, 0.0))
    };
    let scene = Scene { planes: &planes, label: &label, tolerance, size: domain.bounds().diameter() };
    let mut found: Vec<Edge> = Vec::new();
    for (k, first) in planes.iter().enumerate() {
        for second in &planes[k + 1..] {
            let Some(line) = scene.line(first, second) else { continue };
            for piece in scene.pieces(&line) {
                let is_known = |edge: &Edge| {
                    distance(&edge.frame.at, &axpy(&line.at, 0.5 * (piece[0] + piece[1]), &line.axes[2]))
                        <= 4.0 * tolerance
                };
                if !found.iter().any(is_known) {
                    found.extend(scene.edge(&line, piece));
                }
            }
        }
    }
    joined(found, tolerance)
}

/// The planes of all primitives; unbounded ones as far as the domain reaches.
fn planes<const D: usize>(domain: &Domain<D>, regions: &RegionMap<D>) -> Vec<Plane> {
    let solid = |x: &[f64; D]| -> [f64; 3] { std::array::from_fn(|k| x[k]) };
    let all = domain.bounds();
    let all = Aabb { min: solid(&all.min), max: solid(&all.max) };
    let mut found = Vec::new();
    let sides = |b: Aabb<3>| {
        (0..6_u16).map(move |k| {
            let axis = usize::from(k / 2);
            (k, axis_vector(axis, 1.0), if k % 2 == 0 { b.min[axis] } else { b.max[axis] })
        })
    };
    if domain.outer_box().is_some() {
        let side = |(k, normal, offset)| Plane { normal, offset, bounds: all, face: Some(FaceId(k)) };
        found.extend(sides(all).map(side));
    }
    let faces = domain.curved_faces().into_iter().map(|(face, shape, _)| (Some(face), shape));
    let shapes = (0..regions.len() as u16).filter_map(|label| Some((None, regions.shape(label)?)));
    for (face, shape) in faces.chain(shapes) {
        for (leaf, _) in shape.leaves() {
            match leaf {
                Shape::Box(b) => {
                    let bounds = Aabb { min: solid(&b.min), max: solid(&b.max) };
                    found.extend(sides(bounds).map(|(_, normal, offset)| Plane {
                        normal,
                        offset,
                        bounds,
                        face,
                    }));
                }
                Shape::HalfSpace(half) => {
                    let (normal, offset) = (solid(half.normal()), half.offset());
                    found.push(Plane { normal, offset, bounds: all, face });
                }
                _ => {}
            }
        }
    }
    found
}

/// The planes of a scene, what is where, and lengths that count as none and as all.
struct Scene<'a> {
    planes: &'a [Plane],
    label: &'a dyn Fn(&[f64; 3]) -> Option<u16>,
    tolerance: f64,
    size: f64,
}

impl Scene<'_> {
    /// The line that two planes share, about a point of both primitives; `None` where there is none.
    fn line(&self, first: &Plane, second: &Plane) -> Option<Frame> {
        let way = cross(&first.normal, &second.normal);
        let square = dot(&way, &way);
        if square.sqrt() <= STRAIGHT_ON {
            return None;
        }
        let tolerance = self.tolerance;
        let low: [f64; 3] = std::array::from_fn(|k| first.bounds.min[k].max(second.bounds.min[k]));
        let high: [f64; 3] = std::array::from_fn(|k| first.bounds.max[k].min(second.bounds.max[k]));
        if (0..3).any(|k| low[k] > high[k] + tolerance) {
            return None;
        }
        // The same direction and the same sides for all planes of a line.
        let mut axis = scale(1.0 / square.sqrt(), &way);
        if axis.iter().find(|a| a.abs() > SAME).is_some_and(|a| *a < 0.0) {
            axis = scale(-1.0, &axis);
        }
        let least = (0..3).min_by(|&a, &b| {
            (axis[a].abs() + SAME * a as f64).total_cmp(&(axis[b].abs() + SAME * b as f64))
        })?;
        let e = normalized(&cross(&axis, &axis_vector(least, 1.0)))?;
        let f = cross(&axis, &e);
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        let heights = [first, second].map(|plane| plane.offset - dot(&plane.normal, &middle));
        let [u, v] = [cross(&second.normal, &way), cross(&way, &first.normal)];
        let step: [f64; 3] = std::array::from_fn(|k| (heights[0] * u[k] + heights[1] * v[k]) / square);
        let at = axpy(&middle, 1.0, &step);
        Some(Frame { at, axes: [e, f, axis] }).filter(|frame| self.range(frame, &low, &high).is_some())
    }

    /// The part of a line within a box.
    fn range(&self, line: &Frame, low: &[f64; 3], high: &[f64; 3]) -> Option<[f64; 2]> {
        let (mut from, mut to) = (-self.size, self.size);
        for k in 0..3 {
            let (x, t) = (line.at[k], line.axes[2][k]);
            if t.abs() <= SAME {
                if x < low[k] - self.tolerance || x > high[k] + self.tolerance {
                    return None;
                }
                continue;
            }
            let ends = [(low[k] - x) / t, (high[k] - x) / t];
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
        (to - from > 8.0 * self.tolerance).then_some([from, to])
    }

    /// The planes through a point of a line that hold the line.
    fn through<'p>(&'p self, line: &'p Frame, t: f64) -> impl Iterator<Item = &'p Plane> {
        let x = axpy(&line.at, t, &line.axes[2]);
        self.planes.iter().filter(move |plane| {
            dot(&plane.normal, &line.axes[2]).abs() <= SAME
                && (dot(&plane.normal, &x) - plane.offset).abs() <= self.tolerance
                && plane.bounds.contains(&x, self.tolerance)
        })
    }

    /// The pieces of a line between the planes that cut it, and between places where something else round it changes.
    fn pieces(&self, line: &Frame) -> Vec<[f64; 2]> {
        let planes = self.through(line, 0.0);
        let bounds = planes.fold(None, |sum: Option<Aabb<3>>, plane| {
            let b = plane.bounds;
            Some(sum.map_or(b, |sum| Aabb {
                min: std::array::from_fn(|k| sum.min[k].min(b.min[k])),
                max: std::array::from_fn(|k| sum.max[k].max(b.max[k])),
            }))
        });
        let Some([from, to]) = bounds.and_then(|b| self.range(line, &b.min, &b.max)) else {
            return Vec::new();
        };
        let mut cuts = vec![from, to];
        for plane in self.planes {
            let slope = dot(&plane.normal, &line.axes[2]);
            if slope.abs() <= SAME {
                continue;
            }
            let t = (plane.offset - dot(&plane.normal, &line.at)) / slope;
            let x = axpy(&line.at, t, &line.axes[2]);
            if t > from && t < to && plane.bounds.contains(&x, self.tolerance) {
                cuts.push(t);
            }
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|a, b| *a - *b <= 8.0 * self.tolerance);
        let mut pieces = Vec::new();
        for pair in cuts.windows(2) {
            self.divide(line, [pair[0], pair[1]], &mut pieces);
        }
        pieces
    }

    /// Divides a piece where what is round it changes.
    fn divide(&self, line: &Frame, [from, to]: [f64; 2], pieces: &mut Vec<[f64; 2]>) {
        let step = BESIDE * (to - from);
        let round = |t: f64| -> Vec<Option<u16>> {
            let sectors = self.sectors(line, t, step);
            sectors.iter().map(|(_, label)| *label).collect()
        };
        let place = |k: usize| from + (to - from) * (k as f64 + 0.5) / PLACES as f64;
        let mut start = from;
        let mut before = round(place(0));
        for k in 1..PLACES {
            let here = round(place(k));
            if here != before {
                let (mut low, mut high) = (place(k - 1), place(k));
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    *(if round(middle) == before { &mut low } else { &mut high }) = middle;
                }
                pieces.push([start, low]);
                start = high;
                before = here;
            }
        }
        pieces.push([start, to]);
    }

    /// The directions of all planes through a line, with what is between each and the next.
    fn sectors(&self, line: &Frame, t: f64, step: f64) -> Vec<(f64, Option<u16>)> {
        let mut angles: Vec<f64> = Vec::new();
        for plane in self.through(line, t) {
            let along = cross(&plane.normal, &line.axes[2]);
            let angle = dot(&along, &line.axes[1]).atan2(dot(&along, &line.axes[0]));
            angles.extend([angle.rem_euclid(TAU), (angle + PI).rem_euclid(TAU)]);
        }
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| *a - *b <= STRAIGHT_ON);
        if angles.len() > 1 && angles[0] + TAU - angles[angles.len() - 1] <= STRAIGHT_ON {
            angles.pop();
        }
        let count = angles.len();
        let between = |k: usize| {
            let opening = if count > 1 { (angles[(k + 1) % count] - angles[k]).rem_euclid(TAU) } else { TAU };
            let (sin, cos) = (angles[k] + 0.5 * opening).sin_cos();
            let x = line.place([step * cos, step * sin], t);
            (angles[k], (self.label)(&x))
        };
        (0..count).map(between).collect()
    }

    /// The edge along a piece of a line; `None` where nothing has a bend there.
    fn edge(&self, line: &Frame, [from, to]: [f64; 2]) -> Option<Edge> {
        let (middle, half_length) = (0.5 * (from + to), 0.5 * (to - from));
        let step = BESIDE * (to - from);
        let all = self.sectors(line, middle, step);
        let count = all.len();
        let kept = |&k: &usize| all[k].1 != all[(k + count - 1) % count].1;
        let kept: Vec<usize> = (0..count).filter(kept).collect();
        if kept.is_empty() {
            return None;
        }
        let frame = Frame { at: axpy(&line.at, middle, &line.axes[2]), ..*line };
        let ray = |&k: &usize| {
            let is_outer = all[k].1.is_none() || all[(k + count - 1) % count].1.is_none();
            let face = if is_outer { self.face_at(line, middle, all[k].0) } else { None };
            Ray { angle: all[k].0, face, curvature: 0.0 }
        };
        let rays: Vec<Ray> = kept.iter().map(ray).collect();
        if let [a, b] = rays[..]
            && ((b.angle - a.angle).rem_euclid(TAU) - PI).abs() <= STRAIGHT_ON
            && a.face == b.face
        {
            return None;
        }
        let sectors = kept.iter().map(|&k| all[k].1).collect();
        let mut around = Vertex { at: [0.0; 2], rays, sectors, clear: 0.0 };
        around.clear = self.clear(&frame, half_length, &around, step);
        let at_wall =
            [-1.0, 1.0].map(|side| self.is_at_wall(&frame, side * half_length, &around, side * step));
        Some(Edge { frame, half_length, at_wall, around })
    }

    /// The face of the boundary at an angle.
    fn face_at(&self, line: &Frame, t: f64, angle: f64) -> Option<FaceId> {
        let along = line.vector::<3>([angle.cos(), angle.sin()], 0.0);
        let holds =
            |plane: &&Plane| plane.face.is_some() && dot(&plane.normal, &along).abs() <= 10.0 * STRAIGHT_ON;
        self.through(line, t).find(holds).and_then(|plane| plane.face)
    }

    /// A direction within a sector, a part of its angle away from its first ray, and the region there.
    fn inside(around: &Vertex, sector: usize, part: f64) -> ([f64; 2], Option<u16>) {
        let (sin, cos) = (around.rays[sector].angle + part * around.opening(sector)).sin_cos();
        ([cos, sin], around.sectors[sector])
    }

    /// Distance from the edge up to which every sector holds nothing but its own region.
    fn clear(&self, frame: &Frame, half_length: f64, around: &Vertex, step: f64) -> f64 {
        let mut clear = self.size;
        for station in STATIONS.map(|s| s * half_length) {
            let directions = (0..around.sectors.len()).flat_map(|k| {
                let count = (around.opening(k) / BETWEEN).ceil() as usize;
                let parts = (1..count).map(move |i| i as f64 / count as f64);
                let parts = parts.chain([BESIDE_RAYS, 1.0 - BESIDE_RAYS]);
                parts.map(move |part| Self::inside(around, k, part))
            });
            for ([cos, sin], label) in directions {
                let differs = |r: f64| (self.label)(&frame.place([r * cos, r * sin], station)) != label;
                let (mut low, mut high) = (0.0, step);
                while low < clear && !differs(high) {
                    (low, high) = (high, (FARTHER * high).min(clear));
                }
                if low >= clear {
                    continue;
                }
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    *(if differs(middle) { &mut high } else { &mut low }) = middle;
                }
                clear = clear.min(low);
            }
        }
        clear
    }

    /// Whether all ends at once where an edge does, at a plane of the boundary at right angles to it.
    fn is_at_wall(&self, frame: &Frame, end: f64, around: &Vertex, step: f64) -> bool {
        let small = BESIDE * step;
        let sectors = (0..around.sectors.len()).map(|k| Self::inside(around, k, 0.5));
        sectors.filter(|(_, label)| label.is_some()).all(|([cos, sin], label)| {
            let across = [step.abs() * cos, step.abs() * sin];
            (self.label)(&frame.place(across, end - small)) == label
                && (self.label)(&frame.place(across, end + small)).is_none()
        })
    }
}

/// Makes one of edges that lead on into each other.
fn joined(mut all: Vec<Edge>, tolerance: f64) -> Vec<Edge> {
    let mut found: Vec<Edge> = Vec::new();
    while let Some(mut edge) = all.pop() {
        let tips = |edge: &Edge| {
            [-1.0, 1.0].map(|s| axpy(&edge.frame.at, s * edge.half_length, &edge.frame.axes[2]))
        };
        let leads_on = |own: &Edge, other: &Edge| {
            let alike = own.frame.axes == other.frame.axes
                && own.around.sectors == other.around.sectors
                && own.around.rays == other.around.rays;
            let ([a, b], [c, d]) = (tips(own), tips(other));
            alike && (distance(&b, &c) <= 16.0 * tolerance || distance(&a, &d) <= 16.0 * tolerance)
        };
        while let Some(k) = all.iter().position(|other| leads_on(&edge, other)) {
            let other = all.swap_remove(k);
            let ahead = dot(&sub(&other.frame.at, &edge.frame.at), &edge.frame.axes[2]) > 0.0;
            let (low, high) = if ahead { (&edge, &other) } else { (&other, &edge) };
            let (from, to) = (tips(low)[0], tips(high)[1]);
            let at = std::array::from_fn(|axis| 0.5 * (from[axis] + to[axis]));
            let clear = low.around.clear.min(high.around.clear);
            edge = Edge {
                frame: Frame { at, ..edge.frame },
                half_length: 0.5 * norm(&sub(&to, &from)),
                at_wall: [low.at_wall[0], high.at_wall[1]],
                around: Vertex { clear, ..edge.around.clone() },
            };
        }
        found.push(edge);
    }
    found.sort_by(|a, b| {
        let pairs = a.frame.at.iter().zip(&b.frame.at);
        pairs.map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_has_twelve_edges() {
        let domain = Domain::boxed([-1.0; 3], [1.0; 3]).unwrap();
        let cube = Shape::cuboid([-0.4; 3], [0.4; 3]).unwrap();
        let regions = RegionMap::new(vec![Some(cube), None]).unwrap();
        let all = edges(&domain, &regions);
        let inner: Vec<&Edge> = all.iter().filter(|e| e.around.sectors.iter().all(Option::is_some)).collect();
        assert_eq!((all.len(), inner.len()), (24, 12));
        for edge in inner {
            assert!((edge.half_length - 0.4).abs() < 1e-8 && edge.at_wall == [false; 2], "{edge:?}");
            assert!((edge.around.clear - 0.6).abs() < 0.02, "{edge:?}");
            let inside = edge.around.sectors.iter().position(|s| *s == Some(0)).unwrap();
            assert!((edge.around.opening(inside) - 0.5 * PI).abs() < 1e-12);
            // The frame is right-handed, and its coordinates lead back.
            let x = edge.frame.place::<3>([0.1, 0.2], 0.3);
            let ([a, b], c) = edge.frame.coordinates(&x);
            assert!((a - 0.1).abs() + (b - 0.2).abs() + (c - 0.3).abs() < 1e-14);
            let [e, f, t] = edge.frame.axes;
            assert!((dot(&cross(&e, &f), &t) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_bar_through_a_wall_has_edges_that_end_there() {
        let domain = Domain::boxed([0.0; 3], [1.0; 3]).unwrap();
        let bar = Shape::cuboid([-1.0, -1.0, -1.0], [0.3, 0.2, 2.0]).unwrap();
        let regions = RegionMap::new(vec![Some(bar), None]).unwrap();
        let all = edges(&domain, &regions);
        let inner: Vec<&Edge> = all.iter().filter(|e| e.around.sectors.iter().all(Option::is_some)).collect();
        assert_eq!(inner.len(), 1);
        assert!((inner[0].half_length - 0.5).abs() < 1e-8 && inner[0].at_wall == [true; 2], "{:?}", inner[0]);
        // Where the bar's sides meet the walls two regions meet at the boundary: four lines on the lower and the upper wall, two beside.
        let two = all.iter().filter(|e| e.around.sectors.iter().flatten().count() == 2).count();
        assert_eq!(two, 6 + inner.len());
    }
}
