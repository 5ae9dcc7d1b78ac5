//! Cells by region in space.

use meshless_cells::{Cell, CellScratch, FaceKind};
use meshless_geometry::{Aabb, FaceId, Shape, gauss};
use meshless_neighbors::CellList;

use super::faces::{BESIDE, Beyond, FARTHEST_POINT, Face, FacePoint, OfRegion, Pieces, cell_of};
use super::facet::{Facet, Level, Point, Surface};
use crate::sharp::maker::Maker;
use crate::{MethodError, Problem, parallel};

/// How much wider than what it is to hold a polygon is before it is cut.
const MARGIN: f64 = 1.05;

/// How far from an interface a node is that has no face on it, in spacings.
const FAR: f64 = 4.0;

/// Nodes beyond an interface that may share a face, in sizes of the face beyond the nearest one.
const OTHERS: f64 = 2.01;

/// Distances to level sets are known to this factor.
const LEVELS: f64 = 2.0;

/// Points of rules for what is no polynomial, beyond those for what is: where a diffusivity varies, and at most.
const VARYING: usize = 3;
const MOST_POINTS: usize = 8;

/// Each point more makes integrals over faces that turn by an angle more accurate by the square of this, over the angle: measured.
const GAIN: f64 = 2.3;

/// Half of the logarithm of what the error of a face that turns has to become less by: from 6e-6 to round-off.
const NEEDED: f64 = 7.8;

/// What a surface is part of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Of {
    Region,
    Boundary(FaceId),
}

/// A smooth part of the surface of a primitive, and beyond it.
struct Smooth<'a> {
    surface: Surface<'a>,
    of: Of,
    /// What holds the primitive.
    bounds: Option<Aabb<3>>,
}

struct Geometry<'a, 'b, const D: usize> {
    problem: &'a Problem<'a, D>,
    maker: &'a Maker<'a, D>,
    regions: &'b [OfRegion<3>],
    lists: Vec<CellList<'b, 3>>,
    smooth: Vec<Smooth<'b>>,
    /// Whether a diffusivity is not constant.
    varies: bool,
    /// Points along edges and across them: those for polynomials on flat faces, and ever more for what is none.
    rules: Vec<[Vec<(f64, f64)>; 2]>,
}

/// The cell of a node: the planes that hold it, and the surfaces that may cut it.
struct Own<'b> {
    cell: Cell<3>,
    walls: Vec<Surface<'b>>,
    near: Vec<usize>,
}

fn wide<const D: usize>(x: &[f64; 3]) -> [f64; D] {
    std::array::from_fn(|k| x[k])
}

fn solid<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|k| if k < D { x[k] } else { 0.0 })
}

fn solid_box<const D: usize>(b: &Aabb<D>) -> Aabb<3> {
    Aabb { min: solid(&b.min), max: solid(&b.max) }
}

/// The faces of the cells that are wanted, and of all interfaces and boundaries.
pub(super) fn pieces<const D: usize>(
    maker: &Maker<'_, D>,
    wanted: &[bool],
) -> Result<Pieces<D>, MethodError> {
    let problem = maker.problem;
    let regions = OfRegion::all(problem, solid);
    let lists = OfRegion::lists(&regions, problem)?;
    let shapes = shapes(problem);
    let levels: Vec<Option<Box<Level<'_>>>> = shapes.iter().map(|(_, shape)| level(shape)).collect();
    let count = problem.cloud.len();
    let (mut smooth, mut is_known) = (Vec::new(), true);
    for ((of, shape), level) in shapes.iter().zip(&levels) {
        let bounds = shape.bounds().as_ref().map(solid_box);
        match surfaces(shape, level.as_deref()) {
            Some(all) => smooth.extend(all.into_iter().map(|surface| Smooth { surface, of: *of, bounds })),
            None => is_known = false,
        }
    }
    if !is_known {
        return Ok(Pieces { cells: (0..count).map(|_| None).collect(), surfaces: Vec::new() });
    }
    let degree = maker.params.degree();
    // Fluxes are one degree lower, and the area of a triangle grows with the distance from its corner.
    let exact = [degree.div_ceil(2), (degree + 1).div_ceil(2)];
    let rules = (0..=MOST_POINTS).map(|more| exact.map(|n| gauss(n + more))).collect();
    let varies = problem.materials.iter().any(|material| material.diffusivity.as_constant().is_none());
    let geometry = Geometry { problem, maker, regions: &regions, lists, smooth, varies, rules };
    let found =
        parallel::map_with(count, CellScratch::default, |scratch, i| geometry.node(i, wanted[i], scratch));
    let mut pieces = Pieces { cells: Vec::with_capacity(count), surfaces: Vec::new() };
    for found in found {
        let (own, surfaces) = found.unwrap_or_default();
        pieces.cells.push(own);
        pieces.surfaces.extend(surfaces);
    }
    Ok(pieces)
}

