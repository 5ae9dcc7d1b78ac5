//! Boxes round what is marked.

/// Cells of the blocks that are refined or not.
pub(super) const BLOCK: usize = 8;

/// Blocks of a mesh, some of which are marked.
pub(super) struct Blocks<const D: usize> {
    marked: Vec<bool>,
    count: [usize; D],
    cells: [usize; D],
}

/// A box of blocks: the first one, and how many in each direction.
type Box<const D: usize> = ([usize; D], [usize; D]);

impl<const D: usize> Blocks<D> {
    /// Blocks of a mesh with so many cells, of which those with one of `cells_marked` are marked. The last block of a direction may be smaller.
    pub(super) fn new(cells: [usize; D], cells_marked: impl Iterator<Item = [usize; D]>) -> Self {
        let count = cells.map(|n| n.div_ceil(BLOCK));
        let mut blocks = Self { marked: vec![false; count.iter().product()], count, cells };
        for cell in cells_marked {
            // The points of a node-centred mesh are one more than its cells.
            let place = blocks.place(std::array::from_fn(|a| (cell[a] / BLOCK).min(count[a] - 1)));
            blocks.marked[place] = true;
        }
        blocks
    }

    /// Boxes of cells, first one and number, that cover what is marked and do not overlap. A box is divided where that makes the sum of the
    /// costs less; a cost is a function of the number of cells in each direction.
    pub(super) fn covers(&self, cost: &dyn Fn([usize; D]) -> f64) -> Vec<Box<D>> {
        let mut boxes = Vec::new();
        self.divide(([0; D], self.count), cost, &mut boxes);
        boxes.into_iter().map(|of_blocks| (of_blocks.0.map(|b| b * BLOCK), self.cells(of_blocks))).collect()
    }

    fn divide(&self, within: Box<D>, cost: &dyn Fn([usize; D]) -> f64, boxes: &mut Vec<Box<D>>) {
        let Some(around) = self.bounds(within) else { return };
        let mut best = (cost(self.cells(around)), None);
        for axis in 0..D {
            for size in 1..around.1[axis] {
                let halves = cut(around, axis, size);
                let sum =
                    halves.iter().filter_map(|half| self.bounds(*half)).map(|b| cost(self.cells(b))).sum();
                if sum < best.0 {
                    best = (sum, Some(halves));
                }
            }
        }
        match best.1 {
            Some(halves) => halves.into_iter().for_each(|half| self.divide(half, cost, boxes)),
            None => boxes.push(around),
        }
    }

    /// The least box with all that is marked within another one.
    fn bounds(&self, within: Box<D>) -> Option<Box<D>> {
        let (mut low, mut high) = ([usize::MAX; D], [0; D]);
        for block in cover(within).filter(|b| self.marked[self.place(*b)]) {
            for a in 0..D {
                low[a] = low[a].min(block[a]);
                high[a] = high[a].max(block[a] + 1);
            }
        }
        (low[0] < high[0]).then(|| (low, std::array::from_fn(|a| high[a] - low[a])))
    }

    /// Cells of a box in each direction.
    fn cells(&self, (first, size): Box<D>) -> [usize; D] {
        std::array::from_fn(|a| ((first[a] + size[a]) * BLOCK).min(self.cells[a]) - first[a] * BLOCK)
    }

    fn place(&self, block: [usize; D]) -> usize {
        (0..D).rev().fold(0, |all, a| all * self.count[a] + block[a])
    }
}

/// The two parts of a box, the first of which has `size` blocks in a direction.
fn cut<const D: usize>((first, all): Box<D>, axis: usize, size: usize) -> [Box<D>; 2] {
    let (mut low, mut start, mut high) = (all, first, all);
    low[axis] = size;
    start[axis] += size;
    high[axis] -= size;
    [(first, low), (start, high)]
}

/// The blocks of a box.
fn cover<const D: usize>((first, size): Box<D>) -> impl Iterator<Item = [usize; D]> {
    (0..size.iter().product()).map(move |mut i| {
        std::array::from_fn(|a| {
            let offset = i % size[a];
            i /= size[a];
            first[a] + offset
        })
    })
}

#[cfg(test)]
mod tests {
    use super::Blocks;

    /// A ring, two blobs far apart, a corner and the whole.
    #[test]
    fn what_is_marked_is_covered_once() {
        let cells = [100_usize, 84];
        let marked: [fn([usize; 2]) -> bool; 4] = [
            |[x, y]| (20.0..30.0).contains(&(x as f64 - 50.0).hypot(y as f64 - 40.0)),
            |[x, y]| x + y < 9 || x + y > 170,
            |[x, y]| x > 97 && y > 80,
            |_| true,
        ];
        for is_marked in marked {
            let all = || (0..84).flat_map(|y| (0..100).map(move |x| [x, y]));
            let blocks = Blocks::new(cells, all().filter(|c| is_marked(*c)));
            for border in [0.0, 20.0, 1e6] {
                let boxes = blocks.covers(&|n| n.iter().map(|n| *n as f64 + border).product());
                for cell in all() {
                    let inside = |(first, size): &&([usize; 2], [usize; 2])| {
                        (0..2).all(|a| cell[a] >= first[a] && cell[a] < first[a] + size[a])
                    };
                    let count = boxes.iter().filter(inside).count();
                    assert!(count == 1 || count == 0 && !is_marked(cell), "{cell:?}");
                }
                assert!(border < 1e5 || boxes.len() == 1);
            }
        }
    }

    #[test]
    fn what_is_far_apart_is_two_boxes() {
        let blocks = Blocks::new([80, 80], [[3, 3], [75, 70]].into_iter());
        let cost = |n: [usize; 2]| n.iter().map(|n| *n as f64 + 10.0).product();
        assert_eq!(blocks.covers(&cost), [([0, 0], [8, 8]), ([72, 64], [8, 8])]);
    }
}
