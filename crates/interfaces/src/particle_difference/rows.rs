//! The rows of single nodes.

use meshless_stencils::Functional;

use crate::gfdm::add_correction;
use crate::local::{NodeFit, NodeScratch, enlarged_support};
use crate::method::RowKind;
use crate::particle_difference::ParticleDifferenceParams;
use crate::particle_difference::feet::Feet;
use crate::particle_difference::fit::{ConstrainedFit, ConstrainedScratch};
use crate::particle_difference::leg::GRADIENT_STEP;
use crate::particle_difference::slit::{SlitFit, SlitScratch};
use crate::{MethodError, Problem};

/// A row `sum_j c_j (u_j - u_i) + r u_i = b`.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) node: usize,
    pub(super) neighbors: Vec<u32>,
    pub(super) coefficients: Vec<f64>,
    pub(super) row_sum: f64,
    pub(super) rhs: f64,
    pub(super) kind: RowKind,
    pub(super) enlarged: bool,
}

/// Coefficients of an operator at a node, and what they make of the jumps.
#[derive(Debug, Clone, Default)]
pub(super) struct Stencil {
    pub(super) neighbors: Vec<u32>,
    pub(super) coefficients: Vec<f64>,
    /// To be taken from the operator applied to the nodal values: `sum_j c_j shift_j`, less what conditions on slits give.
    pub(super) shift: f64,
    /// The operator applied to nodal values of 1; not zero where conditions on slits say something about u itself.
    pub(super) constant: f64,
    pub(super) constrained: bool,
    pub(super) enlarged: bool,
}

/// Makes stencils: plain ones where the support does not touch an interface, constrained ones where it does.
pub(super) struct StencilMaker<'a, const D: usize> {
    pub(super) problem: &'a Problem<'a, D>,
    feet: &'a Feet<D>,
    plain: NodeFit<D>,
    constrained: ConstrainedFit<'a, D>,
    slit: SlitFit<'a, D>,
}

/// Memory of one thread.
pub(super) struct MakerScratch<'a, const D: usize> {
    pub(super) plain: NodeScratch<D>,
    constrained: ConstrainedScratch<'a, D>,
    slit: SlitScratch<D>,
}

impl<'a, const D: usize> StencilMaker<'a, D> {
    pub(super) fn new(
        problem: &'a Problem<'a, D>,
        feet: &'a Feet<D>,
        params: ParticleDifferenceParams,
    ) -> Self {
        let plain = NodeFit::new(params.degree, params.weight);
        let (constrained, slit) = (ConstrainedFit::new(problem, feet, params), SlitFit::new(problem, params));
        Self { problem, feet, plain, constrained, slit }
    }

