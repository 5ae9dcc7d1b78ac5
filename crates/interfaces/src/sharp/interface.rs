//! Points on the interfaces, with everything that the conditions and the equation need there.

use meshless_neighbors::CellList;

use super::connected::ConnectedParts;
use super::corner::Corner;
use crate::parallel;
use crate::{Field, InterfaceJump, MethodError, Problem};

/// Least distance between two points of an interface, in spacings of the cloud. Candidates lie densely, so that gaps are
/// at most twice as long; distances of 0.3 to 1.2 serve as well, 2.5 is too far.
const SEPARATION: f64 = 0.6;

/// How far from an interface a node may be to be projected onto it, in spacings.
const BAND: f64 = 1.5;

/// How far outside of the domain a point may be, over the domain's diameter: rounding.
const ON_BOUNDARY: f64 = 1e-9;

/// Step of difference quotients where no derivative is given, over the spacing.
const GRADIENT_STEP: f64 = 1e-4;

/// Nodes that are asked which connected part of a region they belong to.
const NODES_ASKED: [usize; 2] = [12, 96];

/// What holds on one side of a point of an interface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side<const D: usize> {
    /// Connected part of a region.
    pub(super) part: u32,
    /// Diffusivity.
    pub(super) eta: f64,
    /// Gradient of its logarithm.
    pub(super) slope: [f64; D],
    /// Source.
    pub(super) source: f64,
}

/// A point of an interface.
#[derive(Debug, Clone, Copy)]
pub(super) struct InterfacePoint<const D: usize> {
    /// Unit normal, from the first side to the second.
    pub(super) normal: [f64; D],
    /// Both sides.
    pub(super) sides: [Side<D>; 2],
    /// `u_1 - u_0`.
    pub(super) value: f64,
    /// `(eta du/dn)_1 - (eta du/dn)_0`.
    pub(super) flux: f64,
    /// How fast both change with time.
    pub(super) rates: [f64; 2],
}

impl<const D: usize> InterfacePoint<D> {
    /// The larger diffusivity.
    pub(super) fn largest(&self) -> f64 {
        self.sides[0].eta.max(self.sides[1].eta)
    }

    /// The smaller diffusivity.
    pub(super) fn smallest(&self) -> f64 {
        self.sides[0].eta.min(self.sides[1].eta)
    }
}

/// All interfaces.
#[derive(Debug, Default)]
pub(super) struct InterfacePoints<const D: usize> {
    /// Where the points are.
    pub(super) places: Vec<[f64; D]>,
    /// What holds there, in the same order.
    pub(super) points: Vec<InterfacePoint<D>>,
}

/// A place on the interface between two labels, the lower one first.
#[derive(Clone, Copy)]
struct Candidate<const D: usize> {
    at: [f64; D],
    normal: [f64; D],
    labels: [u16; 2],
    spacing: f64,
}

impl<const D: usize> InterfacePoints<D> {
    /// Projects the nodes near interfaces onto them, thins what results, and evaluates the data there.
    pub(super) fn sample(
        problem: &Problem<'_, D>,
        parts: &ConnectedParts,
        nodes: &CellList<'_, D>,
    ) -> Result<Self, MethodError> {
        let tolerance = ON_BOUNDARY * problem.domain.bounds().diameter();
        let candidates: Vec<Candidate<D>> =
            parallel::collect(problem.cloud.len(), |i, all| all.extend(candidates_of(problem, i, tolerance)));
        let kept = thin(&candidates)?;
        let candidates: Vec<Candidate<D>> =
            parallel::collect(kept.len(), |k, all| beside_corners(problem, candidates[kept[k]], all));
        let found = parallel::try_map_with(candidates.len(), Vec::new, |found, k| {
            let candidate = &candidates[k];
            Ok::<_, MethodError>(
                point(problem, parts, nodes, candidate, found)?.map(|point| (point, candidate.at)),
            )
        })?;
        let (points, places) = found.into_iter().flatten().unzip();
        Ok(Self { places, points })
    }
}

/// The feet of node i on the interfaces beside it.
fn candidates_of<const D: usize>(problem: &Problem<'_, D>, i: usize, tolerance: f64) -> Vec<Candidate<D>> {
    let own = problem.labels[i];
    let mut beyond: Vec<u16> = Vec::new();
    for &j in problem.supports.lists.of(i) {
        let label = problem.labels[j as usize];
        if label != own && !beyond.contains(&label) {
            beyond.push(label);
        }
    }
    let (x, spacing) = (&problem.cloud.points()[i], problem.cloud.spacing()[i]);
    let foot = |other: u16| {
        let labels = [own.min(other), own.max(other)];
        let foot =
            problem.regions.project_within(problem.domain, labels[0], labels[1], x, BAND * spacing).ok()?;
        let inside = problem.domain.contains(&foot.point, tolerance);
        inside.then_some(Candidate { at: foot.point, normal: foot.normal, labels, spacing })
    };
    beyond.into_iter().filter_map(foot).collect()
}

