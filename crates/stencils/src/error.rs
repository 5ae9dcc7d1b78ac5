//! Why a local fit has no stencil.

use thiserror::Error;

/// Why a local fit has no stencil.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StencilError {
    /// The points do not determine the operator: too few, or all on a curve of the fit's degree.
    #[error(
        "{points} points of rank {rank} do not determine the operator for polynomials of {monomials} terms (what is \
         left over: {remainder:.1e})"
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
    /// As many weights or places for coefficients as points are needed.
    #[error("{given} {what} for {points} points")]
    LengthMismatch {
        /// What there should be one of for each point.
        what: &'static str,
        /// How many there are.
        given: usize,
        /// Points of the support.
        points: usize,
    },
}
