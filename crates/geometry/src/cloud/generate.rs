use super::{BoundaryNode, Cloud, CloudParams, Layout, Spacing, estimate, front, lattice, line};
use crate::boundary::{Sampler, sample};
use crate::domain::Domain;
use crate::error::GeometryError;
use crate::morton::morton_order;
use crate::random::Random;

/// Generates a cloud: nodes on every face with outward normals, then inside.
///
/// A spacing `s` makes about `1 / s^D` nodes a unit of volume in the interior, and nodes about `s` apart on faces,
/// whatever the layout. Corners and edges, also those where shapes trim each other, get nodes that touch every
/// surface meeting there; features smaller than half a spacing are not resolved. The nodes are ordered along a Morton
/// curve. The same arguments give the same cloud, bit for bit.
///
/// # Errors
/// [`GeometryError::InvalidSpacing`], [`GeometryError::TooManyNodes`] (before anything is generated, where the estimate
/// shows it), [`GeometryError::SpacingTooLarge`] where no interior node fits, [`GeometryError::GradedLattice`] for a
/// graded spacing with a grid.
pub fn generate<const D: usize>(
    domain: &Domain<D>,
    params: &CloudParams<D>,
) -> Result<Cloud<D>, GeometryError> {
    estimate::check_size(domain, &params.spacing, params.max_nodes)?;
    let mut random = Random::new(params.seed);
    let mut sampler = Sampler::new(domain, &params.spacing, params.max_nodes);
    match (params.layout, &params.spacing) {
        (Layout::Irregular, _) => {
            sample(&mut sampler, false, &mut random)?;
            if D == 1 {
                line::fill(&mut sampler, &mut random)?;
            } else {
                front::fill(&mut sampler, &mut random)?;
            }
        }
        (layout, Spacing::Uniform(s)) => {
            sample(&mut sampler, true, &mut random)?;
            let jitter = match layout {
                Layout::Jittered => Some((lattice::JITTER, &mut random)),
                Layout::Scattered => Some((lattice::SCATTER, &mut random)),
                _ => None,
            };
            lattice::fill(&mut sampler, *s, jitter)?;
        }
        (layout, Spacing::Graded(_)) => {
            let layout = match layout {
                Layout::Grid => "grid",
                Layout::Scattered => "scattered",
                _ => "jittered",
            };
            return Err(GeometryError::GradedLattice { layout });
        }
    }
    if sampler.nodes.len() == sampler.touches.len() {
        let size = domain.bounds().lengths().into_iter().fold(f64::INFINITY, f64::min);
        let spacing = params.spacing.at(&domain.bounds().center()).unwrap_or(size);
        let smallest = sampler.nodes.spacing().iter().fold(spacing, |a, &b| a.min(b));
        return Err(GeometryError::SpacingTooLarge { spacing: smallest, size });
    }
    finish(sampler)
}

fn finish<const D: usize>(sampler: Sampler<'_, D>) -> Result<Cloud<D>, GeometryError> {
    let order = morton_order(sampler.nodes.points(), &sampler.domain.bounds());
    let boundary = sampler
        .touches
        .into_iter()
        .enumerate()
        .map(|(i, touches)| BoundaryNode { node: i as u32, touches })
        .collect();
    let cloud =
        Cloud::from_parts(sampler.nodes.points().to_vec(), boundary, sampler.nodes.spacing().to_vec())?;
    cloud.permuted(&order)
}
