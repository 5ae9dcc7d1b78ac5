//! Cells by region in the plane.

use meshless_cells::{CellScratch, FaceKind};
use meshless_geometry::{Aabb, FaceId, Shape, gauss, gauss_from_corner};
use meshless_neighbors::CellList;

use super::curve::{Curve, Level, Piece, curves, trace};
use super::faces::{BESIDE, Beyond, FARTHEST_POINT, Face, FacePoint, OfRegion, Pieces, cell_of};
use crate::sharp::maker::Maker;
use crate::{Condition, MethodError, Problem, parallel};

/// Points of a face that ends in a vertex, where its flux may be infinite.
const POINTS_FROM_VERTEX: usize = 16;

/// How often a face beside a vertex is halved at most.
const MOST_HALVINGS: usize = 12;

/// Squares of a spacing that a level set is looked for in at most: it is made by an expression that is asked in each.
const MOST_SEARCHED: f64 = 4e6;

/// Points of a face beyond half the order: faces may be curved.
const POINTS_BEYOND: usize = 2;

/// All of a curve.
const WHOLE: [f64; 2] = [0.0, 1.0];

struct Geometry<'a, 'b, const D: usize> {
    problem: &'a Problem<'a, D>,
    maker: &'a Maker<'a, D>,
    regions: &'b [OfRegion<2>],
    lists: Vec<CellList<'b, 2>>,
    rule: Vec<(f64, f64)>,
    rule_relative: Vec<(f64, f64)>,
}

fn wide<const D: usize>(x: &[f64; 2]) -> [f64; D] {
    std::array::from_fn(|k| if k < 2 { x[k] } else { 0.0 })
}

fn flat<const D: usize>(x: &[f64; D]) -> [f64; 2] {
    std::array::from_fn(|k| if k < D { x[k] } else { 0.0 })
}

/// The faces of the cells that are wanted, and of all interfaces and boundaries.
pub(super) fn pieces<const D: usize>(
    maker: &Maker<'_, D>,
    wanted: &[bool],
) -> Result<Pieces<D>, MethodError> {
    let problem = maker.problem;
    let regions = OfRegion::all(problem, flat);
    let lists = OfRegion::lists(&regions, problem)?;
    let rule = gauss(maker.params.degree() / 2 + POINTS_BEYOND);
    let rule_relative = gauss_from_corner(POINTS_FROM_VERTEX);
    let geometry = Geometry { problem, maker, regions: &regions, lists, rule, rule_relative };
    let cells = parallel::map_with(problem.cloud.len(), CellScratch::default, |scratch, i| {
        if wanted[i] { geometry.cell(i, scratch) } else { None }
    });
    let mut surfaces = geometry.interfaces();
    surfaces.extend(geometry.boundaries());
    Ok(Pieces { cells, surfaces })
}

impl<const D: usize> Geometry<'_, '_, D> {
    fn label(&self, x: &[f64; 2]) -> u16 {
        self.problem.regions.label(&wide(x), 0.0)
    }

    fn inside(&self, x: &[f64; 2]) -> bool {
        self.problem.domain.contains(&wide(x), 0.0)
    }

    fn spacing(&self, x: &[f64; 2]) -> f64 {
        self.maker.nearest_one(&wide(x)).map_or(f64::INFINITY, |j| self.problem.cloud.spacing()[j])
    }

    /// The nearest node of a region.
    fn nearest(&self, label: u16, x: &[f64; 2]) -> Option<u32> {
        let nearest = self.lists[label as usize].nearest_one(x)?;
        Some(self.regions[label as usize].nodes[nearest as usize])
    }

    fn face(&self, curve: &Curve<'_>, [from, to]: [f64; 2], node: u32, beyond: Beyond, sign: f64) -> Face<D> {
        let mut area = 0.0;
        let points = self.parameters(curve, [from, to]).into_iter().map(|(t, weight)| {
            let (x, normal) = curve.at(t);
            let length = normal[0].hypot(normal[1]);
            let weight = weight * length;
            area += weight;
            FacePoint { at: wide(&x), normal: wide(&normal.map(|n| sign * n / length)), weight }
        });
        let points = points.collect();
        let middle = wide(&curve.at(0.5 * (from + to)).0);
        Face { node, beyond, middle, area, points }
    }

