//! What every search asks of its points.

use crate::NeighborError;

/// Points must be finite and countable.
pub(crate) fn check_points<const D: usize>(points: &[[f64; D]]) -> Result<(), NeighborError> {
    if points.len() >= u32::MAX as usize {
        return Err(NeighborError::TooManyPoints { points: points.len() });
    }
    match points.iter().position(|x| x.iter().any(|c| !c.is_finite())) {
        Some(index) => Err(NeighborError::NotFinite { index, position: points[index].to_vec() }),
        None => Ok(()),
    }
}

/// The error for two points that coincide.
pub(crate) fn duplicate<const D: usize>(points: &[[f64; D]], i: u32, j: u32) -> NeighborError {
    let (first, second) = (i.min(j) as usize, i.max(j) as usize);
    NeighborError::Duplicate { first, second, position: points[first].to_vec() }
}

pub(crate) fn squared_distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut squared = 0.0;
    for k in 0..D {
        let d = a[k] - b[k];
        squared += d * d;
    }
    squared
}
