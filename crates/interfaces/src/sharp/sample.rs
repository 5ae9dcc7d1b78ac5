//! Values and gradients of a solution from the fits that made the rows.

use rayon::prelude::*;

use super::maker::{Maker, Scratch};
use crate::{MethodError, Sample, SplitValues};

/// A solution in the unknowns of the fits.
pub(super) struct Values<'a> {
    w: &'a [f64],
    constants: &'a [f64],
}

impl<'a> Values<'a> {
    /// Of a solution: its own unknowns, or its nodal values where nothing floats.
    pub(super) fn new(u: &'a [f64], split: Option<&'a SplitValues>) -> Self {
        match split {
            Some(split) => Self { w: &split.values, constants: &split.constants },
            None => Self { w: u, constants: &[] },
        }
    }
}

impl<const D: usize> Maker<'_, D> {
    /// The constant `c` of a part.
    fn constant(&self, part: u32, values: &Values<'_>) -> f64 {
        let chain = &self.unknowns.chain[part as usize];
        chain.iter().map(|&(k, sigma)| sigma * values.constants.get(k as usize).copied().unwrap_or(0.0)).sum()
    }

    /// The gradient of the own polynomial at node i.
    pub(super) fn gradient(
        &self,
        i: usize,
        values: &Values<'_>,
        scratch: &mut Scratch<D>,
    ) -> Result<[f64; D], MethodError> {
        self.factor(i, scratch)?;
        Ok(std::array::from_fn(|axis| self.evaluate(Some(axis), values, scratch)))
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
        self.factor(i, scratch)?;
        let Scratch { stencil, fit, combination } = scratch;
        let reference: Vec<f64> = (0..stencil.parts.len())
            .map(|part| {
                let first = stencil.part_of.iter().position(|&p| p == part);
                first.map_or(0.0, |place| u[stencil.nodes[place] as usize])
            })
            .collect();
        let scale = |part: usize| self.unknowns.scale[stencil.parts[part] as usize];
        Ok(std::array::from_fn(|axis| {
            fit.functional(stencil, Some(axis), combination);
            let nodes = stencil.nodes.iter().zip(&stencil.part_of).zip(&combination.values);
            let differences = nodes.map(|((&j, &p), h)| h * (u[j as usize] - reference[p]) / scale(p));
            let constants = combination.constants.iter().zip(&reference).map(|(h, c)| h * c);
            scale(0) * (combination.known + differences.sum::<f64>() + constants.sum::<f64>())
        }))
    }

    /// Value and gradient anywhere.
    fn sample(&self, x: &[f64; D], values: &Values<'_>, scratch: &mut Scratch<D>) -> Option<Sample<D>> {
        let nearest = self.nearest_one(x)?;
        let region = self.problem.regions.label(x, self.problem.cloud.spacing()[nearest]);
        let part = self.unknowns.part[self.nearest_of(region, x)?];
        self.factor_at(x, part, scratch, |_| true).ok()?;
        let value = self.evaluate(None, values, scratch) + self.constant(part, values);
        let gradient = std::array::from_fn(|axis| self.evaluate(Some(axis), values, scratch));
        Some(Sample { value, gradient, region })
    }

    /// Values and gradients at many points.
    pub(super) fn samples(&self, points: &[[f64; D]], values: &Values<'_>) -> Vec<Option<Sample<D>>> {
        points.par_iter().map_init(Scratch::default, |scratch, x| self.sample(x, values, scratch)).collect()
    }

    /// `s` times a functional of the own polynomial of the stencil that was factored last.
    fn evaluate(&self, axis: Option<usize>, values: &Values<'_>, scratch: &mut Scratch<D>) -> f64 {
        let Scratch { stencil, fit, combination } = scratch;
        fit.functional(stencil, axis, combination);
        let nodes = stencil.nodes.iter().zip(&combination.values).map(|(&j, h)| h * values.w[j as usize]);
        let parts = stencil.parts.iter().zip(&combination.constants);
        let constants = parts.map(|(&part, h)| h * self.constant(part, values));
        let scale = self.unknowns.scale[stencil.parts[0] as usize];
        scale * (combination.known + nodes.sum::<f64>() + constants.sum::<f64>())
    }
}
