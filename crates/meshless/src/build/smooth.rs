//! Whether the diffusivity of a region jumps within it, where no interface tells methods so.

use meshless_geometry::{Cloud, RegionMap};
use meshless_interfaces::Material;
use meshless_neighbors::NeighborLists;
use rayon::prelude::*;

use crate::Error;
use crate::scene::Scene;

/// Ratio of the diffusivities of two neighbours, as a logarithm, from which on it is asked whether it is a jump: 5 %.
const LEAST: f64 = 0.05;

/// Distance of neighbours that are looked at, in spacings: those next to each other.
const NEXT: f64 = 1.5;

/// How often the way between two neighbours is halved, towards the larger change, and the share of the change that is still
/// there in the end where it jumps.
const HALVINGS: usize = 30;
const SHARE: f64 = 0.5;

/// A jump between two neighbours.
struct Jump<const D: usize> {
    region: u16,
    at: [f64; D],
    from: f64,
    to: f64,
}

/// The diffusivity may vary within a region, but not jump: an interface is between regions.
pub(crate) fn check_diffusivity_is_smooth<const D: usize>(
    scene: &Scene,
    materials: &[Material<D>],
    regions: &RegionMap<D>,
    cloud: &Cloud<D>,
    labels: &[u16],
    lists: &NeighborLists,
    eta: &[f64],
) -> Result<(), Error> {
    if materials.iter().all(|m| m.diffusivity.as_constant().is_some()) {
        return Ok(());
    }
    let points = cloud.points();
    let jump = |i: usize, j: usize| {
        let (x, y) = (&points[i], &points[j]);
        let squared = (0..D).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>();
        let change = (eta[j] / eta[i]).ln();
        let looked_at = j > i && labels[i] == labels[j] && squared <= (NEXT * cloud.spacing()[i]).powi(2);
        if !looked_at || change.abs() < LEAST {
            return None;
        }
        let field = &materials[labels[i] as usize].diffusivity;
        let ((mut a, mut from), (mut b, mut to)) = ((*x, eta[i]), (*y, eta[j]));
        for _ in 0..HALVINGS {
            let middle: [f64; D] = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
            let value = field.at(&middle);
            if (value / from).ln().abs() > (to / value).ln().abs() {
                (b, to) = (middle, value);
            } else {
                (a, from) = (middle, value);
            }
            let left = (to / from).ln().abs();
            // It is no number between the parts of a region, which the expression is not for.
            if left.is_nan() || left < SHARE * change.abs() {
                return None;
            }
        }
        (regions.label(&a, 0.0) == labels[i]).then_some(Jump { region: labels[i], at: a, from, to })
    };
    let of_node = |i: usize| lists.of(i).iter().find_map(|&j| jump(i, j as usize));
    let Some(Jump { region, at, from, to }) = (0..points.len()).into_par_iter().find_map_first(of_node)
    else {
        return Ok(());
    };
    let spec = &scene.regions[region as usize];
    let message = format!(
        "the diffusivity jumps from {from:.3e} to {to:.3e} near {at:?}, within the region \"{}\"",
        spec.name
    );
    let help = "make each side a region of its own, so that there is an interface between them; or name \
                \"gfdm-conservative\", which takes it as it is at the nodes";
    Err(scene.error_at(&spec.diffusivity, message, help).into())
}
