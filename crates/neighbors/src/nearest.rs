//! Neighbour lists by number, from a k-d tree: the one file that names kiddo.

use std::num::NonZero;

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;

use crate::cell_list::check_points;
use crate::{NeighborError, NeighborLists};

/// The k nearest other points of every point, by distance; of two that are as near, the one of lower index comes first.
///
/// Which of several points at the distance of the last one are listed depends on the points alone.
///
/// # Errors
/// Points that are not finite or coincide, and fewer than k + 1 points.
pub fn nearest<const D: usize>(points: &[[f64; D]], k: usize) -> Result<NeighborLists, NeighborError> {
    check_points(points)?;
    let too_few = NeighborError::TooFewPoints { asked: k, points: points.len() };
    let Some(count) = NonZero::new(k + 1).filter(|_| k > 0 && k < points.len()) else {
        return Err(too_few);
    };
    let tree = ImmutableKdTree::new_from_slice(points).map_err(|_| too_few)?;
    let lists = (0..points.len())
        .into_par_iter()
        .map(|i| {
            let mut found: Vec<(f64, u32)> = tree
                .query(&points[i])
                .nearest_n::<SquaredEuclidean<f64>>(count)
                .execute()
                .into_iter()
                .map(|hit| (hit.distance, hit.item as u32))
                .filter(|&(_, j)| j as usize != i)
                .collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            found.truncate(k);
            match found.first() {
                Some(&(0.0, j)) => {
                    let (first, second) = (i.min(j as usize), i.max(j as usize));
                    Err(NeighborError::Duplicate { first, second, position: points[i].to_vec() })
                }
                _ => Ok(found.into_iter().map(|(_, j)| j).collect()),
            }
        })
        .collect::<Result<Vec<Vec<u32>>, _>>()?;
    NeighborLists::from_lists(lists)
}
