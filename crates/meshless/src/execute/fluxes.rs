//! Totals of the flux `eta du/dn`: through the parts of the boundary, and through the interfaces.
//!
//! Surfaces are cut into pieces, each with the value in its middle. Where a condition says what the flux is, that is it; where u is
//! prescribed, and at interfaces, it is that of the method's own polynomials, or of a fit to the nodes of one region.

use meshless_geometry::{Element, FaceId, side_elements};
use meshless_interfaces::{Condition, Problem, Sample, Sampler};

use super::{Boundary, Solved};
use crate::Error;
use crate::plan::{Effect, Plan};
use crate::report::{BoundaryFlux, FluxReport, InterfaceFlux};
use crate::scene::Scene;

/// Pieces on a spacing, by dimension.
const PIECES: [f64; 3] = [1.0, 12.0, 4.0];

/// How far beside a surface its sides are told, in spacings.
const BESIDE: f64 = 1e-6;

/// How often a piece is halved on the way to where something else begins on it.
const HALVINGS: usize = 30;

/// A piece of the boundary: what it belongs to, and the condition there.
struct Piece<const D: usize> {
    element: Element<D>,
    entry: usize,
    condition: Condition,
}

/// A piece of an interface, as seen from the side that conducts less: there the slope is what varies.
struct Seam<const D: usize> {
    element: Element<D>,
    between: [u16; 2],
    from: [f64; D],
}

/// The fluxes of a solved scene.
pub(super) fn fluxes<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    solved: &Solved<D>,
) -> Result<FluxReport, Error> {
    let problem = solved.discrete.problem();
    let spacing = solved.spacing();
    let size = spacing / PIECES[D - 1];
    let boundary = Boundary::new(scene, problem.domain);
    let pieces = boundary_pieces(&problem, &boundary, spacing, size);
    let seams = seams(&problem, spacing, size);
    let places: Vec<[f64; D]> =
        pieces.iter().map(|p| p.element.at).chain(seams.iter().map(|s| s.from)).collect();
    let samples = samples(plan, solved, &places)?;
    let (on_boundary, at_seams) = samples.split_at(pieces.len());
    let boundaries = through_boundary(scene, &problem, &pieces, on_boundary);
    let interfaces = through_interfaces(scene, &problem, &seams, at_seams);
    let left_over = left_over(plan, &boundaries);
    Ok(FluxReport { boundaries, interfaces, left_over })
}

/// The totals of the entries of `[[boundaries]]`.
fn through_boundary<const D: usize>(
    scene: &Scene,
    problem: &Problem<'_, D>,
    pieces: &[Piece<D>],
    samples: &[Option<Sample<D>>],
) -> Vec<BoundaryFlux> {
    let specs = scene.boundaries.iter().enumerate();
    let mut parts: Vec<BoundaryFlux> = specs
        .map(|(entry, spec)| BoundaryFlux { face: spec.face.clone(), entry, flux: 0.0, area: 0.0 })
        .collect();
    for (piece, sample) in pieces.iter().zip(samples) {
        let Some(sample) = sample else { continue };
        let part = &mut parts[piece.entry];
        part.flux += piece.element.area * entering(problem, piece, sample);
        part.area += piece.element.area;
    }
    parts
}

/// The totals of the pairs of regions that meet.
fn through_interfaces<const D: usize>(
    scene: &Scene,
    problem: &Problem<'_, D>,
    seams: &[Seam<D>],
    samples: &[Option<Sample<D>>],
) -> Vec<InterfaceFlux> {
    let mut interfaces: Vec<InterfaceFlux> = Vec::new();
    for (seam, sample) in seams.iter().zip(samples) {
        let Some(sample) = sample else { continue };
        let names = seam.between.map(|region| scene.regions[region as usize].name.clone()).to_vec();
        let eta = problem.materials[sample.region as usize].diffusivity.at(&seam.from);
        let flux = seam.element.area * eta * dot(&sample.gradient, &seam.element.normal);
        match interfaces.iter_mut().find(|known| known.between == names) {
            Some(known) => {
                known.flux += flux;
                known.area += seam.element.area;
            }
            None => interfaces.push(InterfaceFlux { between: names, flux, area: seam.element.area }),
        }
    }
    interfaces
}

/// What enters less what leaves over half of the sum of their sizes, where nothing else is in the balance.
fn left_over(plan: &Plan, parts: &[BoundaryFlux]) -> Option<f64> {
    let size: f64 = parts.iter().map(|part| part.flux.abs()).sum();
    let sourced =
        |effect: &Effect| matches!(effect, Effect::Source | Effect::FluxJump | Effect::Time | Effect::Slits);
    let balances = size > 0.0 && !plan.effects.iter().any(sourced);
    balances.then(|| 2.0 * parts.iter().map(|part| part.flux).sum::<f64>().abs() / size)
}

/// `eta du/dn` with n out of the domain: what enters.
fn entering<const D: usize>(problem: &Problem<'_, D>, piece: &Piece<D>, sample: &Sample<D>) -> f64 {
    let eta = problem.materials[sample.region as usize].diffusivity.at(&piece.element.at);
    match piece.condition {
        Condition::Dirichlet(_) => eta * dot(&sample.gradient, &piece.element.normal),
        Condition::Neumann(slope) => eta * slope,
        Condition::Flux(flux) => flux,
        Condition::Robin { a, b, g } => (g - a * sample.value) / b,
    }
}

