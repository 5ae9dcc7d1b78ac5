//! Regular meshes.

use crate::error::FreeSpaceError;

/// Where in the cells the points are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Centring {
    /// One point in the middle of each cell.
    #[default]
    Cell,
    /// One point at each corner of a cell: one more than cells in every direction.
    Node,
}

/// Fractions of the spacing that points of nested meshes lie at: all ratios up to 16, and half of them.
const SUBDIVISIONS: f64 = 1_441_440.0;

/// Spacings of which volumes of cells, squares of distances and their inverses are numbers.
const SPACINGS: std::ops::RangeInclusive<f64> = 1e-90..=1e90;

/// A regular mesh with cells of any aspect ratio. Arrays of values have x running fastest, then y, then z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mesh<const D: usize> {
    min: [f64; D],
    spacing: [f64; D],
    points: [usize; D],
    centring: Centring,
}

impl<const D: usize> Mesh<D> {
    /// `cells` cells of size `spacing` from the corner `min`.
    ///
    /// # Errors
    /// No cells, a spacing that is not positive and finite or whose cube is not, or more points than can be counted.
    pub fn new(
        min: [f64; D],
        spacing: [f64; D],
        cells: [usize; D],
        centring: Centring,
    ) -> Result<Self, FreeSpaceError> {
        for axis in 0..D {
            if !min[axis].is_finite() {
                return Err(FreeSpaceError::Invalid {
                    what: "corner of the mesh",
                    value: min[axis],
                    expected: "finite",
                });
            }
            FreeSpaceError::unless_positive("spacing", spacing[axis])?;
            if !SPACINGS.contains(&spacing[axis]) {
                return Err(FreeSpaceError::Invalid {
                    what: "spacing",
                    value: spacing[axis],
                    expected: "between 1e-90 and 1e90: take another unit of length",
                });
            }
            if cells[axis] == 0 {
                return Err(FreeSpaceError::NoCells { axis });
            }
        }
        let points = match centring {
            Centring::Cell => cells,
            Centring::Node => cells.map(|n| n.saturating_add(1)),
        };
        // Padding doubles every direction; a complex number has 16 bytes.
        let bytes = points.iter().try_fold(16_usize, |all, &n| n.checked_mul(2)?.checked_mul(all));
        if bytes.is_none() {
            let megabytes: f64 = points.iter().fold(16.0 / 1e6, |all, &n| all * 2.0 * n as f64);
            return Err(FreeSpaceError::Memory {
                needed: megabytes as u64,
                available: (usize::MAX as f64 / 1e6) as u64,
            });
        }
        Ok(Self { min, spacing, points, centring })
    }

    /// The box from `min` to `max` divided into `cells`.
    ///
    /// # Errors
    /// As for [`Self::new`], and a box without volume.
    pub fn of_box(
        min: [f64; D],
        max: [f64; D],
        cells: [usize; D],
        centring: Centring,
    ) -> Result<Self, FreeSpaceError> {
        let mut spacing = [0.0; D];
        for axis in 0..D {
            FreeSpaceError::unless_positive("side of the box", max[axis] - min[axis])?;
            spacing[axis] = (max[axis] - min[axis]) / cells[axis].max(1) as f64;
        }
        Self::new(min, spacing, cells, centring)
    }

    /// Corner with the smallest coordinates.
    pub fn min(&self) -> [f64; D] {
        self.min
    }

    /// Corner with the largest coordinates.
    pub fn max(&self) -> [f64; D] {
        std::array::from_fn(|a| self.min[a] + self.cells()[a] as f64 * self.spacing[a])
    }

    /// Size of a cell.
    pub fn spacing(&self) -> [f64; D] {
        self.spacing
    }

    /// Where in the cells the points are.
    pub fn centring(&self) -> Centring {
        self.centring
    }

    /// Cells in each direction.
    pub fn cells(&self) -> [usize; D] {
        match self.centring {
            Centring::Cell => self.points,
            Centring::Node => self.points.map(|n| n - 1),
        }
    }

    /// Points in each direction.
    pub fn points(&self) -> [usize; D] {
        self.points
    }

    /// Number of points, the length of an array of values.
    pub fn len(&self) -> usize {
        self.points.iter().product()
    }

    /// Whether there are no points; a mesh always has some.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Volume of a cell.
    pub fn cell_volume(&self) -> f64 {
        self.spacing.iter().product()
    }

    /// The coordinate of the points with index `i` in direction `axis`.
    pub fn coordinate(&self, axis: usize, i: usize) -> f64 {
        let offset = match self.centring {
            Centring::Cell => 0.5,
            Centring::Node => 0.0,
        };
        self.min[axis] + (i as f64 + offset) * self.spacing[axis]
    }

    /// The indices of the point at place `index` of an array.
    pub fn indices(&self, mut index: usize) -> [usize; D] {
        self.points.map(|n| {
            let i = index % n;
            index /= n;
            i
        })
    }

    /// The place in an array of the point with these indices.
    pub fn index(&self, indices: [usize; D]) -> usize {
        (0..D).rev().fold(0, |all, a| all * self.points[a] + indices[a])
    }

    /// The mesh with `cells` more on every side.
    pub(crate) fn grown(&self, cells: usize) -> Result<Self, FreeSpaceError> {
        let min = std::array::from_fn(|a| self.min[a] - cells as f64 * self.spacing[a]);
        Self::new(
            min,
            self.spacing,
            self.cells().map(|n| n.saturating_add(cells.saturating_mul(2))),
            self.centring,
        )
    }

    /// Where the points of this mesh lie in another one, in units of its spacing from its first point.
    pub(crate) fn places_in(&self, other: &Self) -> impl Fn(usize, usize) -> f64 {
        let start: [f64; D] =
            std::array::from_fn(|a| (self.coordinate(a, 0) - other.coordinate(a, 0)) / other.spacing[a]);
        let step: [f64; D] = std::array::from_fn(|a| self.spacing[a] / other.spacing[a]);
        // Points of nested meshes lie at multiples of a fraction of the spacing; round-off must not move them across one.
        move |axis, i| ((start[axis] + i as f64 * step[axis]) * SUBDIVISIONS).round() / SUBDIVISIONS
    }

    /// Position of the point at place `index` of an array.
    pub fn point(&self, index: usize) -> [f64; D] {
        let i = self.indices(index);
        std::array::from_fn(|a| self.coordinate(a, i[a]))
    }

    /// The values of a function at the points, in the order of the arrays.
    pub fn sample(&self, f: impl Fn([f64; D]) -> f64) -> Vec<f64> {
        (0..self.len()).map(|i| f(self.point(i))).collect()
    }

    /// The largest magnitude of `values` at the outermost points relative to the largest of all: a source should vanish
    /// at the edge of its box, since what it has beyond is left out. 0 for values that are zero everywhere, NaN where one is.
    pub fn edge_ratio(&self, values: &[f64]) -> f64 {
        if values.iter().any(|v| v.is_nan()) {
            return f64::NAN;
        }
        let (mut edge, mut all) = (0.0_f64, 0.0_f64);
        for (index, value) in values.iter().enumerate() {
            let i = self.indices(index);
            all = all.max(value.abs());
            if (0..D).any(|a| i[a] == 0 || i[a] + 1 == self.points[a]) {
                edge = edge.max(value.abs());
            }
        }
        if all > 0.0 { edge / all } else { 0.0 }
    }
}
