//! Layers and gaps that the nodes do not resolve, or do not see.
//!
//! A layer is *seen* where no two neighbouring nodes lie on both sides of it, and *resolved* where it is [`RESOLVED`] spacings
//! thick. No method is right about a layer that is not seen, but the fits of the sharp method, which reach farther than to the next
//! node: they need a node of the layer between nodes of one region only, and want it resolved.

use meshless_geometry::ThinLayer;
use meshless_neighbors::CellList;

use crate::{MethodError, Problem, RegionName, adjacent_pairs};

/// Layers and gaps that nodes of a spacing resolve, in units of the spacing. With films of 2 spacings solutions that are
/// polynomials in every region are exact to round-off at the orders 4 to 8; with those of 1 some clouds leave out nodes
/// that the fits need, with those of 0.4 all do.
pub const RESOLVED: f64 = 2.0;

/// How near to the middle of a layer nodes are that may see through it, in spacings.
const NEAR: f64 = 1.5;

/// Points of the way between two neighbouring nodes at which it is asked what lies there: so many to the thickness of the
/// layer, and so many at most; how often the ends of what is found are halved.
const SAMPLES: f64 = 3.0;
const MOST_SAMPLES: f64 = 1e4;
const HALVINGS: usize = 20;

/// Largest cosine of the angle between the normals where a way enters and leaves a layer: a way that cuts off a corner leads
/// from one side to the next.
const OPPOSITE: f64 = -0.5;

/// Thickness in spacings below which a layer is the reason why a system is not solved.
const NONE_INSIDE: f64 = 1.0;

/// # Errors
/// [`MethodError::ThinLayer`] where two neighbouring nodes of one region lie on both sides of a layer: its region would be
/// taken for connected across, and a fit to both sides by one polynomial would not see the layer.
pub(crate) fn check<const D: usize>(problem: &Problem<'_, D>) -> Result<(), MethodError> {
    between(problem, &|i, j| problem.labels[i] == problem.labels[j])?
        .map_or(Ok(()), |layer| Err(unresolved(&layer)))
}

/// A layer that two neighbouring nodes lie on both sides of, where there is one: methods that look no farther than to the next
/// node do not see that the layer parts them, and a coarser cloud does not tell.
///
/// # Errors
/// Those of [`CellList::new`].
pub fn unseen<const D: usize>(problem: &Problem<'_, D>) -> Result<Option<ThinLayer<D>>, MethodError> {
    between(problem, &|_, _| true)
}

/// A layer between two neighbouring nodes, of those that count.
fn between<const D: usize>(
    problem: &Problem<'_, D>,
    counts: &dyn Fn(usize, usize) -> bool,
) -> Result<Option<ThinLayer<D>>, MethodError> {
    let layers = layers(problem);
    if layers.is_empty() {
        return Ok(None);
    }
    let middles: Vec<[f64; D]> = layers.iter().map(|layer| layer.at).collect();
    let widest = problem.cloud.spacing().iter().fold(0.0_f64, |a, &b| a.max(b));
    let index = CellList::new(&middles, NEAR * widest)?;
    let mut near = Vec::new();
    for (i, j) in adjacent_pairs(problem.cloud.points(), problem.supports.lists) {
        let (i, j) = (i as usize, j as usize);
        if !counts(i, j) {
            continue;
        }
        near.clear();
        index.within(&problem.cloud.points()[i], NEAR * problem.cloud.spacing()[i], &mut near);
        let parts = |l: &&ThinLayer<D>| [i, j].iter().all(|&k| problem.labels[k] != l.region);
        let near = near.iter().map(|&k| &layers[k as usize]).filter(parts);
        if let Some(layer) = near.min_by(|a, b| a.thickness.total_cmp(&b.thickness))
            && sees_through(problem, (i, j), layer)
        {
            return Ok(Some(*layer));
        }
    }
    Ok(None)
}

/// Whether the way between two nodes leads through a layer, in by one of its sides and out by the opposite one.
fn sees_through<const D: usize>(
    problem: &Problem<'_, D>,
    (i, j): (usize, usize),
    layer: &ThinLayer<D>,
) -> bool {
    let (x, y) = (&problem.cloud.points()[i], &problem.cloud.points()[j]);
    let distance = (0..D).map(|k| (y[k] - x[k]).powi(2)).sum::<f64>().sqrt();
    let samples = (SAMPLES * distance / layer.thickness).ceil().clamp(2.0, MOST_SAMPLES) as usize;
    let at = |t: f64| -> [f64; D] { std::array::from_fn(|d| x[d] + t * (y[d] - x[d])) };
    let inside = |t: f64| problem.regions.label(&at(t), 0.0) == layer.region;
    let along = |k: usize| k as f64 / samples as f64;
    let Some(first) = (1..samples).find(|&k| inside(along(k))) else { return false };
    let last = (first + 1..=samples).find(|&k| !inside(along(k))).unwrap_or(samples);
    let end = |mut within: f64, mut beyond: f64| {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (within + beyond);
            *(if inside(middle) { &mut within } else { &mut beyond }) = middle;
        }
        at(beyond)
    };
    let normal = |(outside, point): (u16, &[f64; D])| {
        let reach = layer.thickness.min(0.1 * distance);
        problem.regions.project(outside, layer.region, point, reach).ok().map(|p| p.normal)
    };
    let ends = [end(along(first), along(first - 1)), end(along(last - 1), along(last))];
    let [Some(enters), Some(leaves)] =
        [(i, &ends[0]), (j, &ends[1])].map(|(k, end)| normal((problem.labels[k], end)))
    else {
        return false;
    };
    (0..D).map(|k| enters[k] * leaves[k]).sum::<f64>() < OPPOSITE
}

/// The layer, gap or inclusion that is thinnest in units of the spacing, where one is thinner than fits want it: the solution
/// is less accurate there.
pub fn thinnest<const D: usize>(problem: &Problem<'_, D>) -> Option<ThinLayer<D>> {
    let relative = |layer: &ThinLayer<D>| layer.thickness / layer.spacing;
    layers(problem).into_iter().min_by(|a, b| relative(a).total_cmp(&relative(b)))
}

fn layers<const D: usize>(problem: &Problem<'_, D>) -> Vec<ThinLayer<D>> {
    problem.regions.thin_layers(problem.cloud, problem.domain, RESOLVED)
}

/// The layer that no node needs to lie in, where there is one: what a system that is not solved may suffer from.
pub fn suspect<const D: usize>(problem: &Problem<'_, D>) -> Option<ThinLayer<D>> {
    thinnest(problem).filter(|layer| layer.thickness < NONE_INSIDE * layer.spacing)
}

/// The error where a layer keeps a problem from being solved.
pub fn unresolved<const D: usize>(layer: &ThinLayer<D>) -> MethodError {
    MethodError::ThinLayer {
        region: RegionName::Place(layer.region),
        position: layer.at.to_vec(),
        thickness: layer.thickness,
        spacing: resolving_spacing(layer),
    }
}

/// The spacing that resolves a layer.
pub fn resolving_spacing<const D: usize>(layer: &ThinLayer<D>) -> f64 {
    layer.thickness / RESOLVED
}
