//! Ghosts by least squares under the conditions at the interface or boundary.
//!
//! For a foot c on the interface between regions i and j, polynomials `P_i` and `P_j` of one degree are fitted to the
//! nearest nodes of each side, under: `P_j - P_i = a` and the same for the derivatives along the interface,
//! `eta_j dP_j/dn - eta_i dP_i/dn = b`, and the equation of each side, all at c. The value of the field of region i
//! beyond the interface is that of `P_i`. On the boundary there is one side with its conditions and its equation.

use meshless_sparse::RowBuilder;
use meshless_stencils::{ConstrainedFit, Monomials, StencilError};

use super::foot::{Foot, LocalEquation, equation, jump, tangents};
use super::ghosts::GhostMaker;
use super::sides::Sides;
use crate::{MethodError, Problem};

/// Nodes of each side for each monomial.
const NODES_PER_MONOMIAL: f64 = 2.4;

/// Weights are `exp(-|s|^2 / WIDTH)` on residuals, s in spacings: the nodes that are nearest to the interface count
/// most, and the farthest of them still do.
const WIDTH: f64 = 2.25;

/// Least weight of the side of the smaller diffusivity up to a contrast of 100. With less the level of that side gets lost: a scalp
/// beyond a skull of 1/79 of its conductivity was 30 % off.
const LEAST_SHARE: f64 = 0.1;

/// Where nodes are few, the unit of length grows, so that the farthest node is at most so many units away.
const FARTHEST: f64 = 3.0;

/// A value as a combination of values at nodes: `sum_p e_p u_p + constant`.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Ghost {
    pub(super) nodes: Vec<u32>,
    pub(super) coefficients: Vec<f64>,
    pub(super) constant: f64,
    /// One minus the sum of the coefficients, without cancellation.
    pub(super) defect: f64,
}

impl Ghost {
    /// What the value adds to the row of its node, in which it stands `-factor` times, but for the constant.
    pub(super) fn subtract(&self, factor: f64, out: &mut RowBuilder) {
        self.nodes.iter().zip(&self.coefficients).for_each(|(&p, e)| out.push(p as usize, -factor * e));
        out.add_to_row_sum(factor * self.defect);
    }
}

/// Makes ghosts.
pub(super) struct ConstrainedGhosts<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    sides: Sides<'a, D>,
    monomials: Monomials<D>,
    /// Whether the equation has a `du/dt`, which is not known here.
    unsteady: bool,
}

/// Memory of one thread.
#[derive(Default)]
pub(super) struct GhostScratch {
    pub(super) fit: ConstrainedFit,
    pub(super) found: Vec<(f64, u32)>,
    pub(super) own: Vec<u32>,
    other: Vec<u32>,
    data: Vec<f64>,
    defects: Vec<f64>,
    pub(super) functional: Vec<f64>,
    pub(super) on_observations: Vec<f64>,
    on_constraints: Vec<f64>,
}

impl GhostScratch {
    /// Adds a constraint with its right-hand side.
    fn constrain(&mut self, data: f64) -> &mut [f64] {
        self.data.push(data);
        self.defects.push(0.0);
        self.fit.constrain()
    }
}

