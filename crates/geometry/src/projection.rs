/// The foot of a point on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection<const D: usize> {
    /// The point of the surface.
    pub point: [f64; D],
    /// Outward unit normal of the surface there.
    pub normal: [f64; D],
    /// Distance from the point that was projected; negative where that lies inside.
    pub distance: f64,
}

/// Why a point has no projection.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectionError {
    /// No point of the surface was found near enough.
    #[error("no point of the surface within {reach} of {at:?} (level {level})")]
    OutOfReach {
        /// The point that was to be projected.
        at: Vec<f64>,
        /// How far was searched.
        reach: f64,
        /// The level there.
        level: f64,
    },
    /// The gradient vanishes where the surface should be, so that it has no normal.
    #[error("the gradient of the level set vanishes at {at:?}")]
    FlatGradient {
        /// Where.
        at: Vec<f64>,
    },
    /// The level, its gradient or the point itself is not a finite number.
    #[error("the level set or its gradient is not finite at {at:?}")]
    NotFinite {
        /// Where.
        at: Vec<f64>,
    },
    /// The nearest point of the surface does not separate the two regions asked for.
    #[error("no interface between regions {regions:?} within {reach} of {at:?}")]
    NotAnInterface {
        /// The point that was to be projected.
        at: Vec<f64>,
        /// The two labels.
        regions: [u16; 2],
        /// How far was searched.
        reach: f64,
    },
}
