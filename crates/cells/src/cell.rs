//! What is known of a cell: its volume, its centroid and its faces.

/// What a face of a cell is shared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceKind {
    /// The cell of another node; the number is the one that the candidate was given.
    Neighbor(u32),
    /// The boundary of the domain; the number is that of the [`Plane`](crate::Plane) or
    /// [`Cut`](crate::Cut), or what lies beyond the [`Walls`](crate::Walls).
    Boundary(u16),
}

/// A face of a cell: a point in one dimension, a segment in two, a polygon in three.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellFace<const D: usize> {
    /// What lies on the other side.
    pub kind: FaceKind,
    /// Size of the face, in units of length^(D-1); 1 in one dimension. For a curved face this is the norm of the
    /// vector area, smaller than the surface by a relative `O(h^2)`: with it, `sum area * normal = 0`
    /// over the faces of a cell.
    pub area: f64,
    /// Unit normal that points out of the cell; for a curved face the direction of the vector area.
    pub normal: [f64; D],
    /// Centroid of the face.
    pub centroid: [f64; D],
}

/// The Voronoi cell of a node, clipped to the domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell<const D: usize> {
    /// Volume, in units of length^D.
    pub volume: f64,
    /// Centroid of the cell.
    pub centroid: [f64; D],
    /// The faces: those with neighbours first, nearest neighbour first, then those on the boundary in the order of
    /// the container's planes, cuts and walls. Faces without size are left out. Each neighbour, plane and cut occurs once
    /// at most, each wall once a piece: pieces are convex.
    pub faces: Vec<CellFace<D>>,
    /// Twice the distance of the farthest vertex: a node farther away than this cannot touch the cell.
    pub reach: f64,
}

impl<const D: usize> Cell<D> {
    /// The faces that are shared with other nodes: `(neighbour, face)`.
    pub fn neighbors(&self) -> impl Iterator<Item = (u32, &CellFace<D>)> {
        self.faces.iter().filter_map(|face| match face.kind {
            FaceKind::Neighbor(index) => Some((index, face)),
            FaceKind::Boundary(_) => None,
        })
    }

    /// Whether a face lies on the boundary of the domain.
    #[must_use]
    pub fn touches_boundary(&self) -> bool {
        self.faces.iter().any(|face| matches!(face.kind, FaceKind::Boundary(_)))
    }
}