impl<'a, const D: usize> ConstrainedGhosts<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        degree: usize,
        unsteady: bool,
    ) -> Result<Self, MethodError> {
        Ok(Self { problem, sides: Sides::new(problem)?, monomials: Monomials::new(degree), unsteady })
    }

    fn per_side(&self) -> usize {
        (NODES_PER_MONOMIAL * self.monomials.count() as f64).ceil() as usize
    }

    /// The value at boundary node b under its conditions, from the nodes of its region.
    pub(super) fn on_boundary(
        &self,
        b: usize,
        conditions: &[([f64; D], f64, f64)],
        scratch: &mut GhostScratch,
    ) -> Result<Ghost, StencilError> {
        let point = self.problem.cloud.points()[b];
        let region = self.problem.labels[b];
        let foot = Foot { point, normal: [0.0; D], spacing: self.problem.cloud.spacing()[b] };
        let GhostScratch { found, own, other, .. } = scratch;
        self.sides.nearest(&point, None, (region, Some(b as u32)), self.per_side(), found, own);
        other.clear();
        let foot = Foot { spacing: self.unit(&foot, scratch), ..foot };
        self.observe(&foot, [1.0; 2], self.monomials.count(), scratch);
        let local = equation(&self.problem.materials[region as usize], &point, foot.spacing);
        for &(normal, a, g) in conditions {
            let a = a * foot.spacing / local.eta;
            let scale = 1.0 / (1.0 + a.abs());
            let row = scratch.constrain(scale * g * foot.spacing / local.eta);
            self.monomials.add_derivative(&[0; D], &[0.0; D], scale * a, row);
            self.directional(&normal, scale, row);
            if let Some(last) = scratch.defects.last_mut() {
                *last = scale * a;
            }
        }
        if !self.unsteady {
            let row = scratch.constrain(local.rhs);
            self.operator(&local, 1.0, row);
        }
        self.evaluate(&point, &foot, scratch)
    }

    /// Unit of length: the spacing, or more where nodes are few.
    fn unit(&self, foot: &Foot<D>, scratch: &GhostScratch) -> f64 {
        let reach = scratch.own.iter().chain(&scratch.other).fold(0.0_f64, |reach, &j| {
            let x = &self.problem.cloud.points()[j as usize];
            reach.max((0..D).map(|k| (x[k] - foot.point[k]).powi(2)).sum())
        });
        foot.spacing.max(reach.sqrt() / FARTHEST)
    }

    /// The values at the nodes of both sides, with a weight for each side.
    ///
    /// Residuals of a side are in units of its flux: what a polynomial of low degree leaves over are higher
    /// derivatives, and across an interface it is those of the flux that are of one size, not those of u.
    fn observe(&self, foot: &Foot<D>, share: [f64; 2], unknowns: usize, scratch: &mut GhostScratch) {
        let n = self.monomials.count();
        let GhostScratch { fit, own, other, data, defects, .. } = scratch;
        fit.clear(unknowns);
        data.clear();
        defects.clear();
        let sides = own.iter().map(|j| (0, share[0], j)).chain(other.iter().map(|j| (n, share[1], j)));
        for (first, share, &j) in sides {
            let x = &self.problem.cloud.points()[j as usize];
            let s: [f64; D] = std::array::from_fn(|k| (x[k] - foot.point[k]) / foot.spacing);
            let weight = share * (-s.iter().map(|c| c * c).sum::<f64>() / WIDTH).exp();
            self.monomials.evaluate(&s, &mut fit.observe(weight)[first..first + n]);
        }
    }

    /// The conditions at an interface.
    fn join(
        &self,
        foot: &Foot<D>,
        regions: [u16; 2],
        [own, other]: [LocalEquation<D>; 2],
        scratch: &mut GhostScratch,
    ) {
        let n = self.monomials.count();
        let scale = own.eta.max(other.eta);
        let jump = jump(self.problem, foot, regions, scale);
        let row = scratch.constrain(jump.value);
        (row[0], row[n]) = (-1.0, 1.0);
        for tangent in tangents(&foot.normal) {
            let along = (0..D).map(|k| tangent[k] * jump.gradient[k]).sum();
            let row = scratch.constrain(along);
            self.directional(&tangent, -1.0, &mut row[..n]);
            self.directional(&tangent, 1.0, &mut row[n..]);
        }
        let row = scratch.constrain(jump.flux);
        self.directional(&foot.normal, -own.eta / scale, &mut row[..n]);
        self.directional(&foot.normal, other.eta / scale, &mut row[n..]);
        if self.unsteady {
            // How du/dt jumps is all that is known of it.
            let [from, to] = [own.eta / scale, other.eta / scale];
            let row = scratch.constrain(to * other.rhs - from * own.rhs + jump.rate);
            self.operator(&own, -from, &mut row[..n]);
            self.operator(&other, to, &mut row[n..]);
        } else {
            for (first, side) in [(0, own), (n, other)] {
                let row = scratch.constrain(side.rhs);
                self.operator(&side, 1.0, &mut row[first..first + n]);
            }
        }
    }

    fn directional(&self, direction: &[f64; D], factor: f64, row: &mut [f64]) {
        for (k, component) in direction.iter().enumerate() {
            self.monomials.add_derivative(&axis(k, 1), &[0.0; D], factor * component, row);
        }
    }

    fn operator(&self, equation: &LocalEquation<D>, factor: f64, row: &mut [f64]) {
        for k in 0..D {
            self.monomials.add_derivative(&axis(k, 2), &[0.0; D], factor, row);
        }
        self.directional(&equation.drift, factor, row);
    }

    /// The first polynomial at x in terms of values at nodes.
    fn evaluate(
        &self,
        x: &[f64; D],
        foot: &Foot<D>,
        scratch: &mut GhostScratch,
    ) -> Result<Ghost, StencilError> {
        let n = self.monomials.count();
        let GhostScratch {
            fit, own, other, data, defects, functional, on_observations, on_constraints, ..
        } = scratch;
        fit.factor();
        let s: [f64; D] = std::array::from_fn(|k| (x[k] - foot.point[k]) / foot.spacing);
        functional.clear();
        functional.resize(fit.unknowns(), 0.0);
        self.monomials.evaluate(&s, &mut functional[..n]);
        on_observations.resize(fit.observations(), 0.0);
        on_constraints.resize(fit.constraints(), 0.0);
        fit.functional(functional, on_observations, on_constraints)?;
        let product = |a: &[f64]| on_constraints.iter().zip(a).map(|(f, d)| f * d).sum::<f64>();
        Ok(Ghost {
            nodes: own.iter().chain(other.iter()).copied().collect(),
            coefficients: on_observations.clone(),
            constant: product(data),
            defect: product(defects),
        })
    }
}

