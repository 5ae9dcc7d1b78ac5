//! What can be wrong with a cloud of points.

use thiserror::Error;

use crate::radius::RADII;

/// Why there are no neighbour lists.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NeighborError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} is not finite: {position:?}")]
    NotFinite {
        /// Index of the point.
        index: usize,
        /// Its coordinates.
        position: Vec<f64>,
    },
    /// Two points coincide.
    #[error("points {first} and {second} coincide at {position:?}; remove one of them")]
    Duplicate {
        /// The lower index.
        first: usize,
        /// The higher index.
        second: usize,
        /// Coordinates of the first.
        position: Vec<f64>,
    },
    /// A point with fewer neighbours than are needed.
    #[error(
        "point {index} at {position:?} has {found} neighbours within its radius {radius}, but {asked} are needed; a \
         radius of {sufficient} would be enough there"
    )]
    TooFewNeighbors {
        /// Index of the point.
        index: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// Its radius.
        radius: f64,
        /// Neighbours it has.
        found: usize,
        /// Neighbours it should have.
        asked: usize,
        /// The smallest radius of this point with which it would have them, all other radii being as they are.
        sufficient: f64,
    },
    /// A radius with which no distances can be compared: not positive, not finite, or with a square that is not.
    #[error("the radius of point {index} is {radius}; it must be between {:e} and {:e}", RADII.start(), RADII.end())]
    InvalidRadius {
        /// Index of the point.
        index: usize,
        /// The radius.
        radius: f64,
    },
    /// The number of radii is not that of the points.
    #[error("{radii} radii for {points} points")]
    LengthMismatch {
        /// Number of radii.
        radii: usize,
        /// Number of points.
        points: usize,
    },
    /// Fewer points than neighbours asked for.
    #[error("{asked} neighbours asked for each of {points} points: there must be more points")]
    TooFewPoints {
        /// Neighbours asked for.
        asked: usize,
        /// Number of points.
        points: usize,
    },
    /// More points than indices can count.
    #[error("{points} points; indices count fewer than {}", u32::MAX)]
    TooManyPoints {
        /// Number of points.
        points: usize,
    },
    /// Lists given from outside that break the invariants.
    #[error("invalid lists at point {index}: {reason}")]
    InvalidLists {
        /// Index of the point.
        index: usize,
        /// What is wrong.
        reason: &'static str,
    },
}
