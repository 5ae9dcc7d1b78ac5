//! The transforms alone.

use rustfft::num_complex::Complex;

use super::Plan;
use super::aligned::Aligned;
use super::real::Real;

impl<const D: usize, T: Real> Plan<D, T> {
    /// Runs the one-dimensional transforms that a solve for phi cannot do without – those of the lines that are not known to
    /// be zero, there and back, each on the same line in the cache – and nothing else, on the calling thread. For
    /// benchmarks: what a solve takes beyond this is what it takes for moving data.
    pub fn bare_transforms(&self) {
        let [x, y, z] = &self.engine.axes;
        let (forward, inverse) = T::real(x.len);
        let (mut real, mut half) = (forward.make_input_vec(), forward.make_output_vec());
        let (mut there, mut back) = (forward.make_scratch_vec(), inverse.make_scratch_vec());
        for _ in 0..y.n * z.n {
            real.fill(T::one());
            let forward = forward.process_with_scratch(&mut real, &mut half, &mut there);
            half.fill(Complex::new(T::one(), T::zero()));
            let inverse = inverse.process_with_scratch(&mut half, &mut real, &mut back);
            debug_assert!(forward.is_ok() && inverse.is_ok(), "the buffers were made for this length");
        }
        for (axis, lines) in [(y, x.half() * z.n), (z, x.half() * y.len)] {
            if axis.len == 1 {
                continue;
            }
            let [forward, inverse] = T::complex(axis.len);
            let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
            let mut line = vec![Complex::new(T::one(), T::zero()); axis.len];
            let mut scratch = vec![Complex::default(); scratch];
            for _ in 0..lines {
                line.fill(Complex::new(T::one(), T::zero()));
                forward.process_with_scratch(&mut line, &mut scratch);
                inverse.process_with_scratch(&mut line, &mut scratch);
            }
        }
    }

    /// The same with the transforms that a solve is made of: several lines at once, without the zeros of padded lines and what is not wanted
    /// of the results.
    pub fn bare_packed_transforms(&self) {
        let ([x, y, z], machine) = (&self.engine.axes, &self.engine.machine);
        let planes = if self.engine.is_flat() { 1 } else { x.half() };
        let across = if self.engine.is_flat() { 0 } else { planes * z.n.div_ceil(machine.lanes()) };
        let pairs = (y.n * z.n).div_ceil(2 * machine.lanes());
        for (axis, count) in [(x, pairs), (y, across), (z, planes * self.engine.packs.len())] {
            let mut line = Aligned::zeros(axis.n * 2 * machine.lanes());
            let mut values = Aligned::zeros(axis.len * 2 * machine.lanes());
            for _ in 0..count {
                line.fill(T::one());
                axis.forward(machine, &line, &mut values);
                axis.inverse(machine, &mut values, &mut line);
            }
        }
    }

    /// Bytes that the plan keeps and that a solve with so many sources and outputs uses beside the fields themselves.
    pub fn bytes(&self, sources: usize, outputs: usize) -> usize {
        let spectra = sources.max(outputs) * self.engine.spectrum();
        size_of::<T>() * (self.engine.kernel.len() + spectra)
    }
}
