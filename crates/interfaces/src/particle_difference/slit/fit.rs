//! Fits over supports that meet slits.

use meshless_stencils::{ConstrainedFit, FitParams, Functional, LocalFit, StencilError};

use super::tip::{Singular, on_side};
use super::view::View;
use crate::method::RowKind;
use crate::particle_difference::ParticleDifferenceParams;
use crate::particle_difference::rows::{Row, Stencil};
use crate::{MethodError, Problem};

/// Nodes nearer to a slit on which u is prescribed than this, in spacings, take their value from it and from their
/// neighbours: the equation there would say something about the neighbours only.
const ON_SLIT: f64 = 0.25;

/// How far a node may be from any slit, in interaction radii, for one to meet its support: supports are as large as the
/// larger of two radii.
const REACH: f64 = 2.0;

/// Fits over the supports of nodes near slits.
pub(in crate::particle_difference) struct SlitFit<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    params: ParticleDifferenceParams,
    fit: LocalFit<D>,
}

/// Memory of one thread.
#[derive(Default)]
pub(in crate::particle_difference) struct SlitScratch<const D: usize> {
    view: View<D>,
    fit: ConstrainedFit,
    functional: Vec<f64>,
    on_nodes: Vec<f64>,
    on_conditions: Vec<f64>,
    /// What the values of the nodes have more than the continuation from this side.
    shifts: Vec<f64>,
    /// Right-hand sides of the conditions, and their factors of u.
    given: Vec<[f64; 2]>,
    powers: Vec<f64>,
}

impl<'a, const D: usize> SlitFit<'a, D> {
    pub(in crate::particle_difference) fn new(
        problem: &'a Problem<'a, D>,
        params: ParticleDifferenceParams,
    ) -> Self {
        Self {
            problem,
            params,
            fit: LocalFit::new(FitParams { degree: params.degree, ..FitParams::default() }),
        }
    }

    /// Whether a slit may change the fit at node i.
    pub(in crate::particle_difference) fn may_matter(&self, i: usize) -> bool {
        let (x, radius) = (&self.problem.cloud.points()[i], self.problem.supports.radius[i]);
        self.problem.slits.iter().any(|s| s.slit.nearest(x).distance <= (REACH * radius).max(s.enrichment))
    }

    /// Stencils of some operators at node i; `None` where no slit changes anything.
    pub(in crate::particle_difference) fn stencils<const N: usize>(
        &self,
        i: usize,
        neighbors: &[u32],
        functionals: &[Functional<D>; N],
        scratch: &mut SlitScratch<D>,
    ) -> Result<Option<[Stencil; N]>, MethodError> {
        scratch.view.look(self.problem, &self.params, i, neighbors)?;
        if scratch.view.is_plain() {
            return Ok(None);
        }
        let x = &self.problem.cloud.points()[i];
        let located = |source| MethodError::stencil(i, x, source);
        self.factor(i, true, scratch).map_err(located)?;
        self.check(i, scratch)?;
        let mut stencils = std::array::from_fn(|_| Stencil::default());
        for (stencil, functional) in stencils.iter_mut().zip(functionals) {
            self.apply(i, functional, scratch).map_err(located)?;
            *stencil = scratch.stencil(1);
        }
        Ok(Some(stencils))
    }

    /// The row of a node that is as good as on a slit where u is prescribed, `None` for any other.
    pub(in crate::particle_difference) fn on_slit(
        &self,
        i: usize,
        neighbors: &[u32],
        scratch: &mut SlitScratch<D>,
    ) -> Result<Option<Row>, MethodError> {
        let (x, h) = (&self.problem.cloud.points()[i], self.problem.cloud.spacing()[i]);
        let near = self.problem.slits.iter().any(|s| {
            let foot = s.slit.nearest(x);
            let prescribed = s.condition.on_each_side(&foot.at.point).is_some_and(|[_, b, _]| b == 0.0);
            prescribed && foot.distance <= ON_SLIT * h
        });
        if !near {
            return Ok(None);
        }
        scratch.view.look(self.problem, &self.params, i, neighbors)?;
        if scratch.view.conditions.is_empty() {
            return Ok(None);
        }
        let located = |source| MethodError::stencil(i, x, source);
        self.factor(i, false, scratch).map_err(located)?;
        self.check(i, scratch)?;
        self.apply(i, &Functional::Value, scratch).map_err(located)?;
        let Stencil { neighbors, coefficients, constant, shift, .. } = scratch.stencil(0);
        // As large as a row of the equation.
        let size = self.problem.eta[i] / (h * h);
        Ok(Some(Row {
            node: i,
            neighbors,
            coefficients: coefficients.into_iter().map(|e| -size * e).collect(),
            row_sum: size * (1.0 - constant),
            rhs: -size * shift,
            kind: RowKind::StrongBoundary,
            enlarged: false,
        }))
    }

    /// What conditions say near node i must be numbers.
    fn check(&self, i: usize, scratch: &SlitScratch<D>) -> Result<(), MethodError> {
        let given = scratch.given.iter().flatten().chain(&scratch.shifts);
        if given.copied().all(f64::is_finite) {
            return Ok(());
        }
        let what = format!(
            "the condition on a slit is not finite near {:?}; it is evaluated along the slit up to a tenth of a \
             thousandth of the spacing from its tips",
            self.problem.cloud.points()[i]
        );
        Err(MethodError::InvalidProblem { what })
    }

