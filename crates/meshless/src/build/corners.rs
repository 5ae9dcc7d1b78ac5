//! The corners of a scene, before it has a cloud.

use meshless_geometry::Size;
use meshless_interfaces::{Corner, CornerData, Obstacle, corners};

use super::shapes::spacing;
use super::{Boundary, domain, jumps, materials, regions};
use crate::Error;
use crate::scene::Scene;

/// Conditions change once at most on this part of the diameter of the domain, where the spacing is no number.
const CHANGES: f64 = 5e-3;

/// The order for which a scene tells the spacings at corners; they fall with the order.
const ORDER: f64 = 4.0;

/// The least spacing at a corner, over what is clear round it; and the least that has to be clear, over the spacing given there: surfaces
/// that touch have corners at a distance of rounding.
const LEAST_PART: f64 = 1e-6;

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

/// What a method makes of corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AtCorners {
    /// Its order.
    pub(crate) order: usize,
    /// Whether it has functions for them.
    pub(crate) serves: bool,
}

/// The spacings that the corners of a scene in the plane ask for, where its cloud adapts to them. One that has functions of its own needs
/// nodes within what is clear round it, the more the higher the order; to others the spacing falls to where the singular part of the
/// solution is as small as the error elsewhere: `(s / L)^(2 lambda) = (h / L)^order`.
pub(super) fn corner_spacings<const D: usize>(
    scene: &Scene,
    method: AtCorners,
) -> Result<Vec<Size<D>>, Error> {
    let Some(spec) = scene.points.corners.filter(|_| D == 2) else { return Ok(Vec::new()) };
    let (given, order) = (spacing::<D>(scene), method.order as f64);
    let across = spec.across * (order / ORDER).max(1.0);
    let mut places = Vec::new();
    for corner in singular_corners(&scene.at_time(0.0), method.order)? {
        let at: [f64; D] = std::array::from_fn(|k| corner.at[k]);
        // What is no spacing is refused where the cloud is made.
        let Some(h) = given.at(&at).ok().filter(|h| corner.clear > LEAST_PART * h) else { continue };
        let size = if method.serves && corner.obstacle == Some(Obstacle::Method) {
            Size { at, spacing: corner.clear / across, within: corner.clear }
        } else {
            let power = order / (2.0 * corner.exponent).max(1.0);
            Size::at(at, corner.clear * (h / corner.clear).min(1.0 / across).powf(power).max(LEAST_PART))
        };
        if size.spacing < h {
            places.push(size);
        }
    }
    Ok(places)
}
