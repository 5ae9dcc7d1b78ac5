use crate::error::GeometryError;
use crate::vector::{axpy, dot, is_finite, norm, normalized, sub};

/// A ball: an interval in 1-D, a disc in 2-D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<const D: usize> {
    center: [f64; D],
    radius: f64,
}

impl<const D: usize> Ball<D> {
    /// The ball about `center`.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] unless the centre is finite and the radius positive and finite.
    pub fn new(center: [f64; D], radius: f64) -> Result<Self, GeometryError> {
        if !is_finite(&center) {
            return Err(GeometryError::invalid("ball", format!("centre {center:?} is not finite")));
        }
        check_length("ball", "radius", radius)?;
        Ok(Self { center, radius })
    }

    /// Centre.
    pub fn center(&self) -> &[f64; D] {
        &self.center
    }

    /// Radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// The points `x` with `normal . x <= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<const D: usize> {
    normal: [f64; D],
    offset: f64,
}

impl<const D: usize> HalfSpace<D> {
    /// The half-space behind the plane through `point` with outward `normal` (of any length).
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] for a zero or non-finite normal or a point that is not finite.
    pub fn new(point: [f64; D], normal: [f64; D]) -> Result<Self, GeometryError> {
        let Some(normal) = normalized(&normal).filter(|_| is_finite(&point)) else {
            return Err(GeometryError::invalid(
                "half-space",
                format!("point {point:?} must be finite and normal {normal:?} finite and not zero"),
            ));
        };
        Ok(Self { normal, offset: dot(&normal, &point) })
    }

    /// Outward unit normal.
    pub fn normal(&self) -> &[f64; D] {
        &self.normal
    }

    /// Distance of the plane from the origin along the normal.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    pub(crate) fn signed_distance(&self, x: &[f64; D]) -> f64 {
        dot(&self.normal, x) - self.offset
    }
}

/// A circular cylinder, endless or cut to a length, in 3-D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<const D: usize> {
    center: [f64; D],
    axis: [f64; D],
    radius: f64,
    half_length: Option<f64>,
}

/// Where a point lies relative to a cylinder.
pub(crate) struct CylinderFrame<const D: usize> {
    /// Signed coordinate along the axis, from the centre.
    pub(crate) along: f64,
    /// Distance from the axis.
    pub(crate) radial: f64,
    /// Unit vector away from the axis; some vector across it for points on the axis.
    pub(crate) outward: [f64; D],
}

impl<const D: usize> Cylinder<D> {
    /// The cylinder about the line through `center` along `axis` (of any length). With a `length`, `center` is the
    /// midpoint of the axis; without, the cylinder is endless.
    ///
    /// # Errors
    /// [`GeometryError::InvalidShape`] in other dimensions than three (a cylinder's cross-section in 2-D is a ball),
    /// for a zero axis, and unless radius and length are positive and finite.
    pub fn new(
        center: [f64; D],
        axis: [f64; D],
        radius: f64,
        length: Option<f64>,
    ) -> Result<Self, GeometryError> {
        if D != 3 {
            return Err(GeometryError::invalid(
                "cylinder",
                format!("it needs 3 dimensions, not {D}; use a ball"),
            ));
        }
        let Some(axis) = normalized(&axis).filter(|_| is_finite(&center)) else {
            return Err(GeometryError::invalid(
                "cylinder",
                format!("centre {center:?} must be finite and axis {axis:?} finite and not zero"),
            ));
        };
        check_length("cylinder", "radius", radius)?;
        if let Some(length) = length {
            check_length("cylinder", "length", length)?;
        }
        Ok(Self { center, axis, radius, half_length: length.map(|l| 0.5 * l) })
    }

    /// A point of the axis: the midpoint where the cylinder has a length.
    pub fn center(&self) -> &[f64; D] {
        &self.center
    }

    /// Unit vector along the axis.
    pub fn axis(&self) -> &[f64; D] {
        &self.axis
    }

    /// Radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Half of the length, `None` for an endless cylinder.
    pub fn half_length(&self) -> Option<f64> {
        self.half_length
    }

    pub(crate) fn frame(&self, x: &[f64; D]) -> CylinderFrame<D> {
        let d = sub(x, &self.center);
        let along = dot(&d, &self.axis);
        let across = axpy(&d, -along, &self.axis);
        let radial = norm(&across);
        let outward = normalized(&across).unwrap_or_else(|| any_normal(&self.axis));
        CylinderFrame { along, radial, outward }
    }

    /// Signed distances from the mantle and, where there are caps, from the nearer cap's plane.
    pub(crate) fn parts(&self, f: &CylinderFrame<D>) -> (f64, f64) {
        (f.radial - self.radius, self.half_length.map_or(f64::NEG_INFINITY, |h| f.along.abs() - h))
    }
}

/// A unit vector across `axis`.
pub(crate) fn any_normal<const D: usize>(axis: &[f64; D]) -> [f64; D] {
    let smallest = (0..D).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs())).unwrap_or(0);
    let e: [f64; D] = crate::vector::axis_vector(smallest, 1.0);
    normalized(&axpy(&e, -axis[smallest], axis)).unwrap_or(e)
}

fn check_length(shape: &'static str, name: &str, value: f64) -> Result<(), GeometryError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(GeometryError::invalid(shape, format!("{name} {value} must be positive and finite")))
}
