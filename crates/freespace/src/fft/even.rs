//! Transforms of lines that are even.

use super::butterfly;
use super::lanes::{Lanes, Work, times};
use super::lines::{Lines, Machine, run};
use super::stage::{Stage, Step};
use crate::plan::Real;

/// The first stage forward, radix 4, of the even continuation of `half`, which has a number more than half of a line. Of the wave
/// numbers 4k + 3 nothing is written: they are the opposites of 4k + 1.
struct FromEven<'a, T> {
    stage: &'a Stage<T>,
    half: &'a [T],
    values: &'a mut [T],
}

impl<T: Real> Work<T> for FromEven<'_, T> {
    #[inline(always)]
    fn run<S: Lanes<T>>(self, s: S) {
        let Stage { below, ref factors, .. } = *self.stage;
        let input = s.packs(self.half).as_chunks::<2>().0;
        let block = s.packs_mut(self.values).as_chunks_mut::<2>().0;
        let (first, rest) = block.split_at_mut(below);
        let (second, third) = rest.split_at_mut(below);
        let third = &mut third[..below];
        // The same places from the other end.
        let (rising, falling) = (&input[..2 * below], &input[1..2 * below + 1]);
        for (j, w) in factors.as_chunks::<3>().0[..below].iter().enumerate() {
            let (up, down) =
                ([rising[j], rising[j + below]], [falling[2 * below - 1 - j], falling[below - 1 - j]]);
            let y = butterfly::four(s, [up[0], up[1], down[0], down[1]]);
            first[j] = y[0];
            second[j] = times(s, y[1], w[0]);
            third[j] = times(s, y[2], w[1]);
        }
    }
}

impl<T: Real> Lines<T> {
    /// Forward, of the even continuation of packs of lines. The wave number k is at [`Self::place_of_even`]; elsewhere may be anything.
    pub(crate) fn forward_even(&self, machine: &Machine, half: &[T], values: &mut [T]) {
        if let [stage, rest @ ..] = &self.stages[..]
            && stage.radix == 4
        {
            machine.run(FromEven { stage, half, values });
            let known = 3 * stage.below * 2 * machine.lanes();
            return run(machine, rest.iter(), Step::Forward, &mut values[..known]);
        }
        let width = 2 * machine.lanes();
        values[..half.len()].copy_from_slice(half);
        let inner =
            half.chunks_exact(width).skip(1).take(self.order().len().saturating_sub(half.len() / width));
        let opposite = values.chunks_exact_mut(width).rev();
        opposite.zip(inner).for_each(|(to, from)| to.copy_from_slice(from));
        self.forward(machine, values);
    }

    /// The place of a wave number up to the Nyquist frequency.
    pub(crate) fn place_of_even(&self, k: usize) -> usize {
        let [p, q] = self.opposite()[k];
        p.min(q) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::{Lines, Machine};

    #[test]
    fn the_continuation_is_transformed() {
        let machine = Machine::new::<f64>();
        let width = 2 * machine.lanes();
        for n in [1, 2, 4, 6, 7, 8, 10, 12, 14, 16, 20, 24, 30, 32, 48, 60, 64, 250, 256, 2048] {
            let lines = Lines::<f64>::new(n);
            let half: Vec<f64> =
                (0..(n / 2 + 1) * width).map(|i| ((i * 7919 + 13) % 1013) as f64 / 506.5 - 1.0).collect();
            let mut expected: Vec<f64> =
                (0..n).flat_map(|j| half[j.min(n - j) * width..][..width].to_vec()).collect();
            lines.forward(&machine, &mut expected);
            let mut values = vec![f64::NAN; n * width];
            lines.forward_even(&machine, &half, &mut values);
            for k in 0..=n / 2 {
                let place = lines.place_of_even(k);
                let ours = &values[place * width..][..width];
                let other = &expected[lines.opposite()[k][0] as usize * width..][..width];
                let error = ours.iter().zip(other).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(error < 1e-14 * n as f64, "{n} {k}: {error:e}");
            }
        }
    }
}