/// The primitives that regions and the domain are made of.
fn shapes<'a, const D: usize>(problem: &Problem<'a, D>) -> Vec<(Of, Shape<D>)> {
    let regions = problem.regions;
    let mut all: Vec<(Of, Shape<D>)> = (0..regions.len())
        .filter_map(|label| regions.shape(label as u16))
        .flat_map(|shape| shape.leaves().into_iter().map(|(leaf, _)| (Of::Region, leaf.clone())))
        .collect();
    let domain = problem.domain;
    if let Some(outer) = domain.outer_box() {
        for k in 0..2 * D {
            // The faces of a box are numbered by axis, the lower one first.
            let sign = if k % 2 == 0 { -1.0 } else { 1.0 };
            let point = if k % 2 == 0 { outer.min } else { outer.max };
            let normal = std::array::from_fn(|axis| if axis == k / 2 { sign } else { 0.0 });
            all.extend(
                Shape::half_space(point, normal).ok().map(|side| (Of::Boundary(FaceId(k as u16)), side)),
            );
        }
    }
    for (id, shape, _) in domain.curved_faces() {
        all.extend(shape.leaves().into_iter().map(|(leaf, _)| (Of::Boundary(id), leaf.clone())));
    }
    all
}

/// The level set of the curved part of a primitive.
fn level<const D: usize>(shape: &Shape<D>) -> Option<Box<Level<'_>>> {
    match shape {
        Shape::Ball(_) | Shape::LevelSet(_) => Some(Box::new(|x| {
            let x = wide(x);
            (shape.level(&x), solid(&shape.gradient(&x)))
        })),
        Shape::Cylinder(cylinder) => {
            let (center, axis, radius) =
                (solid(cylinder.center()), solid(cylinder.axis()), cylinder.radius());
            Some(Box::new(move |x| {
                let way: [f64; 3] = std::array::from_fn(|k| x[k] - center[k]);
                let along: f64 = (0..3).map(|k| way[k] * axis[k]).sum();
                let across: [f64; 3] = std::array::from_fn(|k| way[k] - along * axis[k]);
                let distance = across.iter().map(|a| a * a).sum::<f64>().sqrt();
                (distance - radius, across.map(|a| a / distance))
            }))
        }
        _ => None,
    }
}

/// The smooth surfaces of a primitive; `None` where they are not known.
fn surfaces<'a, const D: usize>(shape: &Shape<D>, level: Option<&'a Level<'a>>) -> Option<Vec<Surface<'a>>> {
    let axis = |k: usize| std::array::from_fn(|axis| if axis == k { 1.0 } else { 0.0 });
    match shape {
        Shape::Box(b) => {
            let side =
                |k: usize| [b.min[k], b.max[k]].map(|offset| Surface::Plane { normal: axis(k), offset });
            Some((0..D).flat_map(side).collect())
        }
        Shape::HalfSpace(h) => Some(vec![Surface::Plane { normal: solid(h.normal()), offset: h.offset() }]),
        Shape::Cylinder(cylinder) => {
            let (center, axis) = (solid(cylinder.center()), solid(cylinder.axis()));
            let ends = cylinder.half_length().into_iter().flat_map(|half| [-half, half]);
            let end = |t: f64| Surface::through(&std::array::from_fn(|k| center[k] + t * axis[k]), axis);
            Some(ends.map(end).chain(level.map(Surface::Level)).collect())
        }
        _ => level.map(|level| vec![Surface::Level(level)]),
    }
}

type OfNode<const D: usize> = (Option<Vec<Face<D>>>, Vec<Face<D>>);

