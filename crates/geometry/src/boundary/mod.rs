//! Boundary nodes: corners first, then the curves between them, then (in 3-D) the surfaces between those.
//!
//! The boundary is a set of smooth patches. `D` of them meet in corners, `D - 1` in curves: in 1-D the curve of no
//! patch is the line itself, in 2-D that of one patch is its boundary curve, in 3-D that of two is an edge. So edges
//! where shapes trim each other are sampled like those of a box, and their nodes carry a normal of every patch.

mod arcs;
mod corners;
mod curve;
mod manifold;
mod patch;
mod sampler;
mod surface;

pub(crate) use patch::patches;
pub(crate) use sampler::Sampler;

use crate::error::GeometryError;
use crate::random::Random;

/// Places all boundary nodes. With `lattice`, planes of an outer box are left to the caller, who puts the nodes of a
/// grid there; only what bounds curved patches is sampled.
pub(crate) fn sample<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    lattice: bool,
    random: &mut Random,
) -> Result<(), GeometryError> {
    let cells = sampler.boundary_cells(lattice)?;
    corners::sample(sampler, &cells, lattice)?;
    if D > 1 {
        curve::sample(sampler, &cells, lattice)?;
    }
    if D > 2 {
        surface::sample(sampler, &cells, lattice, random)?;
    }
    Ok(())
}

/// Nodes along the line, for irregular clouds in 1-D.
pub(crate) fn sample_line<const D: usize>(sampler: &mut Sampler<'_, D>) -> Result<(), GeometryError> {
    curve::sample_line(sampler)
}
