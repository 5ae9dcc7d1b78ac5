use std::fmt;

/// Step of the central differences of [`LevelSet::gradient`], relative to `max(1, |x_i|)`: the cube root of the
/// machine epsilon, which balances truncation (step^2) against cancellation (epsilon / step).
pub const GRADIENT_STEP: f64 = 6.055_454_452_393_343e-6;

/// A continuous function that is negative inside, positive outside and zero on a surface.
///
/// It need not be a distance. Near the surface it must be differentiable with a gradient that does not vanish.
/// Closures `Fn(&[f64; D]) -> f64` implement it; their gradient is taken by central differences.
pub trait LevelSet<const D: usize>: Send + Sync {
    /// Value at `x`.
    fn value(&self, x: &[f64; D]) -> f64;

    /// Gradient at `x`; by default central differences with step [`GRADIENT_STEP`]` * max(1, |x_i|)` along axis `i`,
    /// good to about ten digits for functions that vary over lengths of order one. Functions that vary over much
    /// shorter lengths should bring their own.
    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| {
            central_difference(|y| self.value(y), x, i, GRADIENT_STEP * x[i].abs().max(1.0))
        })
    }
}

impl<const D: usize, F> LevelSet<D> for F
where
    F: Fn(&[f64; D]) -> f64 + Send + Sync,
{
    fn value(&self, x: &[f64; D]) -> f64 {
        self(x)
    }
}

/// A level set from two closures: the value and its exact gradient.
#[derive(Clone, Copy)]
pub struct LevelSetFn<F, G> {
    value: F,
    gradient: G,
}

impl<F, G> LevelSetFn<F, G> {
    /// Pairs a function with its gradient; that they belong together is not checked.
    pub fn new(value: F, gradient: G) -> Self {
        Self { value, gradient }
    }
}

impl<F, G> fmt::Debug for LevelSetFn<F, G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LevelSetFn")
    }
}

impl<const D: usize, F, G> LevelSet<D> for LevelSetFn<F, G>
where
    F: Fn(&[f64; D]) -> f64 + Send + Sync,
    G: Fn(&[f64; D]) -> [f64; D] + Send + Sync,
{
    fn value(&self, x: &[f64; D]) -> f64 {
        (self.value)(x)
    }

    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        (self.gradient)(x)
    }
}

fn central_difference<const D: usize>(
    f: impl Fn(&[f64; D]) -> f64,
    x: &[f64; D],
    axis: usize,
    step: f64,
) -> f64 {
    let (mut low, mut high) = (*x, *x);
    low[axis] -= step;
    high[axis] += step;
    // Dividing by the rounded step removes the rounding of `x + step`.
    (f(&high) - f(&low)) / (high[axis] - low[axis])
}
