//! Nodes inside of the surfaces of 3-D domains: Poisson-disk sampling that advances from the edges.

use super::manifold::onto;
use super::sampler::{BoundaryCell, Sampler};
use crate::error::GeometryError;
use crate::random::Random;
use crate::vector::{axpy, dot, normalized};

/// Smallest distance of nodes over the spacing that makes about `1 / s^2` nodes a unit of area (measured).
const RADIUS: f64 = 0.9;

/// Candidates around every node.
const CANDIDATES: usize = 12;

/// Starting points a cell and axis that look for holes left over.
const SWEEP: usize = 2;

pub(super) fn sample<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    cells: &[BoundaryCell<D>],
    lattice: bool,
    random: &mut Random,
) -> Result<(), GeometryError> {
    for k in 0..sampler.patches.len() {
        if lattice && sampler.patches[k].on_box {
            continue;
        }
        let mut queue: Vec<u32> = (0..sampler.nodes.len() as u32)
            .filter(|&i| sampler.patches[k].holds(&sampler.nodes.points()[i as usize], sampler.tolerance))
            .collect();
        advance(sampler, k, &mut queue, random)?;
        for entry in cells.iter().filter(|entry| entry.near.contains(&k)) {
            for part in 0..SWEEP.pow(D as u32) {
                let x = entry.cell.part(part, SWEEP);
                let Some(x) = onto(&sampler.pick(&[k]), &x, 2.0 * entry.cell.half_diagonal()) else {
                    continue;
                };
                if accept(sampler, k, x)? {
                    queue.clear();
                    queue.push(sampler.nodes.len() as u32 - 1);
                    advance(sampler, k, &mut queue, random)?;
                }
            }
        }
    }
    Ok(())
}

/// Surrounds every node of the queue with candidates in its tangent plane, put onto the surface; accepted ones join the
/// queue.
fn advance<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    k: usize,
    queue: &mut Vec<u32>,
    random: &mut Random,
) -> Result<(), GeometryError> {
    let mut next = 0;
    while next < queue.len() {
        let (p, h) =
            (sampler.nodes.points()[queue[next] as usize], sampler.nodes.spacing()[queue[next] as usize]);
        next += 1;
        let Some(n) = normalized(&sampler.patches[k].gradient(&p)) else { continue };
        for _ in 0..CANDIDATES {
            let v: [f64; D] = random.direction();
            let Some(t) = normalized(&axpy(&v, -dot(&v, &n), &n)) else { continue };
            // A little farther than the smallest distance, which the projection shortens on convex surfaces.
            let flat = axpy(&p, RADIUS * h * (1.0 + 1e-9), &t);
            let Some(x) = onto(&sampler.pick(&[k]), &flat, RADIUS * h) else { continue };
            if accept(sampler, k, x)? {
                queue.push(sampler.nodes.len() as u32 - 1);
            }
        }
    }
    Ok(())
}

/// Makes a point of the patch a node if it belongs to the boundary and is not too near to another node.
fn accept<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    k: usize,
    x: [f64; D],
) -> Result<bool, GeometryError> {
    if let crate::cloud::Spacing::Uniform(h) = sampler.spacing
        && sampler.nodes.conflicts(&x, *h, RADIUS)
    {
        return Ok(false);
    }
    if !sampler.on_all(&[k], &x) {
        return Ok(false);
    }
    let h = sampler.spacing.at(&x)?;
    if sampler.nodes.conflicts(&x, h, RADIUS) {
        return Ok(false);
    }
    sampler.push_boundary(x, h)
}
