//! The Green's function in Fourier space: real, even in every direction, one octant of it kept.

use rayon::prelude::*;

use super::cosine;
use super::packs::Packs;
use super::real::Real;
use super::sample::Samples;
use crate::error::FreeSpaceError;
use crate::kernel::{Radial, Screened, Truncated};

/// Values on the octant of offsets `0..shape` in each direction, the last one running fastest.
pub(super) struct Octant {
    values: Vec<f64>,
    /// What they are to be multiplied by.
    scale: f64,
}

impl Octant {
    /// The transform of a kernel from its samples at the offsets of the mesh, times the volume of a cell.
    pub(super) fn of_samples(mut values: Vec<f64>, half: [usize; 3], spacing: [f64; 3]) -> Self {
        cosine::transform(&mut values, half, [true; 3]);
        Self { values, scale: spacing.iter().product() }
    }

    /// The same of a truncated kernel: sampled in Fourier space with the periods `2 (wide - 1)`, in which it is the
    /// Green's function itself, brought to the offsets of the mesh and back.
    pub(super) fn of_truncated<const D: usize>(
        kernel: &Truncated<D>,
        wide: [usize; 3],
        half: [usize; 3],
        spacing: [f64; 3],
    ) -> Self {
        let period = wide.map(|w| (2 * (w - 1)).max(1));
        let unit: [f64; 3] = std::array::from_fn(|a| std::f64::consts::TAU / (period[a] as f64 * spacing[a]));
        let mut values = Samples { shape: wide, spacing: unit }.of(&Transformed(kernel), kernel.smooth());
        cosine::transform(&mut values, wide, [true; 3]);
        let all: f64 = period.iter().map(|&p| p as f64).product();
        let mut cropped = crop(&values, wide, half);
        drop(values);
        cosine::transform(&mut cropped, half, [true; 3]);
        Self { values: cropped, scale: 1.0 / all }
    }
}

/// A kernel in Fourier space, as a function of the wave number.
struct Transformed<'a, const D: usize>(&'a Truncated<D>);

impl<const D: usize> Radial for Transformed<'_, D> {
    fn value(&self, k: f64) -> f64 {
        self.0.transform(k)
    }
}

impl Octant {
    /// Divided by `all`, in the order that columns are multiplied in: for each wave number of the first direction (none where there is
    /// no second one), block of packs and wave number of the third, one number for each lane.
    pub(super) fn packed<T: Real>(mut self, half: [usize; 3], packs: &Packs, all: f64) -> Vec<T> {
        let (lanes, flat, scale) = (packs.lanes(), half[1] == 1, self.scale / all);
        if flat && lanes == 4 {
            match T::same(self.values) {
                Ok(values) => return interleaved(values, half[2], T::rounded(scale)),
                Err(values) => self.values = values,
            }
        }
        let size = lanes * half[2];
        let planes = if flat { 1 } else { half[0] };
        let of: Vec<Vec<_>> = packs.of_blocks().map(|pack| packs.magnitudes(pack).collect()).collect();
        let mut kernel = vec![T::zero(); planes * of.len() * size];
        kernel.par_chunks_exact_mut(size).enumerate().for_each(|(block, kernel)| {
            let (plane, columns) = (block / of.len(), &of[block % of.len()]);
            let line = |k: usize| &self.values[(plane * half[1] + k) * half[2]..][..half[2]];
            if let [Some(a), Some(b), Some(c), Some(d)] = columns[..] {
                let lines = line(a).iter().zip(line(b)).zip(line(c)).zip(line(d));
                for (to, (((a, b), c), d)) in kernel.as_chunks_mut::<4>().0.iter_mut().zip(lines) {
                    *to = [a * scale, b * scale, c * scale, d * scale].map(T::rounded);
                }
                return;
            }
            for (lane, column) in columns.iter().enumerate() {
                let to = kernel.iter_mut().skip(lane).step_by(lanes);
                let line = column.map_or(&[][..], line);
                to.zip(line).for_each(|(to, g)| *to = T::rounded(g * scale));
            }
        });
        kernel
    }
}

/// Lines of `width` numbers, the numbers of four together, in the same memory; lines that there are not are zero.
fn interleaved<T: Real>(mut lines: Vec<T>, width: usize, scale: T) -> Vec<T> {
    let size = 4 * width;
    lines.resize(lines.len().next_multiple_of(size), T::zero());
    lines.par_chunks_exact_mut(size).for_each_init(
        || vec![T::zero(); size],
        |scratch, block| {
            scratch.copy_from_slice(block);
            let (a, rest) = scratch.split_at(width);
            let (b, rest) = rest.split_at(width);
            let (c, d) = rest.split_at(width);
            let lines = a.iter().zip(b).zip(c).zip(d);
            for (to, (((a, b), c), d)) in block.as_chunks_mut::<4>().0.iter_mut().zip(lines) {
                *to = [*a * scale, *b * scale, *c * scale, *d * scale];
            }
        },
    );
    lines
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
        if count == 0 {
            return Ok(Self { values, scale: 1.0 });
        }
        cosine::transform(&mut values, shape, open);
        let mut cropped = crop(&values, shape, half);
        drop(values);
        cosine::transform(&mut cropped, half, open);
        let all: f64 = (0..3).filter(|a| open[*a]).map(|a| wide[a] as f64).product();
        Ok(Self { values: cropped, scale: 1.0 / all })
    }
}

/// The corner of an array.
fn crop(values: &[f64], wide: [usize; 3], half: [usize; 3]) -> Vec<f64> {
    let mut out = Vec::with_capacity(half.iter().product());
    for i in 0..half[0] {
        for j in 0..half[1] {
            let start = (i * wide[1] + j) * wide[2];
            out.extend_from_slice(&values[start..start + half[2]]);
        }
    }
    out
}
