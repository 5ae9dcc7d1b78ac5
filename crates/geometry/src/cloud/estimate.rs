//! About how many nodes a cloud has, before any is made.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Spacing;
use crate::aabb::Aabb;
use crate::domain::Domain;
use crate::error::GeometryError;

/// Cells along an edge of the box that a count begins with, by the number of axes it runs along: about as many samples of the spacing
/// whatever the dimension.
const CELLS: [usize; 4] = [1, 1024, 32, 8];

/// Relative error of a count at which no cell is divided any more: far less than by how much clouds differ from their counts.
const ACCURACY: f64 = 5e-3;

/// Evaluations of the spacing at most: a few milliseconds. A spacing that falls to a point over ten orders of magnitude takes a tenth.
const EVALUATIONS: usize = 1 << 17;

/// Places of the samples in a cell, along every axis, in halves of its width: Gauss's.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Least spacing that nodes can have, over the diameter of the domain: nodes nearer to each other are one node in rounding.
const LEAST: f64 = 1e-12;

/// Cells that are looked into for where the spacing falls to zero: those with the least samples.
const LOOKED_INTO: usize = 16;

/// About how many nodes a cloud has, without generating it: the measure over the volume of a node, plus half a layer
/// on the boundary of a box. A spacing that varies is integrated over cells that are halved where it varies most; that takes at most
/// some hundred thousand evaluations.
///
/// # Errors
/// [`GeometryError::InvalidSpacing`] where the spacing is not positive and finite, or falls to zero.
pub fn estimate_nodes<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
) -> Result<f64, GeometryError> {
    let bounds = domain.bounds();
    match spacing {
        Spacing::Uniform(_) => {
            let s = spacing.at(&bounds.center())?;
            let in_box: f64 = bounds.lengths().iter().map(|l| l / s + 1.0).product();
            Ok(in_box * (domain.measure_estimate() / bounds.measure()))
        }
        Spacing::Graded(_) => {
            let inside = Count { domain, spacing, power: D as i32 }.over(&bounds)?;
            Ok(inside + half_layer(domain, spacing)?)
        }
    }
}

/// Half a node for every node on the planes of an outer box.
pub(crate) fn half_layer<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
) -> Result<f64, GeometryError> {
    let Some(bounds) = domain.outer_box() else { return Ok(0.0) };
    let mut nodes = 0.0;
    for axis in 0..D {
        for end in [bounds.min[axis], bounds.max[axis]] {
            let mut face = bounds;
            (face.min[axis], face.max[axis]) = (end, end);
            nodes += 0.5 * Count { domain, spacing, power: D as i32 - 1 }.over(&face)?;
        }
    }
    Ok(nodes)
}

/// The integral of a negative power of the spacing over what there is of a domain in a box, or in a face of one.
struct Count<'a, const D: usize> {
    domain: &'a Domain<D>,
    spacing: &'a Spacing<D>,
    power: i32,
}

/// A part of the box with what it counts.
#[derive(Clone, Copy)]
struct Cell<const D: usize> {
    middle: [f64; D],
    /// Half of its width along every axis; zero along the one that a face is normal to.
    half: [f64; D],
    count: f64,
    /// The least spacing among its samples, and where; none where no sample lies in the domain.
    least: Option<(f64, [f64; D])>,
}

/// A cell with its halves: what they count differently is about the error of the cell.
struct Divided<const D: usize> {
    parts: Vec<Cell<D>>,
    count: f64,
    error: f64,
}

