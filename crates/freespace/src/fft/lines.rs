//! Transforms of one length.

use std::sync::Arc;

use pulp::Arch;
use rustfft::Fft;
use rustfft::num_complex::Complex;

use super::factors::Weigh;
use super::lanes::{Lanes, Work};
use super::stage::{Blocks, FromHalf, Middle, Stage, Step, ToHalf};
use crate::plan::Real;

/// Numbers of all lines together on which one stage follows the other: half of a first-level cache.
const NEAR: usize = 2048;

/// The vectors of this processor.
#[derive(Debug, Clone)]
pub(crate) struct Machine {
    arch: Arch,
    lanes: usize,
}

/// How many lanes there are.
struct Count<'a>(&'a mut usize);

impl<T: Real> Work<T> for Count<'_> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, _: S) {
        *self.0 = S::COUNT;
    }
}

impl Machine {
    pub(crate) fn new<T: Real>() -> Self {
        let arch = Arch::new();
        let mut lanes = 1;
        T::vectorize(arch, Count(&mut lanes));
        Self { arch, lanes }
    }

    /// Numbers of type `T` that a vector holds.
    pub(crate) fn lanes(&self) -> usize {
        self.lanes
    }

    pub(crate) fn run<T: Real>(&self, work: impl Work<T>) {
        T::vectorize(self.arch, work);
    }
}

/// Transforms of as many lines as there are lanes, in packs: real parts of a place, imaginary parts of it, and so on.
#[derive(Debug)]
pub(crate) struct Lines<T: Real> {
    len: usize,
    /// Largest blocks first.
    pub(super) stages: Vec<Stage<T>>,
    /// For lengths with other prime factors than 2, 3 and 5.
    library: Option<Library<T>>,
    /// The wave number at each place of a transform, modulo the length.
    order: Vec<usize>,
    /// Its magnitude.
    fold: Vec<u32>,
    /// The places of a wave number up to the Nyquist frequency and of its opposite.
    opposite: Vec<[u32; 2]>,
}

/// Transforms one by one.
struct Library<T> {
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
}

impl<T> std::fmt::Debug for Library<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Library").finish_non_exhaustive()
    }
}

/// Radices of the stages; none for lengths with prime factors above 5.
fn radices(len: usize) -> Option<Vec<usize>> {
    let (mut rest, mut odd, mut twos) = (len, Vec::new(), 0);
    for prime in [5, 3] {
        while rest.is_multiple_of(prime) {
            odd.push(prime);
            rest /= prime;
        }
    }
    while rest.is_multiple_of(2) {
        twos += 1;
        rest /= 2;
    }
    if rest != 1 {
        return None;
    }
    // First one that can leave out a half, then small ones, so that the last blocks are in registers.
    let mut radices = match twos {
        0 => Vec::new(),
        1 => vec![2],
        _ => vec![4],
    };
    twos -= radices.first().map_or(0, |r| r / 2);
    radices.extend(odd);
    match twos % 3 {
        1 if twos > 3 => {
            radices.extend([4, 4]);
            twos -= 4;
        }
        1 => {
            radices.push(2);
            twos -= 1;
        }
        2 => {
            radices.push(4);
            twos -= 2;
        }
        _ => {}
    }
    radices.extend(std::iter::repeat_n(8, twos / 3));
    Some(radices)
}

impl<T: Real> Lines<T> {
    pub(crate) fn new(len: usize) -> Self {
        let radices = radices(len);
        let library = radices.is_none().then(|| {
            let [forward, inverse] = T::complex(len);
            Library { forward, inverse }
        });
        let radices = radices.unwrap_or_default();
        let mut order = vec![0; len];
        for (place, wave) in order.iter_mut().enumerate() {
            let (mut rest, mut block, mut unit) = (place, len, 1);
            for radix in &radices {
                block /= radix;
                *wave += unit * (rest / block);
                rest %= block;
                unit *= radix;
            }
            *wave += unit * rest;
        }
        let mut block = len;
        let stages = radices
            .iter()
            .map(|&radix| {
                block /= radix;
                Stage::new(radix, block)
            })
            .collect();
        let fold = order.iter().map(|&k| k.min(len - k) as u32).collect();
        let mut place = vec![0; len];
        order.iter().enumerate().for_each(|(at, &k)| place[k] = at as u32);
        let opposite = (0..=len / 2).map(|k| [place[k], place[(len - k) % len]]).collect();
        Self { len, stages, library, order, fold, opposite }
    }

    /// The wave number at each place of a transform.
    pub(crate) fn order(&self) -> &[usize] {
        &self.order
    }

    /// The magnitude of the wave number at each place.
    pub(crate) fn fold(&self) -> &[u32] {
        &self.fold
    }