impl<'b, const D: usize> Geometry<'_, 'b, D> {
    fn label(&self, x: &[f64; 3]) -> u16 {
        self.problem.regions.label(&wide(x), 0.0)
    }

    fn inside(&self, x: &[f64; 3]) -> bool {
        self.problem.domain.contains(&wide(x), 0.0)
    }

    /// The faces of a node with others of its region, where they are wanted, and those on interfaces and boundaries of which it is the
    /// first node; `None` where they cannot be told.
    fn node(&self, i: usize, wanted: bool, scratch: &mut CellScratch) -> Option<OfNode<D>> {
        let x = &self.problem.cloud.points()[i];
        let spacing = self.problem.cloud.spacing()[i];
        if !wanted && !self.maker.has_interface_within(x, FAR * spacing) {
            return None;
        }
        let own = self.own(i, scratch)?;
        let cell = if wanted { Some(self.cell(i, &own)?) } else { None };
        let mut surfaces = Vec::new();
        for &place in &own.near {
            self.surface(i, &own, place, &mut surfaces)?;
        }
        Some((cell, surfaces))
    }

    fn own(&self, i: usize, scratch: &mut CellScratch) -> Option<Own<'b>> {
        let label = self.problem.labels[i] as usize;
        let x = solid(&self.problem.cloud.points()[i]);
        let cell = cell_of((self.problem, i), (&self.regions[label], &self.lists[label]), solid, scratch)?;
        let walls = cell.faces.iter().map(|face| Surface::through(&face.centroid, face.normal)).collect();
        let radius = 0.5 * cell.reach;
        let is_near = |smooth: &Smooth<'_>| {
            let held = |b: &Aabb<3>| (0..3).all(|k| b.min[k] - radius <= x[k] && x[k] <= b.max[k] + radius);
            let factor = if smooth.surface.is_plane() { 1.0 } else { LEVELS };
            smooth.bounds.as_ref().is_none_or(held) && smooth.surface.distance(&x) <= factor * radius * MARGIN
        };
        let near = (0..self.smooth.len()).filter(|&place| is_near(&self.smooth[place])).collect();
        Some(Own { cell, walls, near })
    }

    fn points(&self, facet: &Facet<'_>) -> Option<Vec<Point>> {
        let turn = facet.turn()?;
        let curved = if turn > 0.0 { (NEEDED / (GAIN / turn).ln().max(1.0)).ceil() as usize } else { 0 };
        let more = curved.max(if self.varies { VARYING } else { 0 });
        let [along_edge, across] = &self.rules[more.min(MOST_POINTS)];
        facet.points([along_edge, across])
    }

    fn face(&self, points: &[Point], node: u32, beyond: Beyond, sign: f64) -> Face<D> {
        let area: f64 = points.iter().map(|(_, _, weight)| weight).sum();
        let middle: [f64; 3] =
            std::array::from_fn(|k| points.iter().map(|(x, _, weight)| weight * x[k]).sum::<f64>() / area);
        let point = |(at, normal, weight): &Point| FacePoint {
            at: wide(at),
            normal: wide(&normal.map(|n| sign * n)),
            weight: *weight,
        };
        Face { node, beyond, middle: wide(&middle), area, points: points.iter().map(point).collect() }
    }

    /// The faces of a cell with nodes of its own region.
    fn cell(&self, i: usize, own: &Own<'b>) -> Option<Vec<Face<D>>> {
        let label = self.problem.labels[i];
        let mut faces = Vec::new();
        for (place, face) in own.cell.faces.iter().enumerate() {
            let FaceKind::Neighbor(j) = face.kind else { continue };
            let square = Facet::square(own.walls[place], &face.centroid, own.cell.reach)?;
            let others = (0..own.walls.len()).filter(|&k| k != place).map(|k| own.walls[k]);
            let mut points = Vec::new();
            for whole in square.within(others)? {
                for part in whole.divided(own.near.iter().map(|&k| self.smooth[k].surface))? {
                    let middle = part.middle()?;
                    if self.label(&middle) == label && self.inside(&middle) {
                        points.extend(self.points(&part)?);
                    }
                }
            }
            if !points.is_empty() {
                let mut face = self.face(&points, i as u32, Beyond::Node(j), 1.0);
                let out: f64 = (0..3).map(|k| points[0].1[k] * own.cell.faces[place].normal[k]).sum();
                if out < 0.0 {
                    face.points.iter_mut().for_each(|point| point.normal = point.normal.map(|n| -n));
                }
                faces.push(face);
            }
        }
        Some(faces)
    }

    /// The parts of a surface that are faces of a cell, of which its node is the first.
    fn surface(&self, i: usize, own: &Own<'b>, place: usize, faces: &mut Vec<Face<D>>) -> Option<()> {
        let Smooth { surface, of, .. } = self.smooth[place];
        let x = solid(&self.problem.cloud.points()[i]);
        let label = self.problem.labels[i];
        // An interface is told from the region that is named first.
        if of == Of::Region && label as usize + 1 == self.problem.regions.len() {
            return Some(());
        }
        let spacing = self.problem.cloud.spacing()[i];
        let step = BESIDE * spacing;
        let half_width = MARGIN * f64::min(0.5 * own.cell.reach, FARTHEST_POINT * spacing);
        // A surface that turns away is not seen from here, or a cell is left open.
        let Some(square) = Facet::square(surface, &x, half_width) else { return Some(()) };
        let others = || own.near.iter().filter(|&&k| k != place);
        for whole in square.within(own.walls.iter().copied())? {
            let cutting: Vec<Surface<'b>> =
                others().map(|&k| self.smooth[k].surface).filter(|other| !whole.is_on(other)).collect();
            for part in whole.divided(cutting.into_iter())? {
                let middle = part.middle()?;
                let normal = surface.normal(&middle);
                let beside = [-step, step].map(|t| std::array::from_fn(|k| middle[k] + t * normal[k]));
                // A surface of several primitives is that of the first.
                let is_known = others().any(|&k| {
                    let other = &self.smooth[k];
                    k < place
                        && (other.of == Of::Region) == (of == Of::Region)
                        && other.surface.distance(&middle) <= step
                });
                let inside = beside.each_ref().map(|x| self.inside(x));
                let labels = beside.each_ref().map(|x| self.label(x));
                if is_known {
                    continue;
                }
                match of {
                    Of::Region if inside == [true; 2] && labels[0] != labels[1] => {
                        let Some(side) = labels.iter().position(|&l| l == label) else { continue };
                        let other = labels[1 - side];
                        if other > label {
                            let sign = if side == 0 { 1.0 } else { -1.0 };
                            self.shared(i, other, part, &middle, sign, faces)?;
                        }
                    }
                    Of::Boundary(id) if inside[0] != inside[1] => {
                        let side = usize::from(inside[1]);
                        if labels[side] == label {
                            let sign = if side == 0 { 1.0 } else { -1.0 };
                            faces.push(self.face(&self.points(&part)?, i as u32, Beyond::Boundary(id), sign));
                        }
                    }
                    _ => {}
                }
            }
        }
        Some(())
    }

    /// Cuts a part of an interface where the nearest node beyond it changes.
    fn shared(
        &self,
        i: usize,
        other: u16,
        part: Facet<'b>,
        middle: &[f64; 3],
        sign: f64,
        faces: &mut Vec<Face<D>>,
    ) -> Option<()> {
        let (list, region) = (&self.lists[other as usize], &self.regions[other as usize]);
        let nearest = list.nearest_one(middle)? as usize;
        let away =
            |j: usize| region.places[j].iter().zip(middle).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let mut found = Vec::new();
        list.within(middle, away(nearest) + OTHERS * part.radius(middle)?, &mut found);
        // A node that all of the part is farther from than from the nearest one has nothing of it.
        let first = &region.places[nearest];
        found.retain(|&j| {
            j as usize == nearest || !part.is_within(&Surface::between(first, &region.places[j as usize]))
        });
        for &j in &found {
            let own = &region.places[j as usize];
            let walls = found.iter().filter(|&&k| k != j);
            let walls = walls.map(|&k| Surface::between(own, &region.places[k as usize]));
            let mut points = Vec::new();
            for piece in part.clone().within(walls)? {
                points.extend(self.points(&piece)?);
            }
            if !points.is_empty() {
                faces.push(self.face(&points, i as u32, Beyond::Node(region.nodes[j as usize]), sign));
            }
        }
        Some(())
    }
}