/// Keeps, in the order of the nodes, every candidate that is not close to one of the same interface kept before.
fn thin<const D: usize>(candidates: &[Candidate<D>]) -> Result<Vec<usize>, MethodError> {
    let places: Vec<[f64; D]> = candidates.iter().map(|c| c.at).collect();
    let widest = candidates.iter().fold(0.0_f64, |w, c| w.max(c.spacing));
    let index = CellList::new(&places, SEPARATION * widest)?;
    let mut passed = vec![false; candidates.len()];
    let (mut kept, mut near) = (Vec::new(), Vec::new());
    for (k, candidate) in candidates.iter().enumerate() {
        if passed[k] {
            continue;
        }
        kept.push(k);
        near.clear();
        index.within(&candidate.at, SEPARATION * candidate.spacing, &mut near);
        near.iter()
            .filter(|&&j| candidates[j as usize].labels == candidate.labels)
            .for_each(|&j| passed[j as usize] = true);
    }
    Ok(kept)
}

/// A candidate, or where the flux jumps in a corner a place on each of the pieces that meet there in its place.
fn beside_corners<const D: usize>(
    problem: &Problem<'_, D>,
    candidate: Candidate<D>,
    all: &mut Vec<Candidate<D>>,
) {
    let Candidate { at, normal, labels, spacing } = candidate;
    let jump = problem.jump_between(labels[0], labels[1]);
    let pieces = match jump.and_then(|(jump, _)| jump.flux.as_ref()) {
        Some(_) => Corner { problem, labels, at, normal, spacing }.pieces(),
        None => Vec::new(),
    };
    if pieces.is_empty() {
        all.push(candidate);
    }
    all.extend(pieces.into_iter().map(|(at, normal)| Candidate { at, normal, labels, spacing }));
}

/// What holds at a candidate; `None` where no node of one of its regions is near.
fn point<const D: usize>(
    problem: &Problem<'_, D>,
    parts: &ConnectedParts,
    nodes: &CellList<'_, D>,
    candidate: &Candidate<D>,
    found: &mut Vec<(f64, u32)>,
) -> Result<Option<InterfacePoint<D>>, MethodError> {
    let Candidate { at, normal, labels, spacing } = candidate;
    let mut part_of = |label: u16| {
        NODES_ASKED.iter().find_map(|&count| {
            let of_label = |&j: &u32| problem.labels[j as usize] == label;
            nodes.nearest(at, count, found).find(of_label).map(|j| parts.of_node[j as usize])
        })
    };
    let (Some(first), Some(second)) = (part_of(labels[0]), part_of(labels[1])) else { return Ok(None) };
    let side = |part: u32, label: u16| {
        let material = &problem.materials[label as usize];
        let eta = material.diffusivity.at(at);
        if !(eta > 0.0 && eta.is_finite()) {
            let what = format!(
                "the diffusivity is {eta} at the interface point {at:?}; it must be positive and finite up to the interface"
            );
            return Err(MethodError::InvalidProblem { what });
        }
        let slope = material.diffusivity.gradient(at, GRADIENT_STEP * spacing).map(|g| g / eta);
        let source = material.source.as_ref().map_or(0.0, |f| f.at(at));
        finite(source, "source", at)?;
        Ok(Side { part, eta, slope, source })
    };
    let sides = [side(first, labels[0])?, side(second, labels[1])?];
    let [value, flux] = jumps(problem.jump_between(labels[0], labels[1]), at);
    finite(value, "jump of u", at)?;
    finite(flux, "jump of the flux", at)?;
    let rates = jumps(problem.jump_rate_between(labels[0], labels[1]), at);
    finite(rates[0], "rate of the jump of u", at)?;
    finite(rates[1], "rate of the jump of the flux", at)?;
    Ok(Some(InterfacePoint { normal: *normal, sides, value, flux, rates }))
}

/// The jump of u and that of its flux. The normal of the scene's entry may point the other way: then u jumps by the opposite,
/// and the flux, whose sign turns with the normal as well as with the order of the sides, by the same.
fn jumps<const D: usize>(jump: Option<(&InterfaceJump<D>, f64)>, at: &[f64; D]) -> [f64; 2] {
    let Some((jump, sign)) = jump else { return [0.0; 2] };
    let given = |field: Option<&Field<D>>| field.map_or(0.0, |f| f.at(at));
    [sign * given(jump.value.as_ref()), given(jump.flux.as_ref())]
}

fn finite<const D: usize>(value: f64, what: &str, at: &[f64; D]) -> Result<(), MethodError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(MethodError::InvalidProblem { what: format!("the {what} is {value} at the interface point {at:?}") })
}
