//! The first direction, between real lines and half-spectra.

use std::ops::Range;

use super::aligned::Aligned;
use super::axis::Axis;
use super::engine::Engine;
use super::real::Real;
use super::recipe::{Last, Recipe};
use crate::fft::{FromColumns, FromReals, MOST, Spectrum, Tangle, ToColumns, ToReals, Untangle};

/// Pairs of packs that are transformed before their spectra are put where they belong, in one go: there as many numbers follow each other, and
/// each wave number is in another page of memory.
const PAIRS: usize = 4;

/// Numbers between transforms: the same place of all would fall on the same lines of the cache.
const GAP: usize = 16;

/// Scratch of one thread. Two packs of lines are the real and the imaginary parts of one.
pub(super) struct First<'a, T: Real> {
    engine: &'a Engine<T>,
    /// Lines in packs.
    reals: Aligned<T>,
    /// Their transforms.
    values: Aligned<T>,
    /// The spectrum of two packs, where the second direction is no direction.
    rows: Aligned<T>,
    /// Lines that there are not, zeros on the way there.
    missing: Aligned<T>,
}

/// What spectra are multiplied by on the way back, for each wave number; one if none.
pub(super) struct Factors<T>(Option<Vec<[T; 2]>>);

impl<T: Real> Factors<T> {
    pub(super) fn new(x: &Axis<T>, recipe: &Recipe<T>, last: &Last) -> Self {
        let phases = recipe.phases(0, last.shift);
        if !last.along && last.sign == 1.0 && phases.is_none() {
            return Self(None);
        }
        let sign = T::rounded(last.sign);
        let of = |k: usize| {
            let [re, im] = phases.map_or([T::one(), T::zero()], |phases| phases[k]);
            if last.along {
                let wave = sign * x.wave[k];
                [T::zero() - wave * im, wave * re]
            } else {
                [sign * re, sign * im]
            }
        };
        Self(Some((0..x.half()).map(of).collect()))
    }
}

impl<'a, T: Real> First<'a, T> {
    pub(super) fn new(engine: &'a Engine<T>) -> Self {
        let (x, lanes) = (&engine.axes[0], engine.machine.lanes());
        let width = 2 * lanes;
        let pairs = if engine.is_flat() { 1 } else { PAIRS.min(engine.axes[1].n.div_ceil(2)) };
        Self {
            engine,
            reals: Aligned::zeros(x.n * width),
            values: Aligned::zeros((x.len * width + GAP) * pairs),
            rows: Aligned::zeros(if engine.is_flat() { 2 * (x.half() + 1) * width } else { 0 }),
            missing: Aligned::zeros(x.n * lanes),
        }
    }

    /// Twice the spectra of the lines of a slab. Whether sums of lines are finite.
    pub(super) fn forward(&mut self, lines: &[T], slab: &mut [T]) -> bool {
        let engine = self.engine;
        let (lanes, row) = (engine.machine.lanes(), engine.row());
        if !engine.is_flat() {
            return self.pairs().fold(true, |finite, pairs| {
                let at = pairs.start * 4 * lanes;
                self.pairs_forward(lines, pairs, Spectrum { rows: &mut *slab, row, at }) && finite
            });
        }
        let mut rows = std::mem::take(&mut self.rows);
        let spectrum = Spectrum { rows: &mut rows[..], row: 4 * lanes, at: 0 };
        let finite = self.pairs_forward(lines, 0..1, spectrum);
        for part in 0..2 {
            let (values, places) = (&rows[2 * part * lanes..], engine.packs.places());
            let at = 2 * part * lanes * lanes;
            engine.machine.run(ToColumns { values, places, columns: slab, pitch: row, at });
        }
        self.rows = rows;
        finite
    }

    /// The lines of a slab.
    pub(super) fn inverse(&mut self, slab: &[T], factors: &Factors<T>, lines: &mut [T]) {
        let engine = self.engine;
        let (lanes, row) = (engine.machine.lanes(), engine.row());
        if !engine.is_flat() {
            for pairs in self.pairs() {
                let spectrum = Spectrum { rows: slab, row, at: pairs.start * 4 * lanes };
                self.pairs_inverse(spectrum, factors, lines, pairs);
            }
            return;
        }
        let mut rows = std::mem::take(&mut self.rows);
        for part in 0..2 {
            let (values, places) = (&mut rows[2 * part * lanes..], engine.packs.places());
            let at = 2 * part * lanes * lanes;
            engine.machine.run(FromColumns { columns: slab, places, pitch: row, at, values });
        }
        self.pairs_inverse(Spectrum { rows: &rows[..], row: 4 * lanes, at: 0 }, factors, lines, 0..1);
        self.rows = rows;
    }

    /// The pairs of packs of a slab, those together that are put in their places together.
    fn pairs(&self) -> impl Iterator<Item = Range<usize>> + use<T> {
        let count = self.engine.axes[1].n.div_ceil(2);
        (0..count).step_by(PAIRS).map(move |start| start..(start + PAIRS).min(count))
    }

    /// Numbers of a transform, from one to the next.
    fn pitch(&self) -> usize {
        2 * self.engine.machine.lanes() * self.engine.axes[0].len + GAP
    }

