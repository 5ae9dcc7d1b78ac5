//! The strong-form operator: collocation of the equation by least-squares stencils (Kraus et al. 2022, section 2.2.1).

use std::collections::BTreeMap;
use std::sync::Mutex;

use meshless_stencils::{Functional, Weight};

use crate::gfdm::StrongParams;
use crate::gfdm::diffusivity::StrongDiffusivity;
use crate::local::{NodeFit, NodeScratch, enlarged_support};
use crate::support_values::SupportValues;
use crate::{MethodError, Problem};

/// Coefficients `gamma_ij` of `div(eta grad u)` at every node of a set, and `gamma_ii = -sum gamma_ij`.
pub(super) struct StrongRows {
    values: SupportValues,
    enlarged: BTreeMap<u32, (Vec<u32>, Vec<f64>)>,
}

impl StrongRows {
    /// Computes the rows of the nodes for which `wanted` holds; the others stay zero.
    pub(super) fn compute<const D: usize>(
        problem: &Problem<'_, D>,
        params: &StrongParams,
        wanted: &[bool],
    ) -> Result<Self, MethodError> {
        let operator = StrongOperator::new(problem, params);
        let most = problem.supports.lists.max_count();
        let enlarged = Mutex::new(BTreeMap::new());
        let values = SupportValues::compute(
            problem.supports.lists,
            || operator.scratch(most),
            |scratch, i, out| {
                if !wanted[i] {
                    return Ok(());
                }
                let neighbors = problem.supports.lists.of(i);
                if operator.row(i, neighbors, scratch, out).is_ok() {
                    return Ok(());
                }
                let (neighbors, row) = operator.enlarged_row(i)?;
                enlarged
                    .lock()
                    .unwrap_or_else(std::sync::PoisonError::into_inner)
                    .insert(i as u32, (neighbors, row));
                Ok::<(), MethodError>(())
            },
        )?;
        Ok(Self {
            values,
            enlarged: enlarged.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner),
        })
    }

    /// Neighbours and coefficients of node i.
    pub(super) fn row<'a, const D: usize>(
        &'a self,
        problem: &Problem<'a, D>,
        i: usize,
    ) -> (&'a [u32], &'a [f64]) {
        match self.enlarged.get(&(i as u32)) {
            Some((neighbors, row)) => (neighbors, row),
            None => (problem.supports.lists.of(i), self.values.of(i)),
        }
    }

    /// Stencils that needed a larger support.
    pub(super) fn enlarged(&self) -> usize {
        self.enlarged.len()
    }
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

    fn enlarged_row(&self, i: usize) -> Result<(Vec<u32>, Vec<f64>), MethodError> {
        let neighbors = enlarged_support(self.problem, i);
        let mut row = vec![0.0; neighbors.len()];
        self.row(i, &neighbors, &mut self.scratch(neighbors.len()), &mut row)?;
        Ok((neighbors, row))
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
        let functional = match &self.diffusivity {
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
