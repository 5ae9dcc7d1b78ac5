//! A kernel by polynomials, where so many values of it are wanted that it pays to know it on short pieces.

use std::f64::consts::PI;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::Radial;

/// Points of a piece, one more than the degree of its polynomial. Over three quarters of a period of an oscillation what is left out is
/// `2 J_20(3 pi / 4)`, 2e-17 of it.
const POINTS: usize = 20;

/// Error of a polynomial relative to the largest value of its piece: what kernels themselves are known to.
const ERROR: f64 = 4e-15;

/// How many of the values that are wanted a value for a polynomial must stand for.
const WORTH: usize = 3;

/// How smooth a kernel is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Smooth {
    /// Length of pieces on which it is a polynomial of degree 19 to round-off: three quarters of the shortest period, or less.
    pub(crate) width: f64,
    /// An error that does not matter wherever it is.
    pub(crate) error: f64,
}

/// A kernel as polynomials on pieces of equal length. Pieces on which the polynomial is not the kernel ask the kernel itself.
pub(crate) struct Pieces<'a> {
    kernel: &'a dyn Radial,
    /// Pieces for a unit of length.
    inverse: f64,
    pieces: Vec<Option<[f64; POINTS]>>,
}

impl<'a> Pieces<'a> {
    /// The kernel up to the distance `farthest`, if that takes fewer values than `wanted`.
    pub(crate) fn new(kernel: &'a dyn Radial, smooth: Smooth, farthest: f64, wanted: usize) -> Option<Self> {
        let count = farthest / smooth.width + 1.0;
        let pays = count * (WORTH * POINTS) as f64 <= wanted as f64;
        pays.then(|| {
            let rule = Rule::new();
            let fit = |piece: usize| rule.fit(kernel, smooth, piece);
            let pieces = (0..count as usize).into_par_iter().map(fit).collect();
            Self { kernel, inverse: 1.0 / smooth.width, pieces }
        })
    }
}

impl Radial for Pieces<'_> {
    #[inline]
    fn value(&self, r: f64) -> f64 {
        let place = r * self.inverse;
        let piece = place as usize;
        match self.pieces.get(piece) {
            Some(Some(coefficients)) => polynomial(coefficients, 2.0 * (place - piece as f64) - 1.0),
            _ => self.kernel.value(r),
        }
    }

    fn values(&self, unit: f64, squares: &mut [f64]) {
        Arch::new().dispatch(Each { pieces: self, unit, squares });
    }
}

/// Each value, its four sums in a vector where the processor has such.
struct Each<'a> {
    pieces: &'a Pieces<'a>,
    unit: f64,
    squares: &'a mut [f64],
}

impl WithSimd for Each<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { pieces, unit, squares } = self;
        if S::F64_LANES != 4 {
            return squares.iter_mut().for_each(|s| *s = pieces.value(unit * s.sqrt()));
        }
        for square in squares {
            let r = unit * square.sqrt();
            let place = r * pieces.inverse;
            let piece = place as usize;
            *square = match pieces.pieces.get(piece) {
                Some(Some(coefficients)) => four_sums(simd, coefficients, 2.0 * (place - piece as f64) - 1.0),
                _ => pieces.kernel.value(r),
            };
        }
    }
}

/// [`polynomial`] with vectors of four.
#[inline(always)]
fn four_sums<S: Simd>(simd: S, coefficients: &[f64; POINTS], t: f64) -> f64 {
    let (square, mut sums) = (t * t, [0.0; 4]);
    let (fourth, fours) = (simd.splat_f64s(square * square), S::as_simd_f64s(coefficients).0);
    let sum =
        fours.iter().rev().fold(simd.splat_f64s(0.0), |sum, four| simd.mul_add_f64s(sum, fourth, *four));
    S::as_mut_simd_f64s(&mut sums).0.iter_mut().for_each(|to| *to = sum);
    (sums[0] + sums[2] * square) + t * (sums[1] + sums[3] * square)
}

/// Powers of t, the lowest first: four sums of every fourth power, which do not wait for each other.
#[inline]
fn polynomial(coefficients: &[f64; POINTS], t: f64) -> f64 {
    let (square, mut sums) = (t * t, [0.0; 4]);
    let fourth = square * square;
    for four in coefficients.as_chunks::<4>().0.iter().rev() {
        sums.iter_mut().zip(four).for_each(|(sum, c)| *sum = *sum * fourth + c);
    }
    (sums[0] + sums[2] * square) + t * (sums[1] + sums[3] * square)
}

/// Interpolation in the zeros of the Chebyshev polynomial of the degree that is left out.
struct Rule {
    points: [f64; POINTS],
    /// For each Chebyshev polynomial, its values at the points.
    cosines: [[f64; POINTS]; POINTS],
}

impl Rule {
    fn new() -> Self {
        let angle = |j: usize| PI * (j as f64 + 0.5) / POINTS as f64;
        Self {
            points: std::array::from_fn(|j| angle(j).cos()),
            cosines: std::array::from_fn(|k| std::array::from_fn(|j| (angle(j) * k as f64).cos())),
        }
    }

