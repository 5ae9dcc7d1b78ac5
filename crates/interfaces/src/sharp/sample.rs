//! Values and gradients of a solution from the fits that made the rows.

use super::fit::Share;
use super::maker::{Maker, Scratch};
use super::stencil::Heard;
use crate::parallel;
use crate::{GradientRow, MethodError, Sample, SystemSolution};

/// A solution in the unknowns of the fits.
pub(super) struct Values<'a> {
    w: &'a [f64],
    constants: &'a [f64],
    /// `du/dt` at the nodes; empty in steady scenes.
    rates: &'a [f64],
}

/// Points a node from which on its fit serves them.
const SHARED: usize = 2;

/// Whose fit a point belongs to.
#[derive(Debug, Clone, Copy)]
struct Owner {
    node: usize,
    region: u16,
}

impl<'a> Values<'a> {
    /// Of a solution: its own unknowns, or its nodal values where nothing floats.
    pub(super) fn new(solution: &'a SystemSolution) -> Self {
        let rates = solution.rates.as_deref().unwrap_or_default();
        match &solution.split {
            Some(split) => Self { w: &split.values, constants: &split.constants, rates },
            None => Self { w: &solution.u, constants: &[], rates },
        }
    }
}

impl<const D: usize> Maker<'_, D> {
    /// The constant `c` of a part, less that of another, without their offsets.
    fn constants(&self, of: u32, less: Option<u32>, values: &Values<'_>) -> f64 {
        let constant = |k: u32| values.constants.get(k as usize).copied().unwrap_or(0.0);
        self.unknowns.shares(of, less).map(|(k, sigma)| sigma * constant(k)).sum()
    }

    /// What is added to `s w` in a part.
    fn constant(&self, part: u32, values: &Values<'_>) -> f64 {
        self.unknowns.offset[part as usize] + self.constants(part, None, values)
    }

    /// The constant by which nodal values differ from the unknowns that they are made of, where nothing fixes it and it was
    /// chosen afterwards.
    pub(super) fn level(&self, u: &[f64], values: &Values<'_>) -> f64 {
        let own =
            |(&part, w): (&u32, &f64)| self.unknowns.scale[part as usize] * w + self.constant(part, values);
        self.unknowns.part.iter().zip(values.w).map(own).zip(u).next().map_or(0.0, |(own, u)| u - own)
    }

    /// The gradient of the own polynomial at node i.
    pub(super) fn gradient(
        &self,
        i: usize,
        values: &Values<'_>,
        scratch: &mut Scratch<D>,
    ) -> Result<[f64; D], MethodError> {
        self.factor_for_gradient(i, scratch)?;
        Ok(std::array::from_fn(|axis| self.evaluate(Some(axis), values, scratch)))
    }

    /// Whether gradients are kept with the rows.
    pub(super) fn keeps_gradients(&self) -> bool {
        self.params.keep_gradients && self.rates.is_none()
    }

    /// The gradient at node i, in terms of the unknowns.
    pub(super) fn gradient_at(&self, i: usize, scratch: &mut Scratch<D>) -> Result<GradientRow, MethodError> {
        self.factor_for_gradient(i, scratch)?;
        Ok(self.gradient_row(scratch))
    }

    /// The gradient of the own polynomial of the stencil that was factored last, in terms of the unknowns.
    pub(super) fn gradient_row(&self, scratch: &mut Scratch<D>) -> GradientRow {
        let Scratch { stencil, fit, combination, .. } = scratch;
        let scale = self.unknowns.scale[stencil.parts[0] as usize];
        let mut row = GradientRow { nodes: stencil.nodes.clone(), ..GradientRow::default() };
        row.factors.reserve_exact(D * row.nodes.len());
        for axis in 0..D {
            fit.functional(self, stencil, Some(axis), combination);
            row.factors.extend(combination.values.iter().map(|h| scale * h));
            row.known.push(scale * combination.known);
            for share in &combination.constants {
                let part = |place: usize| stencil.parts[place];
                let shares = self.unknowns.shares(part(share.of), share.less.map(part));
                row.constants.extend(shares.map(|(k, sigma)| (axis, k, scale * sigma * share.factor)));
            }
        }
        row
    }

    /// The gradient at node i for nodal values of any field.
    ///
    /// A fit does not change when a part's constant moves from `c` to `w`. So the value at one node of every part
    /// serves as its constant here, and only differences from it are scaled.
    pub(super) fn gradient_of_values(
        &self,
        i: usize,
        u: &[f64],
        scratch: &mut Scratch<D>,
    ) -> Result<[f64; D], MethodError> {
        self.factor_for_gradient(i, scratch)?;
        let Scratch { stencil, fit, combination, .. } = scratch;
        let reference: Vec<f64> = (0..stencil.parts.len())
            .map(|part| {
                let first = stencil.part_of.iter().position(|&p| p == part);
                first.map_or(0.0, |place| u[stencil.nodes[place] as usize])
            })
            .collect();
        let constant = |place: usize| reference[place] - self.unknowns.offset[stencil.parts[place] as usize];
        let scale = |part: usize| self.unknowns.scale[stencil.parts[part] as usize];
        Ok(std::array::from_fn(|axis| {
            fit.functional(self, stencil, Some(axis), combination);
            let nodes = stencil.nodes.iter().zip(&stencil.part_of).zip(&combination.values);
            let differences = nodes.map(|((&j, &p), h)| h * (u[j as usize] - reference[p]) / scale(p));
            let shares = combination.constants.iter();
            let constants = shares.map(|s| s.factor * (constant(s.of) - s.less.map_or(0.0, constant)));
            scale(0) * (combination.known + differences.sum::<f64>() + constants.sum::<f64>())
        }))
    }

    /// Region of a point, and the node of it that is nearest; `None` where none is near.
    fn owner(&self, x: &[f64; D]) -> Option<Owner> {
        let nearest = self.nearest_one(x)?;
        let region = self.problem.regions.label(x, self.problem.cloud.spacing()[nearest]);
        Some(Owner { node: self.nearest_of(region, x)?, region })
    }

    /// Value and gradient at a point from a fit round it.
    fn sample(
        &self,
        x: &[f64; D],
        owner: Owner,
        values: &Values<'_>,
        scratch: &mut Scratch<D>,
    ) -> Option<Sample<D>> {
        let part = self.unknowns.part[owner.node];
        self.factor_at((x, part, Heard::All), scratch, |_| true)?;
        let value = self.evaluate(None, values, scratch) + self.constant(part, values);
        let gradient = std::array::from_fn(|axis| self.evaluate(Some(axis), values, scratch));
        Some(Sample { value, gradient, region: owner.region })
    }

    /// Values and gradients at points: a fit round each of a few, and the fits of the nodes nearest to many, so that a
    /// picture takes no longer than the rows did, nor the points of a surface longer than the nodes along it.
    pub(super) fn samples(&self, points: &[[f64; D]], values: &Values<'_>) -> Vec<Option<Sample<D>>> {
        let owners = parallel::map(points.len(), |k| self.owner(&points[k]));
        let node = |k: &usize| owners[*k].map(|owner| owner.node);
        let mut order: Vec<usize> = (0..points.len()).filter(|k| owners[*k].is_some()).collect();
        order.sort_by_key(node);
        let groups: Vec<&[usize]> = order.chunk_by(|a, b| node(a) == node(b)).collect();
        // The polynomials of rates are at hand for a functional only.
        if order.len() < SHARED * groups.len() || !values.rates.is_empty() {
            return parallel::map_with(points.len(), Scratch::default, |scratch, k| {
                self.sample(&points[k], owners[k]?, values, scratch)
            });
        }
        let found = parallel::map_with(groups.len(), Scratch::default, |scratch, g| {
            let members = groups[g].iter().filter_map(|&k| Some((points[k], owners[k]?)));
            self.sample_group(&members.collect::<Vec<_>>(), values, scratch)
        });
        let mut samples = vec![None; points.len()];
        order.iter().zip(found.into_iter().flatten()).for_each(|(&k, sample)| samples[k] = sample);
        samples
    }

    /// Values and gradients at points of one region round one node, from the fit of that node.
    fn sample_group(
        &self,
        members: &[([f64; D], Owner)],
        values: &Values<'_>,
        scratch: &mut Scratch<D>,
    ) -> Vec<Option<Sample<D>>> {
        let Some((_, Owner { node, .. })) = members.first() else { return Vec::new() };
        let (part, center) = (self.unknowns.part[*node], self.problem.cloud.points()[*node]);
        let solved = self.factor_at((&center, part, Heard::All), scratch, |_| true).is_some()
            && scratch.stencil.vertex.is_none()
            && scratch.fit.solve(
                &scratch.stencil,
                |j| values.w[j as usize],
                |of, less| self.constants(of, less, values),
            );
        let (scale, constant) = (self.unknowns.scale[part as usize], self.constant(part, values));
        let radius = scratch.stencil.radius;
        let sample = |(x, owner): &([f64; D], Owner)| {
            if !solved {
                // Not all polynomials are determined: what a fit round the point says of the point itself is.
                return self.sample(x, *owner, values, scratch);
            }
            let z = std::array::from_fn(|k| (x[k] - center[k]) / radius);
            let (value, slope) = scratch.fit.own(self, &z);
            let gradient = slope.map(|g| scale * g / radius);
            Some(Sample { value: constant + scale * value, gradient, region: owner.region })
        };
        members.iter().map(sample).collect()
    }

    /// `s` times a functional of the own polynomial of the stencil that was factored last.
    fn evaluate(&self, axis: Option<usize>, values: &Values<'_>, scratch: &mut Scratch<D>) -> f64 {
        let Scratch { stencil, fit, combination, rates, mass, .. } = scratch;
        fit.functional(self, stencil, axis, combination);
        let mut known = combination.known;
        if let (Some(polynomials), false) = (&self.rates, values.rates.is_empty()) {
            polynomials.of_any(self, stencil, fit, rates, mass);
            known -=
                stencil.nodes.iter().zip(&*mass).map(|(&j, m)| m * values.rates[j as usize]).sum::<f64>();
            known -= rates.known;
        }
        let nodes = stencil.nodes.iter().zip(&combination.values).map(|(&j, h)| h * values.w[j as usize]);
        let part = |place: usize| stencil.parts[place];
        let of_share = |s: &Share| s.factor * self.constants(part(s.of), s.less.map(part), values);
        let constants = combination.constants.iter().map(of_share);
        let scale = self.unknowns.scale[stencil.parts[0] as usize];
        scale * (known + nodes.sum::<f64>() + constants.sum::<f64>())
    }
}
