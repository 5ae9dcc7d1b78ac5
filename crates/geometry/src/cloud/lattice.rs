//! Grid and jittered clouds.

use super::front::CLEARANCE;
use crate::boundary::Sampler;
use crate::error::GeometryError;
use crate::random::Random;
use crate::vector::{distance, norm};

/// Lattice nodes nearer to a curved surface, or to the nodes on it, than this times the spacing are left out.
const CURVED_CLEARANCE: f64 = 0.5;

/// How far jittered nodes are moved along each axis, relative to the lattice's own spacing.
pub(super) const JITTER: f64 = 0.25;

/// The same for scattered nodes.
pub(super) const SCATTER: f64 = 0.5;

/// Adds the nodes of a lattice that divides the bounds evenly, as nearly by the spacing as possible: first those on
/// the planes of an outer box, then those inside.
pub(super) fn fill<const D: usize>(
    sampler: &mut Sampler<'_, D>,
    spacing: f64,
    jitter: Option<(f64, &mut Random)>,
) -> Result<(), GeometryError> {
    let bounds = sampler.domain.bounds();
    let curved = sampler.nodes.len();
    let parts: [usize; D] =
        std::array::from_fn(|i| (bounds.lengths()[i] / spacing).round().max(1.0) as usize);
    let at = |index: &[usize; D]| -> [f64; D] {
        // The upper end exactly, not up to rounding.
        std::array::from_fn(|i| {
            let t = index[i] as f64 / parts[i] as f64;
            if index[i] == parts[i] { bounds.max[i] } else { bounds.min[i] + t * bounds.lengths()[i] }
        })
    };
    let boxed = sampler.domain.outer_box().is_some();
    for_each_index(&parts, &mut |index| {
        let on_face = (0..D).any(|i| index[i] == 0 || index[i] == parts[i]);
        let x = at(index);
        if boxed && on_face && clear(sampler, &x, spacing, CURVED_CLEARANCE, curved) {
            sampler.push_boundary(x, spacing)?;
        }
        Ok(())
    })?;
    let mut jitter = jitter;
    for_each_index(&parts, &mut |index| {
        let on_face = (0..D).any(|i| index[i] == 0 || index[i] == parts[i]);
        let mut x = at(index);
        if on_face || !clear(sampler, &x, spacing, CURVED_CLEARANCE, curved) {
            return Ok(());
        }
        if let Some((amplitude, random)) = &mut jitter {
            let y = std::array::from_fn(|i| {
                x[i] + *amplitude * random.symmetric() * bounds.lengths()[i] / parts[i] as f64
            });
            // Nodes that would come too near to a curved surface stay where they are.
            if clear(sampler, &y, spacing, CLEARANCE, curved) {
                x = y;
            }
        }
        sampler.push(x, spacing)?;
        Ok(())
    })
}

/// Whether a point lies in the domain and keeps its distance from curved surfaces and from the first `curved` nodes,
/// those on them.
fn clear<const D: usize>(
    sampler: &Sampler<'_, D>,
    x: &[f64; D],
    spacing: f64,
    factor: f64,
    curved: usize,
) -> bool {
    let reach = factor * spacing;
    let away = sampler.curved.iter().all(|(_, shape, hole)| {
        let level = if *hole { -shape.level(x) } else { shape.level(x) };
        level < 0.0 && -level >= reach * norm(&shape.gradient(x))
    });
    if !away {
        return false;
    }
    curved == 0
        || sampler.nodes.nearest(x, reach, None).is_none_or(|(id, _)| {
            id as usize >= curved || distance(x, &sampler.nodes.points()[id as usize]) >= reach
        })
}

fn for_each_index<const D: usize>(
    parts: &[usize; D],
    visit: &mut impl FnMut(&[usize; D]) -> Result<(), GeometryError>,
) -> Result<(), GeometryError> {
    let mut index = [0; D];
    loop {
        visit(&index)?;
        let Some(axis) = (0..D).find(|&i| index[i] < parts[i]) else { return Ok(()) };
        index[axis] += 1;
        index[..axis].fill(0);
    }
}
