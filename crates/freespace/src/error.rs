//! What can be wrong with a problem.

use thiserror::Error;

/// Why a mesh, a kernel, a plan or a source is refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FreeSpaceError {
    /// A direction without cells.
    #[error("direction {axis} has no cells; give at least one")]
    NoCells {
        /// Direction, 0 for x.
        axis: usize,
    },
    /// A spacing, a corner or another length that cannot be.
    #[error("{what} is {value}, which must be {expected}")]
    Invalid {
        /// What was given.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// An order that there is no kernel of.
    #[error("no Gaussian kernel has order {order}; orders are even, from 2 to 20")]
    Order {
        /// What was asked for.
        order: usize,
    },
    /// A period too short for a truncated kernel: images of the source would reach the box.
    #[error(
        "the period {period} in direction {axis} is shorter than {needed}, the box and the radius of truncation together"
    )]
    Period {
        /// Direction.
        axis: usize,
        /// Period, a length.
        period: f64,
        /// The least period that suffices.
        needed: f64,
    },
    /// A source of the wrong length.
    #[error("the {what} has {got} values, {expected} are needed")]
    Length {
        /// Which array.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length that it must have.
        expected: usize,
    },
    /// A value that is not finite.
    #[error("value {index} of the {what} is {value}; values must be finite")]
    NotFinite {
        /// Which array.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Index in the array.
        index: usize,
    },
    /// Values whose sums are not finite.
    #[error(
        "sums of the values of the source overflow; divide it by its largest magnitude, and multiply the results"
    )]
    Overflow,
    /// More memory than there is.
    #[error("this mesh needs {needed} MB, {available} MB are available; use fewer cells")]
    Memory {
        /// Megabytes that the plan and one solve need.
        needed: u64,
        /// Megabytes that may be used.
        available: u64,
    },
    /// A kernel that has no estimate of its error, or a boundary that it cannot have.
    #[error("{what}")]
    Kernel {
        /// What does not go together.
        what: String,
    },
    /// A tolerance that the mesh does not allow.
    #[error(
        "the tolerance {tolerance:e} cannot be met on this mesh, {error:e} is the least; use a finer mesh"
    )]
    Tolerance {
        /// What was asked for.
        tolerance: f64,
        /// The error that is expected of the best kernel.
        error: f64,
    },
    /// A source that does not end within its box.
    #[error(
        "at the edge of its box the source is {edge:e} of its largest value, above the tolerance {tolerance:e}; enlarge the box"
    )]
    Edge {
        /// Largest magnitude at the edge over that of all.
        edge: f64,
        /// What was asked for.
        tolerance: f64,
    },
    /// Patches that would have to be finer than allowed.
    #[error(
        "after {levels} levels of patches the estimated error is {error:e} of the largest value, above the tolerance {tolerance:e}; allow more \
         levels, or make the source smoother"
    )]
    Levels {
        /// Levels that were allowed.
        levels: usize,
        /// What was asked for.
        tolerance: f64,
        /// The largest estimate on the finest patches.
        error: f64,
    },
    /// A source that no periodic potential belongs to.
    #[error(
        "the mean of the source is {mean:e} of its largest value, and no direction is open: subtract it, or allow that with \
         `remove_mean`"
    )]
    Mean {
        /// Mean over largest magnitude.
        mean: f64,
    },
    /// A patch that cannot be.
    #[error("patch {patch}: {what}")]
    Patch {
        /// Which patch, counted from 0.
        patch: usize,
        /// What is wrong with it.
        what: String,
    },
    /// A particle where the mesh does not reach around it.
    #[error(
        "particle {particle} at {at} in direction {axis} has no {points} points of the mesh on each side; enlarge the box"
    )]
    Particle {
        /// Which particle, counted from 0.
        particle: usize,
        /// Direction.
        axis: usize,
        /// Its coordinate there.
        at: f64,
        /// Points that are needed on each side.
        points: usize,
    },
    /// An output that refers to a source or a direction that is not there.
    #[error("{what}")]
    Output {
        /// What does not exist.
        what: String,
    },
}

impl FreeSpaceError {
    /// Refuses a length that is not positive and finite.
    pub(crate) fn unless_positive(what: &'static str, value: f64) -> Result<(), Self> {
        if value > 0.0 && value.is_finite() {
            Ok(())
        } else {
            Err(Self::Invalid { what, value, expected: "positive and finite" })
        }
    }
}
