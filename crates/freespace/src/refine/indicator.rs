//! Where to refine.

use crate::error::FreeSpaceError;
use crate::mesh::Mesh;

use super::Patch;

/// Cells of the blocks that are refined or not.
const BLOCK: usize = 8;

/// Patches of the base mesh that cover every cell in which `error`, the estimate of a solve on it, exceeds `tolerance` times
/// the largest magnitude of `field`, and the cells around it: blocks of eight cells, joined to boxes.
///
/// # Errors
/// Arrays of the wrong length, or a tolerance that is not positive.
pub fn suggest<const D: usize>(
    mesh: &Mesh<D>,
    error: &[f64],
    field: &[f64],
    tolerance: f64,
    ratio: usize,
) -> Result<Vec<Patch<D>>, FreeSpaceError> {
    FreeSpaceError::unless_positive("tolerance", tolerance)?;
    crate::plan::check_values("estimate of the error", error, mesh.len())?;
    crate::plan::check_values("field", field, mesh.len())?;
    let limit = tolerance * field.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let blocks = mesh.cells().map(|n| n.div_ceil(BLOCK));
    let count: usize = blocks.iter().product();
    let mut marked = vec![false; count];
    for (point, _) in error.iter().enumerate().filter(|(_, e)| e.abs() > limit) {
        let i = mesh.indices(point);
        let block: [usize; D] = std::array::from_fn(|a| (i[a] / BLOCK).min(blocks[a] - 1));
        marked[place(block, blocks)] = true;
    }
    let mut patches = Vec::new();
    while let Some(start) = marked.iter().position(|m| *m) {
        let first = indices(start, blocks);
        let mut size = [1; D];
        // A box grows in one direction after the other as long as all of the next layer is marked.
        for axis in 0..D {
            while first[axis] + size[axis] < blocks[axis]
                && layer(first, size, axis).all(|b| marked[place(b, blocks)])
            {
                size[axis] += 1;
            }
        }
        cover(first, size).for_each(|b| marked[place(b, blocks)] = false);
        let end: [usize; D] = std::array::from_fn(|a| ((first[a] + size[a]) * BLOCK).min(mesh.cells()[a]));
        let first = first.map(|b| b * BLOCK);
        patches.push(Patch { parent: None, first, cells: std::array::from_fn(|a| end[a] - first[a]), ratio });
    }
    Ok(patches)
}

fn place<const D: usize>(block: [usize; D], blocks: [usize; D]) -> usize {
    (0..D).rev().fold(0, |all, a| all * blocks[a] + block[a])
}

fn indices<const D: usize>(mut index: usize, blocks: [usize; D]) -> [usize; D] {
    blocks.map(|n| {
        let i = index % n;
        index /= n;
        i
    })
}

/// The blocks of a box.
fn cover<const D: usize>(first: [usize; D], size: [usize; D]) -> impl Iterator<Item = [usize; D]> {
    (0..size.iter().product()).map(move |i| {
        let offset = indices(i, size);
        std::array::from_fn(|a| first[a] + offset[a])
    })
}

/// The blocks behind a box in a direction.
fn layer<const D: usize>(
    mut first: [usize; D],
    mut size: [usize; D],
    axis: usize,
) -> impl Iterator<Item = [usize; D]> {
    first[axis] += size[axis];
    size[axis] = 1;
    cover(first, size)
}

#[cfg(test)]
mod tests {
    use super::suggest;
    use crate::mesh::{Centring, Mesh};

    #[test]
    fn every_point_above_the_tolerance_is_covered_once() -> Result<(), crate::error::FreeSpaceError> {
        let mesh = Mesh::new([0.0; 2], [1.0; 2], [50, 44], Centring::Cell)?;
        let error = mesh.sample(|[x, y]| if (x - 20.0).hypot(y - 25.0) < 14.0 { 1.0 } else { 0.0 });
        let patches = suggest(&mesh, &error, &vec![1.0; mesh.len()], 0.5, 2)?;
        for (point, error) in error.iter().enumerate() {
            let i = mesh.indices(point);
            let inside =
                |p: &&super::Patch<2>| (0..2).all(|a| i[a] >= p.first[a] && i[a] < p.first[a] + p.cells[a]);
            let count = patches.iter().filter(inside).count();
            assert!(count <= 1 && (count == 1 || *error < 0.5), "{i:?}");
        }
        assert!(patches.len() > 1 && suggest(&mesh, &error, &error, 2.0, 2)?.is_empty());
        Ok(())
    }
}
