//! The surfaces of a scene as points with weights: the boundary by its conditions, and the interfaces by the regions that they part.

use meshless_geometry::{Aabb, Element, FaceId, Patch, Shape, TIE, side_patch};
use meshless_interfaces::{Condition, Problem};
use meshless_neighbors::{CellList, NeighborError};

use super::pieces::Rule;
use crate::execute::Boundary;

/// How far beside a surface its sides are told, in the least of all spacings, twice the distance at which a node counts as on it; and over
/// the diameter of the domain at least: rounding.
const BESIDE: f64 = 2.0 * TIE;
const LEAST_BESIDE: f64 = 1e-14;

/// How far inside fluxes through the boundary are taken at most, over the length that a point stands for, and over the diameter of the domain
/// at least: rounding.
const NEARER: f64 = 1e-3;
const LEAST_STEP: f64 = 4e-16;

/// How far apart points at a corner are at most, over the length that the farthest of them stands for; and the part of the largest prescribed value by which two
/// differ that meet.
const MEET: f64 = 100.0;
const JUMP: f64 = 1e-3;

/// Cells of a grid in which level sets are looked for, a node.
const CELLS: f64 = 16.0;

/// Distance from a surface, over the diameter of the domain, below which a point is on it; and cosine of the angle between normals from which
/// on two surfaces run along each other. Rounding.
const ON_SURFACE: f64 = 1e-9;
const ALONG: f64 = 1.0 - 1e-9;

/// A point of the boundary with the area that it stands for, the normal out of the domain.
pub(super) struct Wall<const D: usize> {
    pub(super) element: Element<D>,
    /// Its entry of `[[boundaries]]`, and what that says there.
    pub(super) entry: usize,
    pub(super) condition: Condition,
    /// The region inside, and a place in it.
    pub(super) region: u16,
    pub(super) within: [f64; D],
}

/// A point of an interface with the area that it stands for, the normal from the region named first to the other.
pub(super) struct Seam<const D: usize> {
    pub(super) element: Element<D>,
    pub(super) between: [u16; 2],
    /// Which of the two conducts less: there the slope is what varies. And a place on that side.
    pub(super) soft: usize,
    pub(super) from: [f64; D],
    /// `eta du/dn` on the second side less that on the first, where it is given.
    pub(super) jump: f64,
}

/// All of them.
pub(super) struct Surfaces<const D: usize> {
    pub(super) walls: Vec<Wall<D>>,
    pub(super) seams: Vec<Seam<D>>,
}

impl<const D: usize> Surfaces<D> {
    /// `corners` tells whether fluxes may be infinite at corners in the plane.
    pub(super) fn new(
        problem: &Problem<'_, D>,
        boundary: &Boundary<D>,
        corners: bool,
    ) -> Result<Self, NeighborError> {
        let spacings = problem.cloud.spacing();
        let least = spacings.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let most = spacings.iter().fold(0.0_f64, |a, &b| a.max(b));
        let index = CellList::new(problem.cloud.points(), most)?;
        let near = |x: &[f64; D]| index.nearest_one(x).map_or(least, |i| spacings[i as usize]);
        let uniform = |_: &[f64; D]| least;
        let spacing: &dyn Fn(&[f64; D]) -> f64 = if most > least { &near } else { &uniform };
        let rule = Rule { spacing, least, corners };
        let bounds = problem.domain.bounds();
        let size = (bounds.measure() / (CELLS * problem.cloud.len() as f64)).powf(1.0 / D as f64);
        Ok(Self { walls: walls(problem, boundary, &rule, size), seams: seams(problem, &rule, size) })
    }
}

