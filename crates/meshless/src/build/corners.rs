//! The corners of a scene, before it has a cloud, and the spacings that they ask for.

use meshless_geometry::Size;
use meshless_interfaces::{Corner, CornerData, Obstacle, corners};

use super::shapes::spacing;
use super::{Boundary, domain, laws, materials, regions};
use crate::Error;
use crate::scene::Scene;

/// Conditions change once at most on this part of the diameter of the domain, where the spacing is no number.
const CHANGES: f64 = 5e-3;

/// The order for which a scene tells the spacings at corners; they fall with the order.
const ORDER: f64 = 4.0;

/// The least spacing at a corner, over what is clear round it; and the least that has to be clear, over the spacing given there: surfaces
/// that touch have corners at a distance of rounding.
const LEAST_PART: f64 = 1e-6;

/// Places along a straight part of an edge in space at which a spacing is asked for, at most.
const MOST_ALONG: f64 = 1e4;

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
    let (materials, laws) = (materials::<D>(scene), laws::<D>(scene));
    let widest = CHANGES * domain.bounds().diameter();
    let spacing = scene.points.spacing.expr.as_constant().map_or(widest, |spacing| spacing.max(widest));
    let data = CornerData {
        domain: &domain,
        regions: &regions,
        materials: &materials,
        boundary: &boundary,
        laws: &laws,
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

/// The spacings that the corners of a scene ask for, where its cloud adapts to them. One in the plane that has functions of its own needs
/// nodes within what is clear round it, the more the higher the order. To others, and to the vertices in which edges in space end, the spacing
/// falls to where the singular part of the solution leaves as little as the order does elsewhere, `(s / L)^rate = (h / L)^order`.
pub(super) fn corner_spacings<const D: usize>(
    scene: &Scene,
    method: AtCorners,
) -> Result<Vec<Size<D>>, Error> {
    let Some(spec) = scene.points.corners.filter(|_| D > 1) else { return Ok(Vec::new()) };
    let (given, order) = (spacing::<D>(scene), method.order as f64);
    let across = spec.across * (order / ORDER).max(1.0);
    let mut places = Vec::new();
    for corner in singular_corners(&scene.at_time(0.0), method.order)? {
        let (clear, rate) = (corner.clear, 2.0 * corner.exponent);
        let is_served = method.serves && corner.obstacle == Some(Obstacle::Method);
        let mut ask = |at: [f64; D], size: &dyn Fn(f64) -> Size<D>| {
            // What is no spacing is refused where the cloud is made.
            let h = given.at(&at).ok().filter(|h| clear > LEAST_PART * h)?;
            let size = size(h);
            (size.spacing < h).then(|| places.push(size))
        };
        let falling = |at: [f64; D], h: f64, most: f64, rate: f64| {
            let power = order / rate.max(1.0);
            Size::at(at, clear * (h / clear).min(most).powf(power).max(LEAST_PART))
        };
        match D {
            2 if is_served => {
                let at = point(&corner.at);
                ask(at, &|_| Size { at, spacing: clear / across, within: clear });
            }
            2 => {
                let at = point(&corner.at);
                ask(at, &|h| falling(at, h, across.recip(), rate));
            }
            _ if is_served => {
                for at in corner.tips.iter().map(|tip| point(tip)) {
                    ask(at, &|h| falling(at, h, 1.0, rate + 1.0));
                }
            }
            _ => {
                for ends in corner.line.windows(2) {
                    let [from, to]: [[f64; D]; 2] = [point(&ends[0]), point(&ends[1])];
                    let middle: [f64; D] = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
                    let Ok(h) = given.at(&middle) else { continue };
                    let step = falling(middle, h, 1.0, rate).spacing;
                    let length = (0..D).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt();
                    let count = (length / step).ceil().clamp(1.0, MOST_ALONG);
                    for number in 0..=count as u32 {
                        let t = f64::from(number) / count;
                        let at = std::array::from_fn(|k| from[k] + t * (to[k] - from[k]));
                        ask(at, &|h| falling(at, h, 1.0, rate));
                    }
                }
            }
        }
    }
    Ok(places)
}

fn point<const D: usize>(x: &[f64]) -> [f64; D] {
    std::array::from_fn(|k| x[k])
}
