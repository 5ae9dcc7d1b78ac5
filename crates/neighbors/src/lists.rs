//! Compressed neighbour lists.

use crate::NeighborError;

/// The neighbours of every point, compressed: no point is its own neighbour, none is listed twice.
///
/// Lists by radius are in the order of ascending index, lists by number in that of distance; lists from outside keep
/// their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NeighborLists {
    offsets: Vec<usize>,
    indices: Vec<u32>,
}

impl NeighborLists {
    /// From one list a point.
    ///
    /// # Errors
    /// [`NeighborError::InvalidLists`] where a list names its own point, a point twice, or one that does not exist.
    pub fn from_lists(lists: Vec<Vec<u32>>) -> Result<Self, NeighborError> {
        let mut offsets = Vec::with_capacity(lists.len() + 1);
        offsets.push(0);
        for list in &lists {
            offsets.push(offsets[offsets.len() - 1] + list.len());
        }
        Self::from_parts(offsets, lists.concat())
    }

    /// From offsets (one more than there are points) and indices; all invariants are checked.
    ///
    /// # Errors
    /// As for [`Self::from_lists`], and for offsets that do not divide the indices.
    pub fn from_parts(offsets: Vec<usize>, indices: Vec<u32>) -> Result<Self, NeighborError> {
        let invalid = |index, reason| Err(NeighborError::InvalidLists { index, reason });
        if offsets.first() != Some(&0) || offsets.last() != Some(&indices.len()) {
            return invalid(0, "offsets must start at 0 and end at the number of indices");
        }
        if let Some(i) = offsets.windows(2).position(|pair| pair[0] > pair[1]) {
            return invalid(i, "offsets must not decrease");
        }
        let n = offsets.len() - 1;
        if n >= u32::MAX as usize {
            return Err(NeighborError::TooManyPoints { points: n });
        }
        let mut seen = vec![u32::MAX; n];
        for i in 0..n {
            for &j in &indices[offsets[i]..offsets[i + 1]] {
                match seen.get_mut(j as usize) {
                    None => return invalid(i, "an index is out of range"),
                    Some(_) if j as usize == i => return invalid(i, "a point is its own neighbour"),
                    Some(last) if *last == i as u32 => return invalid(i, "a neighbour is listed twice"),
                    Some(last) => *last = i as u32,
                }
            }
        }
        Ok(Self { offsets, indices })
    }

    /// From parts that a search of this crate has made.
    pub(crate) fn from_search(offsets: Vec<usize>, indices: Vec<u32>) -> Self {
        Self { offsets, indices }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Neighbours of point i.
    ///
    /// # Panics
    /// For a point out of range.
    pub fn of(&self, i: usize) -> &[u32] {
        &self.indices[self.offsets[i]..self.offsets[i + 1]]
    }

    /// Offsets and indices: the neighbours of point i are `indices[offsets[i]..offsets[i + 1]]`.
    pub fn as_csr(&self) -> (&[usize], &[u32]) {
        (&self.offsets, &self.indices)
    }

    /// The lists after a renumbering in which the point with the new index i had the index `order[i]` before; each
    /// list by ascending index.
    ///
    /// # Errors
    /// [`NeighborError::InvalidLists`] where `order` does not name every point once.
    pub fn permuted(&self, order: &[u32]) -> Result<Self, NeighborError> {
        let invalid =
            |index| Err(NeighborError::InvalidLists { index, reason: "an order must name every point once" });
        if order.len() != self.len() {
            return invalid(order.len());
        }
        let mut new_index = vec![u32::MAX; self.len()];
        for (new, &old) in order.iter().enumerate() {
            match new_index.get_mut(old as usize) {
                Some(place) if *place == u32::MAX => *place = new as u32,
                _ => return invalid(new),
            }
        }
        let mut offsets = vec![0];
        let mut indices = Vec::with_capacity(self.total());
        for &old in order {
            let from = indices.len();
            indices.extend(self.of(old as usize).iter().map(|&j| new_index[j as usize]));
            indices[from..].sort_unstable();
            offsets.push(indices.len());
        }
        Ok(Self { offsets, indices })
    }

    /// The lists, point by point.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        (0..self.len()).map(|i| self.of(i))
    }

    /// Number of entries of all lists.
    pub fn total(&self) -> usize {
        self.indices.len()
    }

    /// Length of the shortest list.
    pub fn min_count(&self) -> usize {
        self.iter().map(<[u32]>::len).min().unwrap_or(0)
    }

    /// Length of the longest list.
    pub fn max_count(&self) -> usize {
        self.iter().map(<[u32]>::len).max().unwrap_or(0)
    }

    /// Average length of the lists.
    pub fn mean_count(&self) -> f64 {
        self.total() as f64 / self.len().max(1) as f64
    }

    /// Whether j is listed at i wherever i is listed at j.
    pub fn is_symmetric(&self) -> bool {
        (0..self.len()).all(|i| self.of(i).iter().all(|&j| self.of(j as usize).contains(&(i as u32))))
    }

    /// The lists with every missing counterpart added; neighbours in ascending order.
    pub fn symmetrized(&self) -> Self {
        let mut lists: Vec<Vec<u32>> = self.iter().map(<[u32]>::to_vec).collect();
        for i in 0..self.len() {
            for &j in self.of(i) {
                lists[j as usize].push(i as u32);
            }
        }
        let mut offsets = vec![0];
        let mut indices = Vec::new();
        for list in &mut lists {
            list.sort_unstable();
            list.dedup();
            indices.extend_from_slice(list);
            offsets.push(indices.len());
        }
        Self { offsets, indices }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_checked() {
        let of = |lists: &[&[u32]]| NeighborLists::from_lists(lists.iter().map(|l| l.to_vec()).collect());
        assert!(of(&[&[1], &[0]]).is_ok());
        assert!(of(&[&[0], &[0]]).is_err());
        assert!(of(&[&[2], &[0]]).is_err());
        assert!(of(&[&[1, 1], &[0]]).is_err());
        assert!(NeighborLists::from_parts(vec![0, 2, 1], vec![1]).is_err());
    }

    #[test]
    fn orders_are_checked() {
        let lists = NeighborLists::from_lists(vec![vec![1], vec![0, 2], vec![1]]).unwrap();
        assert_eq!(lists.permuted(&[1, 0, 2]).unwrap().of(0), [1, 2]);
        assert!(lists.permuted(&[1, 0]).is_err());
        assert!(lists.permuted(&[1, 1, 0]).is_err());
        assert!(lists.permuted(&[1, 3, 0]).is_err());
    }

    #[test]
    fn symmetrizing_adds_counterparts() {
        let lists = NeighborLists::from_lists(vec![vec![1, 2], vec![], vec![1]]).unwrap();
        assert!(!lists.is_symmetric());
        let symmetric = lists.symmetrized();
        assert!(symmetric.is_symmetric());
        assert_eq!(symmetric.of(1), [0, 2]);
    }
}
