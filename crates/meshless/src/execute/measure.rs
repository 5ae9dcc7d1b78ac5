//! Errors against the exact solution, and values at the probes.

use std::collections::BTreeMap;

use meshless_interfaces::Sample;

use super::Solved;
use super::discrete::Exact;
use super::samples::samples;
use crate::Error;
use crate::norms::ErrorNorms;
use crate::plan::Plan;
use crate::report::{Errors, Probe, RegionErrors};
use crate::scene::Scene;

/// Norms over all nodes and over each region.
pub(super) fn errors<const D: usize>(
    scene: &Scene,
    solved: &Solved<D>,
    exact: &Exact<D>,
    gradient: &[[f64; D]],
) -> Errors {
    let discrete = &solved.discrete;
    let volumes = discrete.measures();
    let (mut all, mut slope) = (ErrorNorms::default(), ErrorNorms::default());
    let mut regions = vec![[ErrorNorms::default(); 2]; scene.regions.len()];
    for (i, &u) in solved.system.u.iter().enumerate() {
        let error = u - exact.values[i];
        all.add(volumes[i], error, exact.values[i]);
        let difference: [f64; D] = std::array::from_fn(|k| gradient[i][k] - exact.gradients[i][k]);
        slope.add(volumes[i], norm(&difference), norm(&exact.gradients[i]));
        let [value, gradient] = &mut regions[discrete.labels[i] as usize];
        value.add(volumes[i], error, exact.values[i]);
        gradient.add(volumes[i], norm(&difference), norm(&exact.gradients[i]));
    }
    let regions: BTreeMap<String, RegionErrors> = scene
        .regions
        .iter()
        .zip(&regions)
        .map(|(region, [value, gradient])| {
            let errors = RegionErrors { l2: value.l2(), linf: value.linf(), gradient_linf: gradient.linf() };
            (region.name.clone(), errors)
        })
        .collect();
    let jump_linf = jumps(scene, solved);
    Errors { l2: all.l2(), linf: all.linf(), gradient_linf: slope.linf(), jump_linf, regions }
}

/// Largest error of the jumps of the slope that are unknowns, relative to the largest jump of the exact solution.
fn jumps<const D: usize>(scene: &Scene, solved: &Solved<D>) -> Option<f64> {
    let points = &solved.discretization.interface_points;
    let mut norms = ErrorNorms::default();
    for (point, found) in points.iter().zip(&solved.system.extra) {
        let slope = |region: u16| -> Option<f64> {
            let exact = &scene.regions[region as usize].exact.as_ref()?.expr;
            Some((0..D).map(|k| point.normal[k] * exact.derivative(k).eval(&point.at)).sum())
        };
        let exact = slope(point.between[1])? - slope(point.between[0])?;
        norms.add(1.0, found - exact, exact);
    }
    (!points.is_empty()).then(|| norms.linf())
}

/// Where u is determined only up to a constant: gives it the mean of the exact solution.
pub(super) fn match_means<const D: usize>(solved: &mut Solved<D>, exact: &Exact<D>) {
    let volumes = &solved.discretization.volumes;
    let difference =
        solved.system.u.iter().zip(&exact.values).zip(volumes).map(|((u, e), v)| v * (e - u)).sum::<f64>();
    let shift = difference / volumes.iter().sum::<f64>();
    solved.system.u.iter_mut().for_each(|u| *u += shift);
}

/// Values at the probes; a probe outside of the domain has none.
pub(super) fn probes<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    solved: &Solved<D>,
) -> Result<Vec<Probe>, Error> {
    if scene.probes.is_empty() {
        return Ok(Vec::new());
    }
    let problem = solved.discrete.problem();
    let places: Vec<[f64; D]> = scene.probes.iter().map(|probe| std::array::from_fn(|k| probe[k])).collect();
    let values = samples(&plan.method.params, &problem, &solved.system, &places)?;
    let tolerance = 1e-9 * problem.domain.bounds().diameter();
    let value = |(at, sample): (&[f64; D], Option<Sample<D>>)| {
        let inside = problem.domain.contains(at, tolerance);
        Probe { at: at.to_vec(), value: sample.filter(|_| inside).map(|s| s.value), ..Probe::default() }
    };
    Ok(places.iter().zip(values).map(value).collect())
}

fn norm<const D: usize>(x: &[f64; D]) -> f64 {
    x.iter().map(|a| a * a).sum::<f64>().sqrt()
}
