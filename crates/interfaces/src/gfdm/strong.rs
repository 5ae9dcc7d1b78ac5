//! The strong-form operator: collocation of the equation by least-squares stencils (Kraus et al. 2022, section 2.2.1).

use meshless_stencils::{Functional, Weight};

use crate::gfdm::StrongParams;
use crate::gfdm::diffusivity::StrongDiffusivity;
use crate::local::{NodeFit, NodeScratch};
use crate::operator_rows::OperatorRows;
use crate::{MethodError, Problem};

/// Coefficients `gamma_ij` of `div(eta grad u) - velocity . grad u` at the nodes for which `wanted` holds; `gamma_ii = -sum gamma_ij`.
pub(super) fn compute<const D: usize>(
    problem: &Problem<'_, D>,
    params: &StrongParams,
    wanted: &[bool],
) -> Result<OperatorRows, MethodError> {
    let operator = StrongOperator::new(problem, params);
    OperatorRows::compute(
        problem,
        |i| wanted[i],
        || operator.scratch(problem.supports.lists.max_count()),
        |i, neighbors, scratch, out| operator.row(i, neighbors, scratch, out),
    )
}

struct StrongOperator<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    fit: NodeFit<D>,
    diffusivity: Option<StrongDiffusivity>,
    correction: bool,
}

struct StrongScratch<const D: usize> {
    node: NodeScratch<D>,
    partials: [Vec<f64>; D],
    correction: Vec<f64>,
}

impl<'a, const D: usize> StrongOperator<'a, D> {
    fn new(problem: &'a Problem<'a, D>, params: &StrongParams) -> Self {
        Self {
            problem,
            fit: NodeFit::new(params.degree, Weight::Exponential),
            diffusivity: StrongDiffusivity::new(problem, params),
            correction: params.correction,
        }
    }

    fn scratch(&self, max_neighbors: usize) -> StrongScratch<D> {
        StrongScratch {
            node: self.fit.scratch(max_neighbors),
            partials: std::array::from_fn(|_| vec![0.0; max_neighbors]),
            correction: vec![0.0; max_neighbors],
        }
    }

    fn row(
        &self,
        i: usize,
        neighbors: &[u32],
        scratch: &mut StrongScratch<D>,
        out: &mut [f64],
    ) -> Result<(), MethodError> {
        let located = |source| MethodError::stencil(i, &self.problem.cloud.points()[i], source);
        self.fit.factor(self.problem, i, neighbors, &mut scratch.node).map_err(located)?;
        let mut functional = match &self.diffusivity {
            Some(diffusivity) if diffusivity.varies(i, neighbors) => {
                for k in 0..D {
                    scratch.partials[k].resize(neighbors.len(), 0.0);
                    self.fit
                        .coefficients(&Functional::Partial(k), &mut scratch.node, &mut scratch.partials[k])
                        .map_err(located)?;
                }
                let (eta, gradient) = diffusivity.at(i, neighbors, &scratch.partials);
                Functional::Diffusion { eta, gradient }
            }
            Some(diffusivity) => Functional::Diffusion { eta: diffusivity.value(i), gradient: [0.0; D] },
            None => Functional::Diffusion { eta: self.problem.eta[i], gradient: [0.0; D] },
        };
        if let Functional::Diffusion { gradient, .. } = &mut functional {
            let velocity = self.problem.velocity(i);
            gradient.iter_mut().zip(velocity).for_each(|(g, v)| *g -= v);
        }
        self.fit.coefficients(&functional, &mut scratch.node, out).map_err(located)?;
        if self.correction {
            scratch.correction.resize(neighbors.len(), 0.0);
            self.fit.correction(&mut scratch.node, &mut scratch.correction).map_err(located)?;
            add_correction(out, &scratch.correction);
        }
        Ok(())
    }
}

/// Adds `alpha_min xi` (18) to a row; both are given off the diagonal, where `gamma_ii = -sum gamma_ij` and `xi_ii = 1`.
pub(crate) fn add_correction(row: &mut [f64], xi: &[f64]) {
    let diagonal = -row.iter().sum::<f64>();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mixed = diagonal + dot(row, xi);
    let own = diagonal * diagonal + dot(row, row);
    let null = 1.0 + dot(xi, xi);
    let denominator = mixed - diagonal * null;
    if denominator == 0.0 {
        return;
    }
    let alpha = (diagonal * mixed - own) / denominator;
    if diagonal + alpha < 0.0 {
        row.iter_mut().zip(xi).for_each(|(c, x)| *c += alpha * x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_correction_minimises_the_row_relative_to_its_diagonal() {
        let row = [1.0, 1.0, 1.0, -0.2];
        let xi = [-0.4, -0.4, -0.3, 0.1];
        let ratio = |alpha: f64| {
            let diagonal = -row.iter().sum::<f64>() + alpha;
            row.iter().zip(xi).map(|(c, x)| (c + alpha * x).powi(2)).sum::<f64>() / diagonal.powi(2)
        };
        let mut corrected = row;
        add_correction(&mut corrected, &xi);
        let alpha = (corrected[0] - row[0]) / xi[0];
        assert!(ratio(alpha) <= ratio(alpha + 1e-3) && ratio(alpha) <= ratio(alpha - 1e-3));
    }

    /// The only stationary point has a positive diagonal here: the ratio falls towards the null vector alone.
    #[test]
    fn a_correction_that_would_turn_the_diagonal_over_is_left_out() {
        let row = [3.0, -1.0, 2.0, 0.5];
        let mut corrected = row;
        add_correction(&mut corrected, &[-0.4, -0.2, -0.3, -0.1]);
        assert_eq!(corrected, row);
    }
}
