//! Where a mesh is refined.

use crate::error::FreeSpaceError;
use crate::mesh::Mesh;

use super::Superposition;

/// A box of cells of another mesh, divided more finely.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patch<const D: usize> {
    /// The patch that it lies in; `None` for the base mesh.
    pub parent: Option<usize>,
    /// First cell of the parent in each direction.
    pub first: [usize; D],
    /// Cells of the parent that it covers.
    pub cells: [usize; D],
    /// Parts that a cell of the parent is divided into in each direction.
    pub ratio: usize,
}

impl<const D: usize> Patch<D> {
    /// The patch of the base mesh that covers the box from `min` to `max` and as little more as possible.
    pub fn covering(base: &Mesh<D>, min: [f64; D], max: [f64; D], ratio: usize) -> Self {
        let (mut first, mut cells) = ([0; D], [0; D]);
        for a in 0..D {
            let place = |x: f64| (x - base.min()[a]) / base.spacing()[a];
            // A face that is meant to lie on a face of the mesh may be off by round-off.
            let low = (place(min[a]) + 1e-9).floor().max(0.0) as usize;
            let high = (place(max[a]) - 1e-9).ceil().max(0.0) as usize;
            (first[a], cells[a]) = (low, high.saturating_sub(low));
        }
        Self { parent: None, first, cells, ratio }
    }

    pub(super) fn mesh(&self, index: usize, parent: &Mesh<D>) -> Result<Mesh<D>, FreeSpaceError> {
        let wrong = |what: String| Err(FreeSpaceError::Patch { patch: index, what });
        if self.ratio < 2 {
            return wrong(format!("its ratio is {}, which must be a whole number from 2 on", self.ratio));
        }
        for a in 0..D {
            let (end, there) = (self.first[a].saturating_add(self.cells[a]), parent.cells()[a]);
            if self.cells[a] == 0 || end > there {
                return wrong(format!(
                    "it covers the cells {} to {end} of its parent in direction {a}, which has {there}",
                    self.first[a]
                ));
            }
        }
        let spacing = parent.spacing();
        Mesh::new(
            std::array::from_fn(|a| parent.min()[a] + self.first[a] as f64 * spacing[a]),
            spacing.map(|h| h / self.ratio as f64),
            self.cells.map(|n| n.saturating_mul(self.ratio)),
            parent.centring(),
        )
    }
}

/// Points that `coarse` lacks on its sides for all points of `fine` to be interpolated from it.
pub(super) fn shortage<const D: usize>(fine: &Mesh<D>, coarse: &Mesh<D>, how: Superposition) -> usize {
    let (half, place) = (how.half_width() as f64, fine.places_in(coarse));
    let lacking = |a: usize| {
        let (low, high) = (place(a, 0).floor(), place(a, fine.points()[a] - 1).floor());
        (half - 1.0 - low).max(high + half - (coarse.points()[a] - 1) as f64)
    };
    (0..D).map(lacking).fold(0.0, f64::max) as usize
}
