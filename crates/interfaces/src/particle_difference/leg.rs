//! An interface near a node, with everything that the conditions across it need.

use crate::InterfaceLaw;
use crate::particle_difference::feet::Foot;
use crate::particle_difference::frame::Frame;
use crate::particle_difference::{ParticleDifferenceParams, Wedge};
use crate::{MethodError, Problem};

/// Step of difference quotients where no derivative is given, over the spacing: their error is about 1e-8 of the
/// variation over a spacing, and rounding leaves four digits more than that.
pub(super) const GRADIENT_STEP: f64 = 1e-4;

/// The same for second differences, which lose twice as many digits.
const SECOND_STEP: f64 = 1e-2;

/// Largest curvature of an interface that is resolved, in units of the inverse of the interaction radius; what is more
/// than that is a corner that a difference quotient has met.
const RESOLVED_CURVATURE: f64 = 2.0;

/// Distance from the interface, over the step, up to which the end of a step counts as on it: curvature takes a step
/// off it by far less, a corner by more.
const ON_INTERFACE: f64 = 0.05;

/// An interface within the support of a node, with the condition across it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg<'a, const D: usize> {
    pub(super) foot: Foot<D>,
    /// Diffusivity on this side over that beyond, at the foot.
    pub(super) ratio: f64,
    /// Diffusivity beyond, at the foot.
    pub(super) eta_beyond: f64,
    /// The jump of the second derivative across.
    pub(super) bend: Bend<D>,
    /// What is prescribed, and the sign of its value from this side.
    jump: Option<(&'a InterfaceLaw<D>, f64)>,
    /// Step of difference quotients.
    step: f64,
}

/// `[d2u/dn2] = given + by_gradient . grad u`, the gradient that of this side at the foot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend<const D: usize> {
    pub(super) given: f64,
    pub(super) by_gradient: [f64; D],
}

