//! An index of a cloud, for queries around any position.

use crate::NeighborError;
use crate::check::{check_points, squared_distance};
use crate::grid::GridTree;

/// Width of the cells in search radii: narrower cells hold fewer points that do not count, but there are more of them.
pub(crate) const CELL_WIDTH: f64 = 0.5;

/// Points sorted into cells; answers which points are near any position, a point of the cloud or not.
///
/// Crowded cells are divided again, so that clouds of strongly varying density are searched as fast as others.
/// Nothing is found around a position that is not finite.
#[derive(Debug, Clone)]
pub struct CellList<'a, const D: usize> {
    points: &'a [[f64; D]],
    tree: GridTree<D>,
}

impl<'a, const D: usize> CellList<'a, D> {
    /// Sorts the points; cells suit queries with radii around `radius`, but any radius will do.
    ///
    /// # Errors
    /// A point that is not finite, or more points than indices can count.
    pub fn new(points: &'a [[f64; D]], radius: f64) -> Result<Self, NeighborError> {
        check_points(points)?;
        let width = if radius.is_finite() { (CELL_WIDTH * radius).max(0.0) } else { 0.0 };
        Ok(Self { points, tree: GridTree::new(points, width) })
    }

    /// The points that are indexed.
    pub fn points(&self) -> &'a [[f64; D]] {
        self.points
    }

    /// Appends the points within `radius` of `center` (and at it) to `found`, by ascending index.
    pub fn within(&self, center: &[f64; D], radius: f64, found: &mut Vec<u32>) {
        let before = found.len();
        self.visit(center, radius, |index, _| found.push(index));
        found[before..].sort_unstable();
    }

    /// The point nearest to `center`, the one of lowest index where several are as near; `None` if there are no points.
    pub fn nearest_one(&self, center: &[f64; D]) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        self.widen(center, |list, radius| {
            list.visit(center, radius, |index, squared| {
                if best.is_none_or(|(s, i)| squared < s || (squared == s && index < i)) {
                    best = Some((squared, index));
                }
            });
            best.is_some()
        });
        best.map(|(_, index)| index)
    }

    /// The k points nearest to `center` (and at it), by distance and, where that is the same, by index; all points if
    /// there are fewer than k.
    ///
    /// `found` is memory to be used again; it holds squared distances and indices.
    pub fn nearest<'b>(
        &self,
        center: &[f64; D],
        k: usize,
        found: &'b mut Vec<(f64, u32)>,
    ) -> impl ExactSizeIterator<Item = u32> + use<'b, D> {
        let k = k.min(self.points.len());
        found.clear();
        if k > 0 {
            self.widen(center, |list, radius| {
                found.clear();
                list.visit(center, radius, |index, squared| found.push((squared, index)));
                found.len() >= k
            });
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(k);
        found.iter().map(|&(_, index)| index)
    }

    /// Tries growing radii until one is enough; none is tried where nothing can be found.
    fn widen(&self, center: &[f64; D], mut enough: impl FnMut(&Self, f64) -> bool) {
        if self.points.is_empty() || center.iter().any(|x| !x.is_finite()) {
            return;
        }
        let mut radius = self.tree.distance_to(center) + self.tree.width_at(center);
        while !enough(self, radius) && radius.is_finite() {
            radius *= 2.0;
        }
    }

    /// Calls `visit(index, squared distance)` for every point within `radius` of `center`.
    fn visit(&self, center: &[f64; D], radius: f64, mut visit: impl FnMut(u32, f64)) {
        let in_reach = radius >= 0.0 && center.iter().all(|x| x.is_finite()) && !self.points.is_empty();
        if !in_reach {
            return;
        }
        let squared_radius = radius * radius;
        let (order, sorted) = (self.tree.order(), self.tree.sorted());
        self.tree.runs(center, radius, &mut |run| {
            for (&index, point) in order[run.clone()].iter().zip(&sorted[run]) {
                let squared = squared_distance(point, center);
                if squared <= squared_radius {
                    visit(index, squared);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_far_away_or_not_finite_are_no_trouble() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        let list = CellList::new(&points, 0.5).unwrap();
        assert_eq!(list.nearest_one(&[1e300, 1e300]), Some(0), "squares overflow: all are as far");
        assert_eq!(list.nearest_one(&[1e9, 2e9]), Some(2));
        assert_eq!(list.nearest_one(&[f64::NAN, 0.0]), None);
        let mut found = vec![7];
        list.within(&[0.5, 0.0], f64::NAN, &mut found);
        list.within(&[0.5, 0.0], -1.0, &mut found);
        assert_eq!(found, [7]);
        list.within(&[0.5, 0.0], f64::INFINITY, &mut found);
        assert_eq!(found, [7, 0, 1, 2]);
    }

    #[test]
    fn no_points_and_one_place() {
        let list = CellList::<2>::new(&[], 1.0).unwrap();
        assert_eq!(list.nearest_one(&[0.0, 0.0]), None);
        assert_eq!(list.nearest(&[0.0, 0.0], 3, &mut Vec::new()).count(), 0);
        let points = [[2.0]; 100];
        let list = CellList::new(&points, 0.0).unwrap();
        assert_eq!(list.nearest_one(&[3.0]), Some(0));
        assert_eq!(list.nearest(&[3.0], 3, &mut Vec::new()).collect::<Vec<_>>(), [0, 1, 2]);
    }
}
