//! Values and gradients of a solution anywhere.

use meshless_interfaces::{Problem, Sample, Sampler, SystemSolution};
use rayon::prelude::*;

use crate::Error;
use crate::plan::MethodParams;

/// By the method's own polynomials, or by fits of second degree to the nodes of one region.
pub(super) fn samples<const D: usize>(
    method: &MethodParams,
    problem: &Problem<'_, D>,
    system: &SystemSolution,
    places: &[[f64; D]],
) -> Result<Vec<Option<Sample<D>>>, Error> {
    match method.build().samples(problem, system, places)? {
        Some(samples) => Ok(samples),
        None => by_fits(&Sampler::new(problem, &system.u)?, places),
    }
}

/// By fits to nodal values.
pub(super) fn by_fits<const D: usize>(
    sampler: &Sampler<'_, D>,
    places: &[[f64; D]],
) -> Result<Vec<Option<Sample<D>>>, Error> {
    let at = |scratch: &mut _, x: &[f64; D]| sampler.at(x, scratch);
    Ok(places.par_iter().map_init(|| sampler.scratch(), at).collect())
}
