//! Interfaces and boundaries in the plane as smooth pieces of curves, and the vertices where these meet.
//!
//! Sides of boxes, edges of polygons, lines and circles are cut where they cross; what remains is every piece with different
//! things on its two sides. Level sets have no pieces, but cut those of others, and vertices know how near they are.

mod curve;
mod vertices;

use crate::domain::{Domain, FaceId};
use crate::region::RegionMap;
use crate::shape::Shape;
use crate::vector::{axpy, distance};

pub(crate) use curve::Curve;
pub use vertices::{Ray, Vertex};

/// Points nearer than this to each other are one, over the diameter of the domain: rounding of what users write.
const SAME: f64 = 1e-9;

/// How far beside the middle of a piece its two sides are told, over its length.
const BESIDE: f64 = 1e-4;

/// Size of the pieces in which level sets are looked at, over the diameter of the domain.
const SAMPLED: f64 = 5e-3;

/// Halvings of a step in which a curve crosses a level set.
const HALVINGS: usize = 52;

/// Curves beyond which vertices are not looked for: each of so many is far smaller than any spacing, and what they outline
/// is a curve.
const MOST_CURVES: usize = 4000;

/// A smooth piece of an interface or of the boundary.
#[derive(Clone, Debug)]
pub struct PlanarPiece {
    curve: Curve,
    /// The face that it is part of, on the boundary of the domain.
    pub face: Option<FaceId>,
    /// Regions to the left and to the right of the way from its start to its end; `None` outside of the domain.
    pub sides: [Option<u16>; 2],
}

impl PlanarPiece {
    /// The point a fraction `t` of the length away from the start.
    pub fn at(&self, t: f64) -> [f64; 2] {
        self.curve.at(t)
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.curve.length()
    }
}

/// All pieces of a scene in the plane.
#[derive(Clone, Debug, Default)]
pub struct PlanarPieces {
    pieces: Vec<PlanarPiece>,
    /// Points on the surfaces of shapes that have no such pieces, and how far apart they are: nothing is clear beyond them.
    others: Vec<[f64; 2]>,
    between_others: f64,
    /// Where level sets cut pieces.
    crossings: Vec<[f64; 2]>,
    /// Points nearer than this to each other are one.
    tolerance: f64,
}

impl PlanarPieces {
    /// Cuts all curves of a scene where they cross; empty in other dimensions than two, and where there are more than some
    /// thousands of them.
    pub fn new<const D: usize>(domain: &Domain<D>, regions: &RegionMap<D>) -> Self {
        let tolerance = SAME * domain.bounds().diameter();
        let curves = if D == 2 { curves(domain, regions) } else { Vec::new() };
        if curves.len() > MOST_CURVES {
            return Self { tolerance, ..Self::default() };
        }
        let between_others = SAMPLED * domain.bounds().diameter();
        let levels = if D == 2 { level_sets(domain, regions) } else { Vec::new() };
        let others = others(&levels, domain, between_others);
        let label = |x: [f64; 2]| {
            let x: [f64; D] = std::array::from_fn(|k| x[k]);
            domain.contains(&x, 0.0).then(|| regions.label(&x, 0.0))
        };
        let mut pieces: Vec<PlanarPiece> = Vec::new();
        let mut crossings = Vec::new();
        for (curve, face) in cut(&curves, &levels, (tolerance, between_others), &mut crossings) {
            let step = BESIDE * curve.length();
            let (middle, normal) = (curve.at(0.5), curve.left(0.5));
            let sides = [step, -step].map(|t| label(axpy(&middle, t, &normal)));
            // The face of a boundary is that of the domain, also where a region ends there.
            let on_boundary = sides.contains(&None);
            if sides[0] != sides[1] && face.is_some() == on_boundary {
                pieces.push(PlanarPiece { curve, face, sides });
            }
        }
        // Shapes that share a side, and faces of holes that do, have it once.
        pieces.sort_by(|a, b| a.at(0.5)[0].total_cmp(&b.at(0.5)[0]));
        let mut kept: Vec<PlanarPiece> = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let middle = piece.at(0.5);
            let near = kept.iter().rev().take_while(|k| middle[0] - k.at(0.5)[0] <= tolerance);
            let same = |other: &PlanarPiece| {
                distance(&other.at(0.5), &middle) <= tolerance
                    && (other.length() - piece.length()).abs() <= 4.0 * tolerance
            };
            if !near.into_iter().any(same) {
                kept.push(piece);
            }
        }
        Self { pieces: kept, others, between_others, crossings, tolerance }
    }

    /// The pieces.
    pub fn pieces(&self) -> &[PlanarPiece] {
        &self.pieces
    }
}