    /// The polynomial of a piece, if it is the kernel in the middle and near the ends, where it would be farthest off.
    fn fit(&self, kernel: &dyn Radial, smooth: Smooth, piece: usize) -> Option<[f64; POINTS]> {
        let at = |t: f64| kernel.value((piece as f64 + 0.5 * (t + 1.0)) * smooth.width);
        let values = self.points.map(at);
        let coefficients = self.powers(&values);
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let limit = smooth.error.max(ERROR * largest);
        let end = (PI / POINTS as f64).cos();
        let holds = |t: f64| (polynomial(&coefficients, t) - at(t)).abs() <= limit;
        [-end, 0.0, end].into_iter().all(holds).then_some(coefficients)
    }

    /// Coefficients of the powers by those of the Chebyshev polynomials, `T_(k+1) = 2 t T_k - T_(k-1)`.
    fn powers(&self, values: &[f64; POINTS]) -> [f64; POINTS] {
        let (mut before, mut here) = ([0.0; POINTS], [0.0; POINTS]);
        here[0] = 1.0;
        let mut sum = [0.0; POINTS];
        for (k, cosines) in self.cosines.iter().enumerate() {
            let weight = if k == 0 { 1.0 } else { 2.0 } / POINTS as f64;
            let product: f64 = cosines.iter().zip(values).map(|(c, v)| c * v).sum();
            sum.iter_mut().zip(&here).for_each(|(s, c)| *s += weight * product * c);
            let factor = if k == 0 { 1.0 } else { 2.0 };
            let mut next = before.map(|c| -c);
            (1..POINTS).for_each(|i| next[i] += factor * here[i - 1]);
            (before, here) = (here, next);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{Pieces, Smooth};
    use crate::error::FreeSpaceError;
    use crate::kernel::{BandPass, Radial, Spectral};

    /// A function of the distance.
    struct Function<F>(F);

    impl<F: Fn(f64) -> f64 + Sync> Radial for Function<F> {
        fn value(&self, r: f64) -> f64 {
            (self.0)(r)
        }
    }

    /// Largest difference from the kernel, over the largest value nearby but at least `least`.
    fn difference(kernel: &dyn Radial, smooth: Option<Smooth>, farthest: f64, least: f64) -> f64 {
        let smooth = smooth.expect("a smooth kernel");
        let pieces = Pieces::new(kernel, smooth, farthest, usize::MAX).expect("pieces");
        let whole = pieces.pieces.iter().flatten().count();
        assert!(whole * 10 > pieces.pieces.len() * 9, "{whole} of {} pieces", pieces.pieces.len());
        let count = 40_000;
        let mut together: Vec<f64> =
            (0..count).map(|i| (farthest * (f64::from(i) + 0.3) / f64::from(count)).powi(2)).collect();
        pieces.values(1.0, &mut together);
        (0..count).fold(0.0_f64, |worst, i| {
            let r = farthest * (f64::from(i) + 0.3) / f64::from(count);
            let near = (-2..=2).map(|k| (r + 0.25 * f64::from(k) * smooth.width).max(0.0));
            let scale = near.fold(least, |m, r| m.max(kernel.value(r).abs()));
            let apart = (pieces.value(r) - kernel.value(r)).abs();
            worst.max(apart.max((together[i as usize] - kernel.value(r)).abs()) / scale)
        })
    }

    #[test]
    fn pieces_are_the_kernels() -> Result<(), FreeSpaceError> {
        let (flat, deep) = (Spectral::<2>::new(1.0 / PI)?, Spectral::<3>::new(1.0 / PI)?);
        let error = difference(&flat, flat.smooth(), 1500.0, 0.08);
        assert!(error < 1e-14, "{error:e}");
        let error = difference(&deep, deep.smooth(), 500.0, 0.0);
        assert!(error < 1e-14, "{error:e}");
        for order in [2, 10, 20] {
            // Its tail matters as a part of what is at the origin.
            let (flat, deep) = (BandPass::<2>::new(order, 1.0, 2.0)?, BandPass::<3>::new(order, 1.0, 2.0)?);
            let error = difference(&flat, flat.smooth(), 18.0, 0.1 * flat.value(0.0));
            assert!(error < 1e-14, "order {order}: {error:e}");
            let error = difference(&deep, deep.smooth(), 18.0, 0.1 * deep.value(0.0));
            assert!(error < 1e-14, "order {order}: {error:e}");
        }
        Ok(())
    }

    #[test]
    fn a_step_is_left_to_the_function() {
        let step = Function(|r: f64| if r < 3.3 { 1.0 } else { 0.0 });
        let pieces = Pieces::new(&step, Smooth { width: 0.5, error: 0.0 }, 10.0, usize::MAX).expect("pieces");
        assert!(
            (0..1000).map(|i| f64::from(i) * 0.01).all(|r| (pieces.value(r) - step.value(r)).abs() < 1e-14)
        );
        assert_eq!(pieces.pieces.iter().filter(|p| p.is_none()).count(), 1);
        assert!(Pieces::new(&step, Smooth { width: 0.5, error: 0.0 }, 10.0, 1000).is_none());
        assert!(Pieces::new(&step, Smooth { width: 0.0, error: 0.0 }, 10.0, 1000).is_none());
    }
}
