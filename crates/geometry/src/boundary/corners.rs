//! Corners: where as many patches meet as there are dimensions, the vertices of polygons, and those of surfaces of triangles.

use super::manifold::onto;
use super::patch::Patch;
use super::sampler::{BoundaryCell, Sampler, for_each_subset};
use crate::error::GeometryError;
use crate::vector::dot;

/// Smallest distance of two corners, and of any two boundary nodes on different curves, relative to the spacing.
/// Features that are smaller than this are not resolved: the second corner is left out.
pub(super) const FEATURE_SEPARATION: f64 = 0.5;

/// Smallest distance of two vertices of a polygon that both become nodes, relative to the spacing. Of finer polygons
/// the sharpest vertices are kept.
const VERTEX_SEPARATION: f64 = 0.75;

pub(super) fn sample<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    cells: &[BoundaryCell<D>],
    lattice: bool,
) -> Result<(), GeometryError> {
    for entry in cells.iter().filter(|entry| entry.near.len() >= D) {
        let reach = 3.0 * entry.cell.half_diagonal();
        for_each_subset(&entry.near, D, &mut |subset| {
            if lattice && sampler.covered_by_lattice(subset) {
                return Ok(());
            }
            let Some(x) = onto(&sampler.pick(subset), &entry.cell.center, reach) else { return Ok(()) };
            // In 1-D the cells on the two sides of a point may both find it.
            if sampler.nodes.nearest(&x, sampler.tolerance, None).is_some() || !sampler.on_all(subset, &x) {
                return Ok(());
            }
            let h = sampler.spacing.at(&x)?;
            if !sampler.nodes.conflicts(&x, h, FEATURE_SEPARATION) {
                sampler.push_boundary(x, h)?;
            }
            Ok(())
        })?;
    }
    vertices(sampler)
}

fn vertices<const D: usize>(sampler: &mut Sampler<'_, D>) -> Result<(), GeometryError> {
    for k in 0..sampler.patches.len() {
        for x in ordered_vertices(&sampler.patches[k]) {
            if !sampler.on_all(&[k], &x) {
                continue;
            }
            let h = sampler.spacing.at(&x)?;
            if !sampler.nodes.conflicts(&x, h, VERTEX_SEPARATION) {
                sampler.push_boundary(x, h)?;
            }
        }
    }
    Ok(())
}

/// Vertices of a polygon, sharpest first, in the polygon's order among equals; corners of a surface of triangles.
fn ordered_vertices<const D: usize>(patch: &Patch<'_, D>) -> Vec<[f64; D]> {
    if let Some(surface) = patch.triangles() {
        return surface.corners().map(|v| std::array::from_fn(|axis| v[axis])).collect();
    }
    let Some(polygon) = patch.polygon() else { return Vec::new() };
    let count = polygon.vertices().len();
    // The cosine of the turn at each vertex.
    let mut order: Vec<(f64, usize)> = (0..count)
        .map(|i| (dot(&polygon.edge_normal((i + count - 1) % count), &polygon.edge_normal(i)), i))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let vertex = |i: usize| std::array::from_fn(|axis| polygon.vertices()[i][axis]);
    order.into_iter().map(|(_, i)| vertex(i)).collect()
}
