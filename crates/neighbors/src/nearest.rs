//! Neighbour lists by number, from a k-d tree: the one file that names kiddo.

use std::num::NonZero;

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;

use crate::check::{check_points, duplicate, squared_distance};
use crate::{NeighborError, NeighborLists};

/// Squared distances that agree to this factor may be ties: the rounding of a sum of three squares, and then some.
const WIDER: f64 = 1.0 + 8.0 * f64::EPSILON;

/// The k nearest other points of every point, by distance and, where that is the same, by index.
///
/// # Errors
/// Points that are not finite or coincide (or are so close that the square of their distance is 0), and fewer than
/// k + 1 points.
pub fn nearest<const D: usize>(points: &[[f64; D]], k: usize) -> Result<NeighborLists, NeighborError> {
    check_points(points)?;
    let too_few = || NeighborError::TooFewPoints { asked: k, points: points.len() };
    if k == 0 || k >= points.len() {
        return Err(too_few());
    }
    let tree = ImmutableKdTree::new_from_slice(points).map_err(|_| too_few())?;
    let outcomes: Vec<Result<Vec<u32>, NeighborError>> = (0..points.len())
        .into_par_iter()
        .map_init(Vec::new, |found, i| {
            around(&tree, points, &points[i], k, found);
            found.retain(|&(_, j)| j as usize != i);
            match found.first() {
                Some(&(0.0, j)) => Err(duplicate(points, i as u32, j)),
                _ => Ok(found[..k].iter().map(|&(_, j)| j).collect()),
            }
        })
        .collect();
    // Which points an error names must not depend on which thread was faster.
    NeighborLists::from_lists(outcomes.into_iter().collect::<Result<_, _>>()?)
}

/// Squared distances and indices of the k + 1 points nearest to x or more, in order.
fn around<const D: usize>(
    tree: &ImmutableKdTree<f64, D>,
    points: &[[f64; D]],
    x: &[f64; D],
    k: usize,
    found: &mut Vec<(f64, u32)>,
) {
    // Distances are computed here, so that neither order nor ties depend on how the tree rounds them.
    let entry = |j: u32| (squared_distance(&points[j as usize], x), j);
    let in_order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    // One more than is needed, to see whether the last one is tied with others that the tree has left out.
    let asked = NonZero::<usize>::MIN.saturating_add(k + 1);
    let hits = tree.query(x).nearest_n::<SquaredEuclidean<f64>>(asked).execute();
    found.clear();
    found.extend(hits.iter().map(|hit| entry(hit.item)));
    found.sort_unstable_by(in_order);
    if found.len() <= k {
        // Squares overflow, and the tree leaves out what is infinitely far away.
        found.clear();
        found.extend((0..points.len() as u32).map(entry));
        found.sort_unstable_by(in_order);
    } else if found.len() > k + 1 && found[k + 1].0 <= found[k].0 * WIDER {
        let limit = found[k].0 * WIDER;
        let ties = tree.query(x).within::<SquaredEuclidean<f64>>(limit).execute();
        found.clear();
        found.extend(ties.iter().map(|hit| entry(hit.item)));
        found.sort_unstable_by(in_order);
    }
}
