//! Nodes in hashed cells, for queries by distance while nodes are being added.

use crate::vector::{distance, distance_squared};

/// Edge of a cell over the smallest spacing of its level: about the distance that is queried most, so that a query
/// reads three cells along each axis.
const CELL: f64 = 0.9;

const END: u32 = u32::MAX;
const PRIMES: [i64; 3] = [1, 73_856_093, 19_349_663];

/// Nodes of spacing within a factor of two share a level with cells of their size (Teschner et al. 2003, "Optimized
/// spatial hashing"). Cells that collide only cost time, since distances decide. Cells along x are neighbours in
/// memory.
pub(crate) struct SpatialHash<const D: usize> {
    points: Vec<[f64; D]>,
    spacing: Vec<f64>,
    next: Vec<u32>,
    levels: Vec<Level>,
    unit: f64,
}

struct Level {
    exponent: i32,
    inverse_cell: f64,
    largest: f64,
    count: usize,
    head: Vec<u32>,
}

impl<const D: usize> SpatialHash<D> {
    pub(crate) fn new() -> Self {
        Self { points: Vec::new(), spacing: Vec::new(), next: Vec::new(), levels: Vec::new(), unit: 1.0 }
    }

    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    pub(crate) fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    pub(crate) fn spacing(&self) -> &[f64] {
        &self.spacing
    }

    /// Adds a node and returns its index.
    pub(crate) fn insert(&mut self, x: [f64; D], spacing: f64) -> u32 {
        if self.points.is_empty() {
            self.unit = spacing;
        }
        let exponent = exponent(spacing / self.unit);
        let k = match self.levels.iter().position(|l| l.exponent == exponent) {
            Some(k) => k,
            None => {
                let cell = CELL * self.unit * 2.0_f64.powi(exponent);
                let head = vec![END; 1 << 10];
                self.levels.push(Level { exponent, inverse_cell: 1.0 / cell, largest: 0.0, count: 0, head });
                self.levels.len() - 1
            }
        };
        if self.levels[k].count >= self.levels[k].head.len() {
            self.grow(k);
        }
        let id = self.points.len() as u32;
        self.points.push(x);
        self.spacing.push(spacing);
        let level = &mut self.levels[k];
        level.largest = level.largest.max(spacing);
        level.count += 1;
        let slot = level.slot(&x);
        self.next.push(level.head[slot]);
        level.head[slot] = id;
        id
    }

    /// Moves all nodes from index `first` on by a displacement made from their spacing.
    pub(crate) fn displace(&mut self, first: usize, mut by: impl FnMut(f64) -> [f64; D]) {
        let (points, spacing) = (std::mem::take(&mut self.points), std::mem::take(&mut self.spacing));
        *self = Self::new();
        for (i, (x, h)) in points.into_iter().zip(spacing).enumerate() {
            let y = if i < first { x } else { crate::vector::axpy(&x, 1.0, &by(h)) };
            self.insert(y, h);
        }
    }

    fn grow(&mut self, k: usize) {
        let level = &mut self.levels[k];
        let old = std::mem::take(&mut level.head);
        level.head = vec![END; 4 * old.len()];
        for mut id in old {
            while id != END {
                let following = self.next[id as usize];
                let slot = level.slot(&self.points[id as usize]);
                self.next[id as usize] = level.head[slot];
                level.head[slot] = id;
                id = following;
            }
        }
    }

    /// Whether some node is nearer to `x` than `factor` times the smaller of the two spacings.
    pub(crate) fn conflicts(&self, x: &[f64; D], spacing: f64, factor: f64) -> bool {
        self.levels.iter().any(|level| {
            let reach = factor * spacing.min(level.largest);
            self.any_near(level, x, reach, |id, d2| {
                let limit = factor * spacing.min(self.spacing[id as usize]);
                d2 < limit * limit
            })
        })
    }

    /// The nearest node within `reach` (other than `except`) and its distance.
    pub(crate) fn nearest(&self, x: &[f64; D], reach: f64, except: Option<u32>) -> Option<(u32, f64)> {
        let mut best = None;
        let mut best_square = reach * reach;
        for level in &self.levels {
            self.any_near(level, x, reach, |id, d2| {
                // The lower index of equals, whatever the order of the cells.
                let better = d2 < best_square || (d2 == best_square && best.is_none_or(|b| id < b));
                if better && Some(id) != except {
                    (best, best_square) = (Some(id), d2);
                }
                false
            });
        }
        best.map(|id| (id, distance(x, &self.points[id as usize])))
    }

