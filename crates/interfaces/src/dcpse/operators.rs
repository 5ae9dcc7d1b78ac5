//! DC-PSE operators at all nodes: of `div(eta grad u)` with the diffusivity of the node's own region, or any others.

use meshless_stencils::{FitParams, FitScratch, Functional, LocalFit};

use super::foot;
use crate::operator_rows::OperatorRows;
use crate::{MethodError, Problem};

/// Width of the kernel relative to the radius of the support.
const KERNEL_WIDTH: f64 = 0.5;

/// Operators `functional(i)` of a degree at the nodes for which `wanted` holds. A coefficient is zero where `sees(i, j)`
/// does not hold: such a neighbour takes no part.
pub(super) fn compute<const D: usize>(
    problem: &Problem<'_, D>,
    degree: usize,
    functional: impl Fn(usize) -> Functional<D> + Sync,
    wanted: impl Fn(usize) -> bool + Sync,
    sees: impl Fn(usize, usize) -> bool + Sync,
) -> Result<OperatorRows, MethodError> {
    let fit = LocalFit::<D>::new(FitParams { degree, through_centre: true, ..FitParams::default() });
    let operator = Operator { problem, fit, functional, sees };
    OperatorRows::compute(
        problem,
        wanted,
        || operator.scratch(),
        |i, neighbors, scratch, out| operator.row(i, neighbors, scratch, out),
    )
}

/// `div(eta grad u)` at a node, with the diffusivity of its own region.
pub(super) fn diffusion<const D: usize>(problem: &Problem<'_, D>, i: usize) -> Functional<D> {
    let material = &problem.materials[problem.labels[i] as usize];
    let (x, spacing) = (&problem.cloud.points()[i], problem.cloud.spacing()[i]);
    Functional::Diffusion { eta: problem.eta[i], gradient: foot::gradient(&material.diffusivity, x, spacing) }
}

struct Operator<'a, const D: usize, F, S> {
    problem: &'a Problem<'a, D>,
    fit: LocalFit<D>,
    functional: F,
    sees: S,
}

/// Memory of one thread.
struct Scratch<const D: usize> {
    fit: FitScratch<D>,
    places: Vec<usize>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
}

impl<const D: usize, F, S> Operator<'_, D, F, S>
where
    F: Fn(usize) -> Functional<D> + Sync,
    S: Fn(usize, usize) -> bool + Sync,
{
    fn scratch(&self) -> Scratch<D> {
        let most = self.problem.supports.lists.max_count();
        Scratch {
            fit: self.fit.scratch(most),
            places: Vec::with_capacity(most),
            offsets: Vec::with_capacity(most),
            weights: Vec::with_capacity(most),
            coefficients: Vec::with_capacity(most),
        }
    }

    fn row(
        &self,
        i: usize,
        neighbors: &[u32],
        scratch: &mut Scratch<D>,
        out: &mut [f64],
    ) -> Result<(), MethodError> {
        let points = self.problem.cloud.points();
        let Scratch { fit, places, offsets, weights, coefficients } = scratch;
        places.clear();
        offsets.clear();
        weights.clear();
        places.extend((0..neighbors.len()).filter(|&k| (self.sees)(i, neighbors[k] as usize)));
        let width = KERNEL_WIDTH * self.problem.supports.radius[i];
        let mut reach = 0.0_f64;
        for &place in places.iter() {
            let x = &points[neighbors[place] as usize];
            let offset: [f64; D] = std::array::from_fn(|k| x[k] - points[i][k]);
            let squared = offset.iter().map(|c| c * c).sum::<f64>();
            offsets.push(offset);
            weights.push((-0.5 * squared / (width * width)).exp());
            reach = reach.max(squared.sqrt());
        }
        let reach = if reach > 0.0 { reach } else { width };
        coefficients.clear();
        coefficients.resize(places.len(), 0.0);
        self.fit
            .factor(offsets, weights, reach, fit)
            .and_then(|_| self.fit.coefficients(&(self.functional)(i), fit, coefficients))
            .map_err(|source| MethodError::stencil(i, &points[i], source))?;
        places.iter().zip(coefficients).for_each(|(&place, c)| out[place] = *c);
        Ok(())
    }
}