/// All curves of a scene, with the faces that they are on.
fn curves<const D: usize>(domain: &Domain<D>, regions: &RegionMap<D>) -> Vec<(Curve, Option<FaceId>)> {
    let mut found = Vec::new();
    let bounds = domain.bounds();
    let plane = |x: &[f64; D]| [x[0], x[1]];
    let reach = bounds.diameter();
    let mut add = |shape: &Shape<D>, face: Option<FaceId>| {
        for (leaf, _) in shape.leaves() {
            let curves: Vec<Curve> = match leaf {
                Shape::Box(b) => {
                    let ([x0, y0], [x1, y1]) = (plane(&b.min), plane(&b.max));
                    Curve::closed(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
                }
                Shape::Polygon(polygon) => Curve::closed(polygon.vertices()),
                Shape::Ball(ball) => vec![Curve::circle(plane(ball.center()), ball.radius())],
                Shape::HalfSpace(half) => {
                    let center = plane(&bounds.center());
                    let normal = plane(half.normal());
                    let height = half.offset() - (normal[0] * center[0] + normal[1] * center[1]);
                    let foot = axpy(&center, height, &normal);
                    let along = [-normal[1], normal[0]];
                    vec![Curve::Segment { from: axpy(&foot, -reach, &along), to: axpy(&foot, reach, &along) }]
                }
                _ => Vec::new(),
            };
            found.extend(curves.into_iter().map(|curve| (curve, face)));
        }
    };
    for (face, shape, _) in domain.curved_faces() {
        add(shape, Some(face));
    }
    for label in 0..regions.len() as u16 {
        if let Some(shape) = regions.shape(label) {
            add(shape, None);
        }
    }
    if let Some(outer) = domain.outer_box() {
        let ([x0, y0], [x1, y1]) = (plane(&outer.min), plane(&outer.max));
        let sides = [[[x0, y0], [x0, y1]], [[x1, y0], [x1, y1]], [[x0, y0], [x1, y0]], [[x0, y1], [x1, y1]]];
        let side = |(k, [from, to]): (u16, [[f64; 2]; 2])| (Curve::Segment { from, to }, Some(FaceId(k)));
        found.extend((0..).zip(sides).map(side));
    }
    found
}

/// The level sets of a scene.
fn level_sets<'a, const D: usize>(domain: &'a Domain<D>, regions: &'a RegionMap<D>) -> Vec<&'a Shape<D>> {
    let faces = domain.curved_faces().into_iter().map(|(_, shape, _)| shape);
    let shapes = faces.chain((0..regions.len() as u16).filter_map(|label| regions.shape(label)));
    let leaves = shapes.flat_map(Shape::leaves).map(|(leaf, _)| leaf);
    leaves.filter(|leaf| matches!(leaf, Shape::LevelSet(_))).collect()
}

/// Points on the surfaces of level sets.
fn others<const D: usize>(levels: &[&Shape<D>], domain: &Domain<D>, size: f64) -> Vec<[f64; 2]> {
    let all = levels.iter().flat_map(|leaf| leaf.elements(&domain.bounds(), size));
    all.map(|e| [e.at[0], e.at[1]]).collect()
}

/// Places of a curve, as parts of its length, where it crosses a level set; looked for in steps of a size.
fn crossings<const D: usize>(curve: &Curve, level: &Shape<D>, size: f64) -> Vec<f64> {
    let inside = |t: f64| {
        let x = curve.at(t);
        level.level(&std::array::from_fn(|k| x[k])) < 0.0
    };
    let steps = (curve.length() / size).ceil().max(1.0) as usize;
    let mut found = Vec::new();
    let (mut before, mut was_inside) = (0.0, inside(0.0));
    for step in 1..=steps {
        let here = step as f64 / steps as f64;
        let is_inside = inside(here);
        if is_inside != was_inside {
            let (mut low, mut high) = (before, here);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if inside(middle) == was_inside { &mut low } else { &mut high }) = middle;
            }
            found.push(0.5 * (low + high));
        }
        (before, was_inside) = (here, is_inside);
    }
    found
}

/// Every curve in pieces between the places where others and level sets cross or touch it. `crossed` gets those of level sets.
fn cut<const D: usize>(
    curves: &[(Curve, Option<FaceId>)],
    levels: &[&Shape<D>],
    (tolerance, size): (f64, f64),
    crossed: &mut Vec<[f64; 2]>,
) -> Vec<(Curve, Option<FaceId>)> {
    let mut places: Vec<Vec<f64>> = vec![Vec::new(); curves.len()];
    let boxes: Vec<[[f64; 2]; 2]> = curves.iter().map(|(curve, _)| curve.bounds(tolerance)).collect();
    let mut order: Vec<usize> = (0..curves.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0][0].total_cmp(&boxes[b][0][0]).then(a.cmp(&b)));
    for (rank, &i) in order.iter().enumerate() {
        for &j in order[rank + 1..].iter().take_while(|&&j| boxes[j][0][0] <= boxes[i][1][0]) {
            if boxes[j][0][1] <= boxes[i][1][1] && boxes[i][0][1] <= boxes[j][1][1] {
                for x in curves[i].0.meets(&curves[j].0, tolerance) {
                    places[i].push(curves[i].0.place_of(&x));
                    places[j].push(curves[j].0.place_of(&x));
                }
            }
        }
    }
    for ((curve, _), places) in curves.iter().zip(&mut places) {
        for level in levels {
            let inside = tolerance / curve.length();
            let found: Vec<f64> = crossings(curve, level, size)
                .into_iter()
                .filter(|t| (inside..=1.0 - inside).contains(t))
                .collect();
            crossed.extend(found.iter().map(|&t| curve.at(t)));
            places.extend(found);
        }
    }
    let pieces = curves.iter().zip(places).flat_map(|((curve, face), places)| {
        curve.divided(places, tolerance).into_iter().map(|piece| (piece, *face))
    });
    pieces.collect()
}
