//! The boundary of the domain and the interfaces as cells see them: flat faces, which are met exactly, apart from curved ones.

use meshless_cells::{Cut, Wall};
use meshless_geometry::{Domain, FaceId, FlatFace, Shape};

use crate::Problem;

/// A level set, negative in the domain.
pub(super) type Level<'a, const D: usize> = Box<dyn Fn(&[f64; D]) -> f64 + Sync + 'a>;

/// The number of a face, by a point out of the domain.
type Beyond<'a, const D: usize> = Box<dyn Fn(&[f64; D]) -> Option<u16> + Sync + 'a>;

/// The flat faces of a domain that are not planes of an outer box.
pub(super) struct Flat<'a, const D: usize> {
    pub(super) walls: Vec<Wall<D>>,
    /// The same faces as level sets.
    pub(super) levels: Vec<(FaceId, Level<'a, D>)>,
    /// The face towards a point out of the domain.
    pub(super) beyond: Beyond<'a, D>,
}

impl<'a, const D: usize> Flat<'a, D> {
    fn new(faces: Vec<(FaceId, &'a Shape<D>, bool, Vec<FlatFace<D>>)>) -> Self {
        let walls = faces.iter().flat_map(|(.., flat)| flat).map(wall).collect();
        let levels = faces.iter().map(|&(face, shape, hole, _)| (face, level(shape, hole))).collect();
        let shapes: Vec<(FaceId, &Shape<D>, bool)> =
            faces.iter().map(|face| (face.0, face.1, face.2)).collect();
        let beyond = Box::new(move |x: &[f64; D]| {
            let is_out = |&&(_, shape, hole): &&(FaceId, &Shape<D>, bool)| (shape.level(x) < 0.0) == hole;
            shapes.iter().find(is_out).map(|(face, ..)| face.0)
        });
        Self { walls, levels, beyond }
    }
}

/// The level of a shape or, for a hole, of what it leaves.
fn level<const D: usize>(shape: &Shape<D>, hole: bool) -> Level<'_, D> {
    let sign = if hole { -1.0 } else { 1.0 };
    Box::new(move |x: &[f64; D]| sign * shape.level(x))
}

fn wall<const D: usize>(face: &FlatFace<D>) -> Wall<D> {
    Wall { normal: face.normal, offset: face.offset, min: face.min, max: face.max }
}

/// The faces of a domain that are not planes of an outer box, those that are flat apart.
type Faces<'a, const D: usize> = (Vec<(FaceId, Level<'a, D>)>, Flat<'a, D>);

pub(super) fn faces<const D: usize>(domain: &Domain<D>) -> Faces<'_, D> {
    let (mut curved, mut flat) = (Vec::new(), Vec::new());
    for (face, shape, hole) in domain.curved_faces() {
        match shape.flat_faces() {
            Some(faces) => flat.push((face, shape, hole, faces)),
            None => curved.push((face, level(shape, hole))),
        }
    }
    (curved, Flat::new(flat))
}

/// Interfaces that are flat, and the shapes that have others.
pub(super) struct FlatInterfaces<'a, const D: usize> {
    pub(super) walls: Vec<Wall<D>>,
    pub(super) others: Vec<&'a Shape<D>>,
}

/// The surfaces of all shapes that regions are made of.
pub(super) fn interfaces<'a, const D: usize>(problem: &Problem<'a, D>) -> FlatInterfaces<'a, D> {
    let mut found = FlatInterfaces { walls: Vec::new(), others: Vec::new() };
    let regions = problem.regions;
    let shapes = (0..regions.len()).filter_map(|label| regions.shape(label as u16));
    for (leaf, _) in shapes.flat_map(Shape::leaves) {
        match leaf.flat_faces() {
            Some(faces) => found.walls.extend(faces.iter().map(wall)),
            None => found.others.push(leaf),
        }
    }
    found
}

/// Level sets as cells take them.
pub(super) fn cuts<'b, const D: usize>(levels: &'b [(FaceId, Level<'_, D>)]) -> Vec<Cut<'b, D>> {
    levels.iter().map(|(face, level)| Cut { level: &**level, face: face.0 }).collect()
}
