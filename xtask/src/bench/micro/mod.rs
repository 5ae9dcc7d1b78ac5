//! The building blocks one by one.

pub(super) mod cells;
pub(super) mod freespace;
pub(super) mod neighbors;
pub(super) mod sparse;
pub(super) mod stencils;

use meshless_geometry::{Cloud, CloudParams, Domain, GeometryError, Layout, Spacing, generate};

/// More nodes than any benchmark asks for.
const MAX_NODES: usize = 10_000_000;

/// About `nodes` irregular nodes in the unit box, and their spacing.
fn irregular<const D: usize>(nodes: usize) -> Result<(Cloud<D>, f64), GeometryError> {
    let domain = Domain::boxed([0.0; D], [1.0; D])?;
    let spacing = (nodes as f64).powf(-1.0 / D as f64);
    let params = CloudParams {
        spacing: Spacing::Uniform(spacing),
        layout: Layout::Irregular,
        seed: 1,
        max_nodes: MAX_NODES,
    };
    Ok((generate(&domain, &params)?, spacing))
}
