//! A few planes of the first direction's spectrum, on their way through the other two directions and back.

use rustfft::num_complex::Complex;

use super::engine::Engine;
use super::output::Wanted;
use super::real::Real;

/// Columns that are gathered at once: four cache lines of complex numbers from each row.
const COLUMNS: usize = 16;

/// Numbers between two columns: without them, columns whose length is a power of two would all fall on the same few lines of
/// the cache.
const PADDING: usize = 4;

/// How much a tile holds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// Planes.
    pub(super) block: usize,
    /// Sources.
    pub(super) sources: usize,
    /// Outputs.
    pub(super) outputs: usize,
}

/// Scratch of one thread.
pub(super) struct Tile<T> {
    shape: Shape,
    /// For each source or output: rows of the third direction, in each the padded lines of all planes.
    rows: Vec<Vec<Complex<T>>>,
    /// For each source: padded columns.
    columns: Vec<Vec<Complex<T>>>,
    /// One column of an output.
    product: Vec<Complex<T>>,
    /// Columns of an output.
    results: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Real> Tile<T> {
    pub(super) fn new(engine: &Engine<T>, shape: Shape) -> Self {
        let [_, y, z] = &engine.axes;
        let zeros = |n| vec![Complex::default(); n];
        Self {
            shape,
            rows: (0..shape.sources.max(shape.outputs)).map(|_| zeros(z.n * shape.block * y.len)).collect(),
            columns: (0..shape.sources).map(|_| zeros(COLUMNS * (z.len + PADDING))).collect(),
            product: zeros(z.len),
            results: zeros(COLUMNS * (z.len + PADDING)),
            scratch: zeros(y.scratch().max(z.scratch())),
        }
    }

    /// Works on the planes from `first` on; `parts` has for each source or output, and for each row, the lines of these
    /// planes.
    pub(super) fn convolve(
        &mut self,
        engine: &Engine<T>,
        first: usize,
        parts: &mut [&mut [Complex<T>]],
        wanted: &[Wanted<T>],
    ) {
        let [_, y, z] = &engine.axes;
        let width = parts.first().map_or(0, |p| p.len()) / y.n * y.len;
        for source in 0..self.shape.sources {
            for (row, part) in self.rows[source].chunks_exact_mut(width).zip(&parts[source * z.n..][..z.n]) {
                for (line, values) in row.chunks_exact_mut(y.len).zip(part.chunks_exact(y.n)) {
                    y.load(values, line);
                }
                if y.len > 1 {
                    y.forward.process_with_scratch(row, &mut self.scratch);
                }
            }
        }
        for start in (0..width).step_by(COLUMNS) {
            self.columns(engine, first, width, start, wanted);
        }
        for output in 0..self.shape.outputs {
            for (row, part) in
                self.rows[output].chunks_exact_mut(width).zip(&mut parts[output * z.n..][..z.n])
            {
                if y.len > 1 {
                    y.inverse.process_with_scratch(row, &mut self.scratch);
                }
                for (line, values) in row.chunks_exact(y.len).zip(part.chunks_exact_mut(y.n)) {
                    y.store(line, values);
                }
            }
        }
    }

    /// Transforms, multiplies and transforms back the columns from `start` on.
    fn columns(
        &mut self,
        engine: &Engine<T>,
        first: usize,
        width: usize,
        start: usize,
        wanted: &[Wanted<T>],
    ) {
        let [_, y, z] = &engine.axes;
        let (count, stride) = (COLUMNS.min(width - start), z.len + PADDING);
        for (rows, columns) in self.rows.iter().zip(&mut self.columns) {
            for (j, row) in rows.chunks_exact(width).take(z.n.min(z.len)).enumerate() {
                for (c, value) in row[start..start + count].iter().enumerate() {
                    columns[c * stride + j] = *value;
                }
            }
            for column in columns.chunks_exact_mut(stride).take(count) {
                z.continue_in_place(&mut column[..z.len]);
                z.forward.process_with_scratch(&mut column[..z.len], &mut self.scratch);
            }
        }
        for (output, (wanted, rows)) in wanted.iter().zip(&mut self.rows).enumerate() {
            for c in 0..count {
                let place = start + c;
                let waves = [first + place / y.len, place % y.len];
                let line = c * stride..c * stride + z.len;
                // A source that no later output needs may be overwritten.
                let in_place = self.shape.sources == 1 && output + 1 == self.shape.outputs;
                let out = if in_place && wanted.is_plain() {
                    let column = &mut self.columns[0][line];
                    multiply(engine, waves, wanted, column);
                    column
                } else {
                    let out = &mut self.product[..z.len];
                    combine(engine, waves, wanted, &self.columns, line, out);
                    out
                };
                z.inverse.process_with_scratch(out, &mut self.scratch);
                self.results[c * stride..c * stride + z.n.min(z.len)].copy_from_slice(&out[..z.n.min(z.len)]);
            }
            for (j, row) in rows.chunks_exact_mut(width).take(z.n).enumerate() {
                // Beyond a period the values begin again.
                let place = if j < z.len { j } else { j - z.len };
                for (c, value) in row[start..start + count].iter_mut().enumerate() {
                    *value = self.results[c * stride + place];
                }
            }
        }
    }
}

/// A line of a source in Fourier space times Ĝ.
fn multiply<T: Real>(engine: &Engine<T>, waves: [usize; 2], wanted: &Wanted<T>, line: &mut [Complex<T>]) {
    let sign = T::rounded(wanted.terms.first().map_or(1.0, |t| t.sign));
    weigh(engine, waves, line, |value, g| *value = *value * (g * sign));
}

/// Ĝ of a line, place by place.
fn weigh<T: Real>(
    engine: &Engine<T>,
    waves: [usize; 2],
    line: &mut [Complex<T>],
    mut apply: impl FnMut(&mut Complex<T>, T),
) {
    let [_, y, z] = &engine.axes;
    let half = z.half();
    let kernel = &engine.kernel[(waves[0] * y.half() + y.fold(waves[1])) * half..][..half];
    let (low, high) = line.split_at_mut(half);
    low.iter_mut().zip(kernel).for_each(|(value, g)| apply(value, *g));
    // The other wave numbers have the magnitudes of those before, from the far end.
    let mirrored = kernel[1..].iter().rev().skip(1 - z.len % 2);
    high.iter_mut().zip(mirrored).for_each(|(value, g)| apply(value, *g));
}

/// A line of an output in Fourier space: Ĝ, or the estimate of its error, times its terms.
fn combine<T: Real>(
    engine: &Engine<T>,
    waves: [usize; 2],
    wanted: &Wanted<T>,
    sources: &[Vec<Complex<T>>],
    line: std::ops::Range<usize>,
    out: &mut [Complex<T>],
) {
    let [x, y, z] = &engine.axes;
    for (index, term) in wanted.terms.iter().enumerate() {
        let source = &sources[term.source][line.clone()];
        let sign = T::rounded(term.sign);
        let times_i = |s: &Complex<T>, k: T| Complex::new(-k * s.im, k * s.re);
        let add = |out: &mut Complex<T>, value: Complex<T>| {
            *out = if index == 0 { value } else { *out + value };
        };
        match term.axis {
            None => out.iter_mut().zip(source).for_each(|(o, s)| add(o, s * sign)),
            Some(2) => {
                let waves = z.wave.iter().map(|k| *k * sign);
                out.iter_mut().zip(source).zip(waves).for_each(|((o, s), k)| add(o, times_i(s, k)));
            }
            Some(axis) => {
                let k = sign * if axis == 0 { x.wave[waves[0]] } else { y.wave[waves[1]] };
                out.iter_mut().zip(source).for_each(|(o, s)| add(o, times_i(s, k)));
            }
        }
    }
    if let (true, Some(estimate)) = (wanted.estimate, &engine.estimate) {
        estimate.apply([waves[0], y.fold(waves[1])], z.half(), out);
    } else {
        weigh(engine, waves, out, |value, g| *value = *value * g);
    }
    if let Some([of_x, of_y, of_z]) = &wanted.phases {
        let here = of_x[waves[0]] * of_y[waves[1]];
        out.iter_mut().zip(of_z).for_each(|(o, p)| *o = *o * (here * p));
    }
}
