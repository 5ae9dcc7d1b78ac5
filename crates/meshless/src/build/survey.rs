//! What can be told about a scene without a cloud.

use super::corners::AtCorners;
use super::fields::{field, materials};
use super::points::{estimated, file_points};
use super::shapes::{check_level_sets, domain, regions};
use crate::Error;
use crate::scene::{Scene, ShapeSpec};

/// Points along each axis at which a variable diffusivity is sampled.
const SAMPLES_PER_AXIS: [usize; 3] = [257, 65, 17];

/// Whether the boundary is anything but the faces of a box.
pub(crate) fn is_curved(scene: &Scene) -> bool {
    !matches!(scene.domain.shape, ShapeSpec::Box(_)) || !scene.holes.is_empty()
}

/// About how many nodes the cloud will have; refused where they are too many.
pub(crate) fn estimated_nodes(scene: &Scene, method: AtCorners) -> Result<f64, Error> {
    match scene.dimension {
        1 => estimated_nodes_in::<1>(scene, method),
        2 => estimated_nodes_in::<2>(scene, method),
        _ => estimated_nodes_in::<3>(scene, method),
    }
}

fn estimated_nodes_in<const D: usize>(scene: &Scene, method: AtCorners) -> Result<f64, Error> {
    let domain = domain::<D>(scene)?;
    check_level_sets(scene, &domain)?;
    estimated(scene, method, &domain)
}

/// Largest over smallest diffusivity: of the constants where all are constant, else of samples on a lattice.
pub(crate) fn sampled_contrast(scene: &Scene) -> Result<f64, Error> {
    let constants: Option<Vec<f64>> =
        scene.regions.iter().map(|r| r.diffusivity.expr.as_constant()).collect();
    match (constants, scene.dimension) {
        (Some(values), _) => Ok(ratio(values.into_iter())),
        (None, 1) => sampled_contrast_in::<1>(scene),
        (None, 2) => sampled_contrast_in::<2>(scene),
        (None, _) => sampled_contrast_in::<3>(scene),
    }
}

fn sampled_contrast_in<const D: usize>(scene: &Scene) -> Result<f64, Error> {
    let (domain, materials) = (domain::<D>(scene)?, materials::<D>(scene));
    if let (Some(file), true) = (&scene.points.file, scene.is_labelled()) {
        let given = file_points::<D>(scene, file)?;
        let labels = given.labels.unwrap_or_default();
        let all = given.points.iter().zip(&labels);
        let values = all.map(|(x, &label)| materials[label as usize].diffusivity.at(x));
        return Ok(ratio(values.filter(|eta| *eta > 0.0 && eta.is_finite())));
    }
    let regions = regions::<D>(scene)?;
    let (bounds, count) = (domain.bounds(), SAMPLES_PER_AXIS[D - 1]);
    let total = count.pow(D as u32);
    let lengths = bounds.lengths();
    let values = (0..total).filter_map(|index| {
        let x: [f64; D] = std::array::from_fn(|k| {
            let along = (index / count.pow(k as u32)) % count;
            bounds.min[k] + lengths[k] * along as f64 / (count - 1) as f64
        });
        if domain.level(&x) > 0.0 {
            return None;
        }
        let eta = materials[regions.label(&x, 0.0) as usize].diffusivity.at(&x);
        // What is not positive is refused when the nodes are known, with its place in the scene.
        (eta > 0.0 && eta.is_finite()).then_some(eta)
    });
    Ok(ratio(values))
}

/// The largest Péclet number `|v| h / eta` of a cell: of samples on a lattice.
pub(crate) fn sampled_peclet(scene: &Scene) -> Result<f64, Error> {
    match scene.dimension {
        1 => sampled_peclet_in::<1>(scene),
        2 => sampled_peclet_in::<2>(scene),
        _ => sampled_peclet_in::<3>(scene),
    }
}

fn sampled_peclet_in<const D: usize>(scene: &Scene) -> Result<f64, Error> {
    let (domain, materials) = (domain::<D>(scene)?, materials::<D>(scene));
    let regions = if scene.is_labelled() { None } else { Some(regions::<D>(scene)?) };
    let spacing = field::<D>(&scene.points.spacing.expr);
    let (bounds, count) = (domain.bounds(), SAMPLES_PER_AXIS[D - 1]);
    let lengths = bounds.lengths();
    let mut largest = 0.0_f64;
    for index in 0..count.pow(D as u32) {
        let x: [f64; D] = std::array::from_fn(|k| {
            let along = (index / count.pow(k as u32)) % count;
            bounds.min[k] + lengths[k] * along as f64 / (count - 1) as f64
        });
        if domain.level(&x) > 0.0 {
            continue;
        }
        let own = regions.as_ref().map(|regions| regions.label(&x, 0.0) as usize);
        for material in
            materials.iter().enumerate().filter(|(k, _)| own.is_none_or(|own| own == *k)).map(|m| m.1)
        {
            let speed = material.velocity_at(&x).iter().map(|v| v * v).sum::<f64>().sqrt();
            let peclet = speed * spacing.at(&x) / material.diffusivity.at(&x);
            // What is no number is refused when the nodes are known, with its place in the scene.
            largest = if peclet.is_finite() { largest.max(peclet) } else { largest };
        }
    }
    Ok(largest)
}

fn ratio(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    if low.is_finite() && high > 0.0 { high / low } else { 1.0 }
}
