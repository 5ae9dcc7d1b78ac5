//! One direction of the transforms.

use std::f64::consts::TAU;
use std::sync::Arc;

use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex;

use super::boundary::Continuation;
use super::real::Real;

/// Number of points, padded length and transforms of one direction.
pub(super) struct Axis<T: Real> {
    /// Points of the mesh.
    pub(super) n: usize,
    /// Length of the transforms.
    pub(super) len: usize,
    /// Values that a line begins with; the rest are images or zeros.
    own: usize,
    /// Images: place, index of the value, sign.
    images: Vec<(usize, usize, T)>,
    /// The wave number that belongs to each place of a transform, for derivatives: zero at the Nyquist frequency, whose
    /// derivative is not known at the points.
    pub(super) wave: Vec<T>,
    pub(super) forward: Arc<dyn Fft<T>>,
    pub(super) inverse: Arc<dyn Fft<T>>,
}

/// The transforms of the first direction, between real and complex numbers.
pub(super) struct RealTransforms<T: Real> {
    pub(super) forward: Arc<dyn RealToComplex<T>>,
    pub(super) inverse: Arc<dyn ComplexToReal<T>>,
}

impl<T: Real> std::fmt::Debug for Axis<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Axis").field("n", &self.n).field("len", &self.len).finish_non_exhaustive()
    }
}

impl<T: Real> std::fmt::Debug for RealTransforms<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RealTransforms").finish_non_exhaustive()
    }
}

impl<T: Real> Axis<T> {
    pub(super) fn new(n: usize, continuation: &Continuation, spacing: f64) -> Self {
        let len = continuation.len;
        let [forward, inverse] = T::complex(len);
        Self {
            n,
            len,
            own: continuation.own,
            images: continuation
                .images
                .iter()
                .map(|&(place, i, sign)| (place, i, T::rounded(sign)))
                .collect(),
            wave: waves(len, spacing).map(T::rounded).collect(),
            forward,
            inverse,
        }
    }

    /// Continues a line of values to the length of the transforms.
    pub(super) fn load<V>(&self, values: &[V], line: &mut [V])
    where
        V: Copy + Default + std::ops::Mul<T, Output = V>,
    {
        line[..self.own].copy_from_slice(&values[..self.own]);
        line[self.own..].fill(V::default());
        for &(place, index, sign) in &self.images {
            line[place] = values[index] * sign;
        }
    }

    /// The same where the line begins with the values already.
    pub(super) fn continue_in_place<V>(&self, line: &mut [V])
    where
        V: Copy + Default + std::ops::Mul<T, Output = V>,
    {
        line[self.own..].fill(V::default());
        for &(place, index, sign) in &self.images {
            line[place] = line[index] * sign;
        }
    }

    /// The values at the points; beyond a period they begin again.
    pub(super) fn store<V: Copy>(&self, line: &[V], values: &mut [V]) {
        let once = self.n.min(self.len);
        values[..once].copy_from_slice(&line[..once]);
        values[once..self.n].copy_from_slice(&line[..self.n - once]);
    }

    /// Places of a transform up to and including the Nyquist frequency.
    pub(super) fn half(&self) -> usize {
        self.len / 2 + 1
    }

    /// The place below the Nyquist frequency with the same magnitude of the wave number.
    pub(super) fn fold(&self, place: usize) -> usize {
        place.min(self.len - place)
    }

    /// The factors that move a line by `shift` points, `exp(i k shift h)`; at the Nyquist frequency the cosine, since the
    /// sine is not known there.
    pub(super) fn phases(&self, shift: f64) -> Vec<Complex<T>> {
        (0..self.len)
            .map(|k| {
                let signed = if 2 * k <= self.len { k as f64 } else { k as f64 - self.len as f64 };
                let (sin, cos) = (TAU * signed * shift / self.len as f64).sin_cos();
                let sin = if 2 * k == self.len { 0.0 } else { sin };
                Complex::new(T::rounded(cos), T::rounded(sin))
            })
            .collect()
    }

    /// Scratch that either transform needs.
    pub(super) fn scratch(&self) -> usize {
        self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len())
    }
}

impl<T: Real> RealTransforms<T> {
    pub(super) fn new(len: usize) -> Self {
        let (forward, inverse) = T::real(len);
        Self { forward, inverse }
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
    let least = least.max(2);
    let mut best = least.next_power_of_two();
    let mut fives = 1;
    while fives < best {
        let mut threes = fives;
        while threes < best {
            let mut all = 2 * threes;
            while all < least {
                all *= 2;
            }
            best = best.min(all);
            threes *= 3;
        }
        fives *= 5;
    }
    best
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
