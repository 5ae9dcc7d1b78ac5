//! Transforms of lines that are even.
//!
//! The odd wave numbers 4k + 3 of an even line are the opposites of 4k + 1, and the even ones belong to a line of half the period, which
//! is even again (split radix): altogether half of the transform of the line.

use std::f64::consts::TAU;

use super::lanes::{Lanes, Work, add, sub, sub_turned, times};
use super::lines::{Lines, Machine};
use crate::plan::Real;

/// Periods from which on lines are divided.
const DIVIDED: usize = 48;

/// Transforms of even lines of one period, in packs.
#[derive(Debug)]
pub(crate) struct Even<T: Real> {
    levels: Vec<Level<T>>,
    /// The period that is not divided any more.
    rest: Lines<T>,
    /// Of wave numbers up to the Nyquist frequency.
    places: Vec<u32>,
    /// Places of all transforms, and of these and all folded lines.
    room: [usize; 2],
}

/// Odd wave numbers are divided from even ones.
#[derive(Debug)]
struct Level<T: Real> {
    /// `exp(-2 pi i j / period)` for a quarter of the period.
    factors: Vec<[T; 2]>,
    odd: Lines<T>,
}

/// A line of period 4q, of which there are 2q + 1 places, to what the transforms of its wave numbers 4k + 1 and 2k are taken of.
struct Divide<'a, T> {
    factors: &'a [[T; 2]],
    half: &'a [T],
    odd: &'a mut [T],
    even: &'a mut [T],
}

impl<T: Real> Work<T> for Divide<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let quarter = self.factors.len();
        let input = s.packs(self.half).as_chunks::<2>().0;
        let odd = &mut s.packs_mut(self.odd).as_chunks_mut::<2>().0[..quarter];
        let even = s.packs_mut(self.even).as_chunks_mut::<2>().0;
        // The same places from the other end.
        let (rising, falling) = (&input[..2 * quarter], &input[1..2 * quarter + 1]);
        let folded = &mut even[..quarter];
        for (j, w) in self.factors.iter().enumerate() {
            let (up, down) = (rising[j], falling[2 * quarter - 1 - j]);
            let (next, last) = (rising[j + quarter], falling[quarter - 1 - j]);
            folded[j] = add(s, up, down);
            odd[j] = times(s, sub_turned(s, sub(s, up, down), sub(s, next, last)), *w);
        }
        let middle = input[quarter];
        even[quarter] = add(s, middle, middle);
    }
}

/// Periods of the lines that a line is divided into, each half of the one before, and of the one that is not divided any more.
fn periods(mut period: usize) -> (Vec<usize>, usize) {
    let mut divided = Vec::new();
    while period >= DIVIDED && period.is_multiple_of(4) {
        divided.push(period);
        period /= 2;
    }
    (divided, period)
}

/// Places that are transformed for one line.
pub(crate) fn even_cost(period: usize) -> usize {
    let (divided, rest) = periods(period);
    divided.into_iter().map(|p| p / 4).sum::<usize>() + rest
}

impl<T: Real> Even<T> {
    pub(crate) fn new(period: usize) -> Self {
        let (divided, last) = periods(period);
        let factor = |j: usize, n: usize| {
            let (sin, cos) = (-TAU * j as f64 / n as f64).sin_cos();
            [T::rounded(cos), T::rounded(sin)]
        };
        let levels: Vec<Level<T>> = divided
            .iter()
            .map(|&n| Level { factors: (0..n / 4).map(|j| factor(j, n)).collect(), odd: Lines::new(n / 4) })
            .collect();
        let rest = Lines::new(last);
        let mut places = vec![0; period / 2 + 1];
        let (mut start, mut step) = (0, 1);
        for (level, &n) in levels.iter().zip(&divided) {
            for (place, wave) in level.odd.order().iter().enumerate() {
                let wave = 4 * wave + 1;
                places[step * wave.min(n - wave)] = (start + place) as u32;
            }
            start += n / 4;
            step *= 2;
        }
        for (k, [place, _]) in rest.opposite().iter().enumerate() {
            places[step * k] = start as u32 + place;
        }
        let transforms = start + last;
        let folded: usize = divided.iter().map(|n| n / 4 + 1).sum();
        Self { levels, rest, places, room: [transforms, transforms + folded] }
    }

    /// Places that a transform needs.
    pub(crate) fn room(&self) -> usize {
        self.room[1]
    }

    /// Places of the wave numbers up to the Nyquist frequency.
    pub(crate) fn places(&self) -> &[u32] {
        &self.places
    }

    /// Of the even continuation of packs of lines, of which `half` has the places up to half of the period.
    pub(crate) fn forward(&self, machine: &Machine, half: &[T], values: &mut [T]) {
        let width = 2 * machine.lanes();
        let (mut values, mut folded) = values[..self.room[1] * width].split_at_mut(self.room[0] * width);
        let mut half = half;
        for Level { factors, odd: lines } in &self.levels {
            let (odd, others) = values.split_at_mut(factors.len() * width);
            let (even, rest) = folded.split_at_mut((factors.len() + 1) * width);
            machine.run(Divide { factors, half, odd, even });
            lines.forward(machine, odd);
            (values, folded, half) = (others, rest, even);
        }
        values[..half.len()].copy_from_slice(half);
        let inner = half.chunks_exact(width).skip(1);
        let opposite = values.chunks_exact_mut(width).skip(half.len() / width).rev();
        opposite.zip(inner).for_each(|(to, from)| to.copy_from_slice(from));
        self.rest.forward(machine, values);
    }
}

#[cfg(test)]
mod tests {
    use super::{DIVIDED, Even, Lines, Machine, even_cost};

    #[test]
    fn the_continuation_is_transformed() {
        let machine = Machine::new::<f64>();
        let width = 2 * machine.lanes();
        let lengths =
            [1, 2, 4, 6, 7, 8, 10, 12, 14, 16, 20, 24, 30, 32, 48, 50, 52, 60, 64, 90, 96, 250, 256];
        for n in lengths.into_iter().chain([300, 360, 720, 2048, 2500, 2560]) {
            let (lines, even) = (Lines::<f64>::new(n), Even::<f64>::new(n));
            let half: Vec<f64> =
                (0..(n / 2 + 1) * width).map(|i| ((i * 7919 + 13) % 1013) as f64 / 506.5 - 1.0).collect();
            let mut expected: Vec<f64> =
                (0..n).flat_map(|j| half[j.min(n - j) * width..][..width].to_vec()).collect();
            lines.forward(&machine, &mut expected);
            let mut values = vec![f64::NAN; even.room() * width];
            even.forward(&machine, &half, &mut values);
            for (k, place) in even.places().iter().enumerate() {
                let ours = &values[*place as usize * width..][..width];
                let other = &expected[lines.opposite()[k][0] as usize * width..][..width];
                let error = ours.iter().zip(other).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(error < 1e-15 * n as f64, "{n} {k}: {error:e}");
            }
        }
    }

    #[test]
    fn half_of_a_period_is_transformed_where_it_can_be_divided() {
        assert_eq!(even_cost(DIVIDED / 2), DIVIDED / 2);
        assert_eq!(even_cost(2048), 1024 + 16);
        assert_eq!(even_cost(2500), 625 + 1250);
    }
}