impl<const D: usize> Count<'_, D> {
    fn over(&self, bounds: &Aabb<D>) -> Result<f64, GeometryError> {
        let axes: Vec<usize> = (0..D).filter(|&k| bounds.max[k] > bounds.min[k]).collect();
        let along = CELLS[axes.len()];
        let mut half = [0.0; D];
        axes.iter().for_each(|&k| half[k] = 0.5 * (bounds.max[k] - bounds.min[k]) / along as f64);
        let first = (0..along.pow(axes.len() as u32)).map(|code| {
            let (mut middle, mut rest) = (bounds.min, code);
            for &k in &axes {
                middle[k] += half[k] * (2 * (rest % along) + 1) as f64;
                rest /= along;
            }
            self.cell(middle, half, &axes)
        });
        let first: Vec<Cell<D>> = first.collect::<Result<_, _>>()?;
        self.check_positive(&first, &axes)?;
        let mut cells = BinaryHeap::with_capacity(first.len());
        let (mut count, mut error) = (0.0, 0.0);
        for cell in first {
            let divided = self.divide(&cell, &axes)?;
            (count, error) = (count + divided.count, error + divided.error);
            cells.push(divided);
        }
        let evaluations = 8_usize.pow(axes.len() as u32);
        for _ in 0..EVALUATIONS / evaluations {
            if error <= ACCURACY * count {
                break;
            }
            let Some(worst) = cells.pop() else { break };
            (count, error) = (count - worst.count, error - worst.error);
            for part in &worst.parts {
                let divided = self.divide(part, &axes)?;
                (count, error) = (count + divided.count, error + divided.error);
                cells.push(divided);
            }
        }
        // The running sum has lost digits to the large numbers that came and went.
        Ok(cells.iter().map(|divided| divided.count).sum())
    }

    fn divide(&self, cell: &Cell<D>, axes: &[usize]) -> Result<Divided<D>, GeometryError> {
        let half = cell.half.map(|h| 0.5 * h);
        let parts: Vec<Cell<D>> = corners(axes, &cell.middle, &half)
            .map(|middle| self.cell(middle, half, axes))
            .collect::<Result<_, _>>()?;
        let count: f64 = parts.iter().map(|part| part.count).sum();
        Ok(Divided { parts, count, error: (count - cell.count).abs() })
    }

    fn cell(&self, middle: [f64; D], half: [f64; D], axes: &[usize]) -> Result<Cell<D>, GeometryError> {
        let (mut sum, mut least) = (0.0, None);
        for x in corners(axes, &middle, &half.map(|h| GAUSS * h)) {
            if self.domain.level(&x) <= 0.0 {
                let spacing = self.spacing.at(&x)?;
                sum += spacing.powi(-self.power);
                if least.is_none_or(|(known, _)| spacing < known) {
                    least = Some((spacing, x));
                }
            }
        }
        // The mean over the samples times the measure.
        let count = sum * axes.iter().map(|&k| half[k]).product::<f64>();
        Ok(Cell { middle, half, count, least })
    }

    /// Follows the spacing down where it is least. As it changes by less than its half over its own length, it can fall to zero only
    /// in cells that are larger than it.
    fn check_positive(&self, cells: &[Cell<D>], axes: &[usize]) -> Result<(), GeometryError> {
        let least = |cell: &Cell<D>| cell.least.map_or(f64::INFINITY, |(spacing, _)| spacing);
        let mut order: Vec<&Cell<D>> = cells.iter().filter(|cell| cell.least.is_some()).collect();
        order.sort_by(|a, b| least(a).total_cmp(&least(b)));
        let zero = LEAST * self.domain.bounds().diameter();
        for start in order.into_iter().take(LOOKED_INTO) {
            let mut cell = *start;
            while let Some((spacing, at)) = cell.least {
                if spacing < zero {
                    return Err(GeometryError::VanishingSpacing { at: at.to_vec(), spacing });
                }
                if axes.iter().all(|&k| 2.0 * cell.half[k] < spacing) {
                    break;
                }
                let parts = self.divide(&cell, axes)?.parts;
                let Some(next) = parts.into_iter().min_by(|a, b| least(a).total_cmp(&least(b))) else {
                    break;
                };
                cell = next;
            }
        }
        Ok(())
    }
}

impl<const D: usize> PartialEq for Divided<D> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<const D: usize> Eq for Divided<D> {}

impl<const D: usize> PartialOrd for Divided<D> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const D: usize> Ord for Divided<D> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error)
    }
}

/// A point and all its images in the planes through a middle.
fn corners<const D: usize>(
    axes: &[usize],
    middle: &[f64; D],
    offset: &[f64; D],
) -> impl Iterator<Item = [f64; D]> {
    (0..1_usize << axes.len()).map(move |code| {
        let mut x = *middle;
        for (bit, &k) in axes.iter().enumerate() {
            x[k] += if (code >> bit) & 1 == 1 { offset[k] } else { -offset[k] };
        }
        x
    })
}

/// About how many nodes a cloud has, as [`estimate_nodes`]; refused where there are more than `limit`.
///
/// # Errors
/// [`GeometryError::TooManyNodes`] with the spacing that would do, and those of [`estimate_nodes`].
pub fn check_size<const D: usize>(
    domain: &Domain<D>,
    spacing: &Spacing<D>,
    limit: usize,
) -> Result<f64, GeometryError> {
    let estimate = estimate_nodes(domain, spacing)?;
    if estimate > limit as f64 {
        return Err(too_many::<D>(estimate, limit));
    }
    Ok(estimate)
}

pub(crate) fn too_many<const D: usize>(estimate: f64, limit: usize) -> GeometryError {
    // A little more than the ratio asks for, because estimates are estimates.
    let factor = 1.05 * (estimate / limit.max(1) as f64).powf(1.0 / D as f64);
    GeometryError::TooManyNodes { estimate, limit, factor }
}