fn walls<const D: usize>(
    problem: &Problem<'_, D>,
    boundary: &Boundary<D>,
    rule: &Rule<'_, D>,
    size: f64,
) -> Vec<Wall<D>> {
    let domain = problem.domain;
    let bounds = domain.bounds();
    let mut faces: Vec<(FaceId, Vec<Patch<'_, D>>, Covered<'_, D>)> = Vec::new();
    if let Some(outer) = domain.outer_box() {
        let side = |k: usize| vec![side_patch(&outer, k / 2, k % 2 == 1)];
        faces.extend((0..2 * D).map(|k| (FaceId(k as u16), side(k), Covered::by_nothing())));
    }
    for (face, shape, _) in domain.curved_faces() {
        let of_leaf = |(patches, covered)| (face, patches, covered);
        faces.extend(leaf_patches(shape, &bounds, size).into_iter().map(of_leaf));
    }
    let mut walls = Vec::new();
    for (face, patches, covered) in &faces {
        // Which way is out, which condition holds, and what is inside.
        let kind = |element: &Element<D>| -> Option<(bool, usize, u16)> {
            if covered.holds(element) {
                return None;
            }
            let step = step_of(problem, rule);
            let inside = [-step, step].map(|t| domain.contains(&beside(element, t), 0.0));
            let along = match inside {
                [true, false] => true,
                [false, true] => false,
                _ => return None,
            };
            let within = beside(element, if along { -step } else { step });
            Some((along, boundary.entry(*face, &element.at)?, problem.regions.label(&within, 0.0)))
        };
        for patch in patches {
            for (element, (along, entry, region)) in rule.points(patch, &kind) {
                let out = if along { 1.0 } else { -1.0 };
                let step = step_of(problem, rule);
                let element = Element { normal: element.normal.map(|n| out * n), ..element };
                walls.push(Wall {
                    entry,
                    condition: boundary.of_entry(entry, &element.at),
                    region,
                    within: beside(&element, -step),
                    element,
                });
            }
        }
    }
    if D == 2 {
        gather(&mut walls, step_of(problem, rule), bounds.diameter());
    }
    walls
}

/// Towards a corner points gather, and so have the places inside at which fluxes are taken: else those of the last of them are not infinite as
/// they are on the boundary. But where two prescribed values meet: there fluxes on both sides have to cancel.
fn gather<const D: usize>(walls: &mut [Wall<D>], step: f64, size: f64) {
    let is_near = |wall: &Wall<D>| NEARER * wall.element.area < step;
    let value = |wall: &Wall<D>| match wall.condition {
        Condition::Dirichlet(value) => Some(value),
        _ => None,
    };
    let largest = walls.iter().filter_map(&value).map(f64::abs).fold(0.0, f64::max);
    let near: Vec<([f64; D], f64)> = walls
        .iter()
        .filter(|wall| is_near(wall))
        .filter_map(|wall| Some((wall.element.at, value(wall)?)))
        .collect();
    let apart = |x: &[f64; D], y: &[f64; D]| (0..D).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>().sqrt();
    // Points as near to the corner as each other are no farther apart than some lengths that they stand for.
    let reach = MEET * step / NEARER;
    let jumps: Vec<[f64; D]> = (near.iter().enumerate())
        .filter(|(k, (x, u))| {
            near[k + 1..].iter().any(|(y, v)| (u - v).abs() > JUMP * largest && apart(x, y) < reach)
        })
        .map(|(_, (x, _))| *x)
        .collect();
    for wall in walls.iter_mut().filter(|wall| is_near(wall)) {
        if !jumps.iter().any(|x| apart(x, &wall.element.at) < reach) {
            let nearer = (NEARER * wall.element.area).max(LEAST_STEP * size);
            wall.within = beside(&wall.element, -nearer.min(step));
        }
    }
}

fn seams<const D: usize>(problem: &Problem<'_, D>, rule: &Rule<'_, D>, size: f64) -> Vec<Seam<D>> {
    let bounds = problem.domain.bounds();
    let mut seams = Vec::new();
    for surface in 0..problem.regions.len() as u16 - 1 {
        let Some(shape) = problem.regions.shape(surface) else { continue };
        for (patches, covered) in leaf_patches(shape, &bounds, size) {
            seams_of(problem, rule, (surface, &patches, &covered), &mut seams);
        }
    }
    seams
}

