//! Cells by region: of every region the Voronoi cells of its own nodes, of which the parts in the region count.
//!
//! Interfaces and boundaries are cut where the nearest node on either side changes, so that every piece is a face of one cell, or of
//! two. A cell is used only if its faces close it: what a cell misses of its surface, its balance would miss of the flux.

use meshless_cells::{CellScratch, Container, FaceKind, box_planes, voronoi_cell};
use meshless_geometry::{Aabb, FaceId, Shape, gauss, gauss_from_corner};
use meshless_neighbors::CellList;

use super::curve::{Curve, Level, Piece, curves, trace};
use crate::sharp::maker::Maker;
use crate::{Condition, MethodError, Problem, parallel};

/// Half the width of the box that a cell is looked for in, in spacings: no part of a region is farther from its nearest node.
const HALF_WIDTH: f64 = 2.5;

/// How far beside an interface it is asked what is there, in spacings: beyond round-off of coordinates, and far less than a cell has
/// to be closed by.
const BESIDE: f64 = 1e-12;

/// What may be missing of the surface of a cell, over its size.
const CLOSED: f64 = 1e-5;

/// Points of a face beyond half the order: faces may be curved.
const POINTS_BEYOND: usize = 2;

/// Points of a face that ends in a vertex, where its flux may be infinite.
const POINTS_FROM_VERTEX: usize = 16;

/// How often a face beside a vertex is halved at most.
const MOST_HALVINGS: usize = 12;

/// Squares of a spacing that a level set is looked for in at most: it is made by an expression that is asked in each.
const MOST_SEARCHED: f64 = 4e6;

/// Distance of a point of an interface from the nearest one that is sampled on it, in spacings, at most.
const FARTHEST_POINT: f64 = 1.5;

/// All of a curve.
const WHOLE: [f64; 2] = [0.0, 1.0];

/// What a face is between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// Another node: of the same region, or across an interface.
    Node(u32),
    /// A face of the domain.
    Boundary(FaceId),
}

/// A point of a face: where, and the normal out of the first node's cell, times the weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacePoint<const D: usize> {
    pub(super) at: [f64; D],
    pub(super) normal: [f64; D],
    pub(super) weight: f64,
}

/// A face of a cell.
#[derive(Debug, Clone)]
pub(super) struct Face<const D: usize> {
    pub(super) node: u32,
    pub(super) beyond: Beyond,
    pub(super) middle: [f64; D],
    pub(super) area: f64,
    pub(super) points: Vec<FacePoint<D>>,
}

/// The faces of all cells that could be made.
#[derive(Debug)]
pub(super) struct Faces<const D: usize> {
    /// Each face once.
    pub(super) all: Vec<Face<D>>,
    /// Faces of every node: their places, and whether it is the first node of the face. None where there is no closed cell.
    pub(super) of_node: Vec<Vec<(usize, bool)>>,
}

/// The nodes of one region.
struct OfRegion {
    places: Vec<[f64; 2]>,
    nodes: Vec<u32>,
}

struct Geometry<'a, 'b, const D: usize> {
    problem: &'a Problem<'a, D>,
    maker: &'a Maker<'a, D>,
    regions: &'b [OfRegion],
    lists: Vec<CellList<'b, 2>>,
    rule: Vec<(f64, f64)>,
    rule_from_vertex: Vec<(f64, f64)>,
}

fn wide<const D: usize>(x: &[f64; 2]) -> [f64; D] {
    std::array::from_fn(|k| if k < 2 { x[k] } else { 0.0 })
}

fn flat<const D: usize>(x: &[f64; D]) -> [f64; 2] {
    std::array::from_fn(|k| if k < D { x[k] } else { 0.0 })
}

