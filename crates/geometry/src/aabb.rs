use crate::error::GeometryError;
use crate::vector::{distance, is_finite};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<const D: usize> {
    /// The corner with the smallest coordinates.
    pub min: [f64; D],
    /// The corner with the largest coordinates.
    pub max: [f64; D],
}

impl<const D: usize> Aabb<D> {
    /// The box between two corners.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] unless all coordinates are finite and `min < max` along every axis.
    pub fn new(min: [f64; D], max: [f64; D]) -> Result<Self, GeometryError> {
        if !is_finite(&min) || !is_finite(&max) {
            return Err(GeometryError::invalid("box", format!("corners {min:?} and {max:?} must be finite")));
        }
        for axis in 0..D {
            if min[axis] >= max[axis] {
                return Err(GeometryError::invalid(
                    "box",
                    format!("min {} is not below max {} along axis {axis}", min[axis], max[axis]),
                ));
            }
        }
        Ok(Self { min, max })
    }

    /// The smallest box that holds some points.
    ///
    /// # Errors
    /// As [`Aabb::new`]: for no points, and for points in a plane across an axis.
    pub(crate) fn of_points(points: &[[f64; D]]) -> Result<Self, GeometryError> {
        let (mut min, mut max) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for x in points {
            for axis in 0..D {
                min[axis] = min[axis].min(x[axis]);
                max[axis] = max[axis].max(x[axis]);
            }
        }
        Self::new(min, max)
    }

    /// Edge lengths.
    pub fn lengths(&self) -> [f64; D] {
        std::array::from_fn(|i| self.max[i] - self.min[i])
    }

    /// Length, area or volume.
    pub fn measure(&self) -> f64 {
        self.lengths().iter().product()
    }

    /// Midpoint.
    pub fn center(&self) -> [f64; D] {
        std::array::from_fn(|i| self.min[i] + 0.5 * (self.max[i] - self.min[i]))
    }

    /// Length of the diagonal.
    pub fn diameter(&self) -> f64 {
        distance(&self.min, &self.max)
    }

    /// Whether `x` lies inside, the surface and a margin `tol` (a length) included.
    pub fn contains(&self, x: &[f64; D], tol: f64) -> bool {
        (0..D).all(|i| x[i] >= self.min[i] - tol && x[i] <= self.max[i] + tol)
    }

    /// The nearest point of the box (`x` itself when inside).
    pub fn clamp(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| x[i].max(self.min[i]).min(self.max[i]))
    }

    /// The box grown by `margin` on every side; a negative margin shrinks it, never past its midpoint.
    pub fn inflated(&self, margin: f64) -> Self {
        let c = self.center();
        Self {
            min: std::array::from_fn(|i| (self.min[i] - margin).min(c[i])),
            max: std::array::from_fn(|i| (self.max[i] + margin).max(c[i])),
        }
    }

    /// The smallest box that holds both.
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    /// The part common to both, or `None` where they do not overlap in a set of positive measure.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let min: [f64; D] = std::array::from_fn(|i| self.min[i].max(other.min[i]));
        let max: [f64; D] = std::array::from_fn(|i| self.max[i].min(other.max[i]));
        (0..D).all(|i| min[i] < max[i]).then_some(Self { min, max })
    }

    /// Signed distance, negative inside.
    pub(crate) fn signed_distance(&self, x: &[f64; D]) -> f64 {
        let mut inside = f64::NEG_INFINITY;
        let mut outside = 0.0;
        for i in 0..D {
            let q = (self.min[i] - x[i]).max(x[i] - self.max[i]);
            inside = inside.max(q);
            outside += q.max(0.0) * q.max(0.0);
        }
        if inside > 0.0 { outside.sqrt() } else { inside }
    }

    /// The plane (axis, is the upper one) that is nearest to `x` in terms of signed distance.
    pub(crate) fn nearest_plane(&self, x: &[f64; D]) -> (usize, bool) {
        let mut best = (0, false);
        let mut largest = f64::NEG_INFINITY;
        for i in 0..D {
            for (upper, q) in [(false, self.min[i] - x[i]), (true, x[i] - self.max[i])] {
                if q > largest {
                    (best, largest) = ((i, upper), q);
                }
            }
        }
        best
    }

    /// Gradient of the signed distance; on edges, where it has none, one of the one-sided gradients.
    pub(crate) fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        let outward: [f64; D] = std::array::from_fn(|i| x[i] - x[i].max(self.min[i]).min(self.max[i]));
        crate::vector::normalized(&outward).unwrap_or_else(|| {
            let (axis, upper) = self.nearest_plane(x);
            crate::vector::axis_vector(axis, if upper { 1.0 } else { -1.0 })
        })
    }
}
