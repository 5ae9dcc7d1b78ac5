//! The rows of single nodes.

use meshless_stencils::{Functional, Weight};

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
    /// What is left of the reproduction, relative to the operator.
    pub(super) remainder: f64,
    pub(super) constrained: bool,
    pub(super) enlarged: bool,
}

impl Stencil {
    /// How wrong the operator is by rounding and by what is left of the reproduction, over its size on a support of this radius.
    fn inexactness<const D: usize>(&self, functional: &Functional<D>, radius: f64) -> f64 {
        let length = |v: &[f64; D]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let size = match functional {
            Functional::Diffusion { eta, .. } => eta / radius.powi(2),
            Functional::Directional(direction) => length(direction) / radius,
            Functional::Partial(_) => 1.0 / radius,
            _ => return 0.0,
        };
        f64::EPSILON * self.coefficients.iter().map(|c| c.abs()).sum::<f64>() / size + self.remainder
    }
}

/// The own entry of a row over the absolute ones of the others; 1 where none of these has the wrong sign.
pub(super) fn own_share(coefficients: &[f64]) -> f64 {
    coefficients.iter().sum::<f64>() / coefficients.iter().map(|c| c.abs()).sum::<f64>()
}

/// In place of a row in which the own value of node i counts less than [`LEAST_OWN`], one of a fit in which all neighbours count alike,
/// over the support and then over the enlarged one; that with the largest share where none reaches it. `attempt` makes such a row over
/// some neighbours, and knows whether they are those of the enlarged support.
pub(super) fn calmest<R, const D: usize>(
    problem: &Problem<'_, D>,
    i: usize,
    first: R,
    share: impl Fn(&R) -> f64,
    mut attempt: impl FnMut(&[u32], bool) -> Option<R>,
) -> R {
    let (mut largest, mut best) = (share(&first), first);
    for enlarged in [false, true] {
        if largest >= LEAST_OWN {
            break;
        }
        let all = enlarged.then(|| enlarged_support(problem, i));
        let neighbors = all.as_deref().unwrap_or_else(|| problem.supports.lists.of(i));
        if let Some(found) = attempt(neighbors, enlarged)
            && share(&found) > largest
        {
            (largest, best) = (share(&found), found);
        }
    }
    best
}

/// Error of an operator, over its natural size, from which a larger support is tried: what rounding of the values makes of it, and what is
/// left of the reproduction. Supports that hardly determine all functions have 1e-8.
const MOST_INEXACT: f64 = 1e-10;

/// Share of the absolute entries of the others that the own one of a row has at least where u changes with time. In a row of the
/// wrong sign the node grows by itself.
const LEAST_OWN: f64 = 0.2;

