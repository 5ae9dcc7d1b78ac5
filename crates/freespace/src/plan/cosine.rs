//! Cosine transforms of lines that are even, several at once.

use super::aligned::Aligned;
use super::columns::Half;
use crate::fft::{Even, FromReals, MOST, Machine, ToReals};

/// Transforms of one length: `X_k = x_0 + (-1)^k x_n + 2 sum x_j cos(pi j k / n)`, n + 1 numbers each (DCT-I), which is the
/// discrete Fourier transform of the even continuation with period 2n. It is real, so that two packs of lines are the real and the
/// imaginary parts of one.
struct Cosine {
    even: Even<f64>,
    half: usize,
}

impl Cosine {
    fn new(half: usize) -> Self {
        Self { even: Even::new((2 * (half - 1)).max(1)), half }
    }
}

/// What is done with the lines of a direction: a transform, or a transform of which only the first numbers are wanted and the
/// transform of these, or nothing.
pub(super) struct Direction {
    cosines: Vec<Cosine>,
    machine: Machine,
    /// Numbers before and after.
    pub(super) from: usize,
    pub(super) to: usize,
    /// The places of numbers that nothing is done with.
    places: Vec<u32>,
}

/// Two packs of lines, and room to transform them in.
pub(super) struct Scratch {
    pub(super) packs: Aligned<f64>,
    values: Aligned<f64>,
    /// Lines that there are not: a line of zeros, and lines that are not wanted.
    zeros: Vec<f64>,
    unwanted: Vec<f64>,
}

impl Direction {
    /// Nothing is done with `half` numbers, or they are transformed once; or `wide` numbers are, and the first `half` of these again.
    pub(super) fn new(wide: usize, half: usize, times: usize) -> Self {
        let lengths: &[usize] = match times {
            0 => &[],
            1 => &[half],
            _ => &[wide, half],
        };
        let lengths = if wide > 1 { lengths } else { &[] };
        let cosines = lengths.iter().map(|&n| Cosine::new(n)).collect();
        let places = (0..half as u32).collect();
        Self { cosines, machine: Machine::new::<f64>(), from: wide, to: half, places }
    }

    /// Lines that are transformed together: numbers of a place of two packs.
    pub(super) fn width(&self) -> usize {
        2 * self.machine.lanes()
    }

    pub(super) fn scratch(&self) -> Scratch {
        let room = self.cosines.iter().map(|c| c.even.room()).max().unwrap_or(0);
        let most = self.from.max(self.to);
        Scratch {
            packs: Aligned::zeros(most * self.width()),
            values: Aligned::zeros(room * self.width()),
            zeros: vec![0.0; most],
            unwanted: vec![0.0; most * self.width()],
        }
    }

    /// Transforms the packs: for each number, those of all lines.
    pub(super) fn run<'s>(&'s self, scratch: &'s mut Scratch) -> impl Iterator<Item = &'s [f64]> {
        let width = self.width();
        let Scratch { packs, values, .. } = scratch;
        for (index, Cosine { even, half }) in self.cosines.iter().enumerate() {
            if index > 0 {
                ordered(values, self.cosines[index - 1].even.places(), &mut packs[..half * width], width);
            }
            even.forward(&self.machine, &packs[..half * width], values);
        }
        let (from, places) = match self.cosines.last() {
            Some(cosine) => (&values[..], cosine.even.places()),
            None => (&packs[..], &self.places[..]),
        };
        places.iter().map(move |place| &from[*place as usize * width..][..width])
    }

    /// Takes columns of a symmetric array of which half is known.
    pub(super) fn half(&self, values: &[f64], first: usize, scratch: &mut Scratch) {
        let Scratch { packs, zeros, .. } = scratch;
        let half = Half { values, n: self.from, machine: &self.machine, zeros };
        half.fill(first, self.width(), &mut packs[..self.from * self.width()]);
    }

    /// Takes up to as many lines as are transformed together, the same piece of each, to the places from `at` on.
    pub(super) fn take<'l>(&self, lines: impl Iterator<Item = &'l [f64]>, at: usize, scratch: &mut Scratch) {
        let (lanes, mut lines) = (self.machine.lanes(), lines.peekable());
        let count = lines.peek().map_or(0, |line| line.len());
        for first in 0..2 {
            let mut these = [&scratch.zeros[..count]; MOST];
            these[..lanes].iter_mut().zip(&mut lines).for_each(|(to, line)| *to = line);
            let (lines, values) = (&these[..lanes], &mut scratch.packs[at * 2 * lanes..]);
            self.machine.run(FromReals { lines, count, values, first, stride: 2 });
        }
    }

    /// Transforms the packs and gives up to as many lines.
    pub(super) fn give<'l>(&self, lines: impl Iterator<Item = &'l mut [f64]>, scratch: &'l mut Scratch) {
        let (lanes, count) = (self.machine.lanes(), self.to);
        self.run(scratch).for_each(drop);
        let Scratch { packs, values, unwanted, .. } = scratch;
        if let Some(cosine) = self.cosines.last() {
            ordered(values, cosine.even.places(), packs, self.width());
        }
        let mut lines = lines.chain(unwanted.chunks_exact_mut(count));
        for first in 0..2 {
            let mut these: [&mut [f64]; MOST] = std::array::from_fn(|_| &mut [][..]);
            these[..lanes].iter_mut().zip(&mut lines).for_each(|(to, line)| *to = line);
            let (lines, values) = (&mut these[..lanes], &packs[..]);
            self.machine.run(ToReals { lines, count, values, first, stride: 2 });
        }
    }
}

/// Numbers in the order of their places.
fn ordered(values: &[f64], places: &[u32], packs: &mut [f64], width: usize) {
    for (place, to) in places.iter().zip(packs.chunks_exact_mut(width)) {
        copy(&values[*place as usize * width..][..width], to);
    }
}

/// Places of one or two packs of four are one or two moves of vectors and no call.
pub(super) fn copy(from: &[f64], to: &mut [f64]) {
    if let (Ok(from), Ok(to)) = (<&[f64; 8]>::try_from(from), <&mut [f64; 8]>::try_from(&mut *to)) {
        *to = *from;
    } else if let (Ok(from), Ok(to)) = (<&[f64; 4]>::try_from(from), <&mut [f64; 4]>::try_from(&mut *to)) {
        *to = *from;
    } else {
        to.copy_from_slice(from);
    }
}
