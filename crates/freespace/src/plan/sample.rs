//! Values of a kernel at all offsets of a mesh.

use rayon::prelude::*;

use crate::kernel::{Pieces, Radial, Smooth};

/// Rows that are worked on together.
const ROWS: usize = 32;

/// The offsets `0..shape` of each direction, the last one running fastest.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    pub(super) shape: [usize; 3],
    pub(super) spacing: [f64; 3],
}

impl Samples {
    /// Values of a kernel, by polynomials where that takes less time.
    pub(super) fn of(self, kernel: &dyn Radial, smooth: Option<Smooth>) -> Vec<f64> {
        let pieces =
            smooth.and_then(|smooth| Pieces::new(kernel, smooth, self.farthest(), self.evaluations()));
        match &pieces {
            Some(pieces) => self.values(pieces),
            None => self.values(kernel),
        }
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

    fn values(self, kernel: &(impl Radial + ?Sized)) -> Vec<f64> {
        match self.repeats() {
            Some(spacing) => self.cubes(kernel, spacing),
            None => self.rows(kernel),
        }
    }

    /// Row by row; of squares half.
    fn rows(self, kernel: &(impl Radial + ?Sized)) -> Vec<f64> {
        let (shape, square) = (self.shape, self.is_square());
        // Where cells are cubes, squares of distances in their units are whole numbers.
        let unit = self.used().fold(0.0, |unit: f64, a| unit.max(self.spacing[a]));
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let squares: [Vec<f64>; 3] = std::array::from_fn(|a| {
            let ratio = self.spacing[a] / unit;
            (0..shape[a]).map(|i| (i as f64 * ratio).powi(2)).collect()
        });
        // With room for lines that make the last four complete.
        let count: usize = shape.iter().product();
        let mut values = vec![0.0; count + 3 * shape[2]];
        values.truncate(count);
        values.par_chunks_mut(shape[2]).enumerate().for_each(|(line, out)| {
            let (i, j) = (line / shape[1], line % shape[1]);
            let (here, skip) = (squares[0][i] + squares[1][j], if square { i } else { 0 });
            let own = &mut out[skip..];
            own.iter_mut().zip(&squares[2][skip..]).for_each(|(value, z)| *value = here + z);
            kernel.values(unit, own);
        });
        if square {
            mirror(&mut values, shape[2]);
        }
        values
    }

    /// Distances between the points of cubes are `h sqrt(i)`; each is evaluated once.
    fn cubes(self, kernel: &(impl Radial + ?Sized), spacing: f64) -> Vec<f64> {
        let shape = self.shape;
        let first = |j: usize| if shape[1] == shape[2] { j } else { 0 };
        let mut occurs = vec![false; self.squares() + 1];
        for i in 0..shape[0] {
            for j in 0..shape[1] {
                let here = i * i + j * j;
                (first(j)..shape[2]).for_each(|k| occurs[here + k * k] = true);
            }
        }
        let table: Vec<f64> = occurs
            .par_iter()
            .enumerate()
            .with_min_len(256)
            .map(|(square, &used)| if used { kernel.value(spacing * (square as f64).sqrt()) } else { 0.0 })
            .collect();
        let mut values = vec![0.0; shape.iter().product()];
        values.par_chunks_mut(shape[2]).enumerate().for_each(|(line, out)| {
            let (i, j) = (line / shape[1], line % shape[1]);
            out.iter_mut().enumerate().for_each(|(k, value)| *value = table[i * i + j * j + k * k]);
        });
        values
    }
}

/// What is below the diagonal of a square, from what is above it.
fn mirror(values: &mut [f64], n: usize) {
    for start in (0..n).step_by(ROWS) {
        let count = ROWS.min(n - start);
        let (above, rows) = values.split_at_mut(start * n);
        for (k, from) in above.chunks_exact(n).enumerate() {
            let from = &from[start..start + count];
            from.iter().zip(rows.chunks_exact_mut(n)).for_each(|(value, row)| row[k] = *value);
        }
        for i in 0..count {
            (0..i).for_each(|k| rows[i * n + start + k] = rows[k * n + start + i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Samples;
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
                let samples = Samples { shape, spacing }.of(kernel, smooth);
                for (index, value) in samples.iter().enumerate() {
                    let i = [index / shape[2] / shape[1], index / shape[2] % shape[1], index % shape[2]];
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
