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

/// A flat face that ends at edges, a side of a polygon or of one of the boxes of a union: part of a boundary that is not the
/// intersection of its planes, or of an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall<const D: usize> {
    /// Unit normal, to either side.
    pub normal: [f64; D],
    /// Distance of the wall's plane from the origin along the normal.
    pub offset: f64,
    /// Lower corner of a box that holds the face; may be infinite.
    pub min: [f64; D],
    /// Upper corner of that box; may be infinite.
    pub max: [f64; D],
}

/// A boundary that is made of walls, in any arrangement: re-entrant edges, corners, slots and openings are met exactly.
///
/// A cell that walls cross is divided by their planes into convex parts, each of which is wholly in the domain or out of it. Parts
/// across a gap that are farther away than half of what was searched are not found: nodes have to resolve the domain on either side.
#[derive(Clone, Copy)]
pub struct Walls<'a, const D: usize> {
    /// The walls.
    pub walls: &'a [Wall<D>],
    /// `None` at a point in the domain, otherwise the number that faces towards that point carry. Asked off the walls only.
    pub beyond: &'a (dyn Fn(&[f64; D]) -> Option<u16> + Sync),
    /// The same boundary by level sets: for a cell that more than [`MOST_WALLS`] planes cross.
    pub cuts: &'a [Cut<'a, D>],
}

/// Most planes of walls that a cell is divided by. Parts are as many as their number to the power D, at worst; a cell that more
/// walls cross than this is larger than what they resolve.
pub const MOST_WALLS: usize = 32;

impl<const D: usize> fmt::Debug for Walls<'_, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Walls").field("walls", &self.walls).field("cuts", &self.cuts).finish_non_exhaustive()
    }
}

/// What divides the domain: interfaces that are made of walls.
#[derive(Clone, Copy)]
pub struct Interfaces<'a, const D: usize> {
    /// The walls.
    pub walls: &'a [Wall<D>],
    /// The number of the part that a point off the walls is in.
    pub label: &'a (dyn Fn(&[f64; D]) -> u16 + Sync),
}

impl<const D: usize> fmt::Debug for Interfaces<'_, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Interfaces").field("walls", &self.walls).finish_non_exhaustive()
    }
}

/// The domain that cells are clipped to: the intersection of all its planes and cuts, and of what walls bound.
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
    /// Flat faces with edges.
    pub walls: Option<Walls<'a, D>>,
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
        self.walls.map_or(Ok(()), |walls| check_walls(walls.walls))
    }
}

/// Whether walls are given by unit normals.
pub(crate) fn check_walls<const D: usize>(walls: &[Wall<D>]) -> Result<(), CellError> {
    for (wall, Wall { normal, offset, .. }) in walls.iter().enumerate() {
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if !offset.is_finite() || length.is_nan() || (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err(CellError::InvalidWall { wall, length, offset: *offset });
        }
    }
    Ok(())
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
