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
use super::output::Wanted;
use super::real::Real;
use super::tile::{Shape, Tile};

/// Lines that are transformed before they are stored across.
const LINES: usize = 8;

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
    arrays: Vec<Vec<Complex<T>>>,
}

impl<T: Real> Engine<T> {
    /// Convolves the sources; one output for each that is wanted.
    pub(super) fn run(
        &self,
        sources: &[&[T]],
        wanted: &[Wanted<T>],
        spectra: &mut Spectra<T>,
        outputs: &mut [Vec<T>],
    ) {
        let [nx, ny, nz] = [self.axes[0].n, self.axes[1].n, self.axes[2].n];
        let slab = self.axes[0].half() * ny;
        let arrays = &mut spectra.arrays;
        arrays.resize_with(sources.len().max(wanted.len()), Vec::new);
        arrays.iter_mut().for_each(|a| a.resize(slab * nz, Complex::default()));
        for (source, array) in sources.iter().zip(arrays.iter_mut()) {
            self.forward_first(source, array);
        }
        let block = if ny == 1 { PLANES_OF_LINES } else { 1 };
        let mut planes: Vec<Vec<&mut [Complex<T>]>> =
            (0..self.axes[0].half().div_ceil(block)).map(|_| Vec::with_capacity(arrays.len() * nz)).collect();
        for array in arrays.iter_mut() {
            for slab in array.chunks_exact_mut(slab) {
                for (plane, part) in planes.iter_mut().zip(slab.chunks_mut(block * ny)) {
                    plane.push(part);
                }
            }
        }
        let shape = Shape { block, sources: sources.len(), outputs: wanted.len() };
        planes.par_iter_mut().enumerate().for_each_init(
            || Tile::new(self, shape),
            |tile, (index, parts)| tile.convolve(self, index * block, parts, wanted),
        );
        for (array, output) in arrays.iter().zip(outputs.iter_mut()) {
            output.resize(nx * ny * nz, T::default());
            self.inverse_first(array, output);
        }
    }

    /// From real lines to spectra, stored with the second direction fastest, then the first, then the third.
    fn forward_first(&self, source: &[T], spectra: &mut [Complex<T>]) {
        let (x, y) = (&self.axes[0], &self.axes[1]);
        let half = x.half();
        let plan = &self.real.forward;
        spectra.par_chunks_mut(half * y.n).zip(source.par_chunks(x.n * y.n)).for_each_init(
            || (plan.make_input_vec(), vec![Complex::default(); LINES * half], plan.make_scratch_vec()),
            |(padded, lines, scratch), (slab, values)| {
                if y.n == 1 {
                    x.load(values, padded);
                    let outcome = plan.process_with_scratch(padded, slab, scratch);
                    debug_assert!(outcome.is_ok(), "the buffers were made for this length");
                    return;
                }
                for (group, rows) in values.chunks(LINES * x.n).enumerate() {
                    let count = rows.len() / x.n;
                    for (row, line) in rows.chunks_exact(x.n).zip(lines.chunks_exact_mut(half)) {
                        x.load(row, padded);
                        let outcome = plan.process_with_scratch(padded, line, scratch);
                        debug_assert!(outcome.is_ok(), "the buffers were made for this length");
                    }
                    for (k, across) in slab.chunks_exact_mut(y.n).enumerate() {
                        let stored = &mut across[group * LINES..group * LINES + count];
                        for (j, value) in stored.iter_mut().enumerate() {
                            *value = lines[j * half + k];
                        }
                    }
                }
            },
        );
    }

    /// Back to real lines.
    fn inverse_first(&self, spectra: &[Complex<T>], output: &mut [T]) {
        let (x, y) = (&self.axes[0], &self.axes[1]);
        let half = x.half();
        let plan = &self.real.inverse;
        output.par_chunks_mut(x.n * y.n).zip(spectra.par_chunks(half * y.n)).for_each_init(
            || (plan.make_output_vec(), vec![Complex::default(); LINES * half], plan.make_scratch_vec()),
            |(padded, lines, scratch), (values, slab)| {
                if y.n == 1 {
                    lines[..half].copy_from_slice(slab);
                    back(x, plan.as_ref(), &mut lines[..half], padded, scratch, values);
                    return;
                }
                for (group, rows) in values.chunks_mut(LINES * x.n).enumerate() {
                    let count = rows.len() / x.n;
                    for (k, across) in slab.chunks_exact(y.n).enumerate() {
                        let stored = &across[group * LINES..group * LINES + count];
                        for (j, value) in stored.iter().enumerate() {
                            lines[j * half + k] = *value;
                        }
                    }
                    for (row, line) in rows.chunks_exact_mut(x.n).zip(lines.chunks_exact_mut(half)) {
                        back(x, plan.as_ref(), line, padded, scratch, row);
                    }
                }
            },
        );
    }
}

/// A line of a spectrum back to real values.
fn back<T: Real>(
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
