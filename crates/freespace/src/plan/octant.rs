//! The Green's function in Fourier space: real, even in every direction, one octant of it kept.

use rayon::prelude::*;

use super::cosine;
use super::packs::Packs;
use super::real::Real;
use crate::error::FreeSpaceError;
use crate::kernel::{Radial, Screened, Truncated};

/// Values on the octant of offsets `0..shape` in each direction, the last one running fastest.
pub(super) struct Octant {
    pub(super) values: Vec<f64>,
}

impl Octant {
    /// The transform of a kernel that is sampled at the offsets of the mesh, times the volume of a cell.
    pub(super) fn of_radial(kernel: &dyn Radial, half: [usize; 3], spacing: [f64; 3]) -> Self {
        let mut octant = Self { values: sample_radial(kernel, half, spacing) };
        cosine::transform(&mut octant.values, half, [true; 3]);
        let volume: f64 = spacing.iter().product();
        octant.values.par_iter_mut().for_each(|v| *v *= volume);
        octant
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
        let transform = |k: f64| kernel.transform(k);
        let mut values = sample_radial(&Function(transform), wide, unit);
        cosine::transform(&mut values, wide, [true; 3]);
        let all: f64 = period.iter().map(|&p| p as f64).product();
        let mut octant = Self { values: crop(&values, wide, half) };
        drop(values);
        cosine::transform(&mut octant.values, half, [true; 3]);
        octant.values.par_iter_mut().for_each(|v| *v /= all);
        octant
    }
}

impl Octant {
    /// Divided by `all`, in the order that columns are multiplied in: for each wave number of the first direction (none where there is
    /// no second one), block of packs and wave number of the third, one number for each lane.
    pub(super) fn packed<T: Real>(self, half: [usize; 3], packs: &Packs, all: f64) -> Vec<T> {
        let (lanes, flat) = (packs.lanes(), half[1] == 1);
        let size = lanes * half[2];
        let planes = if flat { 1 } else { half[0] };
        let of: Vec<Vec<_>> = packs.of_blocks().map(|pack| packs.magnitudes(pack).collect()).collect();
        let mut kernel = vec![T::zero(); planes * of.len() * size];
        kernel.par_chunks_mut(of.len() * size).enumerate().for_each(|(plane, kernel)| {
            for (columns, kernel) in of.iter().zip(kernel.chunks_exact_mut(size)) {
                let line = |k: usize| &self.values[(plane * half[1] + k) * half[2]..][..half[2]];
                if let [Some(a), Some(b), Some(c), Some(d)] = columns[..] {
                    let lines = line(a).iter().zip(line(b)).zip(line(c)).zip(line(d));
                    for (to, (((a, b), c), d)) in kernel.as_chunks_mut::<4>().0.iter_mut().zip(lines) {
                        *to = [a / all, b / all, c / all, d / all].map(T::rounded);
                    }
                    continue;
                }
                for (lane, column) in columns.iter().enumerate() {
                    let to = kernel.iter_mut().skip(lane).step_by(lanes);
                    let line = column.map_or(&[][..], line);
                    to.zip(line).for_each(|(to, g)| *to = T::rounded(g / all));
                }
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
            return Ok(Self { values });
        }
        cosine::transform(&mut values, shape, open);
        let mut octant = Self { values: crop(&values, shape, half) };
        cosine::transform(&mut octant.values, half, open);
        let all: f64 = (0..3).filter(|a| open[*a]).map(|a| wide[a] as f64).product();
        octant.values.par_iter_mut().for_each(|v| *v /= all);
        Ok(octant)
    }
}

/// A function of the distance.
struct Function<F>(F);

impl<F: Fn(f64) -> f64 + Sync> Radial for Function<F> {
    fn value(&self, r: f64) -> f64 {
        (self.0)(r)
    }
}

/// Values at all offsets; for cubes each distinct distance is evaluated once.
fn sample_radial(kernel: &dyn Radial, shape: [usize; 3], spacing: [f64; 3]) -> Vec<f64> {
    let used: Vec<f64> = (0..3).filter(|&a| shape[a] > 1).map(|a| spacing[a]).collect();
    if used.iter().all(|h| *h == used[0]) {
        return sample_cubes(kernel, shape, used.first().copied().unwrap_or(1.0));
    }
    let squares: [Vec<f64>; 3] =
        std::array::from_fn(|a| (0..shape[a]).map(|i| (i as f64 * spacing[a]).powi(2)).collect());
    let mut values = vec![0.0; shape.iter().product()];
    values.par_chunks_mut(shape[2]).enumerate().for_each(|(line, out)| {
        let here = squares[0][line / shape[1]] + squares[1][line % shape[1]];
        out.iter_mut().zip(&squares[2]).for_each(|(value, z)| *value = kernel.value((here + z).sqrt()));
    });
    values
}

/// Distances between the points of cubes are `h sqrt(i)`.
fn sample_cubes(kernel: &dyn Radial, shape: [usize; 3], spacing: f64) -> Vec<f64> {
    // Directions of equal length: the order of i, j and k does not matter.
    let flat = shape[1] == 1 && shape[0] == shape[2];
    let first = |i: usize, j: usize| match () {
        () if flat => i,
        () if shape[1] == shape[2] => j,
        () => 0,
    };
    let farthest: usize = shape.iter().map(|&n| (n - 1) * (n - 1)).sum();
    let mut occurs = vec![false; farthest + 1];
    for i in 0..shape[0] {
        for j in 0..shape[1] {
            let here = i * i + j * j;
            (first(i, j)..shape[2]).for_each(|k| occurs[here + k * k] = true);
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
        let own = out.iter_mut().enumerate().skip(if flat { i } else { 0 });
        own.for_each(|(k, value)| *value = table[i * i + j * j + k * k]);
    });
    if flat {
        mirror(&mut values, shape[2]);
    }
    values
}

/// Rows that are worked on together.
const ROWS: usize = 16;

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