/// The pieces of all faces, with normals out of the domain.
fn boundary_pieces<const D: usize>(
    problem: &Problem<'_, D>,
    boundary: &Boundary<D>,
    spacing: f64,
    size: f64,
) -> Vec<Piece<D>> {
    let domain = problem.domain;
    let (bounds, step) = (domain.bounds(), BESIDE * spacing);
    let mut faces: Vec<(FaceId, Vec<Element<D>>)> = Vec::new();
    if let Some(outer) = domain.outer_box() {
        let sides = (0..2 * D).map(|k| (FaceId(k as u16), side_elements(&outer, k / 2, k % 2 == 1, size)));
        faces.extend(sides);
    }
    faces.extend(
        domain.curved_faces().into_iter().map(|(face, shape, _)| (face, shape.elements(&bounds, size))),
    );
    let mut pieces = Vec::new();
    for (face, elements) in faces {
        for element in elements {
            let inside = [-step, step].map(|t| domain.contains(&beside(&element, t), 0.0));
            let out = match inside {
                [true, false] => 1.0,
                [false, true] => -1.0,
                _ => continue,
            };
            let element = Element { normal: element.normal.map(|n| out * n), ..element };
            // What is on the inner side, and which condition.
            let what = |x: &[f64; D]| {
                let within: [f64; D] = std::array::from_fn(|k| x[k] - step * element.normal[k]);
                (problem.regions.label(&within, 0.0), boundary.entry_at(face, x).map(|(entry, _)| entry))
            };
            for element in divided(&element, &what) {
                if let Some((entry, condition)) = boundary.entry_at(face, &element.at) {
                    pieces.push(Piece { element, entry, condition });
                }
            }
        }
    }
    pieces
}

/// A piece of a curve in two where something else begins on it; in space it stays whole.
fn divided<const D: usize, T: PartialEq>(
    element: &Element<D>,
    what: &dyn Fn(&[f64; D]) -> T,
) -> Vec<Element<D>> {
    let mut along = [0.0; D];
    if D == 2 {
        (along[0], along[1]) = (-element.normal[1], element.normal[0]);
    }
    let at = |t: f64| std::array::from_fn(|k| element.at[k] + t * along[k]);
    let half = 0.5 * element.area;
    let first = what(&at(-half));
    if D != 2 || first == what(&at(half)) {
        return vec![*element];
    }
    let (mut low, mut high) = (-half, half);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if what(&at(middle)) == first { &mut low } else { &mut high }) = middle;
    }
    let part = |from: f64, to: f64| Element { at: at(0.5 * (from + to)), area: to - from, ..*element };
    let change = 0.5 * (low + high);
    vec![part(-half, change), part(change, half)]
}

/// The pieces of all interfaces, with normals from the region named first to the other.
fn seams<const D: usize>(problem: &Problem<'_, D>, spacing: f64, size: f64) -> Vec<Seam<D>> {
    let (bounds, step) = (problem.domain.bounds(), BESIDE * spacing);
    let mut seams = Vec::new();
    for surface in 0..problem.regions.len() as u16 - 1 {
        let Some(shape) = problem.regions.shape(surface) else { continue };
        for element in shape.elements(&bounds, size) {
            let places = [-step, step].map(|t| beside(&element, t));
            if !places.iter().all(|x| problem.domain.contains(x, 0.0)) {
                continue;
            }
            let sides = [0, 1].map(|k| problem.regions.label(&places[k], 0.0));
            // Where two shapes have a surface in common it is that of the one named first.
            if sides[0] == sides[1] || sides[0].min(sides[1]) != surface {
                continue;
            }
            let turn = if sides[0] < sides[1] { 1.0 } else { -1.0 };
            let eta = [0, 1].map(|k| problem.materials[sides[k] as usize].diffusivity.at(&places[k]));
            let from = places[usize::from(eta[1] < eta[0])];
            let between = [sides[0].min(sides[1]), sides[0].max(sides[1])];
            seams.push(Seam {
                element: Element { normal: element.normal.map(|n| turn * n), ..element },
                between,
                from,
            });
        }
    }
    seams
}

fn beside<const D: usize>(element: &Element<D>, t: f64) -> [f64; D] {
    std::array::from_fn(|k| element.at[k] + t * element.normal[k])
}

/// Values and gradients of the solution at points.
pub(super) fn samples<const D: usize>(
    plan: &Plan,
    solved: &Solved<D>,
    places: &[[f64; D]],
) -> Result<Vec<Option<Sample<D>>>, Error> {
    let problem = solved.discrete.problem();
    if let Some(samples) = plan.method.params.build().samples(&problem, &solved.system, places)? {
        return Ok(samples);
    }
    let sampler = Sampler::new(&problem, &solved.system.u)?;
    let mut scratch = sampler.scratch();
    Ok(places.iter().map(|at| sampler.at(at, &mut scratch)).collect())
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
