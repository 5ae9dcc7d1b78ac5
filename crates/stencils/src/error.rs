//! Why a local fit has no stencil.

use thiserror::Error;

/// Why a local fit has no stencil.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StencilError {
    /// The points do not determine the operator: too few, or all on a curve of the fit's degree.
    #[error(
        "{points} points of rank {rank} do not determine the operator for polynomials of {monomials} terms (what is \
         left over: {remainder:.1e}); enlarge the support"
    )]
    Unresolvable {
        /// Points of the support.
        points: usize,
        /// Monomials to reproduce.
        monomials: usize,
        /// Rank of the moment matrix.
        rank: usize,
        /// Largest violated reproduction condition, relative to the largest moment.
        remainder: f64,
    },
    /// An offset, a weight or the radius is not finite, or a weight or the radius is not positive.
    #[error("the {what} of entry {entry} is {value}; offsets must be finite, weights and radius positive")]
    Invalid {
        /// Which quantity.
        what: &'static str,
        /// Entry of the support.
        entry: usize,
        /// Its value.
        value: f64,
    },
    /// A place among the points of a support that has no such place.
    #[error("no point {entry} in a support of {points} points")]
    NoSuchPoint {
        /// Place that was named.
        entry: usize,
        /// Points of the support.
        points: usize,
    },
    /// An axis that the space does not have.
    #[error("{functional} names an axis beyond the {dimension} there are")]
    NoSuchAxis {
        /// The functional.
        functional: String,
        /// Dimension of the space.
        dimension: usize,
    },
    /// A derivative of higher order than the polynomials that are reproduced: it would be zero on all of them.
    #[error(
        "{functional} is of order {order}, but only polynomials to degree {degree} are reproduced; raise the degree"
    )]
    DegreeTooLow {
        /// The functional.
        functional: String,
        /// Its order.
        order: usize,
        /// Degree of the fit.
        degree: usize,
    },
    /// Supports that are no lists of the points.
    #[error("the supports of {points} points are invalid at point {node}: {reason}")]
    InvalidSupports {
        /// The point.
        node: usize,
        /// Number of points.
        points: usize,
        /// What is wrong.
        reason: &'static str,
    },
    /// No stencil at one point of a cloud.
    #[error("no stencil at point {node} ({position:?}): {source}")]
    AtPoint {
        /// The point.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
        /// Why.
        source: Box<StencilError>,
    },
    /// A slice of the wrong length.
    #[error("{given} {what} where {expected} are needed")]
    LengthMismatch {
        /// What is in the slice.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length that it should have.
        expected: usize,
    },
}
