//! Why a cell could not be built.

use thiserror::Error;

/// Why a cell could not be built. Positions are given in full, one number for each dimension.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CellError {
    /// The candidates do not reach far enough to know the cell.
    #[error(
        "the cell of the node at {center:?} needs all nodes within {needed:e}, but they were searched within \
         {searched:e} only; search farther"
    )]
    Incomplete {
        /// Position of the node.
        center: Vec<f64>,
        /// Radius that was searched.
        searched: f64,
        /// Radius that is needed, as far as is known: another search may have to follow.
        needed: f64,
    },
    /// The node lies outside the domain.
    #[error(
        "the node at {center:?} lies outside the domain, by {distance:e} beyond face {face}; move or remove it"
    )]
    OutsideDomain {
        /// Position of the node.
        center: Vec<f64>,
        /// Number of the violated face.
        face: u16,
        /// Distance from the plane, or value of the level set.
        distance: f64,
    },
    /// The node lies outside the bounding box.
    #[error("the node at {center:?} lies outside the bounding box of the domain")]
    OutsideBox {
        /// Position of the node.
        center: Vec<f64>,
    },
    /// A candidate coincides with the node.
    #[error("candidate {index} coincides with the node at {center:?}; remove one of the two nodes")]
    Duplicate {
        /// Number of the candidate.
        index: u32,
        /// Position of the node.
        center: Vec<f64>,
    },
    /// Two candidates coincide.
    #[error("candidates {first} and {second} coincide at {position:?}; remove one of the two nodes")]
    DuplicateCandidates {
        /// Number of a candidate.
        first: u32,
        /// Number of the other.
        second: u32,
        /// Where both lie.
        position: Vec<f64>,
    },
    /// A coordinate of the node is not finite.
    #[error("the node's position {center:?} is not finite")]
    CenterNotFinite {
        /// Position of the node.
        center: Vec<f64>,
    },
    /// A coordinate of a candidate is not finite.
    #[error("the position {position:?} of candidate {index} is not finite")]
    CandidateNotFinite {
        /// Number of the candidate.
        index: u32,
        /// Its position.
        position: Vec<f64>,
    },
    /// A level set has no value.
    #[error("the level set of face {face} is not a number somewhere on the cell of the node at {center:?}")]
    LevelNotANumber {
        /// Number of the curved face.
        face: u16,
        /// Position of the node.
        center: Vec<f64>,
    },
    /// The node is inside, but no vertex of its cell is.
    #[error(
        "the boundary with face {face} cuts away every vertex of the cell of the node at {center:?}, which is \
         inside: the domain is thinner than the cell there; place more nodes"
    )]
    Unresolved {
        /// Number of the curved face.
        face: u16,
        /// Position of the node.
        center: Vec<f64>,
    },
    /// The planes and cuts of the container leave it open.
    #[error(
        "the cell of the node at {center:?} extends beyond the bounding box of the domain: the container's planes and \
         cuts do not close it there"
    )]
    OpenContainer {
        /// Position of the node.
        center: Vec<f64>,
    },
    /// The cell has no volume.
    #[error(
        "the cell of the node at {center:?} is degenerate: its volume is {volume:e} at a radius of {radius:e}"
    )]
    Degenerate {
        /// Position of the node.
        center: Vec<f64>,
        /// Volume of the cell.
        volume: f64,
        /// Distance of the farthest vertex.
        radius: f64,
    },
    /// The bounding box is empty or not finite.
    #[error("the bounding box is invalid on axis {axis}: from {min} to {max}")]
    InvalidBox {
        /// Axis.
        axis: usize,
        /// Lower end.
        min: f64,
        /// Upper end.
        max: f64,
    },
    /// A plane has no unit normal or no finite offset.
    #[error("plane {plane} (face {face}) is invalid: its normal has length {length}, its offset is {offset}")]
    InvalidPlane {
        /// Position in the container's list.
        plane: usize,
        /// Number of the face.
        face: u16,
        /// Length of the normal.
        length: f64,
        /// Offset.
        offset: f64,
    },
    /// A wall has no unit normal or no finite offset.
    #[error("wall {wall} is invalid: its normal has length {length}, its offset is {offset}")]
    InvalidWall {
        /// Position in the list of walls.
        wall: usize,
        /// Length of the normal.
        length: f64,
        /// Offset.
        offset: f64,
    },
    /// The searched radius is negative or not a number.
    #[error("the searched radius {searched} is not a radius")]
    InvalidRadius {
        /// The radius.
        searched: f64,
    },
}
