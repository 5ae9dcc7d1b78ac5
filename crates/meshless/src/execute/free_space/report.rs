//! Figures about a solve in free space.

use meshless_freespace::{Gaussian, Kernel, Radial, Spectral};
use rayon::prelude::*;

use super::{Chosen, Source};
use crate::Error;
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

/// Points whose contributions to a probe are added up together.
const BLOCK: usize = 4096;

pub(super) fn report<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    source: &Source<D>,
    u: &[f64],
    chosen: Chosen,
    errors: Option<Errors>,
    seconds: Seconds,
    probes: Vec<Probe>,
) -> Report {
    let (min, max) = u.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    let (order, name) = match chosen.kernel {
        Kernel::Gaussian { order, smoothing } => {
            (order, format!("fft, Gaussian kernel, sigma = {} h", smoothing.unwrap_or(2.0)))
        }
        Kernel::Spectral => (0, "fft, spectral kernel".to_owned()),
        Kernel::Truncated => (0, "fft, truncated kernel".to_owned()),
    };
    let edge = source.mesh.edge_ratio(&source.values);
    let estimate = if edge > EDGE {
        let why = format!(
            "the source has {edge:.1e} of its largest value at the edge of the box, and what it has beyond is left out"
        );
        Estimate { l2: None, why_not: Some(why) }
    } else {
        Estimate { l2: Some(chosen.error.max(ROUND_OFF)), why_not: None }
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
        extrema: Extrema { min, max },
        solver: SolverReport { name, ..SolverReport::default() },
        seconds,
        peak_memory_mb: peak_memory_mb().unwrap_or(0.0),
        probes,
        ..Report::default()
    }
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

fn length<const D: usize>(x: &[f64; D]) -> f64 {
    x.iter().map(|a| a * a).sum::<f64>().sqrt()
}

/// Values at the probes, by the sum over all points that defines the field: as accurate between the points of the mesh as at
/// them, and outside of the box, too.
pub(super) fn probes<const D: usize>(
    scene: &Scene,
    source: &Source<D>,
    kernel: Kernel,
) -> Result<Vec<Probe>, Error> {
    let coarsest = source.mesh.spacing().into_iter().fold(0.0, f64::max);
    let kernel: Box<dyn Radial> = match kernel {
        Kernel::Gaussian { order, smoothing } => {
            Box::new(Gaussian::<D>::new(order, smoothing.unwrap_or(2.0) * coarsest)?)
        }
        // Where the mesh resolves the source, the two are the same.
        Kernel::Spectral | Kernel::Truncated => {
            Box::new(Spectral::<D>::new(coarsest / std::f64::consts::PI)?)
        }
    };
    let sum = |at: &[f64; D]| -> f64 {
        let blocks = source.points.par_chunks(BLOCK).zip(source.values.par_chunks(BLOCK));
        // Blocks of fixed size, added up in their order: the number of threads does not show.
        let parts: Vec<f64> = blocks
            .map(|(points, values)| {
                let pairs = points.iter().zip(values).filter(|(_, f)| **f != 0.0);
                pairs
                    .map(|(p, f)| f * kernel.value(length::<D>(&std::array::from_fn(|a| p[a] - at[a]))))
                    .sum()
            })
            .collect();
        parts.iter().sum::<f64>() * source.mesh.cell_volume()
    };
    let probe = |at: &Vec<f64>| Probe { at: at.clone(), value: Some(sum(&std::array::from_fn(|a| at[a]))) };
    Ok(scene.probes.iter().map(probe).collect())
}
