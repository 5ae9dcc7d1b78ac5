//! What a node sees of its support.

use meshless_geometry::{Sight, SlitPoint};

use super::jump::Crossing;
use super::tip::Tip;
use crate::particle_difference::ParticleDifferenceParams;
use crate::particle_difference::feet::may_jump;
use crate::{MethodError, Problem, SlitCondition};

/// Distance of a crossing from a tip, relative to the length of the line of sight, below which the line is clear: the
/// jump may be singular there.
const AT_THE_TIP: f64 = 1e-3;

/// Where points of the slit that a condition is imposed at are from a tip at least, in spacings.
const FROM_THE_TIP: f64 = 0.1;

/// Distance of a node from the line of the slit, in spacings, below which it is ahead of a tip and sees both sides.
const AHEAD: f64 = 0.1;

/// The support of a node near slits.
#[derive(Debug, Clone, Default)]
pub(super) struct View<const D: usize> {
    /// Neighbours that take part.
    pub(super) kept: Vec<u32>,
    /// For each of them the slit in between, if there is one.
    pub(super) crossings: Vec<Option<Crossing<D>>>,
    /// Tips whose singular functions take part.
    pub(super) tips: Vec<Tip>,
    /// Points of slits at which the condition of a side holds: the slit, the point, and the side, 1 for the left.
    pub(super) conditions: Vec<(usize, SlitPoint<D>, f64)>,
    /// Whether a neighbour was hidden by a slit whose sides are not coupled.
    hides: bool,
}

impl<const D: usize> View<D> {
    /// Whether no slit changes anything here.
    pub(super) fn is_plain(&self) -> bool {
        !self.hides
            && self.tips.is_empty()
            && self.conditions.is_empty()
            && self.crossings.iter().all(Option::is_none)
    }

    /// Looks at the neighbours of node i.
    pub(super) fn look(
        &mut self,
        problem: &Problem<'_, D>,
        params: &ParticleDifferenceParams,
        i: usize,
        neighbors: &[u32],
    ) -> Result<(), MethodError> {
        self.kept.clear();
        self.crossings.clear();
        self.tips.clear();
        self.conditions.clear();
        self.hides = false;
        if params.enrichment {
            self.enrich(problem, i);
        }
        for &j in neighbors {
            match self.towards(problem, params, i, j as usize) {
                Seen::Clear => self.keep(j, None),
                Seen::Across(crossing) => self.keep(j, Some(crossing)),
                Seen::Hidden => self.hides = true,
            }
        }
        if self.hides {
            (0..problem.slits.len()).for_each(|slit| self.impose(problem, params.degree, i, slit));
        }
        if self.is_plain() {
            return Ok(());
        }
        let own = problem.labels[i];
        match self.kept.iter().find(|&&j| {
            may_jump(problem, own, problem.labels[j as usize]) && problem.labels[j as usize] != own
        }) {
            None => Ok(()),
            Some(_) => {
                let what = format!(
                    "node {i} at {:?} is near both a slit and an interface at which something jumps; a slit must keep \
                     its distance from interfaces: about three spacings",
                    problem.cloud.points()[i]
                );
                Err(MethodError::InvalidProblem { what })
            }
        }
    }

    fn keep(&mut self, j: u32, crossing: Option<Crossing<D>>) {
        self.kept.push(j);
        self.crossings.push(crossing);
    }

    /// The tips near node i whose singular functions are continuous but at their own slit all over the support.
    fn enrich(&mut self, problem: &Problem<'_, D>, i: usize) {
        let (x, radius) = (&problem.cloud.points()[i], problem.supports.radius[i]);
        for (slit, interface) in problem.slits.iter().enumerate() {
            let line = &interface.slit;
            let whole = line.vertices().len() == 2;
            for end in [0, 1].into_iter().filter(|&end| line.tips()[end]) {
                let [r, _] = line.polar(end, x);
                // The function jumps on the straight line that the last segment is part of.
                let ends = !whole || line.tips()[1 - end];
                let fits = !ends || r + radius <= line.end_segment(end);
                if r <= interface.enrichment && fits {
                    self.tips.push(Tip { slit, end });
                }
            }
        }
    }

