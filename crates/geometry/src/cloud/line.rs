//! Irregular clouds in 1-D.

use crate::boundary::{Sampler, sample_line};
use crate::error::GeometryError;
use crate::random::Random;

/// How far nodes are moved from even division, relative to the spacing: the smallest distance stays above 0.75 on
/// stretches of two spacings and more.
const JITTER: f64 = 0.1;

/// Divides what lies between boundary nodes evenly and moves the nodes a little.
pub(super) fn fill<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    random: &mut Random,
) -> Result<(), GeometryError> {
    let boundary = sampler.nodes.len();
    sample_line(sampler)?;
    sampler.nodes.displace(boundary, |h| std::array::from_fn(|_| JITTER * h * random.symmetric()));
    for i in boundary..sampler.nodes.len() {
        sampler.spacing.at(&sampler.nodes.points()[i])?;
    }
    Ok(())
}
