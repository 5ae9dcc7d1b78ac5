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

/// Value and derivatives along the slit, by differences over five points: shorter ones next to a tip, one-sided ones at other ends.
/// Those over three left 1e-7 of the gradient beside a one-sided end, where u has the singular function of a tip far away.
fn derivatives<const D: usize>(field: &Field<D>, slit: &Slit<D>, at: &SlitPoint<D>, step: f64) -> [f64; 3] {
    let value = field.at(&at.point);
    if field.as_constant().is_some() {
        return [value, 0.0, 0.0];
    }
    let to_tip = |end: usize, distance: f64| if slit.tips()[end] { distance } else { f64::INFINITY };
    let room = to_tip(0, at.along).min(to_tip(1, slit.length() - at.along));
    let h = step.min(0.25 * room).min(0.125 * slit.length());
    let middle = at.along.clamp(2.0 * h, slit.length() - 2.0 * h);
    let value_at = |k: f64| {
        let along = (middle + k * h).clamp(0.0, slit.length());
        slit.at(along).map(|p| field.at(&p.point))
    };
    let [Some(a), Some(b), Some(c), Some(d), Some(e)] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(value_at) else {
        return [value, 0.0, 0.0];
    };
    if h <= 0.0 {
        return [value, 0.0, 0.0];
    }
    // Derivatives in steps of the polynomial through the five, at their middle, and from there at the point itself.
    let first = (a - 8.0 * b + 8.0 * d - e) / 12.0;
    let second = (16.0 * (b + d) - 30.0 * c - a - e) / 12.0;
    let (third, fourth) = (0.5 * (e - 2.0 * d + 2.0 * b - a), a - 4.0 * (b + d) + 6.0 * c + e);
    let x = (at.along - middle) / h;
    let slope = first + x * (second + x * (0.5 * third + x * fourth / 6.0));
    [value, slope / h, (second + x * (third + 0.5 * x * fourth)) / (h * h)]
}
