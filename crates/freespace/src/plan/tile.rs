//! A few planes of the first direction's spectrum, on their way through the other two directions and back.

use rustfft::num_complex::Complex;

use super::engine::Engine;
use super::output::Term;
use super::real::Real;
use super::recipe::{Deep, Recipe};
use super::transpose::{Aligned, GROUP, gather, pitch, scatter};

/// Scratch of one thread.
pub(super) struct Tile<T> {
    /// For each source or array of the recipe: rows of the third direction, in each the padded lines of all planes. None where
    /// the second direction is no direction: the rows are where they come from then.
    rows: Vec<Aligned<Complex<T>>>,
    /// For each source: padded columns.
    columns: Vec<Aligned<Complex<T>>>,
    /// Columns of an output.
    product: Aligned<Complex<T>>,
    scratch: Aligned<Complex<T>>,
}

/// Columns that are worked on together: their place among all, and what they belong to.
#[derive(Clone, Copy)]
struct Span {
    /// The first plane.
    plane: usize,
    /// The first column of the planes.
    start: usize,
    count: usize,
}

impl Span {
    /// Columns, with the wave numbers that they have in the first two directions.
    fn waves(self, len: usize) -> impl Iterator<Item = [usize; 2]> {
        (self.start..self.start + self.count).map(move |place| [self.plane + place / len, place % len])
    }
}

impl<T: Real> Tile<T> {
    pub(super) fn new(engine: &Engine<T>, sources: usize, recipe: &Recipe<T>) -> Self {
        let [_, y, z] = &engine.axes;
        let zeros = Aligned::zeros;
        let rows = if y.len > 1 { sources.max(recipe.middle) } else { 0 };
        Self {
            rows: (0..rows).map(|_| zeros(z.n * pitch(y.len))).collect(),
            columns: (0..sources).map(|_| zeros(GROUP * pitch(z.len))).collect(),
            product: zeros(GROUP * pitch(z.len)),
            scratch: zeros(y.scratch().max(z.scratch())),
        }
    }

    /// Works on the planes from `plane` on; `parts` has for each source or array of the recipe, and for each row, the lines of
    /// these planes.
    pub(super) fn convolve(
        &mut self,
        engine: &Engine<T>,
        plane: usize,
        parts: &mut [&mut [Complex<T>]],
        recipe: &Recipe<T>,
    ) {
        let [_, y, z] = &engine.axes;
        if y.len == 1 {
            let width = parts.first().map_or(0, |p| p.len());
            for start in (0..width).step_by(GROUP) {
                self.columns(engine, Span { plane, start, count: GROUP.min(width - start) }, parts, recipe);
            }
            return;
        }
        let stride = pitch(y.len);
        for (source, rows) in self.rows.iter_mut().take(self.columns.len()).enumerate() {
            for (row, part) in rows.chunks_exact_mut(stride).zip(&parts[source * z.n..][..z.n]) {
                y.load(part, &mut row[..y.len]);
                y.forward.process_with_scratch(&mut row[..y.len], &mut self.scratch);
            }
        }
        let mut arrays = std::mem::take(&mut self.rows);
        {
            let mut rows: Vec<&mut [Complex<T>]> =
                arrays.iter_mut().flat_map(|rows| rows.chunks_exact_mut(stride)).collect();
            for start in (0..y.len).step_by(GROUP) {
                let span = Span { plane, start, count: GROUP.min(y.len - start) };
                self.columns(engine, span, &mut rows, recipe);
            }
        }
        self.rows = arrays;
        for (middle, rows) in self.rows.iter_mut().take(recipe.middle).enumerate() {
            for (row, part) in rows.chunks_exact_mut(stride).zip(&mut parts[middle * z.n..][..z.n]) {
                y.inverse.process_with_scratch(&mut row[..y.len], &mut self.scratch);
                y.store(row, part);
            }
        }
    }

    /// Transforms, multiplies and transforms back some columns of the rows.
    fn columns(
        &mut self,
        engine: &Engine<T>,
        span: Span,
        rows: &mut [&mut [Complex<T>]],
        recipe: &Recipe<T>,
    ) {
        let [_, y, z] = &engine.axes;
        let stride = pitch(z.len);
        for (rows, columns) in rows.chunks(z.n).zip(&mut self.columns) {
            gather(rows.iter().take(z.n.min(z.len)).map(|r| &**r), span.start, columns, stride);
            for column in columns.chunks_exact_mut(stride).take(span.count) {
                z.continue_in_place(&mut column[..z.len]);
                z.forward.process_with_scratch(&mut column[..z.len], &mut self.scratch);
            }
        }
        for (index, deep) in recipe.deep.iter().enumerate() {
            // A source that is not needed again may be overwritten.
            let in_place = match deep.terms[..] {
                [term] if index + 1 == recipe.deep.len() => Some(term),
                _ => None,
            };
            if in_place.is_none() {
                for (c, waves) in span.waves(y.len).enumerate() {
                    let line = c * stride..c * stride + z.len;
                    let source = |source: usize| &self.columns[source][line.clone()];
                    sum(engine, waves, &deep.terms, source, &mut self.product[line.clone()]);
                }
            }
            let product = match in_place {
                Some(term) => &mut self.columns[term.source],
                None => &mut self.product,
            };
            for (column, waves) in product.chunks_exact_mut(stride).zip(span.waves(y.len)) {
                let column = &mut column[..z.len];
                in_place.iter().for_each(|term| derive(engine, waves, term, column));
                weigh(engine, waves, deep, recipe, column);
                z.inverse.process_with_scratch(column, &mut self.scratch);
            }
            if let Some(middle) = deep.plain {
                put(product, stride, &mut rows[middle * z.n..][..z.n], span.start, z.len);
            }
            if let Some(middle) = deep.along {
                for (column, waves) in product.chunks_exact_mut(stride).zip(span.waves(y.len)) {
                    let k = y.wave[waves[1]];
                    column[..z.n.min(z.len)].iter_mut().for_each(|v| *v = Complex::new(-k * v.im, k * v.re));
                }
                put(product, stride, &mut rows[middle * z.n..][..z.n], span.start, z.len);
            }
        }
    }
}