impl<const D: usize> Faces<D> {
    /// The cells of the nodes for which a balance is wanted.
    pub(super) fn find(maker: &Maker<'_, D>, wanted: &[bool]) -> Result<Self, MethodError> {
        let problem = maker.problem;
        let count = problem.cloud.len();
        let mut faces = Self { all: Vec::new(), of_node: vec![Vec::new(); count] };
        if D != 2 {
            return Ok(faces);
        }
        let points = problem.cloud.points();
        let regions: Vec<OfRegion> = (0..problem.regions.len())
            .map(|label| {
                let nodes: Vec<u32> =
                    (0..count as u32).filter(|&j| problem.labels[j as usize] as usize == label).collect();
                OfRegion { places: nodes.iter().map(|&j| flat(&points[j as usize])).collect(), nodes }
            })
            .collect();
        let widest = problem.cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
        let lists: Result<Vec<_>, _> =
            regions.iter().map(|region| CellList::new(&region.places, 3.0 * widest)).collect();
        let rule = gauss(maker.params.degree() / 2 + POINTS_BEYOND);
        let rule_from_vertex = gauss_from_corner(POINTS_FROM_VERTEX);
        let geometry = Geometry { problem, maker, regions: &regions, lists: lists?, rule, rule_from_vertex };
        let cells = parallel::map_with(count, CellScratch::default, |scratch, i| {
            if wanted[i] { geometry.cell(i, scratch) } else { None }
        });
        let mut surfaces = geometry.interfaces();
        surfaces.extend(geometry.boundaries());
        // Nodes whose faces close their cells.
        let mut sums: Vec<([f64; D], f64)> = vec![([0.0; D], 0.0); count];
        let mut add = |node: u32, sign: f64, face: &Face<D>| {
            let (vector, area) = &mut sums[node as usize];
            *area += face.area;
            for point in &face.points {
                (0..D).for_each(|k| vector[k] += sign * point.weight * point.normal[k]);
            }
        };
        for face in cells.iter().flatten().flatten() {
            add(face.node, 1.0, face);
        }
        for face in &surfaces {
            add(face.node, 1.0, face);
            if let Beyond::Node(other) = face.beyond {
                add(other, -1.0, face);
            }
        }
        let closed: Vec<bool> = (0..count)
            .map(|i| {
                let (vector, area) = &sums[i];
                let open = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
                cells[i].is_some() && open <= CLOSED * area
            })
            .collect();
        let is_first = |face: &Face<D>| match face.beyond {
            Beyond::Node(other) => face.node < other || !closed[other as usize],
            Beyond::Boundary(_) => true,
        };
        let own = cells.into_iter().enumerate().filter(|(i, _)| closed[*i]).filter_map(|(_, cell)| cell);
        let own = own.flatten().filter(|face| is_first(face));
        let used = |face: &Face<D>| {
            closed[face.node as usize] || matches!(face.beyond, Beyond::Node(other) if closed[other as usize])
        };
        faces.all = own.chain(surfaces.into_iter().filter(used)).collect();
        for (place, face) in faces.all.iter().enumerate() {
            if closed[face.node as usize] {
                faces.of_node[face.node as usize].push((place, true));
            }
            if let Beyond::Node(other) = face.beyond
                && closed[other as usize]
            {
                faces.of_node[other as usize].push((place, false));
            }
        }
        Ok(faces)
    }
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
                [true, false] => ([from, to], &self.rule_from_vertex),
                [false, true] => ([to, from], &self.rule_from_vertex),
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
        if self.problem.regions.label(&self.problem.cloud.points()[i], spacing) != label {
            return None;
        }
        let bounds = self.problem.domain.bounds();
        let reach = HALF_WIDTH * spacing;
        let min: [f64; 2] = std::array::from_fn(|k| bounds.min[k].max(x[k] - reach));
        let max: [f64; 2] = std::array::from_fn(|k| bounds.max[k].min(x[k] + reach));
        let searched = 2.0 * reach * f64::sqrt(2.0) * 1.01;
        let region = &self.regions[label as usize];
        let mut found = Vec::new();
        self.lists[label as usize].within(&x, searched, &mut found);
        let candidates: Vec<(u32, [f64; 2])> = found
            .iter()
            .map(|&place| (region.nodes[place as usize], region.places[place as usize]))
            .filter(|(j, _)| *j as usize != i)
            .collect();
        let planes = box_planes(&min, &max);
        let container = Container { min, max, planes: &planes, cuts: &[] };
        let cell = voronoi_cell(&x, &candidates, f64::INFINITY, &container, scratch).ok()?;
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
