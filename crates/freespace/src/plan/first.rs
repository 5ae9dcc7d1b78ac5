//! The first direction, between real lines and half-spectra.

use super::aligned::Aligned;
use super::axis::Axis;
use super::engine::Engine;
use super::real::Real;
use super::recipe::{Last, Recipe};
use crate::fft::{FromColumns, FromReals, MOST, Spectrum, Tangle, ToColumns, ToReals, Untangle};

/// Scratch of one thread. Two packs of lines are the real and the imaginary parts of one.
pub(super) struct First<'a, T: Real> {
    engine: &'a Engine<T>,
    /// Lines in packs.
    reals: Aligned<T>,
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
        Self {
            engine,
            reals: Aligned::zeros(x.n * width),
            values: Aligned::zeros(x.len * width),
            rows: Aligned::zeros(if engine.is_flat() { 2 * (x.half() + 1) * width } else { 0 }),
            missing: Aligned::zeros(x.n * lanes),
        }
    }

    /// Twice the spectra of the lines of a slab. Whether sums of lines are finite.
    pub(super) fn forward(&mut self, lines: &[T], slab: &mut [T]) -> bool {
        let engine = self.engine;
        let (lanes, row) = (engine.machine.lanes(), engine.row());
        if !engine.is_flat() {
            let pairs = 0..engine.axes[1].n.div_ceil(2);
            return pairs.fold(true, |finite, pair| {
                let spectrum = Spectrum { rows: slab, row, at: pair * 4 * lanes };
                self.pair_forward(lines, pair, spectrum) && finite
            });
        }
        let mut rows = std::mem::take(&mut self.rows);
        let finite = self.pair_forward(lines, 0, Spectrum { rows: &mut rows, row: 4 * lanes, at: 0 });
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
            for pair in 0..engine.axes[1].n.div_ceil(2) {
                self.pair_inverse(slab, [row, 4 * pair * lanes], factors, lines, pair);
            }
            return;
        }
        let mut rows = std::mem::take(&mut self.rows);
        for part in 0..2 {
            let (values, places) = (&mut rows[2 * part * lanes..], engine.packs.places());
            let at = 2 * part * lanes * lanes;
            engine.machine.run(FromColumns { columns: slab, places, pitch: row, at, values });
        }
        self.pair_inverse(&rows, [4 * lanes, 0], factors, lines, 0);
        self.rows = rows;
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
    fn pair_forward(&mut self, lines: &[T], pair: usize, spectrum: Spectrum<'_, T>) -> bool {
        let (machine, x) = (&self.engine.machine, &self.engine.axes[0]);
        let lanes = machine.lanes();
        for part in 0..2 {
            let mut these = [&self.missing[..x.n]; MOST];
            these[..lanes].iter_mut().zip(self.lines(lines, pair, part)).for_each(|(to, line)| *to = line);
            let (lines, values) = (&these[..lanes], &mut self.reals[..]);
            machine.run(FromReals { lines, count: x.own(), values, first: part, stride: 2 });
        }
        x.forward(machine, &self.reals, &mut self.values);
        machine.run(Untangle { values: &self.values, places: x.lines.opposite(), spectrum });
        self.values[..2 * lanes].iter().all(|sum| sum.widened().is_finite())
    }

    fn pair_inverse(
        &mut self,
        rows: &[T],
        [row, at]: [usize; 2],
        factors: &Factors<T>,
        lines: &mut [T],
        pair: usize,
    ) {
        let (machine, x) = (&self.engine.machine, &self.engine.axes[0]);
        let lanes = machine.lanes();
        let (values, places) = (&mut self.values[..], x.lines.opposite());
        machine.run(Tangle { values, places, rows, row, at, factors: factors.0.as_deref() });
        x.inverse(machine, values, &mut self.reals);
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
