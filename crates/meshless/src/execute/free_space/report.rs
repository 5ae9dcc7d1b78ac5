//! Figures about a solve in free space.

use meshless_freespace::Kernel;

use super::{Chosen, Source};
use crate::execute::Exact;
use crate::memory::peak_memory_mb;
use crate::norms::ErrorNorms;
use crate::plan::Plan;
use crate::report::{Errors, Estimate, Extrema, Probe, RegionErrors, Report, Seconds, SolverReport};
use crate::scene::Scene;

/// Part of its largest value that a source may have at the edge of its box.
const EDGE: f64 = 1e-10;

/// The least error that is claimed: the round-off of the transforms.
const ROUND_OFF: f64 = 1e-15;

/// What was solved for.
pub(super) struct Solved<'a> {
    pub(super) u: &'a [f64],
    /// Magnitude of the velocity.
    pub(super) speed: Option<&'a [f64]>,
    pub(super) chosen: Chosen,
    pub(super) errors: Option<Errors>,
    pub(super) probes: Vec<Probe>,
}

fn extrema(values: &[f64]) -> Extrema {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    let (min, max) = values.iter().fold(start, |(l, h), &v| (l.min(v), h.max(v)));
    Extrema { min, max, estimate: None }
}

pub(super) fn report<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    source: &Source<D>,
    solved: Solved<'_>,
    seconds: Seconds,
) -> Report {
    let Solved { u, speed, chosen, errors, probes } = solved;
    let (order, name) = match chosen.kernel {
        Kernel::Gaussian { order, smoothing } => {
            (order, format!("fft, Gaussian kernel, sigma = {} h", smoothing.unwrap_or(2.0)))
        }
        Kernel::Spectral => (0, "fft, spectral kernel".to_owned()),
        Kernel::Truncated => (0, "fft, truncated kernel".to_owned()),
    };
    let estimate = match doubt(source, chosen) {
        Some(why) => Estimate { why_not: Some(why), ..Estimate::default() },
        None => Estimate { l2: Some(chosen.error.max(ROUND_OFF)), ..Estimate::default() },
    };
    Report {
        title: scene.title.clone(),
        dimension: D,
        unknowns: u.len(),
        spacing: source.mesh.spacing().into_iter().fold(f64::INFINITY, f64::min),
        method: plan.method.name.as_str().to_owned(),
        order,
        contrast: 1.0,
        effects: plan.effects.iter().map(|e| e.name().to_owned()).collect(),
        skipped: plan.skipped.iter().map(|s| s.what.to_owned()).collect(),
        errors,
        estimate,
        extrema: extrema(u),
        speed: speed.map(extrema),
        solver: SolverReport { name, ..SolverReport::default() },
        seconds,
        peak_memory_mb: peak_memory_mb().unwrap_or(0.0),
        probes,
        ..Report::default()
    }
}

/// What is wrong with the sources, so that the error of the solution is not that of the method.
fn doubt<const D: usize>(source: &Source<D>, chosen: Chosen) -> Option<String> {
    let all = source.vorticity.iter().chain(std::iter::once(&source.values));
    let edge = all.map(|values| source.mesh.edge_ratio(values)).fold(0.0, f64::max);
    if edge > EDGE {
        return Some(format!(
            "the source has {edge:.1e} of its largest value at the edge of the box, and what it has beyond is left out"
        ));
    }
    chosen.gradient.map(|part| {
        format!(
            "the vorticity has a divergence: {part:.1e} of it is a gradient (by the L2 norm of psi), which the curl of no velocity has"
        )
    })
}

/// Norms over all points and over each region.
pub(super) fn errors<const D: usize>(
    scene: &Scene,
    source: &Source<D>,
    u: &[f64],
    gradient: &[[f64; D]],
    exact: &Exact<D>,
) -> Errors {
    let (mut all, mut slope) = (ErrorNorms::default(), ErrorNorms::default());
    let mut regions = vec![[ErrorNorms::default(); 2]; scene.regions.len()];
    let volume = source.mesh.cell_volume();
    for (i, &value) in u.iter().enumerate() {
        let difference: [f64; D] = std::array::from_fn(|a| gradient[i][a] - exact.gradients[i][a]);
        let (of_value, of_slope) = (value - exact.values[i], length(&difference));
        let steepness = length(&exact.gradients[i]);
        all.add(volume, of_value, exact.values[i]);
        slope.add(volume, of_slope, steepness);
        let [in_value, in_slope] = &mut regions[source.labels[i] as usize];
        in_value.add(volume, of_value, exact.values[i]);
        in_slope.add(volume, of_slope, steepness);
    }
    let named = scene.regions.iter().zip(&regions).map(|(region, [value, slope])| {
        let errors = RegionErrors { l2: value.l2(), linf: value.linf(), gradient_linf: slope.linf() };
        (region.name.clone(), errors)
    });
    Errors {
        l2: all.l2(),
        linf: all.linf(),
        gradient_linf: slope.linf(),
        jump_linf: None,
        regions: named.collect(),
    }
}

pub(super) fn length<const D: usize>(x: &[f64; D]) -> f64 {
    x.iter().map(|a| a * a).sum::<f64>().sqrt()
}
