use super::Spacing;
use crate::domain::Domain;
use crate::error::GeometryError;
use crate::quasi_random::Kronecker;

/// Sample points of the spacing for graded clouds.
const SPACING_SAMPLES: usize = 1 << 14;

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
            Ok(bounds.measure() * density / SPACING_SAMPLES as f64)
        }
    }
}

/// Refuses clouds that would be far too large before any node exists.
pub(super) fn check_size<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
    limit: usize,
) -> Result<(), GeometryError> {
    let estimate = estimate_nodes(domain, spacing)?;
    if estimate > limit as f64 {
        return Err(too_many::<D>(estimate, limit));
    }
    Ok(())
}

pub(crate) fn too_many<const D: usize>(estimate: f64, limit: usize) -> GeometryError {
    // A little more than the ratio asks for, because estimates are estimates.
    let factor = 1.05 * (estimate / limit.max(1) as f64).powf(1.0 / D as f64);
    GeometryError::TooManyNodes { estimate, limit, factor }
}
