//! The domain as cells see it: a bounding box, flat faces and curved faces.

use std::fmt;

use crate::error::CellError;

/// Largest deviation of a plane's normal from unit length. Distances to the plane, and with them the test for nodes
/// outside, are wrong by this fraction; a normal that was normalised in double precision is off by 1e-16.
const UNIT_TOLERANCE: f64 = 1e-9;

/// A flat face of the domain: the domain lies where `normal . x <= offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane<const D: usize> {
    /// Unit normal that points out of the domain.
    pub normal: [f64; D],
    /// Distance of the plane from the origin along the normal.
    pub offset: f64,
    /// Number that the cells' faces on this plane carry.
    pub face: u16,
}

/// A curved face of the domain: the domain lies where the level set is negative.
///
/// The level set has to be continuous; it need not be a distance. It is evaluated at the vertices of the cell and on
/// the edges whose ends differ in sign. A part of the boundary that crosses no edge, or that crosses one twice, is
/// missed: the domain has to be resolved by the nodes. Where several parts of a cell lie inside, they are joined by
/// chords (2-D) or by straight edges across the faces (3-D), as the corners of a cell that pokes through a boundary
/// are cut off one by one. The volume of the domain is met with an error of `O(h^2)`.
#[derive(Clone, Copy)]
pub struct Cut<'a, const D: usize> {
    /// Level set, negative inside the domain.
    pub level: &'a (dyn Fn(&[f64; D]) -> f64 + Sync),
    /// Number that the cells' faces on this boundary carry.
    pub face: u16,
}

impl<const D: usize> fmt::Debug for Cut<'_, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cut").field("face", &self.face).finish_non_exhaustive()
    }
}

/// The domain that cells are clipped to: the intersection of all its planes and cuts.
///
/// A box has no faces of its own: its `2 D` planes carry the numbers, see [`box_planes`].
#[derive(Debug, Clone, Copy)]
pub struct Container<'a, const D: usize> {
    /// Lower corner of a box that holds the domain.
    pub min: [f64; D],
    /// Upper corner of a box that holds the domain.
    pub max: [f64; D],
    /// Flat faces.
    pub planes: &'a [Plane<D>],
    /// Curved faces.
    pub cuts: &'a [Cut<'a, D>],
}

impl<const D: usize> Container<'_, D> {
    /// Whether the box is one and the planes are given by unit normals.
    pub(crate) fn check(&self) -> Result<(), CellError> {
        for axis in 0..D {
            let (lo, hi) = (self.min[axis], self.max[axis]);
            if !(lo.is_finite() && hi.is_finite() && lo < hi) {
                return Err(CellError::InvalidBox { axis, min: lo, max: hi });
            }
        }
        for (plane, &Plane { normal, offset, face }) in self.planes.iter().enumerate() {
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            if !offset.is_finite() || length.is_nan() || (length - 1.0).abs() > UNIT_TOLERANCE {
                return Err(CellError::InvalidPlane { plane, face, length, offset });
            }
        }
        Ok(())
    }
}

/// The planes of the box from `min` to `max`: face `2 k` is the lower one on axis `k`, face `2 k + 1` the upper.
#[must_use]
pub fn box_planes<const D: usize>(min: &[f64; D], max: &[f64; D]) -> Vec<Plane<D>> {
    let mut planes = Vec::with_capacity(2 * D);
    for axis in 0..D {
        for (side, sign) in [(0_usize, -1.0), (1, 1.0)] {
            let mut normal = [0.0; D];
            normal[axis] = sign;
            let offset = if side == 0 { -min[axis] } else { max[axis] };
            planes.push(Plane { normal, offset, face: (2 * axis + side) as u16 });
        }
    }
    planes
}
