//! Cells of the size of the local spacing, by repeated division of the bounding box.

use crate::aabb::Aabb;
use crate::cloud::Spacing;
use crate::error::GeometryError;
use crate::vector::norm;

/// Divisions along an axis below which no cell is left out: parts of a surface are found from cells of this size at
/// least, however far its level seems to be from zero.
const BASE_DIVISIONS: f64 = 32.0;

/// One cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell<const D: usize> {
    pub(crate) center: [f64; D],
    half: [f64; D],
}

impl<const D: usize> Cell<D> {
    pub(crate) fn half_diagonal(&self) -> f64 {
        norm(&self.half)
    }
}

/// Calls `visit` for cells that cover the box and are at most `factor` spacings wide, in a fixed order. Cells for
/// which `keep` does not hold are neither divided nor visited, except that division goes on to a base resolution.
///
/// The spacing may be undefined outside of the domain; cells are then divided to the base resolution only.
pub(crate) fn for_each_cell<const D: usize>(
    bounds: &Aabb<D>,
    spacing: &Spacing<D>,
    factor: f64,
    keep: impl Fn(&Cell<D>) -> bool,
    mut visit: impl FnMut(&Cell<D>) -> Result<(), GeometryError>,
) -> Result<(), GeometryError> {
    let lengths = bounds.lengths();
    let longest = lengths.iter().fold(0.0_f64, |a, &b| a.max(b));
    let base = longest / BASE_DIVISIONS;
    let mut stack = vec![Cell { center: bounds.center(), half: lengths.map(|l| 0.5 * l) }];
    while let Some(cell) = stack.pop() {
        let width = 2.0 * cell.half.iter().fold(0.0_f64, |a, &b| a.max(b));
        let target = spacing.at(&cell.center).map_or(base, |s| factor * s);
        if width <= base.max(target) * (1.0 + 1e-12) && !keep(&cell) {
            continue;
        }
        if width <= target * (1.0 + 1e-12) {
            visit(&cell)?;
            continue;
        }
        // Halving only the long axes keeps cells of long boxes from becoming needles.
        let split: [bool; D] = std::array::from_fn(|i| 2.0 * cell.half[i] > 0.5 * width);
        let half: [f64; D] =
            std::array::from_fn(|i| if split[i] { 0.5 * cell.half[i] } else { cell.half[i] });
        for corner in (0..1_usize << D).rev() {
            if (0..D).any(|i| !split[i] && corner >> i & 1 == 1) {
                continue;
            }
            let center = std::array::from_fn(|i| match (split[i], corner >> i & 1) {
                (false, _) => cell.center[i],
                (true, 0) => cell.center[i] - half[i],
                (true, _) => cell.center[i] + half[i],
            });
            stack.push(Cell { center, half });
        }
    }
    Ok(())
}

impl<const D: usize> Cell<D> {
    /// Midpoint of one of `n^D` parts.
    pub(crate) fn part(&self, part: usize, n: usize) -> [f64; D] {
        let mut rest = part;
        std::array::from_fn(|i| {
            let k = rest % n;
            rest /= n;
            self.center[i] + self.half[i] * ((2 * k + 1) as f64 / n as f64 - 1.0)
        })
    }
}