/// The interfaces along the surface of one primitive of a region's shape.
fn seams_of<const D: usize>(
    problem: &Problem<'_, D>,
    rule: &Rule<'_, D>,
    (surface, patches, covered): (u16, &[Patch<'_, D>], &Covered<'_, D>),
    seams: &mut Vec<Seam<D>>,
) {
    // Which regions are behind and before the surface, and which of them conducts less.
    let kind = |element: &Element<D>| -> Option<([u16; 2], usize)> {
        if covered.holds(element) {
            return None;
        }
        let step = step_of(problem, rule);
        let places = [-step, step].map(|t| beside(element, t));
        let sides = [0, 1].map(|k| problem.regions.label(&places[k], 0.0));
        // Where two shapes have a surface in common it is that of the one named first.
        let own = sides[0] != sides[1] && sides[0].min(sides[1]) == surface;
        if !own || !places.iter().all(|x| problem.domain.contains(x, 0.0)) {
            return None;
        }
        let eta = [0, 1].map(|k| problem.materials[sides[k] as usize].diffusivity.at(&places[k]));
        Some((sides, usize::from(eta[1] < eta[0])))
    };
    for patch in patches {
        for (element, (sides, soft)) in rule.points(patch, &kind) {
            let step = step_of(problem, rule);
            let from = beside(&element, if soft == 0 { -step } else { step });
            let turned = sides[0] > sides[1];
            let turn = if turned { -1.0 } else { 1.0 };
            let between = [sides[0].min(sides[1]), sides[0].max(sides[1])];
            // That the fluxes on the two sides differ by so much holds for either direction of the normal.
            let jump = problem
                .law_between(between[0], between[1])
                .and_then(|(jump, _)| jump.flux.as_ref())
                .map_or(0.0, |flux| flux.at(&element.at));
            seams.push(Seam {
                element: Element { normal: element.normal.map(|n| turn * n), ..element },
                between,
                soft: if turned { 1 - soft } else { soft },
                from,
                jump,
            });
        }
    }
}

/// The primitives of a shape that come before one: where its surface runs along theirs, it is theirs.
struct Covered<'a, const D: usize> {
    before: Vec<&'a Shape<D>>,
    distance: f64,
}

impl<const D: usize> Covered<'_, D> {
    fn by_nothing() -> Self {
        Self { before: Vec::new(), distance: 0.0 }
    }

    fn holds(&self, element: &Element<D>) -> bool {
        self.before.iter().any(|leaf| {
            let slope = leaf.gradient(&element.at);
            let length = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
            let along: f64 = slope.iter().zip(&element.normal).map(|(a, b)| a * b).sum();
            leaf.level(&element.at).abs() <= self.distance * length && along.abs() >= ALONG * length
        })
    }
}

/// The surfaces of the primitives of a shape, each with those before it.
fn leaf_patches<'a, const D: usize>(
    shape: &'a Shape<D>,
    bounds: &Aabb<D>,
    size: f64,
) -> Vec<(Vec<Patch<'a, D>>, Covered<'a, D>)> {
    let leaves: Vec<&Shape<D>> = shape.leaves().into_iter().map(|(leaf, _)| leaf).collect();
    let distance = ON_SURFACE * bounds.diameter();
    let of_leaf = |k: usize| {
        let before = leaves[..k].to_vec();
        (leaves[k].patches(bounds, size), Covered { before, distance })
    };
    (0..leaves.len()).map(of_leaf).collect()
}

fn step_of<const D: usize>(problem: &Problem<'_, D>, rule: &Rule<'_, D>) -> f64 {
    (BESIDE * rule.least).max(LEAST_BESIDE * problem.domain.bounds().diameter())
}

fn beside<const D: usize>(element: &Element<D>, t: f64) -> [f64; D] {
    std::array::from_fn(|k| element.at[k] + t * element.normal[k])
}