impl<'a, const D: usize> Leg<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        i: usize,
        foot: Foot<D>,
        wedge: Wedge,
    ) -> Result<Self, MethodError> {
        let own = problem.labels[i];
        let eta = [own, foot.beyond].map(|l| problem.materials[l as usize].diffusivity.at(&foot.at.point));
        if let Some(bad) = eta.into_iter().find(|eta| !(*eta > 0.0 && eta.is_finite())) {
            let what = format!(
                "the diffusivity is {bad} at the interface point {:?}; it must be positive and finite up to the \
                 interface",
                foot.at.point
            );
            return Err(MethodError::InvalidProblem { what });
        }
        let jump = problem.law_between(own, foot.beyond);
        let step = GRADIENT_STEP * problem.cloud.spacing()[i];
        let bend = Bend { given: 0.0, by_gradient: [0.0; D] };
        let mut leg = Self { foot, ratio: eta[0] / eta[1], eta_beyond: eta[1], bend, jump, step };
        if wedge == Wedge::Quadratic {
            leg.bend = leg.bend(problem, i, eta);
        }
        Ok(leg)
    }

    /// The equation on both sides of the foot, subtracted.
    ///
    /// There `lap u = u_nn + H u_n + lap_s u` with H the divergence of the normal and `lap_s` along the interface. With
    /// `eta lap u + grad eta . grad u = -f` on both sides, and u on the side beyond with the slope `u_n + J` and the
    /// value `u + a`, subtraction leaves `[u_nn]` in terms of what is given, of grad u and of
    /// `J = g/eta_O + (eta_S/eta_O - 1) u_n`.
    fn bend(&self, problem: &Problem<'a, D>, i: usize, eta: [f64; 2]) -> Bend<D> {
        let Foot { beyond, at } = &self.foot;
        let sides = [problem.labels[i], *beyond].map(|l| &problem.materials[l as usize]);
        let load = |side: usize| sides[side].source.as_ref().map_or(0.0, |f| f.at(&at.point)) / eta[side];
        let drift =
            |side: usize| sides[side].diffusivity.gradient(&at.point, self.step).map(|d| d / eta[side]);
        let (drift_own, drift_beyond) = (drift(0), drift(1));
        let across = (0..D).map(|k| drift_beyond[k] * at.normal[k]).sum::<f64>() + self.curvature(problem, i);
        let slope = across * (self.ratio - 1.0);
        let given = load(0) - load(1) - across * self.flux_at_foot() / self.eta_beyond;
        Bend {
            given: given - self.value_bend(problem, &drift_beyond),
            by_gradient: std::array::from_fn(|k| drift_own[k] - drift_beyond[k] - slope * at.normal[k]),
        }
    }

    /// The divergence of the normal at the foot.
    fn curvature(&self, problem: &Problem<'a, D>, i: usize) -> f64 {
        let (own, Foot { beyond, at }) = (problem.labels[i], &self.foot);
        let Some(shape) = problem.regions.shape(own.min(*beyond)) else { return 0.0 };
        let sign = if own < *beyond { 1.0 } else { -1.0 };
        let normal = |tangent: &[f64; D], t: f64| {
            let gradient = shape.gradient(&std::array::from_fn(|k| at.point[k] + t * tangent[k]));
            let length = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
            gradient.map(|g| sign * g / length)
        };
        let sum: f64 = tangents(&at.normal)
            .map(|tangent| {
                let (before, after) = (normal(&tangent, -self.step), normal(&tangent, self.step));
                (0..D).map(|k| (after[k] - before[k]) * tangent[k]).sum::<f64>() / (2.0 * self.step)
            })
            .sum();
        let resolved = sum.is_finite() && sum.abs() * problem.supports.radius[i] <= RESOLVED_CURVATURE;
        if resolved { sum } else { 0.0 }
    }

    /// `lap_s a + (grad eta_O / eta_O) . grad_s a` of the jump a of the value.
    fn value_bend(&self, problem: &Problem<'a, D>, drift: &[f64; D]) -> f64 {
        let at = &self.foot.at;
        let Some((InterfaceLaw { value: Some(value), between, .. }, sign)) = self.jump else { return 0.0 };
        if value.as_constant().is_some() {
            return 0.0;
        }
        let step = self.step * SECOND_STEP / GRADIENT_STEP;
        let there = |tangent: &[f64; D], t: f64| {
            let x = std::array::from_fn(|k| at.point[k] + t * tangent[k]);
            let foot = problem.regions.project_within(problem.domain, between[0], between[1], &x, step);
            value.at(&foot.map_or(x, |foot| foot.point))
        };
        let middle = value.at(&at.point);
        let sum: f64 = tangents(&at.normal)
            .map(|tangent| {
                let (before, after) = (there(&tangent, -step), there(&tangent, step));
                let along: f64 = (0..D).map(|k| drift[k] * tangent[k]).sum();
                (after - 2.0 * middle + before) / (step * step) + along * (after - before) / (2.0 * step)
            })
            .sum();
        sign * sum
    }

    /// The weight of values beyond a stiff side: in units of the flux rather than of u. A slope on this side makes one
    /// `ratio` times as large beyond, and the fit would rather bend the polynomial of this side than miss the third
    /// derivatives beyond.
    pub(super) fn weight(&self, params: &ParticleDifferenceParams) -> f64 {
        if params.flux_weights { (1.0 / self.ratio).min(1.0) } else { 1.0 }
    }

    /// The jump of the flux at a point of the interface.
    pub(super) fn flux_at(&self, point: &[f64; D]) -> f64 {
        self.jump.and_then(|(jump, _)| jump.flux.as_ref()).map_or(0.0, |flux| flux.at(point))
    }

    /// The jump of the flux at the foot.
    pub(super) fn flux_at_foot(&self) -> f64 {
        self.flux_at(&self.foot.at.point)
    }

    /// The jump of the flux at a point of the tangent plane, continued from the foot: from the side of it that is on
    /// the interface where the foot is in a corner.
    pub(super) fn flux_beside(&self, problem: &Problem<'a, D>, i: usize, offset: &[f64; D]) -> f64 {
        let middle = self.flux_at_foot();
        let length = offset.iter().map(|o| o * o).sum::<f64>().sqrt();
        let Some(shape) = problem.regions.shape(problem.labels[i].min(self.foot.beyond)) else {
            return middle;
        };
        let (mut ends, mut found) = ([(0.0, middle); 2], 0);
        for (end, step) in ends.iter_mut().zip([-self.step, self.step]) {
            let x = std::array::from_fn(|k| self.foot.at.point[k] + step * offset[k] / length);
            let gradient = shape.gradient(&x).iter().map(|g| g * g).sum::<f64>().sqrt();
            if shape.level(&x).abs() <= ON_INTERFACE * self.step * gradient {
                *end = (step, self.flux_at(&x));
                found += 1;
            }
        }
        let [(t0, before), (t1, after)] = ends;
        if length > 0.0 && found > 0 { middle + length * (after - before) / (t1 - t0) } else { middle }
    }

    /// By how much u is larger beyond, at a point of the interface.
    pub(super) fn value_at(&self, point: &[f64; D]) -> f64 {
        match self.jump {
            Some((InterfaceLaw { value: Some(value), .. }, sign)) => sign * value.at(point),
            _ => 0.0,
        }
    }
}

/// An orthonormal basis of the tangent plane.
fn tangents<const D: usize>(normal: &[f64; D]) -> impl Iterator<Item = [f64; D]> {
    let frame = Frame::new(normal);
    (1..D).map(move |axis| frame.turn(&std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 })))
}
