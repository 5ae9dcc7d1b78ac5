//! Values of a kernel at all offsets of a mesh, transformed.

use rayon::prelude::*;

use super::columns::{Evaluated, Known};
use super::separable::Separable;
use super::square::Square;
use crate::kernel::{Pieces, Radial, Smooth};

/// The offsets `0..shape` of each direction, the last one running fastest.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    pub(super) shape: [usize; 3],
    pub(super) spacing: [f64; 3],
}

impl Samples {
    /// Values of a kernel, by polynomials where that takes less time, and what is done with them.
    pub(super) fn of(self, kernel: &dyn Radial, smooth: Option<Smooth>, done: &Separable) -> Vec<f64> {
        let pieces =
            smooth.and_then(|smooth| Pieces::new(kernel, smooth, self.farthest(), self.evaluations()));
        let kernel: &dyn Radial = pieces.as_ref().map_or(kernel, |pieces| pieces);
        if let Some(spacing) = self.repeats() {
            let across = self.across(done.is_symmetric());
            let table = self.table(kernel, spacing, &across);
            return done.of(Known { table: &table, across: &across });
        }
        if self.is_square() {
            let (unit, [squares, ..]) = self.squares_along();
            return done.of(Square::new(kernel, unit, &squares, done));
        }
        let (unit, [along, y, z]) = self.squares_along();
        let across: Vec<f64> = y.iter().flat_map(|y| z.iter().map(move |z| y + z)).collect();
        done.of(Evaluated { kernel, unit, along: &along, across: &across })
    }

    /// Whether all three directions are the same.
    pub(super) fn is_symmetric(self) -> bool {
        let [x, y, z] = self.shape;
        x == y && y == z && self.repeats().is_some()
    }

    /// Squares of the distances of columns from the first direction in units of the spacing, of an array that is kept as a symmetric one those
    /// with `y <= z`: that the offsets are symmetric is not enough for that, what is kept of them must be.
    fn across(self, symmetric: bool) -> Vec<usize> {
        let first = |y: usize| if symmetric { y } else { 0 };
        (0..self.shape[1]).flat_map(|y| (first(y)..self.shape[2]).map(move |z| y * y + z * z)).collect()
    }

    /// The largest distance.
    fn farthest(self) -> f64 {
        let along = |a: usize| (self.shape[a] - 1) as f64 * self.spacing[a];
        (0..3).map(|a| along(a).powi(2)).sum::<f64>().sqrt()
    }

    /// Directions of more than one offset.
    fn used(self) -> impl Iterator<Item = usize> {
        (0..3).filter(move |&a| self.shape[a] > 1)
    }

    /// The spacing, if it is the same in all directions.
    fn even(self) -> Option<f64> {
        let mut used = self.used().map(|a| self.spacing[a]);
        let first = used.next().unwrap_or(1.0);
        used.all(|h| h == first).then_some(first)
    }

    /// Whether offsets may change places.
    fn is_square(self) -> bool {
        let [x, y, z] = self.shape;
        y == 1 && x == z && self.even().is_some()
    }

    /// The spacing of cubes, where there are so many fewer distances than offsets that it is worth finding them. Of squares every second
    /// offset above the diagonal has a distance of its own, and finding them takes longer than evaluating all.
    fn repeats(self) -> Option<f64> {
        let all: usize = self.shape.iter().product();
        self.even().filter(|_| self.used().count() == 3 && self.squares() < all)
    }

    /// How many values it takes.
    fn evaluations(self) -> usize {
        let all: usize = self.shape.iter().product();
        match self.repeats() {
            Some(_) => self.squares() + 1,
            None if self.is_square() => all / 2,
            None => all,
        }
    }

    /// The largest square of a distance in units of the spacing.
    fn squares(self) -> usize {
        self.shape.iter().map(|&n| (n - 1) * (n - 1)).sum()
    }

    /// A length and the squares of the offsets of each direction in units of its square: where cells are cubes, whole numbers.
    fn squares_along(self) -> (f64, [Vec<f64>; 3]) {
        let unit = self.used().fold(0.0, |unit: f64, a| unit.max(self.spacing[a]));
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let along = |a: usize| {
            let ratio = self.spacing[a] / unit;
            (0..self.shape[a]).map(|i| (i as f64 * ratio).powi(2)).collect()
        };
        (unit, std::array::from_fn(along))
    }

    /// Values by the square of the distance in units of the spacing, of those that there are.
    fn table(self, kernel: &dyn Radial, spacing: f64, across: &[usize]) -> Vec<f64> {
        let mut occurs = vec![false; self.squares() + 1];
        (0..self.shape[0]).for_each(|i| across.iter().for_each(|here| occurs[i * i + here] = true));
        let of = |(square, &used): (usize, &bool)| {
            if used { kernel.value(spacing * (square as f64).sqrt()) } else { 0.0 }
        };
        occurs.par_iter().enumerate().with_min_len(256).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::cosine::Direction;
    use super::{Samples, Separable};
    use crate::error::FreeSpaceError;
    use crate::kernel::{Gaussian, Radial, Spectral};

    /// Every offset has the value of its distance, whichever way it was found.
    #[test]
    fn samples_are_the_kernel() -> Result<(), FreeSpaceError> {
        let cases = [
            ([90, 1, 90], [0.5, 1.0, 0.5]),
            ([90, 1, 70], [0.5, 1.0, 0.5]),
            ([60, 1, 60], [0.5, 1.0, 0.7]),
            ([300, 1, 300], [1e-60, 1.0, 1e-60]),
            ([1, 1, 50], [1.0, 1.0, 0.3]),
            ([30, 1, 1], [0.2, 1.0, 1.0]),
            ([1, 1, 1], [1.0; 3]),
            ([20, 20, 20], [0.5; 3]),
            ([20, 18, 25], [0.5; 3]),
            ([70, 20, 60], [0.5, 0.4, 0.3]),
        ];
        for (shape, spacing) in cases {
            let h = f64::max(spacing[0], spacing[2]);
            let (gaussian, spectral) = (Gaussian::<2>::new(10, 1.5 * h)?, Spectral::<2>::new(h / 3.2)?);
            let (solid, deep) = (Gaussian::<3>::new(6, 1.5 * h)?, Spectral::<3>::new(h / 3.2)?);
            let (smooth, deep_smooth) = (spectral.smooth(), deep.smooth());
            // Logarithms pass through zero: their error is that of what is added there.
            let least = 0.5 / std::f64::consts::TAU;
            let kernels: [(&dyn Radial, _, f64); 4] = [
                (&gaussian, None, least),
                (&spectral, smooth, least),
                (&solid, None, 0.0),
                (&deep, deep_smooth, 0.0),
            ];
            for (kernel, smooth, least) in kernels {
                let samples = Samples { shape, spacing };
                let symmetric = samples.is_symmetric();
                let nothing = Separable::new(shape.map(|n| Direction::new(n, n, 0)), symmetric, 1.0);
                let values = samples.of(kernel, smooth, &nothing);
                // Lines that make the last ones complete are none of the array.
                for (i, value) in nothing.indices().zip(values).filter(|(i, _)| i[0] < shape[0]) {
                    let r = (0..3).fold(0.0_f64, |r, a| r.hypot(i[a] as f64 * spacing[a]));
                    let error = (value - kernel.value(r)).abs();
                    assert!(
                        error <= 1e-14 * kernel.value(r).abs().max(least),
                        "{shape:?} {spacing:?} {i:?}: {error:e} of {value:e}"
                    );
                }
            }
        }
        Ok(())
    }
}
