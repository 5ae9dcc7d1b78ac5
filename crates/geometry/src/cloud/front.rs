//! Interior nodes of irregular clouds: Poisson-disk sampling by an advancing front.

use crate::boundary::Sampler;
use crate::cells::for_each_cell;
use crate::cloud::Spacing;
use crate::error::GeometryError;
use crate::random::Random;
use crate::vector::{axpy, distance_squared, norm};

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
    let mut near: Vec<[f64; D]> = Vec::new();
    while *next < sampler.nodes.len() {
        let (p, h) = (sampler.nodes.points()[*next], sampler.nodes.spacing()[*next]);
        *next += 1;
        let uniform = matches!(sampler.spacing, Spacing::Uniform(_));
        if uniform {
            // All that candidates around this node can conflict with, read once for all of them.
            near.clear();
            sampler.nodes.collect(&p, 2.01 * radius * h, &mut near);
        }
        for _ in 0..CANDIDATES[D - 2] {
            let x = axpy(&p, radius * h * (1.0 + 1e-9), &random.direction());
            if !uniform {
                accept(sampler, x, radius)?;
            } else if near.iter().all(|q| distance_squared(&x, q) >= radius * h * (radius * h))
                && let Some(h) = spacing_inside(sampler, &x)?
            {
                sampler.push(x, h)?;
                near.push(x);
            }
        }
    }
    Ok(())
}

fn accept<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    x: [f64; D],
    radius: f64,
) -> Result<bool, GeometryError> {
    // Where it lies comes first: outside of the domain a graded spacing need not be defined.
    let Some(h) = spacing_inside(sampler, &x)? else { return Ok(false) };
    if sampler.nodes.conflicts(&x, h, radius) {
        return Ok(false);
    }
    sampler.push(x, h)?;
    Ok(true)
}

/// The spacing at a point, if that lies in the domain and far enough from its surface for an interior node.
fn spacing_inside<const D: usize>(
    sampler: &Sampler<'_, D>,
    x: &[f64; D],
) -> Result<Option<f64>, GeometryError> {
    let level = sampler.domain.level(x);
    if level.is_nan() || level >= 0.0 {
        return Ok(None);
    }
    let h = sampler.spacing.at(x)?;
    let clear = -level >= CLEARANCE * h * norm(&sampler.domain.gradient(x));
    Ok(clear.then_some(h))
}
