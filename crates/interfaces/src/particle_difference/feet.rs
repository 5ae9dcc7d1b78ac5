//! Where the interfaces are, as the nodes near them see it.

use meshless_geometry::Projection;

use crate::Problem;
use crate::parallel;

/// How far a foot is looked for, in units of the interaction radius: an interface that passes between a node and its
/// neighbour is nearer than the neighbour, which may be as far as the larger of both radii.
const REACH: f64 = 2.0;

/// The interface between the region of a node and another one, from the node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot<const D: usize> {
    /// The region beyond.
    pub(super) beyond: u16,
    /// The nearest point of the interface, the unit normal there towards the region beyond, and the distance of the
    /// node, which is negative if the node is on this side.
    pub(super) at: Projection<D>,
}

/// The feet of all nodes that have a neighbour in another region, one for each such region.
#[derive(Debug)]
pub(super) struct Feet<const D: usize> {
    feet: Vec<Option<Vec<Foot<D>>>>,
}

impl<const D: usize> Feet<D> {
    /// Projects the nodes near interfaces at which something jumps.
    pub(super) fn new(problem: &Problem<'_, D>) -> Self {
        let feet = parallel::map(problem.cloud.len(), |i| feet_of(problem, i));
        Self { feet }
    }

    /// The feet of node i.
    pub(super) fn of(&self, i: usize) -> &[Foot<D>] {
        self.feet[i].as_deref().unwrap_or_default()
    }

    /// Whether the support of node i touches an interface at which something may jump.
    pub(super) fn is_near(&self, i: usize) -> bool {
        self.feet[i].is_some()
    }

    /// The foot of node i on the interface with a region.
    pub(super) fn towards(&self, i: usize, beyond: u16) -> Option<&Foot<D>> {
        self.of(i).iter().find(|foot| foot.beyond == beyond)
    }
}

/// The nearest first; `None` where no interface is near.
fn feet_of<const D: usize>(problem: &Problem<'_, D>, i: usize) -> Option<Vec<Foot<D>>> {
    let own = problem.labels[i];
    let mut regions: Vec<u16> = Vec::new();
    for &j in problem.supports.lists.of(i) {
        let label = problem.labels[j as usize];
        if label != own && !regions.contains(&label) && may_jump(problem, own, label) {
            regions.push(label);
        }
    }
    if regions.is_empty() {
        return None;
    }
    let (x, radius) = (&problem.cloud.points()[i], problem.supports.radius[i]);
    let mut feet: Vec<Foot<D>> = regions
        .into_iter()
        .filter_map(|beyond| {
            let at = problem.regions.project_within(problem.domain, own, beyond, x, REACH * radius).ok()?;
            Some(Foot { beyond, at })
        })
        .collect();
    feet.sort_by(|a, b| a.at.distance.abs().total_cmp(&b.at.distance.abs()).then(a.beyond.cmp(&b.beyond)));
    Some(feet)
}

/// Whether u is other than smooth at the interface of two regions: not where both have the same constant diffusivity
/// and nothing is prescribed.
pub(super) fn may_jump<const D: usize>(problem: &Problem<'_, D>, a: u16, b: u16) -> bool {
    let eta = |label: u16| problem.materials[label as usize].diffusivity.as_constant();
    let same = matches!((eta(a), eta(b)), (Some(a), Some(b)) if a == b);
    !same || problem.law_between(a, b).is_some()
}
