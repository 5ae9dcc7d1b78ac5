//! The corners of a scene, before it has a cloud.

use meshless_interfaces::{Corner, CornerData, corners};

use super::{Boundary, domain, jumps, materials, regions};
use crate::Error;
use crate::scene::Scene;

/// Conditions change once at most on this part of the diameter of the domain, where the spacing is no number.
const CHANGES: f64 = 5e-3;

/// The vertices of a scene, and in space edges, whose solutions have a power below `order` that is no polynomial; none where regions
/// are known by labels only, and in free space.
pub(crate) fn singular_corners(scene: &Scene, order: usize) -> Result<Vec<Corner>, Error> {
    if scene.is_labelled() || scene.free_space.is_some() {
        return Ok(Vec::new());
    }
    match scene.dimension {
        2 => in_dimension::<2>(scene, order),
        3 => in_dimension::<3>(scene, order),
        _ => Ok(Vec::new()),
    }
}

fn in_dimension<const D: usize>(scene: &Scene, order: usize) -> Result<Vec<Corner>, Error> {
    let (domain, regions) = (domain::<D>(scene)?, regions::<D>(scene)?);
    let boundary = Boundary::new(scene, &domain);
    let (materials, jumps) = (materials::<D>(scene), jumps::<D>(scene));
    let widest = CHANGES * domain.bounds().diameter();
    let spacing = scene.points.spacing.expr.as_constant().map_or(widest, |spacing| spacing.max(widest));
    let data = CornerData {
        domain: &domain,
        regions: &regions,
        materials: &materials,
        boundary: &boundary,
        jumps: &jumps,
        spacing,
    };
    Ok(corners(&data, order))
}
