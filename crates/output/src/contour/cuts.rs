//! Lines that a field jumps across and that end inside of a region: cells that they pass through are cut in two.

use super::pieces::Domain;

/// A segment of a cut, in units of the grid.
type Segment = [[f64; 2]; 2];

impl Domain<'_> {
    fn segments(&self) -> impl Iterator<Item = Segment> {
        self.cuts.iter().flat_map(|line| line.windows(2).map(|pair| [pair[0], pair[1]]))
    }

    /// The segment that has the longest part in a cell and nodes of the cell on both sides; a cut that ends in the cell is
    /// taken to go through it.
    pub(super) fn cut_through(&self, nodes: [(usize, usize); 4]) -> Option<Segment> {
        let corners = nodes.map(|(i, j)| [i as f64, j as f64]);
        let parts = self.segments().filter_map(|segment| {
            let left = corners.iter().filter(|c| is_left(&segment, c)).count();
            let inside = part_within(&segment, &corners[0]);
            (left > 0 && left < 4 && inside > 0.0).then_some((inside, segment))
        });
        parts.reduce(|a, b| if b.0 > a.0 { b } else { a }).map(|(_, segment)| segment)
    }

    /// The value that a node across a cut would have if the field of the cell's other nodes went on: along the lines
    /// through two nodes on this side where there are such, else the mean of this side.
    pub(super) fn beyond_cut(&self, at: (usize, usize), own: impl Iterator<Item = (usize, usize)>) -> f64 {
        let (mut linear, mut constant) = ((0.0, 0_u32), (0.0, 0_u32));
        for near in own {
            let value = self.values[near.1 * self.nx + near.0];
            constant = (constant.0 + value, constant.1 + 1);
            let step =
                |near: usize, at: usize, most: usize| (2 * near).checked_sub(at).filter(|&far| far < most);
            let (Some(i), Some(j)) = (step(near.0, at.0, self.nx), step(near.1, at.1, self.ny)) else {
                continue;
            };
            let far = self.values[j * self.nx + i];
            let clear = !self.segments().any(|s| crosses(&s, &point(near), &point((i, j))));
            if clear && far.is_finite() {
                linear = (linear.0 + 2.0 * value - far, linear.1 + 1);
            }
        }
        let (sum, count) = if linear.1 > 0 { linear } else { constant };
        sum / f64::from(count)
    }
}

fn point((i, j): (usize, usize)) -> [f64; 2] {
    [i as f64, j as f64]
}

/// Twice the area of the triangle of a segment and a point; positive on the left.
pub(super) fn side([a, b]: &Segment, x: &[f64; 2]) -> f64 {
    (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0])
}

/// Points on a cut belong to its left.
pub(super) fn is_left(segment: &Segment, x: &[f64; 2]) -> bool {
    side(segment, x) >= 0.0
}

fn crosses(segment: &Segment, x: &[f64; 2], y: &[f64; 2]) -> bool {
    let sight = [*x, *y];
    is_left(segment, x) != is_left(segment, y) && side(&sight, &segment[0]) * side(&sight, &segment[1]) <= 0.0
}

/// Which part of a segment, 0 to 1, lies in the cell with this lower corner (Liang and Barsky 1984).
fn part_within([a, b]: &Segment, low: &[f64; 2]) -> f64 {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let d = b[axis] - a[axis];
        let (enter, leave) = (low[axis] - a[axis], low[axis] + 1.0 - a[axis]);
        if d == 0.0 {
            if enter > 0.0 || leave < 0.0 {
                return 0.0;
            }
            continue;
        }
        let (s, t) = (enter / d, leave / d);
        first = first.max(s.min(t));
        last = last.min(s.max(t));
    }
    (last - first).max(0.0)
}
