//! What a value on the other side of a slit has more than the continuation from this side.

use meshless_geometry::{Slit, SlitPoint};

use super::tip::Singular;
use crate::particle_difference::leg::GRADIENT_STEP;
use crate::{Field, Problem, SlitCondition};

/// Step of differences of the jump along the slit, over the spacing: second differences lose twice as many digits as
/// first ones.
const STEP: f64 = 1e-2;

/// A line of sight through a slit that couples its sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing<const D: usize> {
    /// The slit.
    pub(super) slit: usize,
    /// Where the jump is taken.
    pub(super) at: SlitPoint<D>,
    /// 1 where the neighbour is on the left, -1 where on the right.
    pub(super) towards: f64,
    /// Distance of the neighbour from the line of the slit.
    pub(super) distance: f64,
    /// How far along the slit the neighbour is from `at`.
    pub(super) offset: f64,
    /// Whether that is less than the distance from the tips, so that derivatives along the slit mean something.
    pub(super) is_regular: bool,
}

/// The diffusivity at a point of a slit and its logarithmic derivatives across and along it.
#[derive(Debug, Clone, Copy)]
struct Eta {
    value: f64,
    across: f64,
    along: f64,
}

impl<const D: usize> Crossing<D> {
    /// With the jump `J = u_left - u_right` and `J_n = g/eta` along the slit, the equation on both sides, subtracted,
    /// gives `J_nn = -J_ss - (d_n eta J_n + d_s eta J_s)/eta` where the source does not jump: up to the third order in
    /// the distance y from the slit `J(y) = J + y J_n + y^2/2 J_nn`, and likewise along it.
    fn continued(&self, eta: &Eta, [value, slope, bend, across, change]: [f64; 5]) -> f64 {
        let second = -bend - eta.across * across - eta.along * slope;
        let (d, t) = (self.distance, self.offset);
        let (along, twist) = if self.is_regular { (0.5 * t * t * bend, t * change) } else { (0.0, 0.0) };
        self.towards * (value + t * slope + along + 0.5 * d * d * second) + d * (across + twist)
    }

    fn eta(&self, problem: &Problem<'_, D>, i: usize) -> Eta {
        let field = &problem.materials[problem.labels[i] as usize].diffusivity;
        let value = field.at(&self.at.point);
        let gradient = field.gradient(&self.at.point, GRADIENT_STEP * problem.cloud.spacing()[i]);
        let along = |v: &[f64; D]| (0..D).map(|k| gradient[k] * v[k]).sum::<f64>() / value;
        Eta { value, across: along(&self.at.normal), along: along(&self.at.tangent) }
    }

    /// Of u, as the condition says; zero where it says nothing.
    pub(super) fn of_solution(&self, problem: &Problem<'_, D>, i: usize) -> f64 {
        let interface = &problem.slits[self.slit];
        let SlitCondition::Jump { value, flux } = &interface.condition else { return 0.0 };
        let eta = self.eta(problem, i);
        let along = |field: &Option<Field<D>>| {
            let step = STEP * problem.cloud.spacing()[i];
            field.as_ref().map_or([0.0; 3], |field| derivatives(field, &interface.slit, &self.at, step))
        };
        let ([a, slope, bend], [flux, change, _]) = (along(value), along(flux));
        // The flux over a conductivity that changes along the slit, too.
        let across = flux / eta.value;
        self.continued(&eta, [a, slope, bend, across, change / eta.value - eta.along * across])
    }

    /// Of a singular function of a tip of this slit: by the same formula, so that what the formula leaves out of u is
    /// left out of the function, too.
    pub(super) fn of_singular(
        &self,
        problem: &Problem<'_, D>,
        i: usize,
        function: Singular,
        end: usize,
    ) -> f64 {
        let jump = function.jump(&problem.slits[self.slit].slit, end, &self.at);
        self.continued(&self.eta(problem, i), jump)
    }
}

/// Value and derivatives along the slit, by differences: shorter ones next to a tip, one-sided ones at other ends.
fn derivatives<const D: usize>(field: &Field<D>, slit: &Slit<D>, at: &SlitPoint<D>, step: f64) -> [f64; 3] {
    let value = field.at(&at.point);
    if field.as_constant().is_some() {
        return [value, 0.0, 0.0];
    }
    let to_tip = |end: usize, distance: f64| if slit.tips()[end] { distance } else { f64::INFINITY };
    let room = to_tip(0, at.along).min(to_tip(1, slit.length() - at.along));
    let step = step.min(0.5 * room).min(0.25 * slit.length());
    let middle = at.along.clamp(step, slit.length() - step);
    let value_at = |along: f64| slit.at(along.clamp(0.0, slit.length())).map(|p| field.at(&p.point));
    match (value_at(middle - step), value_at(middle), value_at(middle + step)) {
        (Some(before), Some(centre), Some(after)) if step > 0.0 => {
            let bend = (after - 2.0 * centre + before) / (step * step);
            [value, (after - before) / (2.0 * step) + (at.along - middle) * bend, bend]
        }
        _ => [value, 0.0, 0.0],
    }
}