    /// The places of each wave number up to the Nyquist frequency, and of its opposite.
    pub(crate) fn opposite(&self) -> &[[u32; 2]] {
        &self.opposite
    }

    /// Whether transforms can leave out the upper half of a line.
    pub(crate) fn halves(&self) -> bool {
        self.len.is_multiple_of(2) && self.library.is_none()
    }

    /// Forward.
    pub(crate) fn forward(&self, machine: &Machine, values: &mut [T]) {
        match &self.library {
            Some(library) => library.transform(library.forward.as_ref(), machine.lanes(), values),
            None => run(machine, self.stages.iter(), Step::Forward, values),
        }
    }

    /// Forward, of lines that are zero beyond `input`, at most a half. For lengths that [`Self::halves`] are possible with.
    pub(crate) fn forward_from(&self, machine: &Machine, input: &[T], values: &mut [T]) {
        let [stage, rest @ ..] = &self.stages[..] else { return };
        machine.run(FromHalf { stage, input, values });
        run(machine, rest.iter(), Step::Forward, values);
    }

    /// Back, times the length.
    pub(crate) fn inverse(&self, machine: &Machine, values: &mut [T]) {
        match &self.library {
            Some(library) => library.transform(library.inverse.as_ref(), machine.lanes(), values),
            None => run(machine, self.stages.iter().rev(), Step::Inverse, values),
        }
    }

    /// Back, times the length, of which only the beginning is wanted, at most a half: `output`.
    pub(crate) fn inverse_to(&self, machine: &Machine, values: &mut [T], output: &mut [T]) {
        let [stage, rest @ ..] = &self.stages[..] else { return };
        run(machine, rest.iter().rev(), Step::Inverse, values);
        machine.run(ToHalf { stage, values, output });
    }

    /// Forward, times `weights` of the magnitudes of wave numbers, and back.
    pub(crate) fn convolve(&self, machine: &Machine, values: &mut [T], weights: &[T]) {
        if self.stages.is_empty() {
            self.forward(machine, values);
            machine.run(Weigh { values, weights, fold: &self.fold });
            return self.inverse(machine, values);
        }
        self.convolve_stages(&self.stages, machine, values, weights);
    }

    /// The same of lines that are zero beyond `line`, at most a half, which is all that is wanted.
    pub(crate) fn convolve_half(&self, machine: &Machine, line: &mut [T], values: &mut [T], weights: &[T]) {
        let [stage, rest @ ..] = &self.stages[..] else { return };
        machine.run(FromHalf { stage, input: line, values });
        if rest.is_empty() {
            machine.run(Weigh { values, weights, fold: &self.fold });
        } else {
            self.convolve_stages(rest, machine, values, weights);
        }
        machine.run(ToHalf { stage, values, output: line });
    }

    /// Some of the stages, the last ones, product, and these stages back.
    fn convolve_stages(&self, stages: &[Stage<T>], machine: &Machine, values: &mut [T], weights: &[T]) {
        let [outer @ .., last] = stages else { return };
        let width = 2 * machine.lanes();
        // Large blocks stage by stage, small ones through all stages while they are near.
        let near = outer.iter().position(|s| s.radix * s.below * width <= NEAR).unwrap_or(outer.len());
        let (far, near) = outer.split_at(near);
        run(machine, far.iter(), Step::Forward, values);
        let block = near.first().unwrap_or(last);
        let block = block.radix * block.below;
        for (values, fold) in values.chunks_exact_mut(block * width).zip(self.fold.chunks_exact(block)) {
            run(machine, near.iter(), Step::Forward, values);
            machine.run(Middle { radix: last.radix, values, weights, fold });
            run(machine, near.iter().rev(), Step::Inverse, values);
        }
        run(machine, far.iter().rev(), Step::Inverse, values);
    }
}

/// One stage after the other.
pub(super) fn run<'a, T: Real>(
    machine: &Machine,
    stages: impl Iterator<Item = &'a Stage<T>>,
    step: Step,
    values: &mut [T],
) {
    stages.for_each(|stage| machine.run(Blocks { stage, step, values }));
}