    /// Quadrature over a part of a curve: halved beside a vertex, where fluxes vary fast, and graded towards one that it ends in.
    fn parameters(&self, curve: &Curve<'_>, whole: [f64; 2]) -> Vec<(f64, f64)> {
        let place = |t: f64| curve.at(t).0;
        let away = |x: &[f64; 2]| self.maker.vertices.distance(x);
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let mut found = Vec::new();
        let mut waiting = vec![(whole, 0)];
        while let Some(([from, to], halvings)) = waiting.pop() {
            let middle = 0.5 * (from + to);
            let ends = [from, to].map(|t| self.maker.vertices.is_one_at(&place(t)));
            let near = away(&place(middle)) < apart(place(from), place(to));
            let ([begin, end], rule) = match ends {
                [true, false] => ([from, to], &self.rule_relative),
                [false, true] => ([to, from], &self.rule_relative),
                [false, false] if !near || halvings == MOST_HALVINGS => ([from, to], &self.rule),
                _ => {
                    waiting.extend([([middle, to], halvings + 1), ([from, middle], halvings + 1)]);
                    continue;
                }
            };
            let points =
                rule.iter().map(|(t, weight)| (begin + t * (end - begin), weight * (end - begin).abs()));
            found.extend(points);
        }
        found
    }

    /// The faces of a cell with nodes of its own region.
    fn cell(&self, i: usize, scratch: &mut CellScratch) -> Option<Vec<Face<D>>> {
        let label = self.problem.labels[i];
        let x = flat(&self.problem.cloud.points()[i]);
        let spacing = self.problem.cloud.spacing()[i];
        let own = (&self.regions[label as usize], &self.lists[label as usize]);
        let cell = cell_of((self.problem, i), own, flat, scratch)?;
        let reach = 0.5 * cell.reach + FARTHEST_POINT * spacing;
        let is_whole =
            self.problem.domain.outer_box().is_some() && !self.maker.has_interface_within(&wide(&x), reach);
        let mut faces = Vec::new();
        for face in &cell.faces {
            let FaceKind::Neighbor(j) = face.kind else { continue };
            let along = [-face.normal[1], face.normal[0]].map(|t| 0.5 * face.area * t);
            let from = std::array::from_fn(|k| face.centroid[k] - along[k]);
            let to = std::array::from_fn(|k| face.centroid[k] + along[k]);
            let curve = Curve::between(from, to);
            let inside = |x: &[f64; 2], _: &[f64; 2]| self.label(x) == label && self.inside(x);
            let pieces = match is_whole {
                true => vec![Piece { between: WHOLE, key: true }],
                false => curve.split(WHOLE, |_| spacing, inside),
            };
            for Piece { between, .. } in pieces.into_iter().filter(|piece| piece.key) {
                faces.push(self.face(&curve, between, i as u32, Beyond::Node(j), 1.0));
            }
        }
        Some(faces)
    }

    /// The surface of a primitive in smooth pieces; none where it is too large to be looked for.
    fn curves<'c>(&self, leaf: &Shape<D>, level: &'c Level<'c>, bounds: &Aabb<2>) -> Vec<Curve<'c>> {
        if let Some(curves) = flat_shape(leaf).and_then(|shape| curves(&shape, bounds)) {
            return curves;
        }
        let finest = self.problem.cloud.spacing().iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let box_of_all = self.problem.domain.bounds();
        let squares = box_of_all.measure() / (finest * finest);
        if squares.is_nan() || squares > MOST_SEARCHED {
            return Vec::new();
        }
        let starts: Vec<[f64; 2]> =
            leaf.elements(&box_of_all, finest).iter().map(|element| flat(&element.at)).collect();
        trace(level, &starts, bounds, |x| self.spacing(x))
    }

