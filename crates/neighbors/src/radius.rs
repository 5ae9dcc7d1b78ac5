//! Neighbour lists by radius.

use std::ops::RangeInclusive;

use crate::check::{check_points, squared_distance};
use crate::search::{Reach, Search};
use crate::{NeighborError, NeighborLists};

/// Points nearer than this, relative to the radius (the larger of two), coincide: the columns of a least-squares fit
/// that belong to them would agree to about the square root of the machine precision times 1e-2.
pub const COINCIDENCE: f64 = 1e-10;

/// Radii whose squares, and those of [`COINCIDENCE`] times them, are ordinary numbers.
pub(crate) const RADII: RangeInclusive<f64> = 1e-140..=1e140;

/// Interaction radii h.
#[derive(Debug, Clone, Copy)]
pub enum Radius<'a> {
    /// The same for all points.
    Uniform(f64),
    /// One for each point.
    PerPoint(&'a [f64]),
}

impl Radius<'_> {
    /// The radius of a point.
    ///
    /// # Panics
    /// For a point that has no radius.
    pub fn of(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(radius) => *radius,
            Self::PerPoint(radii) => radii[i],
        }
    }

    fn check(&self, points: usize) -> Result<(), NeighborError> {
        let given = match self {
            Self::Uniform(radius) => std::slice::from_ref(radius),
            Self::PerPoint(radii) if radii.len() == points => radii,
            Self::PerPoint(radii) => {
                return Err(NeighborError::LengthMismatch { radii: radii.len(), points });
            }
        };
        match given.iter().position(|r| !RADII.contains(r)) {
            Some(index) => Err(NeighborError::InvalidRadius { index, radius: given[index] }),
            None => Ok(()),
        }
    }
}

/// The relative distance that decides who is a neighbour (Kraus et al. 2022, section 2.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distance {
    /// `d1 = |x_j - x_i| / h_i`: radial, not symmetric.
    D1,
    /// `d2 = 2 |x_j - x_i| / (h_i + h_j)`: symmetric, not radial.
    D2,
}

/// All points j other than i with `d(x_j, x_i) <= 1`, by ascending index, for every point i.
///
/// The work is in proportion to the number of neighbours, for radii that vary strongly as well.
///
/// # Errors
/// Points that are not finite, that coincide (see [`COINCIDENCE`]), or that have no neighbour; radii that are not
/// positive and finite.
pub fn within_radius<const D: usize>(
    points: &[[f64; D]],
    radius: Radius<'_>,
    distance: Distance,
) -> Result<NeighborLists, NeighborError> {
    check_points(points)?;
    radius.check(points.len())?;
    let reach = match (radius, distance) {
        (Radius::Uniform(h), _) => Reach::Ball(Radius::Uniform(h)),
        (Radius::PerPoint(radii), _) if radii.windows(2).all(|pair| pair[0] == pair[1]) => {
            Reach::Ball(Radius::Uniform(radii.first().copied().unwrap_or(1.0)))
        }
        (radii, Distance::D1) => Reach::Ball(radii),
        (Radius::PerPoint(radii), Distance::D2) => Reach::Mean(radii),
    };
    let lists = Search::new(points, reach).run()?;
    require_neighbors(&lists, 1, points, radius, distance)?;
    Ok(lists)
}

/// Checks that every point has at least `asked` neighbours in lists that [`within_radius`] made with these arguments.
///
/// # Errors
/// [`NeighborError::TooFewNeighbors`] for the first point that has fewer; it says what radius would be enough.
/// [`NeighborError::TooFewPoints`] if none would be.
pub fn require_neighbors<const D: usize>(
    lists: &NeighborLists,
    asked: usize,
    points: &[[f64; D]],
    radius: Radius<'_>,
    distance: Distance,
) -> Result<(), NeighborError> {
    let Some(index) = lists.iter().position(|list| list.len() < asked) else { return Ok(()) };
    if asked >= points.len() {
        return Err(NeighborError::TooFewPoints { asked, points: points.len() });
    }
    let needed_for = |j: usize| {
        let length = squared_distance(&points[j], &points[index]).sqrt();
        match distance {
            Distance::D1 => length,
            Distance::D2 if matches!(radius, Radius::Uniform(_)) => length,
            Distance::D2 => 2.0 * length - radius.of(j),
        }
    };
    let mut needed: Vec<f64> = (0..points.len()).filter(|&j| j != index).map(needed_for).collect();
    let (_, &mut sufficient, _) = needed.select_nth_unstable_by(asked - 1, f64::total_cmp);
    Err(NeighborError::TooFewNeighbors {
        index,
        position: points[index].to_vec(),
        radius: radius.of(index),
        found: lists.of(index).len(),
        asked,
        sufficient,
    })
}
