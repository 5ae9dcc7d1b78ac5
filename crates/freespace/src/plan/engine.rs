//! The padded convolution itself, always in three directions, some of which may have one point.
//!
//! The first direction is transformed from real to complex, half a spectrum per line, and stored as planes
//! of the other two. Each plane is padded, transformed, multiplied by Ĝ and transformed back on its own: the padded array
//! of all planes never exists, and lines of zeros are never transformed.

use rayon::prelude::*;

use super::aligned::{Aligned, pitch};
use super::axis::Axis;
use super::estimate::Estimate;
use super::first::{Factors, First};
use super::real::Real;
use super::recipe::{Last, Recipe};
use super::tile::Tile;
use crate::fft::Machine;

/// Planes that are worked on together where a plane is a single line.
const PLANES_OF_LINES: usize = 32;

/// Transforms and kernel.
#[derive(Debug)]
pub(super) struct Engine<T: Real> {
    pub(super) axes: [Axis<T>; 3],
    pub(super) machine: Machine,
    /// Ĝ over the number of points of all transforms, on the octant of wave numbers, the last direction fastest.
    pub(super) kernel: Vec<T>,
    /// The error of a Gaussian kernel, if it is one.
    pub(super) estimate: Option<Estimate<T>>,
}

/// The half-spectra of the first direction, reused from solve to solve.
#[derive(Debug, Default)]
pub(super) struct Spectra<T> {
    arrays: Vec<Aligned<T>>,
}

impl<T: Real> Engine<T> {
    /// Numbers of the half-spectra of one array.
    pub(super) fn spectrum(&self) -> usize {
        self.slab() * self.axes[2].n
    }

    /// Numbers of a row of the second direction.
    pub(super) fn row(&self) -> usize {
        if self.axes[1].len == 1 { 2 } else { 2 * pitch(self.axes[1].n, self.machine.lanes()) }
    }

    /// Planes that are worked on together.
    fn block(&self) -> usize {
        if self.axes[1].len == 1 { PLANES_OF_LINES } else { 1 }
    }

    /// Numbers of the half-spectra with one index of the third direction.
    pub(super) fn slab(&self) -> usize {
        self.axes[0].half().next_multiple_of(self.block()) * self.row()
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
        let (row, slab, block) = (self.row(), self.slab(), self.block());
        let arrays = &mut spectra.arrays;
        arrays.resize_with(sources.len().max(recipe.middle), Aligned::default);
        for array in arrays.iter_mut().filter(|a| a.len() != slab * nz) {
            *array = Aligned::zeros(slab * nz);
        }
        for (source, array) in sources.iter().zip(arrays.iter_mut()) {
            self.forward_first(source, array);
        }
        let mut planes: Vec<Vec<&mut [T]>> =
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
    fn forward_first(&self, source: &[T], spectra: &mut [T]) {
        let (slabs, lines) = self.together();
        spectra
            .par_chunks_mut(slabs * self.slab())
            .zip(source.par_chunks(lines * self.axes[0].n))
            .for_each_init(|| First::new(self), |first, (slabs, lines)| first.forward(lines, slabs));
    }

    /// Back to real lines, those of a derivative or not.
    fn inverse_first(&self, spectra: &[T], last: &Last, output: &mut [T]) {
        let (slabs, lines) = self.together();
        let factors = Factors::new(&self.axes[0], last);
        output
            .par_chunks_mut(lines * self.axes[0].n)
            .zip(spectra.par_chunks(slabs * self.slab()))
            .for_each_init(
                || First::new(self),
                |first, (lines, slabs)| first.inverse(slabs, &factors, lines),
            );
    }

    /// Slabs, and lines of the first direction, that a task works on.
    fn together(&self) -> (usize, usize) {
        if self.axes[1].len == 1 {
            let group = First::<T>::group(&self.machine);
            (group, group)
        } else {
            (1, self.axes[1].n)
        }
    }
}