impl<T: Real> Library<T> {
    fn transform(&self, fft: &dyn Fft<T>, lanes: usize, values: &mut [T]) {
        let mut line = vec![Complex::default(); fft.len()];
        let mut scratch = vec![Complex::default(); fft.get_inplace_scratch_len()];
        for lane in 0..lanes {
            for (number, pair) in line.iter_mut().zip(values.chunks_exact(2 * lanes)) {
                *number = Complex::new(pair[lane], pair[lanes + lane]);
            }
            fft.process_with_scratch(&mut line, &mut scratch);
            for (number, pair) in line.iter().zip(values.chunks_exact_mut(2 * lanes)) {
                (pair[lane], pair[lanes + lane]) = (number.re, number.im);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{Lines, Machine, radices};

    /// Packs of lines of numbers that look random.
    fn packs(count: usize) -> Vec<f64> {
        (0..count).map(|i| ((i * 7919 + 13) % 1013) as f64 / 506.5 - 1.0).collect()
    }

    /// `sum x_j exp(-2 pi i j k / n)` of a lane.
    fn direct(values: &[f64], lanes: usize, lane: usize, k: usize, n: usize) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (j, pair) in values.chunks_exact(2 * lanes).enumerate() {
            let (sin, cos) = (-TAU * (j * k % n) as f64 / n as f64).sin_cos();
            let [re, im] = [pair[lane], pair[lanes + lane]];
            sum = [sum[0] + re * cos - im * sin, sum[1] + re * sin + im * cos];
        }
        sum
    }

    #[test]
    fn every_length_is_transformed_and_transformed_back() {
        let machine = Machine::new::<f64>();
        let lanes = machine.lanes();
        for n in
            [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 15, 16, 20, 22, 24, 30, 32, 45, 48, 64, 90, 128, 250, 256]
        {
            let lines = Lines::<f64>::new(n);
            let before = packs(2 * lanes * n);
            let halves = [n, n / 2, (n / 2).div_ceil(2) + 1, n / 3];
            for filled in halves.into_iter().take(if lines.halves() { 4 } else { 1 }) {
                let filled = filled.min(if filled < n { n / 2 } else { n }).max(1);
                let mut zeroed = before.clone();
                zeroed[2 * lanes * filled..].fill(0.0);
                let input = zeroed[..2 * lanes * filled].to_vec();
                // What is not looked at may be anything.
                let mut values = if filled < n { vec![f64::NAN; 2 * lanes * n] } else { before.clone() };
                if filled < n {
                    lines.forward_from(&machine, &input, &mut values);
                } else {
                    lines.forward(&machine, &mut values);
                }
                for (place, pair) in values.chunks_exact(2 * lanes).enumerate() {
                    for lane in 0..lanes {
                        let [re, im] = direct(&zeroed, lanes, lane, lines.order()[place], n);
                        let error = (pair[lane] - re).hypot(pair[lanes + lane] - im);
                        assert!(error < 1e-15 * n as f64, "{n} {filled} {place}: {error:e}");
                    }
                }
                let mut output = vec![f64::NAN; input.len()];
                if filled < n {
                    lines.inverse_to(&machine, &mut values, &mut output);
                } else {
                    lines.inverse(&machine, &mut values);
                    output.copy_from_slice(&values);
                }
                for (value, before) in output.iter().zip(&input) {
                    assert!((value / n as f64 - before).abs() < 2e-15, "{n} {filled}: {value:e} {before:e}");
                }
            }
        }
    }

    #[test]
    fn convolutions_are_products_of_transforms() {
        let machine = Machine::new::<f64>();
        let lanes = machine.lanes();
        for n in [1, 2, 4, 6, 7, 8, 12, 20, 48, 64, 250, 512, 2048] {
            let lines = Lines::<f64>::new(n);
            let before = packs(2 * lanes * n);
            let weights = packs(lanes * (n / 2 + 1));
            for filled in [n, n / 2].into_iter().take(if lines.halves() { 2 } else { 1 }) {
                let mut other = before.clone();
                other[2 * lanes * filled..].fill(0.0);
                let mut one = other[..2 * lanes * filled].to_vec();
                if filled < n {
                    let mut values = vec![f64::NAN; 2 * lanes * n];
                    lines.convolve_half(&machine, &mut one, &mut values, &weights);
                } else {
                    lines.convolve(&machine, &mut one, &weights);
                }
                lines.forward(&machine, &mut other);
                for (place, pair) in other.chunks_exact_mut(2 * lanes).enumerate() {
                    let weights = &weights[lanes * lines.fold()[place] as usize..];
                    (0..2 * lanes).for_each(|i| pair[i] *= weights[i % lanes]);
                }
                lines.inverse(&machine, &mut other);
                let worst = one.iter().zip(&other).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(worst < 1e-13 * n as f64, "{n} {filled}: {worst:e}");
            }
        }
    }

    #[test]
    fn radices_multiply_to_the_length_and_the_last_are_eights() {
        for n in 1..=4096_usize {
            if let Some(radices) = radices(n) {
                assert_eq!(radices.iter().product::<usize>(), n);
            }
        }
        assert_eq!(radices(256), Some(vec![4, 8, 8]));
        assert_eq!(radices(512), Some(vec![4, 4, 4, 8]));
        assert_eq!(radices(2048), Some(vec![4, 8, 8, 8]));
        assert_eq!(radices(60), Some(vec![4, 5, 3]));
        assert_eq!(radices(14), None);
    }
}
