//! One direction of the transforms.

use std::f64::consts::TAU;

use super::boundary::Continuation;
use super::real::Real;
use crate::fft::{Lines, Machine, even_cost};

/// Number of points, padded length and transforms of one direction.
#[derive(Debug)]
pub(super) struct Axis<T: Real> {
    /// Points of the mesh.
    pub(super) n: usize,
    /// Length of the transforms.
    pub(super) len: usize,
    /// Values that a line begins with; the rest are images or zeros.
    own: usize,
    /// Images: place, index of the value, sign.
    images: Vec<(usize, usize, T)>,
    /// The wave numbers for derivatives: zero at the Nyquist frequency, whose derivative is not known at the points.
    pub(super) wave: Vec<T>,
    /// The same, in the order of the transforms of several lines.
    pub(super) wave_at: Vec<T>,
    pub(super) lines: Lines<T>,
    /// Whether the upper half of a line is zero and not wanted.
    halved: bool,
}

impl<T: Real> Axis<T> {
    pub(super) fn new(n: usize, continuation: &Continuation, spacing: f64) -> Self {
        let len = continuation.len;
        let lines = Lines::new(len);
        let wave: Vec<T> = waves(len, spacing).map(T::rounded).collect();
        Self {
            n,
            len,
            own: continuation.own,
            images: continuation
                .images
                .iter()
                .map(|&(place, i, sign)| (place, i, T::rounded(sign)))
                .collect(),
            wave_at: lines.order().iter().map(|&k| wave[k]).collect(),
            wave,
            halved: lines.halves() && continuation.images.is_empty() && 2 * n <= len,
            lines,
        }
    }

    /// Values of a line that its transform knows of.
    pub(super) fn own(&self) -> usize {
        self.own
    }

    /// Forward, from packs of as many places as there are points.
    pub(super) fn forward(&self, machine: &Machine, line: &[T], values: &mut [T]) {
        if self.halved {
            return self.lines.forward_from(machine, line, values);
        }
        self.continued(machine, line, values);
        self.lines.forward(machine, values);
    }

    /// Back, to packs of as many places as there are points, times the length.
    pub(super) fn inverse(&self, machine: &Machine, values: &mut [T], line: &mut [T]) {
        if self.halved {
            return self.lines.inverse_to(machine, values, line);
        }
        self.lines.inverse(machine, values);
        self.begun(machine, values, line);
    }

    /// Forward, times `weights` of the magnitudes of wave numbers, and back.
    pub(super) fn convolve(&self, machine: &Machine, line: &mut [T], values: &mut [T], weights: &[T]) {
        if self.halved {
            return self.lines.convolve_half(machine, line, values, weights);
        }
        self.continued(machine, line, values);
        self.lines.convolve(machine, values, weights);
        self.begun(machine, values, line);
    }

    /// A line with its images, padded.
    fn continued(&self, machine: &Machine, line: &[T], values: &mut [T]) {
        let width = 2 * machine.lanes();
        let (own, rest) = values.split_at_mut(self.own * width);
        own.copy_from_slice(&line[..self.own * width]);
        rest.fill(T::zero());
        for &(place, index, sign) in &self.images {
            for i in 0..width {
                values[place * width + i] = line[index * width + i] * sign;
            }
        }
    }

    /// The beginning of a line; beyond a period it begins again.
    fn begun(&self, machine: &Machine, values: &[T], line: &mut [T]) {
        let once = self.n.min(self.len) * 2 * machine.lanes();
        line[..once].copy_from_slice(&values[..once]);
        line.copy_within(..line.len() - once, once);
    }

    /// Places of a transform up to and including the Nyquist frequency.
    pub(super) fn half(&self) -> usize {
        self.len / 2 + 1
    }

    /// The factors that move a line by `shift` points, `exp(i k shift h)`; at the Nyquist frequency the cosine, since the
    /// sine is not known there.
    pub(super) fn phases(&self, shift: f64) -> Vec<[T; 2]> {
        (0..self.len)
            .map(|k| {
                let signed = if 2 * k <= self.len { k as f64 } else { k as f64 - self.len as f64 };
                let (sin, cos) = (TAU * signed * shift / self.len as f64).sin_cos();
                let sin = if 2 * k == self.len { 0.0 } else { sin };
                [T::rounded(cos), T::rounded(sin)]
            })
            .collect()
    }

    /// The same in the order of the transforms of several lines.
    pub(super) fn phases_at(&self, shift: f64) -> Vec<[T; 2]> {
        let phases = self.phases(shift);
        self.lines.order().iter().map(|&k| phases[k]).collect()
    }
}

/// The wave numbers of a transform of length `len`.
fn waves(len: usize, spacing: f64) -> impl Iterator<Item = f64> {
    let unit = TAU / (len as f64 * spacing);
    (0..len).map(move |k| match (2 * k).cmp(&len) {
        std::cmp::Ordering::Less => unit * k as f64,
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => unit * (k as f64 - len as f64),
    })
}

/// The least even number of at least `least` that has no prime factor above 5.
pub(super) fn fast_length(least: usize) -> usize {
    fast_lengths(least).min().unwrap_or(least)
}

/// The one whose transforms of even lines cost least, where there are as many lines as the length.
pub(super) fn fast_even_length(least: usize) -> usize {
    fast_lengths(least).min_by_key(|&n| n * even_cost(n)).unwrap_or(least)
}

/// Even numbers of at least `least` without prime factors above 5, for all powers of three and five the least.
fn fast_lengths(least: usize) -> impl Iterator<Item = usize> {
    let least = least.max(2);
    let beyond = least.saturating_mul(2);
    let powers = move |p: usize| {
        std::iter::successors(Some(1), move |n: &usize| n.checked_mul(p)).take_while(move |n| *n < beyond)
    };
    let products =
        powers(5).flat_map(move |fives| powers(3).filter_map(move |threes| fives.checked_mul(threes)));
    products.filter_map(move |odd| {
        let doubled =
            std::iter::successors(odd.checked_mul(2), |n| n.checked_mul(2)).find(|n| *n >= least)?;
        (doubled < beyond).then_some(doubled)
    })
}

#[cfg(test)]
mod tests {
    use super::{fast_length, waves};

    #[test]
    fn lengths_are_even_smooth_and_the_least() {
        for (least, length) in
            [(0, 2), (1, 2), (2, 2), (3, 4), (13, 16), (17, 18), (23, 24), (26, 30), (198, 200)]
        {
            assert_eq!(fast_length(least), length);
        }
    }

    #[test]
    fn the_nyquist_frequency_has_no_derivative() {
        let k: Vec<f64> = waves(4, std::f64::consts::FRAC_PI_2).collect();
        assert_eq!(k, [0.0, 1.0, 0.0, -1.0]);
        assert_eq!(
            waves(3, std::f64::consts::TAU / 3.0).map(f64::round).collect::<Vec<_>>(),
            [0.0, 1.0, -1.0]
        );
    }
}
