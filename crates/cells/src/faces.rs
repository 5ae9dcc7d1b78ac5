//! The faces of the finished cell, from the pieces of the body's surface.

use crate::body::{Piece, Source, resize};
use crate::cell::{CellFace, FaceKind};
use crate::container::Container;
use crate::error::CellError;

/// Size of a face, relative to the cell's radius to the power D-1, up to which it is left out. Faces of regular grids
/// whose bisectors touch an edge of the cell come out with a width of some 1e-16.
const FACE_TOLERANCE: f64 = 1e-14;

/// Merges the pieces that come from the same bisector, plane or curve, and drops those without size;
/// `walls` has the number of every piece of a wall, `scale` is the cell's radius to the power D-1.
pub(crate) fn collect_faces<const D: usize>(
    center: &[f64; D],
    candidates: &[(u32, [f64; D])],
    order: &[(f64, u32)],
    container: &Container<D>,
    walls: &[u16],
    pieces: &mut [Piece],
    scale: f64,
) -> Result<Vec<CellFace<D>>, CellError> {
    pieces.sort_by_key(|piece| piece.source);
    let mut faces = Vec::with_capacity(pieces.len());
    for group in pieces.chunk_by(|a, b| a.source == b.source) {
        let (mut vector, mut weight, mut weighted) = ([0.0; 3], 0.0, [0.0; 3]);
        for piece in group {
            let size = norm(&piece.area);
            weight += size;
            for axis in 0..3 {
                vector[axis] += piece.area[axis];
                weighted[axis] += size * piece.centroid[axis];
            }
        }
        let area = norm(&vector);
        if area <= FACE_TOLERANCE * scale {
            continue;
        }
        let kind = match group[0].source {
            Source::Candidate(rank) => FaceKind::Neighbor(candidates[order[rank as usize].1 as usize].0),
            Source::Plane(k) => FaceKind::Boundary(container.planes[k as usize].face),
            Source::Cut(k) => {
                let more = container.walls.iter().flat_map(|walls| walls.cuts);
                let cut = container.cuts.iter().chain(more).nth(k as usize);
                // Every cut that made a face is one of these.
                FaceKind::Boundary(cut.map_or(0, |cut| cut.face))
            }
            Source::Wall(k) => FaceKind::Boundary(walls[k as usize]),
            Source::Start => return Err(CellError::OpenContainer { center: center.to_vec() }),
        };
        let normal = resize(&vector.map(|x| x / area));
        let centroid = std::array::from_fn(|axis| center[axis] + weighted[axis] / weight);
        faces.push(CellFace { kind, area, normal, centroid });
    }
    Ok(faces)
}

fn norm(x: &[f64; 3]) -> f64 {
    (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt()
}
