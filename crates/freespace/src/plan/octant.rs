//! The Green's function in Fourier space: real, even in every direction, one octant of it kept.

use rayon::prelude::*;

use super::columns::Given;
use super::cosine::Direction;
use super::packs::Packs;
use super::real::Real;
use super::sample::Samples;
use super::separable::{Separable, triangle};
use crate::error::FreeSpaceError;
use crate::kernel::{Radial, Screened, Smooth, Truncated};

/// Ĝ on the octant of wave numbers `0..half` in each direction, the last one running fastest.
pub(super) struct Octant {
    values: Vec<f64>,
    half: [usize; 3],
    /// Whether directions may be exchanged, so that there are lines only for `x <= y`.
    symmetric: bool,
    /// Lines whose numbers lie together; one where there is a second direction.
    together: usize,
}

impl Octant {
    /// The transform of a kernel from its samples at the offsets of the mesh, times the volume of a cell, over `all`.
    pub(super) fn of_samples(
        kernel: &dyn Radial,
        smooth: Option<Smooth>,
        half: [usize; 3],
        spacing: [f64; 3],
        all: f64,
    ) -> Self {
        let samples = Samples { shape: half, spacing };
        let symmetric = samples.is_symmetric();
        let scale = spacing.iter().product::<f64>() / all;
        let done = Separable::new(half.map(|n| Direction::new(n, n, 1)), symmetric, scale);
        Self { values: samples.of(kernel, smooth, &done), half, symmetric, together: done.together() }
    }

    /// The same of a truncated kernel: sampled in Fourier space with the periods `2 (wide - 1)`, in which it is the
    /// Green's function itself, brought to the offsets of the mesh and back.
    pub(super) fn of_truncated<const D: usize>(
        kernel: &Truncated<D>,
        wide: [usize; 3],
        half: [usize; 3],
        spacing: [f64; 3],
        all: f64,
    ) -> Self {
        let points = |half: [usize; 3]| half.map(|n| (2 * (n - 1)).max(1) as f64);
        let (period, padded) = (points(wide), points(half));
        let volume: f64 = padded.iter().zip(spacing).map(|(n, h)| n * h).product();
        let unit: [f64; 3] = std::array::from_fn(|a| std::f64::consts::TAU / (period[a] * spacing[a]));
        let samples = Samples { shape: wide, spacing: unit };
        let symmetric = samples.is_symmetric() && half[0] == half[1] && half[1] == half[2];
        let directions = std::array::from_fn(|a| Direction::new(wide[a], half[a], 2));
        let done = Separable::new(directions, symmetric, 1.0 / (period.iter().product::<f64>() * all));
        let mut values = samples.of(&Transformed(kernel), None, &done);
        // What is left of the kernel is a constant at all offsets.
        values[0] += kernel.rim() * volume / all;
        Self { values, half, symmetric, together: done.together() }
    }

    /// Whether all samples of the kernel were finite: their sum is wave number zero.
    pub(super) fn is_finite(&self) -> bool {
        self.values.first().is_some_and(|sum| sum.is_finite())
    }

    /// The line of two indices.
    fn line(&self, i: usize, j: usize) -> impl Iterator<Item = f64> {
        let (length, together) = (self.half[2], self.together);
        let start = i / together * together * length + i % together;
        let start = if together > 1 { start } else { self.place(i, j) * length };
        self.values[start..].iter().step_by(together).take(length).copied()
    }

    /// Where the line of two indices is, if the numbers of lines do not lie together.
    fn place(&self, i: usize, j: usize) -> usize {
        if self.symmetric { triangle(i.min(j), i.max(j), self.half[0]) } else { i * self.half[1] + j }
    }
}

/// A kernel in Fourier space, as a function of the wave number.
struct Transformed<'a, const D: usize>(&'a Truncated<D>);

impl<const D: usize> Radial for Transformed<'_, D> {
    fn value(&self, k: f64) -> f64 {
        self.0.transform_above_rim(k)
    }

    fn values(&self, unit: f64, squares: &mut [f64]) {
        self.0.transforms_above_rim(unit, squares);
    }
}

