//! Which nodes are next to each other: pairs with no third node in between.

use meshless_neighbors::NeighborLists;

use crate::parallel;

/// A third node on the sphere over a pair counts as between them if it is inside by more than this times the squared
/// distance of the pair, or on it up to as much outside: so a square of four nodes has no diagonals.
const TIE: f64 = 1e-9;

/// The pairs (i < j) of the Gabriel graph: no third node lies in the ball that has the pair as a diameter.
///
/// The graph contains the Euclidean minimum spanning tree, so a region that is resolved by its nodes is connected
/// in it; and its pairs share a face of their Voronoi cells, so regions that touch in it do touch.
pub fn adjacent_pairs<const D: usize>(points: &[[f64; D]], lists: &NeighborLists) -> Vec<(u32, u32)> {
    parallel::collect(points.len(), |i, pairs| {
        let neighbors = lists.of(i);
        let adjacent = |&&j: &&u32| j as usize > i && !separated(points, neighbors, i, j as usize);
        pairs.extend(neighbors.iter().filter(adjacent).map(|&j| (i as u32, j)));
    })
}

/// Whether a node other than i and j lies in the ball over the segment from i to j.
fn separated<const D: usize>(points: &[[f64; D]], neighbors: &[u32], i: usize, j: usize) -> bool {
    let (a, b) = (&points[i], &points[j]);
    let squared = (0..D).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>();
    neighbors.iter().any(|&other| {
        let x = &points[other as usize];
        let product = (0..D).map(|k| (x[k] - a[k]) * (x[k] - b[k])).sum::<f64>();
        other as usize != j && product < TIE * squared
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshless_neighbors::{Distance, Radius, within_radius};

    #[test]
    fn a_lattice_has_its_edges_and_no_diagonals() {
        let points: Vec<[f64; 2]> = (0..16).map(|k| [f64::from(k % 4), f64::from(k / 4)]).collect();
        let lists = within_radius(&points, Radius::Uniform(2.1), Distance::D2).unwrap();
        let pairs = adjacent_pairs(&points, &lists);
        assert_eq!(pairs.len(), 24);
        for (i, j) in pairs {
            let (a, b) = (points[i as usize], points[j as usize]);
            assert_eq!((a[0] - b[0]).abs() + (a[1] - b[1]).abs(), 1.0);
        }
    }
}
