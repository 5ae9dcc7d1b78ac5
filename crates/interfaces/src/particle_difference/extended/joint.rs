//! Jumps that follow from one fit for both sides, for where u changes with time.
//!
//! The flux condition for the fit of `u - d J` is `J = (r - 1) L(u - d J)`, r the ratio of the diffusivities and L a slope: where few
//! neighbours lie beyond the interface, `1 + (r - 1) L(d)` may vanish or have the wrong sign, and in time something grows.
//! A fit with the condition built in, that of [`ParticleDifference`](crate::particle_difference::ParticleDifference), has
//! no such factor.

use meshless_stencils::{StencilError, Weight};

use super::points::Point;
use super::rows::ExtendedRow;
use crate::local::enlarged_support;
use crate::particle_difference::ParticleDifferenceParams;
use crate::particle_difference::feet::Feet;
use crate::particle_difference::fit::{ConstrainedFit, ConstrainedScratch};
use crate::{MethodError, Problem};

/// Weights of these fits: the flatter, the less grows, and the larger the errors. With the quartic weight of the rows something grows
/// on 12 of 144 clouds, with this one on none (`docs/time.md`).
const WEIGHT: Weight = Weight::Gaussian { decay: 3.0 };

/// Makes the equations of the jumps.
pub(super) struct JointFit<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    feet: &'a Feet<D>,
    fit: ConstrainedFit<'a, D>,
}

impl<'a, const D: usize> JointFit<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        feet: &'a Feet<D>,
        params: ParticleDifferenceParams,
    ) -> Self {
        let params = ParticleDifferenceParams { weight: WEIGHT, ..params };
        Self { problem, feet, fit: ConstrainedFit::new(problem, feet, params) }
    }

    pub(super) fn scratch(&self) -> ConstrainedScratch<'a, D> {
        self.fit.scratch()
    }

    /// The flux condition at a point, divided by both conductivities: `[kappa] dq/dn + kappa_O J = g` with q and its slope on the
    /// softer side, where the jump is not a multiple of it.
    pub(super) fn row(
        &self,
        k: u32,
        point: &Point<D>,
        scratch: &mut ConstrainedScratch<'a, D>,
    ) -> Result<ExtendedRow, MethodError> {
        let problem = self.problem;
        let eta = point.between.map(|l| problem.materials[l as usize].diffusivity.at(&point.at));
        let node = self.nearest(point, usize::from(eta[1] < eta[0]));
        self.factored(node, scratch)?;
        let mut slope = Vec::new();
        self.fit
            .slope_at(&point.at, &point.normal, scratch, &mut slope)
            .map_err(|source: StencilError| MethodError::stencil(node, &point.at, source))?;
        let (h, sum) = (problem.cloud.spacing()[point.node], eta[0] + eta[1]);
        let factor = h * (eta[1] - eta[0]) / sum;
        let beyond = eta[usize::from(problem.labels[node] == point.between[0])];
        let sides = &scratch.sides;
        let given: f64 = slope.iter().zip(&sides.shifts).map(|(c, shift)| c * shift).sum();
        let [first, second] = point.between;
        let flux = problem.law_between(first, second).and_then(|(jump, _)| jump.flux.as_ref());
        let mut row = ExtendedRow { rhs: factor * given, ..ExtendedRow::default() };
        row.nodes.extend(sides.kept.iter().zip(&slope).map(|(&j, &c)| (j, factor * c)));
        row.nodes.push((node as u32, -factor * slope.iter().sum::<f64>()));
        row.rhs += h * flux.map_or(0.0, |g| g.at(&point.at)) / sum;
        row.jumps.push((k, h * beyond / sum));
        Ok(row)
    }

    /// The nearest node of a side that sees the interface.
    fn nearest(&self, point: &Point<D>, side: usize) -> usize {
        let (own, beyond) = (point.between[side], point.between[1 - side]);
        let apart = |j: usize| -> f64 {
            let x = &self.problem.cloud.points()[j];
            (0..D).map(|k| (x[k] - point.at[k]).powi(2)).sum()
        };
        let near = self.problem.supports.lists.of(point.node).iter().map(|&j| j as usize).chain([point.node]);
        near.filter(|&j| self.problem.labels[j] == own && self.feet.towards(j, beyond).is_some())
            .min_by(|&a, &b| apart(a).total_cmp(&apart(b)).then(a.cmp(&b)))
            .unwrap_or(point.node)
    }

    /// Factors the fit of a node, over an enlarged support where its own does not determine it.
    fn factored(&self, node: usize, scratch: &mut ConstrainedScratch<'a, D>) -> Result<(), MethodError> {
        self.fit.sort(node, self.problem.supports.lists.of(node), scratch)?;
        if self.fit.factor(node, scratch).is_ok() {
            return Ok(());
        }
        self.fit.sort(node, &enlarged_support(self.problem, node), scratch)?;
        self.fit.factor(node, scratch)
    }
}