/// Columns back to rows; beyond a period, which has `len` points, they begin again.
fn put<T: Real>(
    columns: &[Complex<T>],
    stride: usize,
    rows: &mut [&mut [Complex<T>]],
    at: usize,
    len: usize,
) {
    let (once, again) = rows.split_at_mut(len.min(rows.len()));
    scatter(columns, stride, once.iter_mut().map(|r| &mut **r), at);
    scatter(columns, stride, again.iter_mut().map(|r| &mut **r), at);
}

/// The factor of a term, in a line of the third direction.
fn derive<T: Real>(engine: &Engine<T>, waves: [usize; 2], term: &Term, line: &mut [Complex<T>]) {
    let [x, y, z] = &engine.axes;
    let sign = T::rounded(term.sign);
    let times_i = |s: Complex<T>, k: T| Complex::new(-k * s.im, k * s.re);
    match term.axis {
        None if term.sign == 1.0 => {}
        None => line.iter_mut().for_each(|s| *s = *s * sign),
        Some(2) => line.iter_mut().zip(&z.wave).for_each(|(s, k)| *s = times_i(*s, *k * sign)),
        Some(axis) => {
            let k = sign * if axis == 0 { x.wave[waves[0]] } else { y.wave[waves[1]] };
            line.iter_mut().for_each(|s| *s = times_i(*s, k));
        }
    }
}

/// The sum of terms, each a line of a source times its factor.
fn sum<'a, T: Real>(
    engine: &Engine<T>,
    waves: [usize; 2],
    terms: &[Term],
    source: impl Fn(usize) -> &'a [Complex<T>],
    out: &mut [Complex<T>],
) {
    let [x, y, z] = &engine.axes;
    for (index, term) in terms.iter().enumerate() {
        let line = source(term.source);
        if index == 0 {
            out.copy_from_slice(line);
            derive(engine, waves, term, out);
            continue;
        }
        let sign = T::rounded(term.sign);
        let times_i = |s: &Complex<T>, k: T| Complex::new(-k * s.im, k * s.re);
        match term.axis {
            None => out.iter_mut().zip(line).for_each(|(o, s)| *o = *o + *s * sign),
            Some(2) => {
                let lines = out.iter_mut().zip(line).zip(&z.wave);
                lines.for_each(|((o, s), k)| *o = *o + times_i(s, *k * sign));
            }
            Some(axis) => {
                let k = sign * if axis == 0 { x.wave[waves[0]] } else { y.wave[waves[1]] };
                out.iter_mut().zip(line).for_each(|(o, s)| *o = *o + times_i(s, k));
            }
        }
    }
}

/// Multiplies a line by Ĝ, or by the estimate of its error, and by what moves it.
fn weigh<T: Real>(
    engine: &Engine<T>,
    waves: [usize; 2],
    deep: &Deep,
    recipe: &Recipe<T>,
    line: &mut [Complex<T>],
) {
    let [_, y, z] = &engine.axes;
    let half = z.half();
    if let (true, Some(estimate)) = (deep.estimate, &engine.estimate) {
        estimate.apply([waves[0], y.fold(waves[1])], half, line);
    } else {
        let kernel = &engine.kernel[(waves[0] * y.half() + y.fold(waves[1])) * half..][..half];
        let (low, high) = line.split_at_mut(half);
        low.iter_mut().zip(kernel).for_each(|(value, g)| *value = *value * *g);
        // The other wave numbers have the magnitudes of those before, from the far end.
        let mirrored = &kernel[1..=high.len()];
        high.iter_mut().rev().zip(mirrored).for_each(|(value, g)| *value = *value * *g);
    }
    if let Some([of_x, of_y, of_z]) = &recipe.phases {
        let here = of_x[waves[0]] * of_y[waves[1]];
        line.iter_mut().zip(of_z).for_each(|(o, p)| *o = *o * (here * p));
    }
}
