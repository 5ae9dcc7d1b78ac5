//! Cosine transforms of arrays that are even in every direction.

use rayon::prelude::*;

use super::aligned::Aligned;
use crate::fft::{FromReals, Lines, MOST, Machine, ToReals};

/// Entries of a piece of a plane that one task works on.
const PIECE: usize = 32;

/// Transforms of one length: `X_k = x_0 + (-1)^k x_n + 2 sum x_j cos(pi j k / n)`, n + 1 numbers each (DCT-I), which is the
/// discrete Fourier transform of the even continuation with period 2n. It is real, so that two packs of lines are the real and the
/// imaginary parts of one.
struct Cosine {
    lines: Lines<f64>,
    machine: Machine,
    half: usize,
}

struct Scratch {
    /// The even continuation.
    values: Aligned<f64>,
    /// Lines before and after.
    packs: Aligned<f64>,
    /// A line of zeros, and lines that are not wanted.
    missing: Vec<f64>,
}

impl Cosine {
    fn new(half: usize) -> Self {
        Self { lines: Lines::new((2 * (half - 1)).max(1)), machine: Machine::new::<f64>(), half }
    }

    /// Numbers of a place of two packs.
    fn width(&self) -> usize {
        2 * self.machine.lanes()
    }

    fn scratch(&self) -> Scratch {
        let period = (2 * (self.half - 1)).max(1);
        Scratch {
            values: Aligned::zeros(period * self.width()),
            packs: Aligned::zeros(self.half * self.width()),
            missing: vec![0.0; self.half * (1 + self.machine.lanes())],
        }
    }

    /// The transform of what is in the packs, a place of all lines after the other.
    fn transform<'s>(&'s self, scratch: &'s mut Scratch) -> impl Iterator<Item = &'s [f64]> {
        self.lines.forward_even(&self.machine, &scratch.packs, &mut scratch.values);
        let (values, width) = (&scratch.values[..], self.width());
        (0..self.half).map(move |k| &values[self.lines.place_of_even(k) * width..][..width])
    }

    /// Transforms what is in the packs.
    fn in_place(&self, scratch: &mut Scratch) {
        let mut packs = std::mem::take(&mut scratch.packs);
        self.lines.forward_even(&self.machine, &packs, &mut scratch.values);
        let width = self.width();
        for (k, to) in packs.chunks_exact_mut(width).enumerate() {
            copy(&scratch.values[self.lines.place_of_even(k) * width..][..width], to);
        }
        scratch.packs = packs;
    }

    /// Transforms lines that lie one behind the other.
    fn rows(&self, lines: &mut [f64], scratch: &mut Scratch) {
        let (half, lanes) = (self.half, self.machine.lanes());
        for lines in lines.chunks_mut(half * self.width()) {
            for part in 0..2 {
                let mut these = [&scratch.missing[..half]; MOST];
                let present = lines.chunks_exact(half).skip(part * lanes);
                these[..lanes].iter_mut().zip(present).for_each(|(to, line)| *to = line);
                let (lines, values) = (&these[..lanes], &mut scratch.packs[..]);
                self.machine.run(FromReals { lines, count: half, values, first: part, stride: 2 });
            }
            self.in_place(scratch);
            for part in 0..2 {
                let mut these: [&mut [f64]; MOST] = std::array::from_fn(|_| &mut [][..]);
                let present = lines.chunks_exact_mut(half).skip(part * lanes).take(lanes);
                let all = present.chain(scratch.missing[half..].chunks_exact_mut(half));
                these[..lanes].iter_mut().zip(all).for_each(|(to, line)| *to = line);
                let (lines, values) = (&mut these[..lanes], &scratch.packs[..]);
                self.machine.run(ToReals { lines, count: half, values, first: part, stride: 2 });
            }
        }
    }

    /// Transforms the columns of `rows`, pieces of equal width that lie one below the other.
    fn columns(&self, rows: &mut [&mut [f64]], scratch: &mut Scratch) {
        let width = rows.first().map_or(0, |r| r.len());
        for first in (0..width).step_by(self.width()) {
            let count = self.width().min(width - first);
            for (row, to) in rows.iter().zip(scratch.packs.chunks_exact_mut(self.width())) {
                copy(&row[first..first + count], &mut to[..count]);
                to[count..].fill(0.0);
            }
            for (row, from) in rows.iter_mut().zip(self.transform(scratch)) {
                copy(&from[..count], &mut row[first..first + count]);
            }
        }
    }
}

/// Places of two packs of four are two moves of vectors and no call.
fn copy(from: &[f64], to: &mut [f64]) {
    match (<&[f64; 8]>::try_from(from), <&mut [f64; 8]>::try_from(&mut *to)) {
        (Ok(from), Ok(to)) => *to = *from,
        _ => to.copy_from_slice(from),
    }
}

/// Transforms an array of `shape`, the last direction running fastest, along the directions with `along`.
pub(super) fn transform(values: &mut [f64], shape: [usize; 3], along: [bool; 3]) {
    let [nx, ny, nz] = shape;
    let cosines = shape.map(Cosine::new);
    let along: [bool; 3] = std::array::from_fn(|a| along[a] && shape[a] > 1);
    let together = if ny > 1 { ny * nz } else { nz * cosines[2].width() };
    values.par_chunks_mut(together).for_each_init(
        || (cosines[1].scratch(), cosines[2].scratch()),
        |(for_y, for_z), plane| {
            if along[2] {
                cosines[2].rows(plane, for_z);
            }
            if along[1] {
                let mut rows: Vec<&mut [f64]> = plane.chunks_exact_mut(nz).collect();
                cosines[1].columns(&mut rows, for_y);
            }
        },
    );
    if !along[0] {
        return;
    }
    let mut pieces: Vec<Vec<&mut [f64]>> =
        (0..(ny * nz).div_ceil(PIECE)).map(|_| Vec::with_capacity(nx)).collect();
    for plane in values.chunks_exact_mut(ny * nz) {
        for (rows, piece) in pieces.iter_mut().zip(plane.chunks_mut(PIECE)) {
            rows.push(piece);
        }
    }
    pieces
        .par_iter_mut()
        .for_each_init(|| cosines[0].scratch(), |scratch, rows| cosines[0].columns(rows, scratch));
}

#[cfg(test)]
mod tests {
    use super::transform;

    #[test]
    fn twice_is_the_period_times_the_array() {
        let shape = [5, 4, 7];
        let before: Vec<f64> = (0..140).map(|i| f64::from(i * i % 23) - 7.0).collect();
        let mut values = before.clone();
        transform(&mut values, shape, [true; 3]);
        transform(&mut values, shape, [true; 3]);
        let period = 8.0 * 6.0 * 12.0;
        assert!(values.iter().zip(&before).all(|(v, b)| (v / period - b).abs() < 1e-12));
    }

    #[test]
    fn a_line_is_a_sum_of_cosines() {
        let line = [3.0, -1.0, 2.0, 5.0];
        let mut values = line;
        transform(&mut values, [1, 1, 4], [true; 3]);
        for (k, value) in values.iter().enumerate() {
            let cosine = |j: usize| (std::f64::consts::PI * (j * k) as f64 / 3.0).cos();
            let sum =
                line[0] * cosine(0) + line[3] * cosine(3) + 2.0 * (line[1] * cosine(1) + line[2] * cosine(2));
            assert!((value - sum).abs() < 1e-13);
        }
    }
}