    /// Factors the fit at node i, with the value of the node itself or without.
    fn factor(&self, i: usize, own: bool, scratch: &mut SlitScratch<D>) -> Result<(), StencilError> {
        let (problem, params) = (self.problem, &self.params);
        let (points, radii) = (problem.cloud.points(), problem.supports.radius);
        let (x, radius) = (&points[i], radii[i]);
        let SlitScratch { view, fit, shifts, given, powers, .. } = scratch;
        let monomials = self.fit.monomials();
        let count = monomials.count();
        powers.resize(count, 0.0);
        fit.clear(count + 2 * view.tips.len());
        shifts.clear();
        given.clear();
        let nodes = own
            .then_some((i, None))
            .into_iter()
            .chain(view.kept.iter().map(|&j| j as usize).zip(view.crossings.iter().copied()));
        for (j, crossing) in nodes {
            let z: [f64; D] = std::array::from_fn(|k| (points[j][k] - x[k]) / radius);
            let distance = radius * z.iter().map(|z| z * z).sum::<f64>().sqrt();
            let row = fit.observe(params.weight.value(distance, radius, radii[j]));
            monomials.evaluate(&z, &mut row[..count]);
            for (k, tip) in view.tips.iter().enumerate() {
                for (value, function) in row[count + 2 * k..].iter_mut().zip(Singular::BOTH) {
                    *value = function.at(&problem.slits[tip.slit].slit, tip.end, &points[j]);
                    if let Some(crossing) = crossing.filter(|c| c.slit == tip.slit) {
                        *value -= crossing.of_singular(problem, i, function, tip.end);
                    }
                    *value /= radius.sqrt();
                }
            }
            shifts.push(crossing.map_or(0.0, |c| c.of_solution(problem, i)));
        }
        for (slit, at, side) in &view.conditions {
            let interface = &problem.slits[*slit];
            let Some([a, b, g]) = interface.condition.on_each_side(&at.point) else { continue };
            let eta = problem.materials[problem.labels[i] as usize].diffusivity.at(&at.point);
            // The normal out of the domain; the flux in units of a value over the radius.
            let flux = at.normal.map(|n| -side * n * b * eta);
            let scale = 1.0 / a.abs().max((b * eta).abs() / radius);
            let z = std::array::from_fn(|k| (at.point[k] - x[k]) / radius);
            let row = fit.constrain();
            monomials.evaluate(&z, powers);
            row[..count].iter_mut().zip(&*powers).for_each(|(r, p)| *r = scale * a * p);
            powers.fill(0.0);
            let offset = std::array::from_fn(|k| at.point[k] - x[k]);
            self.fit.moments_at(&Functional::Directional(flux), &offset, radius, powers)?;
            row[..count].iter_mut().zip(&*powers).for_each(|(r, p)| *r += scale * p);
            for (k, tip) in view.tips.iter().enumerate() {
                let line = &problem.slits[tip.slit].slit;
                let point = if tip.slit == *slit { on_side(line, at, *side) } else { at.point };
                for (value, function) in row[count + 2 * k..].iter_mut().zip(Singular::BOTH) {
                    let gradient = function.gradient(line, tip.end, &point, radius);
                    let slope: f64 = (0..D).map(|k| gradient[k] * flux[k]).sum();
                    *value = scale * (a * function.at(line, tip.end, &point) + slope) / radius.sqrt();
                }
            }
            given.push([scale * g, scale * a]);
        }
        fit.factor();
        Ok(())
    }

    /// An operator at node i in terms of the nodes and of the conditions.
    fn apply(
        &self,
        i: usize,
        functional: &Functional<D>,
        scratch: &mut SlitScratch<D>,
    ) -> Result<(), StencilError> {
        let (x, radius) = (&self.problem.cloud.points()[i], self.problem.supports.radius[i]);
        let SlitScratch { view, fit, functional: v, on_nodes, on_conditions, .. } = scratch;
        let count = self.fit.monomials().count();
        v.clear();
        v.resize(fit.unknowns(), 0.0);
        self.fit.moments_at(functional, &[0.0; D], radius, &mut v[..count])?;
        let direction = match functional {
            Functional::Diffusion { gradient, .. } => *gradient,
            Functional::Directional(direction) => *direction,
            Functional::Partial(axis) => std::array::from_fn(|k| if k == *axis { 1.0 } else { 0.0 }),
            _ => [0.0; D],
        };
        for (k, tip) in view.tips.iter().enumerate() {
            let line = &self.problem.slits[tip.slit].slit;
            for (value, function) in v[count + 2 * k..].iter_mut().zip(Singular::BOTH) {
                let gradient = function.gradient(line, tip.end, x, radius);
                *value = (0..D).map(|k| gradient[k] * direction[k]).sum::<f64>() / radius.sqrt();
                if *functional == Functional::Value {
                    *value = function.at(line, tip.end, x) / radius.sqrt();
                }
            }
        }
        on_nodes.resize(fit.observations(), 0.0);
        on_conditions.resize(fit.constraints(), 0.0);
        fit.functional(v, on_nodes, on_conditions)
    }
}

impl<const D: usize> SlitScratch<D> {
    /// The operator that was applied last, as a stencil; `own` is the number of the first neighbour among the nodes.
    fn stencil(&self, own: usize) -> Stencil {
        let conditions = self.on_conditions.iter().zip(&self.given);
        let by_conditions: f64 = conditions.clone().map(|(f, [g, _])| f * g).sum();
        let by_jumps: f64 = self.on_nodes.iter().zip(&self.shifts).map(|(e, s)| e * s).sum();
        // On a constant, conditions give what the nodes do not.
        let constant = conditions.map(|(f, [_, a])| f * a).sum::<f64>();
        let of_constant = self.functional.first().copied().unwrap_or(0.0);
        Stencil {
            neighbors: self.view.kept.clone(),
            coefficients: self.on_nodes[own..].to_vec(),
            shift: by_jumps - by_conditions,
            remainder: self.fit.remainder(),
            constant: of_constant - constant,
            constrained: true,
            enlarged: false,
        }
    }
}