    fn towards(
        &self,
        problem: &Problem<'_, D>,
        params: &ParticleDifferenceParams,
        i: usize,
        j: usize,
    ) -> Seen<D> {
        let (x, y) = (&problem.cloud.points()[i], &problem.cloud.points()[j]);
        let mut seen = Seen::Clear;
        for (slit, interface) in problem.slits.iter().enumerate() {
            let sight =
                if params.visibility { interface.slit.sight(x, y) } else { beyond(problem, slit, i, y) };
            let found = match (sight, &interface.condition) {
                (Sight::Clear, _) => continue,
                (Sight::Through { at, towards }, SlitCondition::Jump { .. }) => {
                    crossing(problem, params, slit, x, y, at, towards)
                }
                _ => Seen::Hidden,
            };
            seen = match (seen, found) {
                (seen, Seen::Clear) => seen,
                (Seen::Clear, found) => found,
                _ => Seen::Hidden,
            };
        }
        seen
    }

    /// Points at which the condition of this side of a slit is imposed: as many as determine a polynomial on it.
    fn impose(&mut self, problem: &Problem<'_, D>, degree: usize, i: usize, slit: usize) {
        let interface = &problem.slits[slit];
        let (line, h, x) = (&interface.slit, problem.cloud.spacing()[i], &problem.cloud.points()[i]);
        let foot = line.nearest(x);
        if foot.distance > problem.supports.radius[i] {
            return;
        }
        let beside: f64 = (0..D).map(|k| (x[k] - foot.at.point[k]) * foot.at.normal[k]).sum();
        if !foot.is_normal && beside.abs() < AHEAD * h {
            return;
        }
        let side = if beside >= -line.tolerance() { 1.0 } else { -1.0 };
        let points = match interface.condition.on_each_side(&foot.at.point) {
            None => return,
            Some([_, b, _]) => {
                if b == 0.0 {
                    degree + 1
                } else {
                    degree
                }
            }
        };
        let clearance = |end: usize| if line.tips()[end] { FROM_THE_TIP * h } else { 0.0 };
        let (low, high) = (clearance(0), line.length() - clearance(1));
        for k in 0..points {
            let along = foot.at.along.clamp(low, high.max(low)) + h * (k as f64 - 0.5 * (points - 1) as f64);
            if let Some(at) = line.at(along).filter(|_| along >= low && along <= high) {
                self.conditions.push((slit, at, side));
            }
        }
    }
}

enum Seen<const D: usize> {
    Clear,
    Across(Crossing<D>),
    Hidden,
}

/// Where the jump between two points is taken: at the foot of the farther one where that is normal to the slit, else
/// where the line of sight crosses it.
fn crossing<const D: usize>(
    problem: &Problem<'_, D>,
    params: &ParticleDifferenceParams,
    slit: usize,
    x: &[f64; D],
    y: &[f64; D],
    at: SlitPoint<D>,
    towards: f64,
) -> Seen<D> {
    let line = &problem.slits[slit].slit;
    let length = (0..D).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>().sqrt();
    let from_tip = |at: &SlitPoint<D>| {
        let first = if line.tips()[0] { at.along } else { f64::INFINITY };
        first.min(if line.tips()[1] { line.length() - at.along } else { f64::INFINITY })
    };
    if from_tip(&at) <= AT_THE_TIP * length {
        return Seen::Clear;
    }
    let foot = line.nearest(y);
    let at = if params.visibility && foot.is_normal && from_tip(&foot.at) > AT_THE_TIP * length {
        foot.at
    } else {
        at
    };
    let from: [f64; D] = std::array::from_fn(|k| y[k] - at.point[k]);
    let along = |v: &[f64; D]| (0..D).map(|k| from[k] * v[k]).sum::<f64>();
    Seen::Across(Crossing {
        slit,
        at,
        towards,
        distance: (towards * along(&at.normal)).max(0.0),
        offset: along(&at.tangent),
        is_regular: from_tip(&at) > along(&at.tangent).abs() + along(&at.normal).abs(),
    })
}

/// As the paper has it, without visibility: whoever is beyond the line of the slit at the foot of the node is across.
fn beyond<const D: usize>(problem: &Problem<'_, D>, slit: usize, i: usize, y: &[f64; D]) -> Sight<D> {
    let (line, x) = (&problem.slits[slit].slit, &problem.cloud.points()[i]);
    let foot = line.nearest(x);
    let side = |p: &[f64; D]| {
        let side: f64 = (0..D).map(|k| (p[k] - foot.at.point[k]) * foot.at.normal[k]).sum();
        side >= -line.tolerance()
    };
    if !foot.is_normal || side(x) == side(y) {
        return Sight::Clear;
    }
    Sight::Through { at: foot.at, towards: if side(y) { 1.0 } else { -1.0 } }
}