impl Octant {
    /// In the order that columns are multiplied in: for each wave number of the first direction (none where there is
    /// no second one), block of packs and wave number of the third, one number for each lane.
    pub(super) fn packed<T: Real>(mut self, packs: &Packs) -> Vec<T> {
        let (half, lanes) = (self.half, packs.lanes());
        let flat = half[1] == 1;
        if flat && lanes == self.together {
            match T::same(self.values) {
                Ok(values) => return values,
                Err(values) => self.values = values,
            }
        }
        let size = lanes * half[2];
        let planes = if flat { 1 } else { half[0] };
        let of: Vec<Vec<_>> = packs.of_blocks().map(|pack| packs.magnitudes(pack).collect()).collect();
        let mut kernel = vec![T::zero(); planes * of.len() * size];
        kernel.par_chunks_exact_mut(size).enumerate().for_each(|(block, kernel)| {
            let (plane, columns) = (block / of.len(), &of[block % of.len()]);
            if let ([Some(a), Some(b), Some(c), Some(d)], false) = (&columns[..], flat) {
                let line = |k: &usize| self.values[self.place(plane, *k) * half[2]..][..half[2]].iter();
                let lines = line(a).zip(line(b)).zip(line(c)).zip(line(d));
                for (to, (((a, b), c), d)) in kernel.as_chunks_mut::<4>().0.iter_mut().zip(lines) {
                    *to = [*a, *b, *c, *d].map(T::rounded);
                }
                return;
            }
            for (lane, column) in columns.iter().enumerate() {
                let Some(k) = *column else { continue };
                let line = if flat { self.line(k, 0) } else { self.line(plane, k) };
                kernel.iter_mut().skip(lane).step_by(lanes).zip(line).for_each(|(to, g)| *to = T::rounded(g));
            }
        });
        kernel
    }
}

/// A problem of which some directions are periods.
pub(super) struct Mixed {
    /// Directions that are open.
    pub(super) open: [bool; 3],
    /// Radius at which kernels are cut off.
    pub(super) radius: f64,
    /// Lengths of the transforms in which they are sampled.
    pub(super) wide: [usize; 3],
    /// The octant.
    pub(super) half: [usize; 3],
    pub(super) spacing: [f64; 3],
}

impl Octant {
    /// Ĝ where some directions are periods: for each wave number of those, the screened Green's function of the others, cut
    /// off, times `filter` of the magnitude of the whole wave number.
    pub(super) fn of_mixed(
        mixed: &Mixed,
        filter: &(dyn Fn(f64) -> f64 + Sync),
        all: f64,
    ) -> Result<Self, FreeSpaceError> {
        let Mixed { open, radius, wide, half, spacing } = *mixed;
        let shape = wide.map(|n| n / 2 + 1);
        // Squares of the wave numbers of each direction.
        let squares: [Vec<f64>; 3] = std::array::from_fn(|a| {
            let unit = std::f64::consts::TAU / (wide[a] as f64 * spacing[a]);
            (0..shape[a]).map(|i| if wide[a] > 1 { (i as f64 * unit).powi(2) } else { 0.0 }).collect()
        });
        let count = open.iter().filter(|o| **o).count();
        let of = |a: usize, i: usize, wanted: bool| if open[a] == wanted { squares[a][i] } else { 0.0 };
        let mut values = vec![0.0; shape.iter().product()];
        values.par_chunks_mut(shape[2]).enumerate().try_for_each(|(line, out)| {
            let (i, j) = (line / shape[1], line % shape[1]);
            let mut kernel = None;
            for (k, value) in out.iter_mut().enumerate() {
                let sum = |wanted| of(0, i, wanted) + of(1, j, wanted) + of(2, k, wanted);
                let (across, along): (f64, f64) = (sum(false), sum(true));
                let kept = match kernel {
                    Some((square, kept)) if square == across => kept,
                    _ => Screened::new(count, radius, across.sqrt()),
                };
                kernel = Some((across, kept));
                *value = filter((across + along).sqrt()) * kept.transform(along.sqrt())?;
            }
            Ok(())
        })?;
        let periods: f64 = (0..3).filter(|a| open[*a]).map(|a| wide[a] as f64).product();
        let directions =
            std::array::from_fn(|a| Direction::new(shape[a], half[a], if open[a] { 2 } else { 0 }));
        let done = Separable::new(directions, false, 1.0 / (periods * all));
        let mut values = done.of(Given { values: &values, across: shape[1] * shape[2] });
        let volume: f64 =
            (0..3).filter(|a| open[*a]).map(|a| spacing[a] * (2 * (half[a] - 1)) as f64).product();
        values[0] += Screened::rim(count, radius)? * volume / all;
        Ok(Self { values, half, symmetric: false, together: done.together() })
    }
}
