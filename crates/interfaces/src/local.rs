//! The least-squares fit over the support of a node, as the methods of this crate use it.

use meshless_stencils::{FitParams, FitScratch, Functional, LocalFit, StencilError, Weight};

use crate::Problem;

/// Fits of one degree and one weight, over supports that include their own node.
pub(crate) struct NodeFit<const D: usize> {
    fit: LocalFit<D>,
    weight: Weight,
}

/// Memory of one thread.
pub(crate) struct NodeScratch<const D: usize> {
    fit: FitScratch<D>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
}

impl<const D: usize> NodeFit<D> {
    pub(crate) fn new(degree: usize, weight: Weight) -> Self {
        Self { fit: LocalFit::new(FitParams { degree, ..FitParams::default() }), weight }
    }

    pub(crate) fn scratch(&self, max_neighbors: usize) -> NodeScratch<D> {
        NodeScratch {
            fit: self.fit.scratch(max_neighbors + 1),
            offsets: Vec::with_capacity(max_neighbors + 1),
            weights: Vec::with_capacity(max_neighbors + 1),
            coefficients: Vec::with_capacity(max_neighbors + 1),
        }
    }

    /// Factors the fit at node i over `neighbors`; the node itself comes first, then its neighbours in their order.
    pub(crate) fn factor(
        &self,
        problem: &Problem<'_, D>,
        i: usize,
        neighbors: &[u32],
        scratch: &mut NodeScratch<D>,
    ) -> Result<(), StencilError> {
        let (points, radius) = (problem.cloud.points(), problem.supports.radius);
        scratch.offsets.clear();
        scratch.weights.clear();
        scratch.offsets.push([0.0; D]);
        scratch.weights.push(self.weight.value(0.0, radius[i], radius[i]));
        let mut reach = radius[i];
        for &j in neighbors {
            let j = j as usize;
            let offset: [f64; D] = std::array::from_fn(|k| points[j][k] - points[i][k]);
            let distance = offset.iter().map(|x| x * x).sum::<f64>().sqrt();
            scratch.offsets.push(offset);
            scratch.weights.push(self.weight.value(distance, radius[i], radius[j]));
            reach = reach.max(distance);
        }
        // An enlarged support may be longer than all others.
        scratch.coefficients.resize(scratch.offsets.len(), 0.0);
        self.fit.factor(&scratch.offsets, &scratch.weights, reach, &mut scratch.fit)?;
        Ok(())
    }

    /// Coefficients of an operator on the values of the neighbours; that of the node itself is minus their sum
    /// for every operator that annihilates constants.
    pub(crate) fn coefficients(
        &self,
        functional: &Functional<D>,
        scratch: &mut NodeScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        let count = scratch.offsets.len();
        self.fit.coefficients(functional, &mut scratch.fit, &mut scratch.coefficients[..count])?;
        out.copy_from_slice(&scratch.coefficients[1..count]);
        Ok(())
    }

    /// Condition of the fit at node i, and how exactly it reproduces the Laplacian of polynomials.
    pub(crate) fn quality(
        &self,
        problem: &Problem<'_, D>,
        i: usize,
        scratch: &mut NodeScratch<D>,
    ) -> Result<(f64, f64), StencilError> {
        self.factor(problem, i, problem.supports.lists.of(i), scratch)?;
        let NodeScratch { fit, offsets, coefficients, .. } = scratch;
        let coefficients = &mut coefficients[..offsets.len()];
        self.fit.coefficients(&Functional::Laplacian, fit, coefficients)?;
        let diagnosis = self.fit.diagnose(&Functional::Laplacian, offsets, 0, coefficients, fit)?;
        Ok((diagnosis.condition, diagnosis.residual))
    }

    /// The correction vector of Kraus et al. (2022), (18), on the neighbours; it is 1 at the node itself.
    pub(crate) fn correction(
        &self,
        scratch: &mut NodeScratch<D>,
        out: &mut [f64],
    ) -> Result<(), StencilError> {
        let count = scratch.offsets.len();
        self.fit.correction(0, &mut scratch.fit, &mut scratch.coefficients[..count])?;
        out.copy_from_slice(&scratch.coefficients[1..count]);
        Ok(())
    }
}

/// The neighbours of the neighbours of i, and its neighbours: the support to fall back on.
pub(crate) fn enlarged_support<const D: usize>(problem: &Problem<'_, D>, i: usize) -> Vec<u32> {
    let lists = problem.supports.lists;
    let mut all: Vec<u32> = lists.of(i).to_vec();
    for &j in lists.of(i) {
        all.extend_from_slice(lists.of(j as usize));
    }
    all.sort_unstable();
    all.dedup();
    all.retain(|&j| j as usize != i);
    all
}