/// Makes stencils: plain ones where the support does not touch an interface, constrained ones where it does.
pub(super) struct StencilMaker<'a, const D: usize> {
    pub(super) problem: &'a Problem<'a, D>,
    feet: &'a Feet<D>,
    plain: NodeFit<D>,
    constrained: ConstrainedFit<'a, D>,
    slit: SlitFit<'a, D>,
    /// The same with all weights alike, where rows have to decay.
    even: Option<(NodeFit<D>, ConstrainedFit<'a, D>)>,
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
        let even = params.decaying.then(|| {
            let params = ParticleDifferenceParams { weight: Weight::Uniform, ..params };
            (NodeFit::new(params.degree, params.weight), ConstrainedFit::new(problem, feet, params))
        });
        Self { problem, feet, plain, constrained, slit, even }
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

    /// Whether the node of a row outweighs the others as far as it has to.
    pub(super) fn decays(&self, coefficients: &[f64]) -> bool {
        self.even.is_none() || own_share(coefficients) >= LEAST_OWN
    }

    /// The row of an interior node.
    pub(super) fn interior(&self, i: usize, scratch: &mut MakerScratch<'a, D>) -> Result<Row, MethodError> {
        if let Some(row) = self.slit.on_slit(i, self.problem.supports.lists.of(i), &mut scratch.slit)? {
            return Ok(row);
        }
        let operator = [self.diffusion(i)];
        let [mut stencil] = self.stencil(i, &operator, false, scratch)?;
        if !self.decays(&stencil.coefficients) {
            stencil = self.calmer(i, stencil, scratch);
        }
        let Stencil { neighbors, mut coefficients, shift, constant, constrained, enlarged, .. } = stencil;
        coefficients.iter_mut().for_each(|c| *c = -*c);
        let rhs = self.problem.source.map_or(0.0, |f| f[i]) - shift;
        let kind = if constrained { RowKind::Constrained } else { RowKind::Strong };
        Ok(Row { node: i, neighbors, coefficients, row_sum: -constant, rhs, kind, enlarged })
    }

    /// In place of a stencil whose own value counts too little: see [`calmest`].
    fn calmer(&self, i: usize, first: Stencil, scratch: &mut MakerScratch<'a, D>) -> Stencil {
        let Some((plain, constrained)) = &self.even else { return first };
        let operator = [self.diffusion(i)];
        let share = |stencil: &Stencil| own_share(&stencil.coefficients);
        calmest(self.problem, i, first, share, |neighbors, enlarged| {
            let found = self.attempt((plain, constrained), (i, neighbors), &operator, false, scratch);
            let [found] = found.ok()?;
            Some(Stencil { enlarged, ..found })
        })
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

    /// Stencils of some operators at node i, on a larger support where the given one does not determine them, or hardly.
    pub(super) fn stencil<const N: usize>(
        &self,
        i: usize,
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut MakerScratch<'a, D>,
    ) -> Result<[Stencil; N], MethodError> {
        let attempt = |neighbors: &[u32], scratch: &mut MakerScratch<'a, D>| {
            self.attempt((&self.plain, &self.constrained), (i, neighbors), functionals, correct, scratch)
        };
        let radius = self.problem.supports.radius[i];
        let inexactness = |stencils: &[Stencil; N]| {
            let pairs = stencils.iter().zip(functionals);
            pairs.map(|(s, functional)| s.inexactness(functional, radius)).fold(0.0, f64::max)
        };
        let first = attempt(self.problem.supports.lists.of(i), scratch);
        let least = first.as_ref().map_or(f64::INFINITY, &inexactness);
        if least <= MOST_INEXACT {
            return first;
        }
        match attempt(&enlarged_support(self.problem, i), scratch) {
            Ok(mut larger) if inexactness(&larger) < least => {
                larger.iter_mut().for_each(|s| s.enlarged = true);
                Ok(larger)
            }
            Ok(larger) => first.or(Ok(larger)),
            Err(error) => first.map_err(|_| error),
        }
    }

    /// The same by some fits over some neighbours.
    fn attempt<const N: usize>(
        &self,
        fits: (&NodeFit<D>, &ConstrainedFit<'a, D>),
        (i, neighbors): (usize, &[u32]),
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut MakerScratch<'a, D>,
    ) -> Result<[Stencil; N], MethodError> {
        if self.may_meet_slit(i)
            && let Some(found) = self.slit.stencils(i, neighbors, functionals, &mut scratch.slit)?
        {
            return Ok(found);
        }
        match self.feet.is_near(i) {
            true => self.constrained_stencils(fits, i, neighbors, functionals, correct, scratch),
            false => self.plain_stencils(fits.0, i, neighbors, functionals, correct, &mut scratch.plain),
        }
    }

    fn constrained_stencils<const N: usize>(
        &self,
        (plain_fit, fit): (&NodeFit<D>, &ConstrainedFit<'a, D>),
        i: usize,
        neighbors: &[u32],
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut MakerScratch<'a, D>,
    ) -> Result<[Stencil; N], MethodError> {
        let MakerScratch { plain, constrained, .. } = scratch;
        fit.sort(i, neighbors, constrained)?;
        if constrained.sides.is_smooth() && constrained.sides.kept.len() == neighbors.len() {
            return self.plain_stencils(plain_fit, i, neighbors, functionals, correct, plain);
        }
        fit.factor(i, constrained)?;
        let located = |source| MethodError::stencil(i, &self.problem.cloud.points()[i], source);
        let mut stencils = std::array::from_fn(|_| Stencil::default());
        for (stencil, functional) in stencils.iter_mut().zip(functionals) {
            fit.coefficients(functional, constrained, &mut stencil.coefficients).map_err(located)?;
            if correct {
                let xi = fit.correction(constrained).map_err(located)?;
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
        fit: &NodeFit<D>,
        i: usize,
        neighbors: &[u32],
        functionals: &[Functional<D>; N],
        correct: bool,
        scratch: &mut NodeScratch<D>,
    ) -> Result<[Stencil; N], MethodError> {
        let located = |source| MethodError::stencil(i, &self.problem.cloud.points()[i], source);
        fit.factor(self.problem, i, neighbors, scratch).map_err(located)?;
        let mut stencils = std::array::from_fn(|_| Stencil::default());
        for (stencil, functional) in stencils.iter_mut().zip(functionals) {
            stencil.coefficients.resize(neighbors.len(), 0.0);
            fit.coefficients(functional, scratch, &mut stencil.coefficients).map_err(located)?;
            if correct {
                let mut xi = vec![0.0; neighbors.len()];
                fit.correction(scratch, &mut xi).map_err(located)?;
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
