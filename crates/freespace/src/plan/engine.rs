//! The padded convolution itself, always in three directions, some of which may have one point.
//!
//! The first direction is transformed line by line from real to complex, half a spectrum per line, and stored as planes
//! of the other two. Each plane is padded, transformed, multiplied by Ĝ and transformed back on its own: the padded array
//! of all planes never exists, and lines of zeros are never transformed.

use rayon::prelude::*;
use realfft::ComplexToReal;
use rustfft::num_complex::Complex;

use super::axis::{Axis, RealTransforms};
use super::estimate::Estimate;
use super::real::Real;
use super::recipe::{Last, Recipe};
use super::tile::Tile;
use super::transpose::{Aligned, GROUP, gather, pitch, scatter};

/// Planes that are worked on together where a plane is a single line.
const PLANES_OF_LINES: usize = 32;

/// Transforms and kernel.
#[derive(Debug)]
pub(super) struct Engine<T: Real> {
    pub(super) axes: [Axis<T>; 3],
    pub(super) real: RealTransforms<T>,
    /// Ĝ over the number of points of all transforms, on the octant of wave numbers, the last direction fastest.
    pub(super) kernel: Vec<T>,
    /// The error of a Gaussian kernel, if it is one.
    pub(super) estimate: Option<Estimate<T>>,
}

/// The half-spectra of the first direction, reused from solve to solve.
#[derive(Debug, Default)]
pub(super) struct Spectra<T> {
    arrays: Vec<Aligned<Complex<T>>>,
}

impl<T: Real> Engine<T> {
    /// Numbers of the half-spectra of one array.
    pub(super) fn spectrum(&self) -> usize {
        self.axes[0].half() * pitch(self.axes[1].n) * self.axes[2].n
    }

    /// Convolves the sources; the outputs are those of the recipe.
    pub(super) fn run(
        &self,
        sources: &[&[T]],
        recipe: &Recipe<T>,
        spectra: &mut Spectra<T>,
        outputs: &mut [Vec<T>],
    ) {
        let [nx, ny, nz] = [self.axes[0].n, self.axes[1].n, self.axes[2].n];
        let row = pitch(ny);
        let slab = self.axes[0].half() * row;
        let arrays = &mut spectra.arrays;
        arrays.resize_with(sources.len().max(recipe.middle), Aligned::default);
        for array in arrays.iter_mut().filter(|a| a.len() != slab * nz) {
            *array = Aligned::zeros(slab * nz);
        }
        for (source, array) in sources.iter().zip(arrays.iter_mut()) {
            self.forward_first(source, array);
        }
        let block = if self.axes[1].len == 1 { PLANES_OF_LINES } else { 1 };
        let mut planes: Vec<Vec<&mut [Complex<T>]>> =
            (0..self.axes[0].half().div_ceil(block)).map(|_| Vec::with_capacity(arrays.len() * nz)).collect();
        for array in arrays.iter_mut() {
            for slab in array.chunks_exact_mut(slab) {
                for (plane, part) in planes.iter_mut().zip(slab.chunks_mut(block * row)) {
                    plane.push(part);
                }
            }
        }
        planes.par_iter_mut().enumerate().for_each_init(
            || Tile::new(self, sources.len(), recipe),
            |tile, (index, parts)| tile.convolve(self, index * block, parts, recipe),
        );
        for (last, output) in recipe.last.iter().zip(outputs.iter_mut()) {
            output.resize(nx * ny * nz, T::default());
            self.inverse_first(&arrays[last.middle], last, output);
        }
    }

    /// From real lines to spectra, stored with the second direction fastest, then the first, then the third.
    fn forward_first(&self, source: &[T], spectra: &mut [Complex<T>]) {
        let (x, y) = (&self.axes[0], &self.axes[1]);
        let (half, stride, row) = (x.half(), pitch(x.half()), pitch(y.n));
        let plan = &self.real.forward;
        spectra.par_chunks_mut(half * row).zip(source.par_chunks(x.n * y.n)).for_each_init(
            || (plan.make_input_vec(), Aligned::zeros(GROUP * stride), plan.make_scratch_vec()),
            |(padded, lines, scratch), (slab, values)| {
                let mut there = |values: &[T], line: &mut [Complex<T>]| {
                    x.load(values, padded);
                    let outcome = plan.process_with_scratch(padded, line, scratch);
                    debug_assert!(outcome.is_ok(), "the buffers were made for this length");
                };
                if y.n == 1 {
                    return there(values, slab);
                }
                for (group, values) in values.chunks(GROUP * x.n).enumerate() {
                    for (values, line) in values.chunks_exact(x.n).zip(lines.chunks_exact_mut(stride)) {
                        there(values, &mut line[..half]);
                    }
                    scatter(lines, stride, slab.chunks_exact_mut(row), group * GROUP);
                }
            },
        );
    }

    /// Back to real lines, those of a derivative or not.
    fn inverse_first(&self, spectra: &[Complex<T>], last: &Last, output: &mut [T]) {
        let (x, y) = (&self.axes[0], &self.axes[1]);
        let (half, stride, row) = (x.half(), pitch(x.half()), pitch(y.n));
        let plan = &self.real.inverse;
        let factors = self.factors(last);
        output.par_chunks_mut(x.n * y.n).zip(spectra.par_chunks(half * row)).for_each_init(
            || (plan.make_output_vec(), Aligned::zeros(GROUP * stride), plan.make_scratch_vec()),
            |(padded, lines, scratch), (values, slab)| {
                let mut back = |line: &mut [Complex<T>], values: &mut [T]| {
                    if let Some(factors) = &factors {
                        line.iter_mut().zip(factors).for_each(|(value, factor)| *value = *value * factor);
                    }
                    inverse(x, plan.as_ref(), line, padded, scratch, values);
                };
                if y.n == 1 {
                    lines[..half].copy_from_slice(slab);
                    return back(&mut lines[..half], values);
                }
                for (group, values) in values.chunks_mut(GROUP * x.n).enumerate() {
                    gather(slab.chunks_exact(row), group * GROUP, lines, stride);
                    for (values, line) in values.chunks_exact_mut(x.n).zip(lines.chunks_exact_mut(stride)) {
                        back(&mut line[..half], values);
                    }
                }
            },
        );
    }

    /// What a line of an output is multiplied by; nothing if by one.
    fn factors(&self, last: &Last) -> Option<Vec<Complex<T>>> {
        let (x, sign) = (&self.axes[0], T::rounded(last.sign));
        if last.along {
            return Some(x.wave.iter().take(x.half()).map(|k| Complex::new(T::zero(), *k * sign)).collect());
        }
        (last.sign != 1.0).then(|| vec![Complex::new(sign, T::zero()); x.half()])
    }
}

/// A line of a spectrum back to real values.
fn inverse<T: Real>(
    x: &Axis<T>,
    plan: &dyn ComplexToReal<T>,
    line: &mut [Complex<T>],
    padded: &mut [T],
    scratch: &mut [Complex<T>],
    row: &mut [T],
) {
    // Round-off only: the spectrum of a real line is real at both ends.
    line[0].im = T::zero();
    if x.len.is_multiple_of(2) {
        line[x.half() - 1].im = T::zero();
    }
    let outcome = plan.process_with_scratch(line, padded, scratch);
    debug_assert!(outcome.is_ok(), "the buffers were made for this length");
    x.store(padded, row);
}