    /// Appends the nodes nearer to `x` than `reach`. A node can appear more than once.
    pub(crate) fn collect(&self, x: &[f64; D], reach: f64, found: &mut Vec<[f64; D]>) {
        for level in &self.levels {
            self.any_near(level, x, reach, |id, d2| {
                if d2 < reach * reach {
                    found.push(self.points[id as usize]);
                }
                false
            });
        }
    }

    #[inline]
    fn any_in_slot(&self, first: u32, x: &[f64; D], test: &mut impl FnMut(u32, f64) -> bool) -> bool {
        let mut id = first;
        while id != END {
            if test(id, distance_squared(x, &self.points[id as usize])) {
                return true;
            }
            id = self.next[id as usize];
        }
        false
    }

    /// Whether `test(node, squared distance)` holds for some node in the cells that a ball meets. A node can be
    /// tested more than once.
    fn any_near(
        &self,
        level: &Level,
        x: &[f64; D],
        reach: f64,
        mut test: impl FnMut(u32, f64) -> bool,
    ) -> bool {
        let low: [i64; D] = std::array::from_fn(|i| ((x[i] - reach) * level.inverse_cell).floor() as i64);
        let high: [i64; D] = std::array::from_fn(|i| ((x[i] + reach) * level.inverse_cell).floor() as i64);
        let cells: f64 = (0..D).map(|i| high[i].saturating_sub(low[i]) as f64 + 1.0).product();
        if cells > level.head.len() as f64 {
            // A ball that is large for this level: reading every slot is less work.
            return (0..level.head.len()).any(|slot| self.any_in_slot(level.head[slot], x, &mut test));
        }
        let mask = level.head.len() - 1;
        let mut row = low;
        loop {
            let base = hash_row(&row);
            for column in low[0]..=high[0] {
                let slot = base.wrapping_add(column) as usize & mask;
                if self.any_in_slot(level.head[slot], x, &mut test) {
                    return true;
                }
            }
            let Some(axis) = (1..D).find(|&i| row[i] < high[i]) else { return false };
            row[axis] += 1;
            row[1..axis].copy_from_slice(&low[1..axis]);
        }
    }
}

impl Level {
    fn slot<const D: usize>(&self, x: &[f64; D]) -> usize {
        let cell: [i64; D] = std::array::from_fn(|i| (x[i] * self.inverse_cell).floor() as i64);
        hash_row(&cell).wrapping_add(cell[0]) as usize & (self.head.len() - 1)
    }
}

fn hash_row<const D: usize>(cell: &[i64; D]) -> i64 {
    (1..D).fold(0_i64, |h, i| h.wrapping_add(cell[i].wrapping_mul(PRIMES[i])))
}

/// The power of two at or below a positive number.
fn exponent(v: f64) -> i32 {
    ((v.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Nodes with spacings over three powers of ten.
    fn filled<const D: usize>(random: &mut Random) -> SpatialHash<D> {
        let mut hash = SpatialHash::new();
        for _ in 0..3000 {
            let x = std::array::from_fn(|_| random.symmetric());
            hash.insert(x, 10.0_f64.powf(1.5 * random.symmetric() - 1.5));
        }
        hash
    }

    fn agrees_with_all_pairs<const D: usize>() {
        let mut random = Random::new(3);
        let hash: SpatialHash<D> = filled(&mut random);
        for _ in 0..300 {
            let x: [f64; D] = std::array::from_fn(|_| 1.2 * random.symmetric());
            let h = 10.0_f64.powf(1.5 * random.symmetric() - 1.5);
            let distances: Vec<f64> = hash.points().iter().map(|p| distance(&x, p)).collect();
            let conflict = distances.iter().zip(hash.spacing()).any(|(d, s)| *d < 0.8 * h.min(*s));
            assert_eq!(hash.conflicts(&x, h, 0.8), conflict);
            let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
            let found = hash.nearest(&x, h, None);
            assert_eq!(found.map(|(_, d)| d), (nearest < h).then_some(nearest));
        }
    }

    #[test]
    fn queries_agree_with_all_pairs() {
        agrees_with_all_pairs::<1>();
        agrees_with_all_pairs::<2>();
        agrees_with_all_pairs::<3>();
    }

    #[test]
    fn a_node_can_be_left_out() {
        let mut hash = SpatialHash::new();
        hash.insert([0.0, 0.0], 1.0);
        hash.insert([0.5, 0.0], 1.0);
        assert_eq!(hash.nearest(&[0.0, 0.0], 1.0, Some(0)), Some((1, 0.5)));
        assert_eq!(hash.nearest(&[0.0, 0.0], 0.4, Some(0)), None);
    }
}
