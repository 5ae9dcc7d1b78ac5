//! Interior nodes of irregular clouds: Poisson-disk sampling by an advancing front.

use crate::boundary::Sampler;
use crate::cells::for_each_cell;
use crate::cloud::Spacing;
use crate::error::GeometryError;
use crate::random::Random;
use crate::vector::{axpy, norm};

/// Smallest distance of nodes over the spacing, for 2-D and 3-D. Measured such that there are `1 / s^D` nodes a unit
/// of volume.
const RADIUS: [f64; 2] = [0.895, 0.9];

/// Candidates around every node, for 2-D and 3-D.
const CANDIDATES: [usize; 2] = [12, 24];

/// Smallest distance of interior nodes from the boundary's surface over the spacing.
pub(super) const CLEARANCE: f64 = 0.4;

/// Width of the cells whose midpoints look for holes left over, relative to the spacing.
const SWEEP: f64 = 0.5;

/// Fills the domain with nodes, starting from those on the boundary (Slak and Kosec 2019, "On generation of node
/// distributions for meshless PDE discretizations"): around every node, at the smallest distance, random candidates
/// are tried; those that keep clear of all nodes become nodes and are surrounded in their turn. A sweep over cells
/// then looks for holes that the candidates missed, and goes on from there.
pub(super) fn fill<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    random: &mut Random,
) -> Result<(), GeometryError> {
    let radius = RADIUS[D - 2];
    let mut next = 0;
    advance(sampler, radius, &mut next, random)?;
    let bounds = sampler.domain.bounds();
    let mut holes = Vec::new();
    let (domain, nodes, spacing) = (sampler.domain, &sampler.nodes, sampler.spacing);
    for_each_cell(
        &bounds,
        spacing,
        SWEEP,
        |cell| domain.contains(&cell.center, 2.0 * cell.half_diagonal()),
        |cell| {
            let x = cell.center;
            if let Spacing::Uniform(h) = spacing
                && nodes.conflicts(&x, *h, radius)
            {
                return Ok(());
            }
            if domain.level(&x) < 0.0 && !nodes.conflicts(&x, spacing.at(&x)?, radius) {
                holes.push(x);
            }
            Ok::<(), GeometryError>(())
        },
    )?;
    for x in holes {
        if accept(sampler, x, radius)? {
            advance(sampler, radius, &mut next, random)?;
        }
    }
    Ok(())
}

fn advance<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    radius: f64,
    next: &mut usize,
    random: &mut Random,
) -> Result<(), GeometryError> {
    while *next < sampler.nodes.len() {
        let (p, h) = (sampler.nodes.points()[*next], sampler.nodes.spacing()[*next]);
        *next += 1;
        for _ in 0..CANDIDATES[D - 2] {
            let x = axpy(&p, radius * h * (1.0 + 1e-9), &random.direction());
            accept(sampler, x, radius)?;
        }
    }
    Ok(())
}

fn accept<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    x: [f64; D],
    radius: f64,
) -> Result<bool, GeometryError> {
    // Outside of the domain a graded spacing need not be defined.
    if let Spacing::Uniform(h) = sampler.spacing
        && sampler.nodes.conflicts(&x, *h, radius)
    {
        return Ok(false);
    }
    let level = sampler.domain.level(&x);
    if level.is_nan() || level >= 0.0 {
        return Ok(false);
    }
    let h = sampler.spacing.at(&x)?;
    if -level < CLEARANCE * h * norm(&sampler.domain.gradient(&x)) {
        return Ok(false);
    }
    if matches!(sampler.spacing, Spacing::Graded(_)) && sampler.nodes.conflicts(&x, h, radius) {
        return Ok(false);
    }
    sampler.push(x, h)?;
    Ok(true)
}
