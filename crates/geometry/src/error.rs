use crate::projection::ProjectionError;

/// What can be wrong with a shape, a domain, a set of regions or the request for a cloud.
///
/// Coordinates are given as vectors, so that one error type serves every dimension.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A shape's parameters contradict each other.
    #[error("invalid {shape}: {reason}")]
    InvalidShape {
        /// Which kind of shape.
        shape: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// The domain has no points, or the pieces it is made of do not fit each other.
    #[error("invalid domain: {reason}")]
    InvalidDomain {
        /// What is wrong with it.
        reason: String,
    },
    /// A spacing that is not a positive finite number.
    #[error("the spacing at {at:?} is {spacing}; it must be positive and finite")]
    InvalidSpacing {
        /// Where it was evaluated.
        at: Vec<f64>,
        /// Its value there.
        spacing: f64,
    },
    /// A spacing that falls to zero somewhere, so that a cloud would have no end.
    #[error(
        "the spacing falls to zero at about {at:?}, where it is {spacing:.1e}; \
         add what it is to be at least, or use `max`"
    )]
    VanishingSpacing {
        /// About where.
        at: Vec<f64>,
        /// Its value there.
        spacing: f64,
    },
    /// The spacing is so large that no node fits inside the domain.
    #[error("a spacing of {spacing} leaves no interior node in a domain of size {size}; use a smaller one")]
    SpacingTooLarge {
        /// The spacing asked for (the smallest one met, for graded clouds).
        spacing: f64,
        /// The shortest edge of the domain's bounding box.
        size: f64,
    },
    /// More nodes than allowed; found before any is generated where the estimate shows it.
    #[error(
        "about {estimate:.3e} nodes, but at most {limit} are allowed; \
         multiply the spacing by {factor:.3}"
    )]
    TooManyNodes {
        /// Estimated number of nodes.
        estimate: f64,
        /// The limit, [`CloudParams::max_nodes`](crate::CloudParams::max_nodes).
        limit: usize,
        /// What to multiply the spacing by to fit (for a uniform spacing `s`, `factor * s` fits).
        factor: f64,
    },
    /// Grid and jittered layouts need one spacing for the whole domain.
    #[error("the {layout} layout needs a uniform spacing; use the irregular layout for a graded cloud")]
    GradedLattice {
        /// The layout asked for.
        layout: &'static str,
    },
    /// A point could not be put onto a boundary.
    #[error("the boundary could not be sampled: {0}")]
    Projection(#[from] ProjectionError),
    /// The parts of a cloud contradict each other.
    #[error("invalid cloud: {reason}")]
    InvalidCloud {
        /// What is wrong, with the node's index.
        reason: String,
    },
    /// A list of regions that does not label every point.
    #[error("invalid regions: {reason}")]
    InvalidRegions {
        /// What is wrong with them.
        reason: String,
    },
}

impl GeometryError {
    pub(crate) fn invalid(shape: &'static str, reason: impl Into<String>) -> Self {
        Self::InvalidShape { shape, reason: reason.into() }
    }

    pub(crate) fn domain(reason: impl Into<String>) -> Self {
        Self::InvalidDomain { reason: reason.into() }
    }

    pub(crate) fn cloud(reason: impl Into<String>) -> Self {
        Self::InvalidCloud { reason: reason.into() }
    }
}