    pub(super) fn scratch(&self) -> MakerScratch<'a, D> {
        let most = self.problem.supports.lists.max_count();
        MakerScratch {
            plain: self.plain.scratch(most),
            constrained: self.constrained.scratch(),
            slit: SlitScratch::default(),
        }
    }

    /// Whether a slit may change the stencil of node i.
    pub(super) fn may_meet_slit(&self, i: usize) -> bool {
        self.slit.may_matter(i)
    }

    /// `div(eta grad u)` at node i by a plain stencil over its neighbours.
    pub(super) fn plain_row(
        &self,
        i: usize,
        scratch: &mut NodeScratch<D>,
        out: &mut [f64],
    ) -> Result<(), MethodError> {
        let located = |source| MethodError::stencil(i, &self.problem.cloud.points()[i], source);
        self.plain.factor(self.problem, i, self.problem.supports.lists.of(i), scratch).map_err(located)?;
        self.plain.coefficients(&self.diffusion(i), scratch, out).map_err(located)
    }

    /// The row of an interior node.
    pub(super) fn interior(&self, i: usize, scratch: &mut MakerScratch<'a, D>) -> Result<Row, MethodError> {
        if let Some(row) = self.slit.on_slit(i, self.problem.supports.lists.of(i), &mut scratch.slit)? {
            return Ok(row);
        }
        let [stencil] = self.stencil(i, &[self.diffusion(i)], false, scratch)?;
        let Stencil { neighbors, mut coefficients, shift, constant, constrained, enlarged } = stencil;
        coefficients.iter_mut().for_each(|c| *c = -*c);
        let rhs = self.problem.source.map_or(0.0, |f| f[i]) - shift;
        let kind = if constrained { RowKind::Constrained } else { RowKind::Strong };
        Ok(Row { node: i, neighbors, coefficients, row_sum: -constant, rhs, kind, enlarged })
    }

    /// The row of a boundary node on which u is not prescribed: the conditions of its faces, added.
    pub(super) fn boundary(
        &self,
        index: usize,
        scratch: &mut MakerScratch<'a, D>,
    ) -> Result<Row, MethodError> {
        let node = &self.problem.cloud.boundary()[index];
        let i = node.node as usize;
        let eta = self.problem.eta[i];
        let (mut direction, mut row_sum, mut rhs) = ([0.0; D], 0.0, 0.0);
        for (touch, condition) in node.touches.iter().zip(&self.problem.conditions[index]) {
            let (a, g) = condition.as_flux(eta).ok_or_else(|| MethodError::RobinWithoutFlux {
                node: i,
                position: self.problem.cloud.points()[i].to_vec(),
            })?;
            row_sum += a;
            rhs += g;
            direction.iter_mut().zip(touch.normal).for_each(|(d, n)| *d -= eta * n);
        }
        let [stencil] = self.stencil(i, &[Functional::Directional(direction)], true, scratch)?;
        let Stencil { neighbors, mut coefficients, shift, constant, enlarged, .. } = stencil;
        coefficients.iter_mut().for_each(|c| *c = -*c);
        Ok(Row {
            node: i,
            neighbors,
            coefficients,
            row_sum: row_sum - constant,
            rhs: rhs - shift,
            kind: RowKind::StrongBoundary,
            enlarged,
        })
    }

    /// Stencils of some operators at node i, on a larger support where the given one does not determine them.
    pub(super) fn stencil<const N: usize>(
        &self,
        i: usize,
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut MakerScratch<'a, D>,
    ) -> Result<[Stencil; N], MethodError> {
        let near = self.feet.is_near(i);
        let meets = self.may_meet_slit(i);
        let attempt = |neighbors: &[u32], scratch: &mut MakerScratch<'a, D>| {
            if meets && let Some(found) = self.slit.stencils(i, neighbors, functionals, &mut scratch.slit)? {
                return Ok(found);
            }
            if near {
                self.constrained_stencils(i, neighbors, functionals, correct, scratch)
            } else {
                self.plain_stencils(i, neighbors, functionals, correct, &mut scratch.plain)
            }
        };
        attempt(self.problem.supports.lists.of(i), scratch).or_else(|_| {
            let mut stencils = attempt(&enlarged_support(self.problem, i), scratch)?;
            stencils.iter_mut().for_each(|s| s.enlarged = true);
            Ok(stencils)
        })
    }

    fn constrained_stencils<const N: usize>(
        &self,
        i: usize,
        neighbors: &[u32],
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut MakerScratch<'a, D>,
    ) -> Result<[Stencil; N], MethodError> {
        let MakerScratch { plain, constrained, .. } = scratch;
        self.constrained.sort(i, neighbors, constrained)?;
        if constrained.sides.is_smooth() && constrained.sides.kept.len() == neighbors.len() {
            return self.plain_stencils(i, neighbors, functionals, correct, plain);
        }
        self.constrained.factor(i, constrained)?;
        let located = |source| MethodError::stencil(i, &self.problem.cloud.points()[i], source);
        let mut stencils = std::array::from_fn(|_| Stencil::default());
        for (stencil, functional) in stencils.iter_mut().zip(functionals) {
            self.constrained
                .coefficients(functional, constrained, &mut stencil.coefficients)
                .map_err(located)?;
            if correct {
                let xi = self.constrained.correction(constrained).map_err(located)?;
                add_correction(&mut stencil.coefficients, xi);
            }
            let shifts = &constrained.sides.shifts;
            stencil.shift = stencil.coefficients.iter().zip(shifts).map(|(c, s)| c * s).sum();
            stencil.neighbors.clone_from(&constrained.sides.kept);
            stencil.constrained = true;
        }
        Ok(stencils)
    }

    fn plain_stencils<const N: usize>(
        &self,
        i: usize,
        neighbors: &[u32],
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut NodeScratch<D>,
    ) -> Result<[Stencil; N], MethodError> {
        let located = |source| MethodError::stencil(i, &self.problem.cloud.points()[i], source);
        self.plain.factor(self.problem, i, neighbors, scratch).map_err(located)?;
        let mut stencils = std::array::from_fn(|_| Stencil::default());
        for (stencil, functional) in stencils.iter_mut().zip(functionals) {
            stencil.coefficients.resize(neighbors.len(), 0.0);
            self.plain.coefficients(functional, scratch, &mut stencil.coefficients).map_err(located)?;
            if correct {
                let mut xi = vec![0.0; neighbors.len()];
                self.plain.correction(scratch, &mut xi).map_err(located)?;
                add_correction(&mut stencil.coefficients, &xi);
            }
            stencil.neighbors = neighbors.to_vec();
        }
        Ok(stencils)
    }

    /// `div(eta grad u)` at node i, with the gradient of eta as its region has it.
    pub(super) fn diffusion(&self, i: usize) -> Functional<D> {
        let problem = self.problem;
        let field = &problem.materials[problem.labels[i] as usize].diffusivity;
        let step = GRADIENT_STEP * problem.cloud.spacing()[i];
        let gradient = field.gradient(&problem.cloud.points()[i], step);
        Functional::Diffusion { eta: problem.eta[i], gradient }
    }
}
