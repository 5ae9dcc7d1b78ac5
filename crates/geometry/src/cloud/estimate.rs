use super::Spacing;
use crate::domain::Domain;
use crate::error::GeometryError;
use crate::quasi_random::Kronecker;

/// Sample points of the spacing for graded clouds.
const SPACING_SAMPLES: usize = 1 << 14;

/// Sample points of the spacing on every face of a box.
const FACE_SAMPLES: usize = 1 << 10;

/// About how many nodes a cloud has, without generating it: the measure over the volume of a node, plus half a layer
/// on the boundary of a box. Costs at most 65536 evaluations of the level.
///
/// # Errors
/// [`GeometryError::InvalidSpacing`] where the spacing is not positive and finite.
pub fn estimate_nodes<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
) -> Result<f64, GeometryError> {
    let bounds = domain.bounds();
    match spacing {
        Spacing::Uniform(_) => {
            let s = spacing.at(&bounds.center())?;
            let in_box: f64 = bounds.lengths().iter().map(|l| l / s + 1.0).product();
            Ok(in_box * (domain.measure_estimate() / bounds.measure()))
        }
        Spacing::Graded(_) => {
            let mut density = 0.0;
            for x in Kronecker::new(&bounds).take(SPACING_SAMPLES) {
                if domain.level(&x) <= 0.0 {
                    density += spacing.at(&x)?.powi(-(D as i32));
                }
            }
            Ok(bounds.measure() * density / SPACING_SAMPLES as f64 + half_layer(domain, spacing)?)
        }
    }
}

/// Half a node for every node on the planes of an outer box.
pub(crate) fn half_layer<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
) -> Result<f64, GeometryError> {
    let Some(bounds) = domain.outer_box() else { return Ok(0.0) };
    let mut nodes = 0.0;
    for axis in 0..D {
        let area = bounds.measure() / bounds.lengths()[axis];
        for end in [bounds.min[axis], bounds.max[axis]] {
            for mut x in Kronecker::new(&bounds).take(FACE_SAMPLES) {
                x[axis] = end;
                if domain.level(&x) <= 0.0 {
                    nodes += 0.5 * area / FACE_SAMPLES as f64 * spacing.at(&x)?.powi(1 - D as i32);
                }
            }
        }
    }
    Ok(nodes)
}

/// About how many nodes a cloud has, as [`estimate_nodes`]; refused where there are more than `limit`.
///
/// # Errors
/// [`GeometryError::TooManyNodes`] with the spacing that would do, and those of [`estimate_nodes`].
pub fn check_size<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
    limit: usize,
) -> Result<f64, GeometryError> {
    let estimate = estimate_nodes(domain, spacing)?;
    if estimate > limit as f64 {
        return Err(too_many::<D>(estimate, limit));
    }
    Ok(estimate)
}

pub(crate) fn too_many<const D: usize>(estimate: f64, limit: usize) -> GeometryError {
    // A little more than the ratio asks for, because estimates are estimates.
    let factor = 1.05 * (estimate / limit.max(1) as f64).powf(1.0 / D as f64);
    GeometryError::TooManyNodes { estimate, limit, factor }
}
