//! Gradients at the nodes from the fits that made the rows.

use super::maker::{Maker, Scratch};
use crate::MethodError;

impl<const D: usize> Maker<'_, D> {
    /// The gradient of the own polynomial at node i, for nodal values u.
    ///
    /// A fit does not change when a part's constant moves from `c` to `w`. So the value at one node of every part
    /// serves as its constant here, and only differences from it are scaled.
    pub(super) fn gradient(
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
        let mut gradient = [0.0; D];
        for (axis, component) in gradient.iter_mut().enumerate() {
            fit.functional(stencil, Some(axis), combination);
            let values = stencil.nodes.iter().zip(&stencil.part_of).zip(&combination.values);
            let mut sum = combination.known;
            for ((&j, &part), h) in values {
                sum += h * (u[j as usize] - reference[part]) / scale(part);
            }
            sum += combination.constants.iter().zip(&reference).map(|(h, c)| h * c).sum::<f64>();
            *component = scale(0) * sum;
        }
        Ok(gradient)
    }
}