    /// The lines of one of the packs that are transformed together.
    fn lines<'l>(&self, lines: &'l [T], pair: usize, part: usize) -> impl Iterator<Item = &'l [T]> {
        let (n, [stride, line]) = (self.engine.axes[0].n, self.places(pair, part));
        let skip = if self.engine.is_flat() { line } else { 0 };
        let within = if self.engine.is_flat() { 0 } else { line };
        lines.chunks(stride * n).skip(skip).filter_map(move |lines| lines.chunks_exact(n).nth(within))
    }

    /// How far lines of a pack are apart, and the first of them.
    fn places(&self, pair: usize, part: usize) -> [usize; 2] {
        if self.engine.is_flat() {
            [1, part * self.engine.machine.lanes()]
        } else {
            [self.engine.axes[1].n, 2 * pair + part]
        }
    }

    /// What is missing in a pack is zero: lines share transforms, in which the larger one leaves its round-off in the other.
    fn pairs_forward(&mut self, lines: &[T], pairs: Range<usize>, spectrum: Spectrum<&mut [T]>) -> bool {
        let (machine, x, pitch) = (&self.engine.machine, &self.engine.axes[0], self.pitch());
        let (lanes, count, last) = (machine.lanes(), pairs.len(), pairs.end - 1);
        let mut all = std::mem::take(&mut self.values);
        for (pair, values) in pairs.zip(all.chunks_exact_mut(pitch)) {
            for part in 0..2 {
                let mut these = [&self.missing[..x.n]; MOST];
                let present = self.lines(lines, pair, part);
                these[..lanes].iter_mut().zip(present).for_each(|(to, line)| *to = line);
                let (lines, values) = (&these[..lanes], &mut self.reals[..]);
                machine.run(FromReals { lines, count: x.own(), values, first: part, stride: 2 });
            }
            x.forward(machine, &self.reals, &mut values[..pitch - GAP]);
        }
        let (values, places) = (&all[..count * pitch], x.lines.opposite());
        let Spectrum { rows, row, at } = spectrum;
        machine.run(Untangle { values, pitch, places, spectrum: Spectrum { rows: &mut *rows, row, at } });
        self.clear_missing(lines, last, Spectrum { rows, row, at: at + 4 * lanes * (count - 1) });
        let mut sums = values.chunks_exact(pitch).flat_map(|values| &values[..2 * lanes]);
        let finite = sums.all(|sum| sum.widened().is_finite());
        self.values = all;
        finite
    }

    /// Zeros in the spectra of lines that there are not beside some that there are, which have left their round-off there: that of the source
    /// would come back in the field, which is smaller by the square of the spacing.
    fn clear_missing(&self, lines: &[T], pair: usize, spectrum: Spectrum<&mut [T]>) {
        let lanes = self.engine.machine.lanes();
        let [even, odd] = [0, 1].map(|part| self.lines(lines, pair, part).take(lanes).count());
        if odd < even {
            let Spectrum { rows, row, at } = spectrum;
            for row in rows.chunks_exact_mut(row) {
                let pack = &mut row[at + 2 * lanes..][..2 * lanes];
                pack.chunks_exact_mut(lanes).for_each(|part| part[odd..].fill(T::zero()));
            }
        }
    }

    fn pairs_inverse(
        &mut self,
        spectrum: Spectrum<&[T]>,
        factors: &Factors<T>,
        lines: &mut [T],
        pairs: Range<usize>,
    ) {
        let (machine, x, pitch) = (&self.engine.machine, &self.engine.axes[0], self.pitch());
        let places = x.lines.opposite();
        let mut all = std::mem::take(&mut self.values);
        let values = &mut all[..pairs.len() * pitch];
        machine.run(Tangle { values, pitch, places, spectrum, factors: factors.0.as_deref() });
        for (pair, values) in pairs.zip(values.chunks_exact_mut(pitch)) {
            x.inverse(machine, &mut values[..pitch - GAP], &mut self.reals);
            self.reals_to_lines(lines, pair);
        }
        self.values = all;
    }

    /// The real lines of a pair of packs to where they belong.
    fn reals_to_lines(&mut self, lines: &mut [T], pair: usize) {
        let (machine, x) = (&self.engine.machine, &self.engine.axes[0]);
        let lanes = machine.lanes();
        for part in 0..2 {
            let [stride, line] = self.places(pair, part);
            let (skip, within) = if self.engine.is_flat() { (line, 0) } else { (0, line) };
            let present = lines.chunks_mut(stride * x.n).skip(skip);
            let present = present.filter_map(|lines| lines.chunks_exact_mut(x.n).nth(within));
            let mut these: [&mut [T]; MOST] = std::array::from_fn(|_| &mut [][..]);
            let all = present.take(lanes).chain(self.missing.chunks_exact_mut(x.n));
            these[..lanes].iter_mut().zip(all).for_each(|(to, line)| *to = line);
            let (lines, values) = (&mut these[..lanes], &self.reals[..]);
            machine.run(ToReals { lines, count: x.n, values, first: part, stride: 2 });
        }
    }
}
