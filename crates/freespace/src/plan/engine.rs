//! The padded convolution itself, always in three directions, some of which may have one point.
//!
//! The first direction is transformed from real to complex, half a spectrum per line, and stored as planes
//! of the other two. Each plane is padded, transformed, multiplied by Ĝ and transformed back on its own: the padded array
//! of all planes never exists, and lines of zeros are never transformed.

use rayon::prelude::*;

use super::aligned::Aligned;
use super::axis::Axis;
use super::estimate::Estimate;
use super::first::{Factors, First};
use super::packs::Packs;
use super::real::Real;
use super::recipe::Recipe;
use super::tile::Tile;
use crate::fft::Machine;

/// Packs of columns that are worked on together where planes are lines.
const PACKS: usize = 4;

/// Numbers between lines whose lengths are powers of two: places at the same distance would all fall on the same few lines of the cache.
const GAP: usize = 16;

/// Transforms and kernel.
#[derive(Debug)]
pub(super) struct Engine<T: Real> {
    pub(super) axes: [Axis<T>; 3],
    pub(super) machine: Machine,
    /// Columns in packs: of a plane, or of the first direction where planes are lines.
    pub(super) packs: Packs,
    /// Ĝ over the number of points of all transforms: for each plane, for each block of packs, the numbers of each lane, those of a wave
    /// number of the third direction together.
    pub(super) kernel: Vec<T>,
    /// The error of a Gaussian kernel, if it is one.
    pub(super) estimate: Option<Estimate<T>>,
}

/// The half-spectra of the first direction, reused from solve to solve.
#[derive(Debug, Default)]
pub(super) struct Spectra<T> {
    arrays: Vec<Aligned<T>>,
}

/// The packs of columns of transforms of these directions.
pub(super) fn packs<T: Real>([x, y, _]: &[Axis<T>; 3], lanes: usize) -> Packs {
    if y.len == 1 {
        // Lines of the first direction come in pairs.
        return Packs::of_half(x.half(), lanes).at(|k| 2 * k, 2 * x.half());
    }
    let opposite = y.lines.opposite();
    let place = |k: usize| if 2 * k <= y.len { opposite[k][0] } else { opposite[y.len - k][1] };
    Packs::of_all(y.len, lanes).at(|k| place(k) as usize, y.len)
}

impl<T: Real> Engine<T> {
    /// Whether there is no second direction, so that planes are lines.
    pub(super) fn is_flat(&self) -> bool {
        self.axes[1].len == 1
    }

    /// Ĝ for a pack of columns of a plane.
    pub(super) fn weights(&self, plane: usize, pack: usize) -> &[T] {
        let size = self.axes[2].half() * self.machine.lanes();
        let blocks = self.packs.blocks();
        &self.kernel[(plane * blocks + self.packs.block(pack)) * size..][..size]
    }

    /// Slabs that the half-spectra consist of: as many indices of the third direction as there are lanes, or twice as many where there
    /// is no second direction.
    pub(super) fn groups(&self) -> usize {
        self.axes[2].n.div_ceil(self.together())
    }

    /// Indices of the third direction in a slab.
    fn together(&self) -> usize {
        if self.is_flat() { 2 * self.machine.lanes() } else { self.machine.lanes() }
    }

    /// Numbers of a row of a slab: what belongs to a plane, or to a pack of columns where there is no second direction.
    pub(super) fn row(&self) -> usize {
        let lanes = self.machine.lanes();
        if self.is_flat() { 4 * lanes * lanes } else { 2 * lanes * self.axes[1].n.next_multiple_of(2) + GAP }
    }

    /// Numbers of a slab.
    fn slab(&self) -> usize {
        self.row() * if self.is_flat() { self.packs.len() } else { self.axes[0].half() }
    }

    /// Numbers of a pack of columns, from one to the next.
    pub(super) fn column(&self) -> usize {
        2 * self.machine.lanes() * self.groups() * self.together() + GAP
    }

    /// Numbers of the half-spectra of one array.
    pub(super) fn spectrum(&self) -> usize {
        self.slab() * self.groups()
    }

    /// Convolves the sources; the outputs are those of the recipe. Whether the sources are finite, unless their sums overflow: if not, there
    /// are no outputs.
    pub(super) fn run(
        &self,
        sources: &[&[T]],
        recipe: &Recipe<T>,
        spectra: &mut Spectra<T>,
        outputs: &mut [Vec<T>],
    ) -> bool {
        let (slab, arrays) = (self.slab(), &mut spectra.arrays);
        arrays.resize_with(sources.len().max(recipe.middle), Aligned::default);
        for array in arrays.iter_mut().filter(|a| a.len() != self.spectrum()) {
            *array = Aligned::zeros(self.spectrum());
        }
        for (source, array) in sources.iter().zip(arrays.iter_mut()) {
            if !self.forward_first(source, array) {
                return false;
            }
        }
        let (part, step) = if self.is_flat() { (PACKS * self.row(), PACKS) } else { (self.row(), 1) };
        let mut planes: Vec<Vec<&mut [T]>> = Vec::new();
        planes.resize_with(slab.div_ceil(part), || Vec::with_capacity(arrays.len() * self.groups()));
        for array in arrays.iter_mut() {
            for slab in array.chunks_exact_mut(slab) {
                planes.iter_mut().zip(slab.chunks_mut(part)).for_each(|(plane, part)| plane.push(part));
            }
        }
        planes.par_iter_mut().enumerate().for_each_init(
            || Tile::new(self, sources.len(), recipe),
            |tile, (index, parts)| tile.convolve(self, index * step, parts, recipe),
        );
        let points = self.axes.iter().map(|axis| axis.n).product();
        for (last, output) in recipe.last.iter().zip(outputs.iter_mut()) {
            output.resize(points, T::default());
            self.inverse_first(&arrays[last.middle], &Factors::new(&self.axes[0], recipe, last), output);
        }
        true
    }

    /// Points of the mesh that a slab has the lines of.
    fn lines(&self) -> usize {
        self.together() * self.axes[1].n * self.axes[0].n
    }

    /// From real lines to spectra: a slab has lines in packs for each wave number, the second direction fastest.
    fn forward_first(&self, source: &[T], spectra: &mut [T]) -> bool {
        spectra
            .par_chunks_mut(self.slab())
            .zip(source.par_chunks(self.lines()))
            .map_init(|| First::new(self), |first, (slab, lines)| first.forward(lines, slab))
            .reduce(|| true, |a, b| a && b)
    }

    /// Back to real lines, those of a derivative or not.
    fn inverse_first(&self, spectra: &[T], factors: &Factors<T>, output: &mut [T]) {
        output
            .par_chunks_mut(self.lines())
            .zip(spectra.par_chunks(self.slab()))
            .for_each_init(|| First::new(self), |first, (lines, slab)| first.inverse(slab, factors, lines));
    }
}
