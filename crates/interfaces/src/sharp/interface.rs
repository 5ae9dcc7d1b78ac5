//! Points on the interfaces, with everything that the conditions and the equation need there.

use meshless_neighbors::CellList;

use super::connected::ConnectedParts;
use super::corner::Corner;
use super::operator::Operator;
use crate::equation::Contact;
use crate::parallel;
use crate::{InterfaceLaw, MethodError, Problem};

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
    /// The equation beside the source.
    pub(super) operator: Operator<D>,
    /// Source.
    pub(super) source: f64,
    /// The factor of du/dt.
    pub(super) capacity: f64,
    /// The derivative of its logarithm along the normal.
    pub(super) capacity_slope: f64,
}

/// A point of an interface.
#[derive(Debug, Clone, Copy)]
pub(super) struct InterfacePoint<const D: usize> {
    /// Unit normal, from the first side to the second.
    pub(super) normal: [f64; D],
    /// Both sides.
    pub(super) sides: [Side<D>; 2],
    /// What holds between them, from the first side to the second.
    pub(super) law: Contact,
    /// How fast the value and the flux of it change with time.
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
    let jump = problem.law_between(labels[0], labels[1]);
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
        let step = GRADIENT_STEP * spacing;
        let operator = Operator::of(material, eta, at, step);
        finite(operator.drift.iter().sum::<f64>() + operator.decay, "velocity or the reaction", at)?;
        let source = material.source.as_ref().map_or(0.0, |f| f.at(at));
        finite(source, "source", at)?;
        let (capacity, capacity_slope) = match &material.capacity {
            None => (1.0, 0.0),
            Some(field) => {
                let (value, slope) = (field.at(at), field.gradient(at, step));
                (value, (0..D).map(|k| slope[k] * normal[k]).sum::<f64>() / value)
            }
        };
        finite(capacity + capacity_slope, "capacity", at)?;
        Ok(Side { part, eta, operator, source, capacity, capacity_slope })
    };
    let sides = [side(first, labels[0])?, side(second, labels[1])?];
    let law = law_at(problem.law_between(labels[0], labels[1]), at);
    finite(law.value, "jump of u", at)?;
    finite(law.flux, "jump of the flux", at)?;
    finite(law.resistance, "resistance", at)?;
    if law.resistance < 0.0 {
        let what = format!(
            "the resistance is {} at the interface point {at:?}; it must not be negative",
            law.resistance
        );
        return Err(MethodError::InvalidProblem { what });
    }
    let rates = law_at(problem.law_rate_between(labels[0], labels[1]), at);
    let rates = [rates.value, rates.flux];
    finite(rates[0], "rate of the jump of u", at)?;
    finite(rates[1], "rate of the jump of the flux", at)?;
    Ok(Some(InterfacePoint { normal: *normal, sides, law, rates }))
}

/// The law of an interface at a point, if it has one.
fn law_at<const D: usize>(law: Option<(&InterfaceLaw<D>, f64)>, at: &[f64; D]) -> Contact {
    law.map_or(Contact::PERFECT, |(law, sign)| law.at(sign, at))
}

fn finite<const D: usize>(value: f64, what: &str, at: &[f64; D]) -> Result<(), MethodError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(MethodError::InvalidProblem { what: format!("the {what} is {value} at the interface point {at:?}") })
}
