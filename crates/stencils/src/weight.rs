//! Weight functions of the distance.

/// How much a neighbour counts in a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Weight {
    /// `exp(-2 r / (h_i + h_j))`: Kraus et al. (2022), (9).
    Exponential,
    /// `exp(-decay r^2 / h_i^2)`.
    Gaussian {
        /// The exponent at `r = h_i`.
        decay: f64,
    },
    /// `(1 - r / h_i)^4` within the radius, and a thousandth of a thousandth beyond: Yoon and Song, the quartic weight.
    Quartic,
    /// The same for all: an unweighted fit.
    Uniform,
}

/// Weight of the quartic function at and beyond the radius, where it would vanish and take a point out of the fit.
const QUARTIC_FLOOR: f64 = 1e-6;

impl Weight {
    /// The weight of a neighbour at a distance, given the radii of the centre and of the neighbour; positive.
    pub fn value(&self, distance: f64, h_i: f64, h_j: f64) -> f64 {
        match *self {
            Self::Exponential => (-2.0 * distance / (h_i + h_j)).exp(),
            Self::Gaussian { decay } => (-decay * (distance / h_i).powi(2)).exp(),
            Self::Quartic => (1.0 - distance / h_i).max(0.0).powi(4).max(QUARTIC_FLOOR),
            Self::Uniform => 1.0,
        }
    }
}
