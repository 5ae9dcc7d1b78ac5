//! The first direction, between real lines and half-spectra.

use super::aligned::Aligned;
use super::axis::Axis;
use super::engine::Engine;
use super::real::Real;
use super::recipe::Last;
use crate::fft::{FromReals, MOST, Machine, Spectrum, Tangle, ToReals, Untangle};

/// Scratch of one thread. Lines are transformed in groups, twice as many as there are lanes.
pub(super) struct First<'a, T: Real> {
    machine: &'a Machine,
    x: &'a Axis<T>,
    /// Numbers between the wave numbers of a slab; none where each line is a slab.
    row: Option<usize>,
    slab: usize,
    values: Aligned<T>,
    /// The spectrum of a group where each line is a slab.
    rows: Aligned<T>,
    /// Zeros on the way there, the lines of a group that is not full on the way back.
    spare: Aligned<T>,
}

/// What spectra are multiplied by on the way back.
pub(super) struct Factors<T> {
    /// A factor of each wave number; one if none.
    real: Option<Vec<T>>,
    /// Whether it is times i.
    turned: bool,
}

impl<T: Real> Factors<T> {
    pub(super) fn new(x: &Axis<T>, last: &Last) -> Self {
        let sign = T::rounded(last.sign);
        let real = match (last.along, last.sign) {
            (true, _) => Some(x.wave.iter().take(x.half()).map(|k| *k * sign).collect()),
            (false, 1.0) => None,
            (false, _) => Some(vec![sign; x.half()]),
        };
        Self { real, turned: last.along }
    }
}

impl<'a, T: Real> First<'a, T> {
    pub(super) fn new(engine: &'a Engine<T>) -> Self {
        let (machine, x) = (&engine.machine, &engine.axes[0]);
        let group = Self::group(machine);
        let flat = engine.axes[1].len == 1;
        Self {
            machine,
            x,
            row: (!flat).then(|| engine.row()),
            slab: engine.slab(),
            values: Aligned::zeros(x.len * group),
            rows: Aligned::zeros(if flat { x.half() * 2 * group } else { 0 }),
            spare: Aligned::zeros(x.n * group),
        }
    }

    /// Lines of a group.
    pub(super) fn group(machine: &Machine) -> usize {
        2 * machine.lanes()
    }

    /// Twice the spectra of lines, to the slabs that they belong to.
    pub(super) fn forward(&mut self, lines: &[T], slabs: &mut [T]) {
        let group = Self::group(self.machine);
        if let Some(row) = self.row {
            for (index, lines) in lines.chunks(group * self.x.n).enumerate() {
                self.group_forward(lines, Spectrum { rows: slabs, row, at: index * group });
            }
            return;
        }
        let mut rows = std::mem::take(&mut self.rows);
        self.group_forward(lines, Spectrum { rows: &mut rows, row: 2 * group, at: 0 });
        for (column, slab) in slabs.chunks_exact_mut(self.slab).enumerate() {
            for (to, from) in slab.as_chunks_mut::<2>().0.iter_mut().zip(rows.chunks_exact(2 * group)) {
                *to = [from[2 * column], from[2 * column + 1]];
            }
        }
        self.rows = rows;
    }

    /// Lines from their slabs.
    pub(super) fn inverse(&mut self, slabs: &[T], factors: &Factors<T>, lines: &mut [T]) {
        let group = Self::group(self.machine);
        if let Some(row) = self.row {
            for (index, lines) in lines.chunks_mut(group * self.x.n).enumerate() {
                self.group_inverse(slabs, row, index * group, factors, lines);
            }
            return;
        }
        let mut rows = std::mem::take(&mut self.rows);
        rows.fill(T::zero());
        for (column, slab) in slabs.chunks_exact(self.slab).enumerate() {
            for (from, to) in slab.as_chunks::<2>().0.iter().zip(rows.chunks_exact_mut(2 * group)) {
                [to[2 * column], to[2 * column + 1]] = *from;
            }
        }
        self.group_inverse(&rows, 2 * group, 0, factors, lines);
        self.rows = rows;
    }

    /// What is missing in a group is zero: lines share transforms, in which the larger one leaves its round-off in the other.
    fn group_forward(&mut self, lines: &[T], spectrum: Spectrum<'_, T>) {
        let Self { machine, x, values, spare, .. } = self;
        let lanes = machine.lanes();
        for part in 0..2 {
            let mut these = [&spare[..x.n]; MOST];
            for (to, column) in these.iter_mut().zip(machine.columns()) {
                if let Some(line) = lines.chunks_exact(x.n).nth(part * lanes + column) {
                    *to = line;
                }
            }
            let lines = &these[..lanes];
            machine.run(FromReals { lines, count: x.own(), values, first: part, stride: 2 });
        }
        let width = 2 * lanes;
        values[x.own() * width..x.filled() * width].fill(T::zero());
        x.continue_packs(values, width);
        x.lines.forward(machine, values, x.halved);
        machine.run(Untangle { values, places: x.lines.opposite(), spectrum });
    }

    fn group_inverse(&mut self, rows: &[T], row: usize, at: usize, factors: &Factors<T>, lines: &mut [T]) {
        let (places, turned) = (self.x.lines.opposite(), factors.turned);
        let (machine, values) = (self.machine, &mut self.values[..]);
        machine.run(Tangle { values, places, rows, row, at, factors: factors.real.as_deref(), turned });
        self.x.lines.inverse(machine, values, self.x.halved);
        if lines.len() == self.spare.len() {
            return self.store(lines);
        }
        let mut spare = std::mem::take(&mut self.spare);
        self.store(&mut spare);
        lines.copy_from_slice(&spare[..lines.len()]);
        self.spare = spare;
    }

    /// A whole group of lines from packs; beyond a period they begin again.
    fn store(&self, lines: &mut [T]) {
        let (n, lanes) = (self.x.n, self.machine.lanes());
        let count = n.min(self.x.len);
        for (part, lines) in lines.chunks_exact_mut(lanes * n).enumerate() {
            let mut these: [&mut [T]; MOST] = std::array::from_fn(|_| &mut [][..]);
            for (column, line) in lines.chunks_exact_mut(n).enumerate() {
                if let Some(lane) = self.machine.columns().iter().position(|c| *c == column) {
                    these[lane] = line;
                }
            }
            let lines = &mut these[..lanes];
            self.machine.run(ToReals { lines, count, values: &self.values, first: part, stride: 2 });
            for line in lines {
                line.copy_within(..n - count, count);
            }
        }
    }
}
