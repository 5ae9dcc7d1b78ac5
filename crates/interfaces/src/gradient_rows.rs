//! Gradients at the nodes as combinations of the unknowns, kept from the fits that made the rows.

use crate::SystemSolution;

/// The gradient at one node: what is known of it, and factors of the unknowns of a method.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GradientRow {
    /// Nodes whose `w` counts.
    pub nodes: Vec<u32>,
    /// Their factors, all of one axis after those of the one before.
    pub factors: Vec<f64>,
    /// Factors of constants: axis, constant, factor.
    pub constants: Vec<(usize, u32, f64)>,
    /// What the data add, one an axis.
    pub known: Vec<f64>,
}

impl GradientRow {
    /// The gradient of a solution, in its own unknowns `w` and `C` where it has them.
    pub fn of<const D: usize>(&self, solution: &SystemSolution) -> [f64; D] {
        let (w, constants) = match &solution.split {
            Some(split) => (&split.values, split.constants.as_slice()),
            None => (&solution.u, &[][..]),
        };
        std::array::from_fn(|axis| {
            let factors = self.factors.chunks_exact(self.nodes.len().max(1)).nth(axis).unwrap_or_default();
            let nodes = self.nodes.iter().zip(factors).map(|(&j, h)| h * w[j as usize]);
            let of_axis = self.constants.iter().filter(|(of, ..)| *of == axis);
            let constants = of_axis.map(|&(_, k, h)| h * constants.get(k as usize).copied().unwrap_or(0.0));
            self.known.get(axis).copied().unwrap_or(0.0) + nodes.sum::<f64>() + constants.sum::<f64>()
        })
    }
}