impl<const D: usize> GhostMaker<D> for ConstrainedGhosts<'_, D> {
    fn across(
        &self,
        q: usize,
        foot: &Foot<D>,
        [own, other]: [u16; 2],
        scratch: &mut GhostScratch,
    ) -> Result<Ghost, StencilError> {
        let (point, n) = (&foot.point, self.monomials.count());
        let towards_own = foot.normal.map(|c| -c);
        let count = self.per_side();
        let GhostScratch { found, own: own_nodes, other: other_nodes, .. } = scratch;
        self.sides.nearest(point, Some(&towards_own), (own, None), count, found, own_nodes);
        self.sides.nearest(point, Some(&foot.normal), (other, None), count, found, other_nodes);
        let foot = Foot { spacing: self.unit(foot, scratch), ..*foot };
        let sides = [own, other].map(|r| equation(&self.problem.materials[r as usize], point, foot.spacing));
        let largest = sides[0].eta.max(sides[1].eta);
        let shares = sides.each_ref().map(|side| share(side.eta / largest));
        self.observe(&foot, shares, 2 * n, scratch);
        self.join(&foot, [own, other], sides, scratch);
        self.evaluate(&self.problem.cloud.points()[q], &foot, scratch)
    }
}

/// The weight of a side by its diffusivity over the larger one. What its polynomial leaves over goes into the level of the stiff side by
/// the square of the weight, and the rows of the stiff side multiply that by the contrast: a weight that falls as the square root of the
/// ratio leaves an error that does not know the contrast, and still lets the soft side determine the flux.
fn share(ratio: f64) -> f64 {
    ratio.max(ratio.sqrt().min(LEAST_SHARE))
}

fn axis<const D: usize>(axis: usize, order: u8) -> [u8; D] {
    std::array::from_fn(|k| if k == axis { order } else { 0 })
}
