//! What can be wrong with a cloud of points.

use thiserror::Error;

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
        /// Their coordinates.
        position: Vec<f64>,
    },
    /// A point without neighbours.
    #[error(
        "point {index} at {position:?} has no neighbour within {radius}; a larger radius is needed there"
    )]
    Isolated {
        /// Index of the point.
        index: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// Its radius.
        radius: f64,
    },
    /// A radius that is not positive and finite.
    #[error("the radius of point {index} is {radius}; it must be positive and finite")]
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
    #[error("{asked} neighbours asked for, but there are only {points} points")]
    TooFewPoints {
        /// Neighbours asked for.
        asked: usize,
        /// Number of points.
        points: usize,
    },
    /// More points than indices can count.
    #[error("{points} points; lists hold at most 4294967295")]
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