    /// The pieces of all interfaces.
    fn interfaces(&self) -> Vec<Face<D>> {
        let bounds = flat_box(&self.problem.domain.bounds());
        let regions = self.problem.regions;
        let leaves: Vec<&Shape<D>> = (0..regions.len())
            .filter_map(|label| regions.shape(label as u16))
            .flat_map(|shape| shape.leaves().into_iter().map(|(leaf, _)| leaf))
            .collect();
        let levels: Vec<Box<Level<'_>>> = leaves.iter().map(|leaf| level(leaf)).collect();
        let pieces: Vec<(usize, Curve<'_>)> = (leaves.iter().zip(&levels).enumerate())
            .flat_map(|(place, (leaf, level))| {
                self.curves(leaf, &**level, &bounds).into_iter().map(move |curve| (place, curve))
            })
            .collect();
        parallel::collect(pieces.len(), |k, all: &mut Vec<Face<D>>| {
            let (leaf, curve) = &pieces[k];
            let key = |x: &[f64; 2], normal: &[f64; 2]| {
                let spacing = self.spacing(x);
                let step = BESIDE * spacing;
                let beside = [-step, step].map(|t| [x[0] + t * normal[0], x[1] + t * normal[1]]);
                let labels = beside.each_ref().map(|x| self.label(x));
                // A surface of several primitives is that of the first.
                let is_known = || levels[..*leaf].iter().any(|level| is_on(level(x), step));
                let is_one = labels[0] != labels[1] && beside.iter().all(|x| self.inside(x)) && !is_known();
                is_one.then_some(labels)
            };
            let spacing = |x: &[f64; 2]| self.spacing(x);
            for Piece { between, key } in curve.split(WHOLE, spacing, key) {
                let Some(labels) = key else { continue };
                let nearest = |x: &[f64; 2], _: &[f64; 2]| labels.map(|label| self.nearest(label, x));
                for Piece { between, key } in curve.split(between, spacing, nearest) {
                    if let [Some(inner), Some(outer)] = key {
                        all.push(self.face(curve, between, inner, Beyond::Node(outer), 1.0));
                    }
                }
            }
        })
    }

    /// The pieces of the boundary of the domain.
    fn boundaries(&self) -> Vec<Face<D>> {
        let domain = self.problem.domain;
        let bounds = flat_box(&domain.bounds());
        let mut all: Vec<(FaceId, Curve<'_>)> = Vec::new();
        if domain.outer_box().is_some() {
            // The sides in the order of their curves: below, right, above, left.
            let sides = curves(&Shape::Box(bounds), &bounds).unwrap_or_default();
            all.extend([2, 1, 3, 0].map(FaceId).into_iter().zip(sides));
        }
        let curved = domain.curved_faces();
        let leaves: Vec<(FaceId, &Shape<D>)> = curved
            .iter()
            .flat_map(|(id, shape, _)| shape.leaves().into_iter().map(|(leaf, _)| (*id, leaf)))
            .collect();
        let levels: Vec<Box<Level<'_>>> = leaves.iter().map(|(_, leaf)| level(leaf)).collect();
        for ((id, leaf), level) in leaves.iter().zip(&levels) {
            all.extend(self.curves(leaf, &**level, &bounds).into_iter().map(|curve| (*id, curve)));
        }
        parallel::collect(all.len(), |k, faces: &mut Vec<Face<D>>| {
            let (id, curve) = &all[k];
            let key = |x: &[f64; 2], normal: &[f64; 2]| {
                let step = BESIDE * self.spacing(x);
                let beside = [-step, step].map(|t| [x[0] + t * normal[0], x[1] + t * normal[1]]);
                let inside = beside.each_ref().map(|x| self.inside(x));
                if inside[0] == inside[1] {
                    return None;
                }
                let own = if inside[0] { &beside[0] } else { &beside[1] };
                let condition = self.problem.boundary.condition(*id, &wide(x));
                let prescribed = matches!(condition, Some(Condition::Dirichlet(_)));
                Some((self.nearest(self.label(own), x)?, inside[0], prescribed))
            };
            for Piece { between, key } in curve.split(WHOLE, |x| self.spacing(x), key) {
                if let Some((node, is_below, _)) = key {
                    let sign = if is_below { 1.0 } else { -1.0 };
                    faces.push(self.face(curve, between, node, Beyond::Boundary(*id), sign));
                }
            }
        })
    }
}

fn flat_box<const D: usize>(b: &Aabb<D>) -> Aabb<2> {
    Aabb { min: flat(&b.min), max: flat(&b.max) }
}

/// The level of a shape in the plane.
fn level<'a, const D: usize>(shape: &'a Shape<D>) -> Box<Level<'a>> {
    Box::new(move |x| {
        let x = wide(x);
        (shape.level(&x), flat(&shape.gradient(&x)))
    })
}

/// Whether a point with this level and gradient is on a surface, up to a distance.
fn is_on((level, gradient): (f64, [f64; 2]), distance: f64) -> bool {
    level.abs() <= distance * gradient[0].hypot(gradient[1])
}

/// A primitive in the plane that is made of straight and round pieces.
fn flat_shape<const D: usize>(leaf: &Shape<D>) -> Option<Shape<2>> {
    match leaf {
        Shape::Box(b) => Some(Shape::Box(flat_box(b))),
        Shape::Ball(ball) => Shape::ball(flat(ball.center()), ball.radius()).ok(),
        Shape::Polygon(polygon) => Some(Shape::Polygon(polygon.clone())),
        Shape::HalfSpace(h) => {
            let point: [f64; 2] = flat(h.normal()).map(|n| h.offset() * n);
            Shape::half_space(point, flat(h.normal())).ok()
        }
        _ => None,
    }
}
