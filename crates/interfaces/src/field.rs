//! Scalar fields given by position: coefficients, sources, boundary data, jumps.

use std::fmt;
use std::sync::Arc;

/// A scalar function of position, evaluated over blocks of points.
pub trait ScalarField<const D: usize>: Send + Sync {
    /// Writes the value at `points[k]` to `out[k]`; both slices have the same length.
    fn eval(&self, points: &[[f64; D]], out: &mut [f64]);

    /// The gradient at one point, where it is known in closed form.
    fn gradient(&self, _point: &[f64; D]) -> Option<[f64; D]> {
        None
    }
}

impl<const D: usize, F> ScalarField<D> for F
where
    F: Fn(&[f64; D]) -> f64 + Send + Sync,
{
    fn eval(&self, points: &[[f64; D]], out: &mut [f64]) {
        for (value, point) in out.iter_mut().zip(points) {
            *value = self(point);
        }
    }
}

/// A constant or a function: a constant is never evaluated point by point.
#[derive(Clone)]
pub enum Field<const D: usize> {
    /// The same value everywhere.
    Constant(f64),
    /// A function of position.
    Function(Arc<dyn ScalarField<D>>),
}

impl<const D: usize> Field<D> {
    /// A field from a closure.
    ///
    /// ```
    /// use meshless_interfaces::Field;
    /// let field = Field::from_fn(|x: &[f64; 2]| x[0] * x[1]);
    /// assert_eq!(field.at(&[2.0, 3.0]), 6.0);
    /// ```
    pub fn from_fn(f: impl Fn(&[f64; D]) -> f64 + Send + Sync + 'static) -> Self {
        Self::Function(Arc::new(f))
    }

    /// The value at one point.
    pub fn at(&self, point: &[f64; D]) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Function(f) => {
                let mut out = [0.0];
                f.eval(std::slice::from_ref(point), &mut out);
                out[0]
            }
        }
    }

    /// The values at many points.
    pub fn eval(&self, points: &[[f64; D]], out: &mut [f64]) {
        match self {
            Self::Constant(value) => out.fill(*value),
            Self::Function(f) => f.eval(points, out),
        }
    }

    /// The gradient at one point: in closed form where there is one, else by central differences of this step.
    pub fn gradient(&self, point: &[f64; D], step: f64) -> [f64; D] {
        let Self::Function(f) = self else { return [0.0; D] };
        f.gradient(point).unwrap_or_else(|| {
            std::array::from_fn(|k| {
                let [before, after] = [-step, step].map(|t| {
                    let mut x = *point;
                    x[k] += t;
                    self.at(&x)
                });
                (after - before) / (2.0 * step)
            })
        })
    }

    /// The value if it is the same everywhere.
    pub fn as_constant(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            Self::Function(_) => None,
        }
    }
}

impl<const D: usize> fmt::Debug for Field<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "Constant({value})"),
            Self::Function(_) => write!(f, "Function(..)"),
        }
    }
}
