//! A few planes of the first direction's spectrum, on their way through the other two directions and back.

use super::aligned::{Aligned, pitch};
use super::axis::Axis;
use super::engine::Engine;
use super::output::Term;
use super::real::Real;
use super::recipe::{Deep, Recipe};
use crate::fft::{
    Accumulate, Factor, FromColumns, FromLines, FromReals, MOST, Machine, Move, ToColumns, ToLines, Turn,
    Weigh,
};

/// Scratch of one thread.
pub(super) struct Tile<T> {
    /// For each source or array of the recipe: rows of the third direction, in each the padded lines of all planes. None where
    /// the second direction is no direction: the rows are where they come from then.
    rows: Vec<Aligned<T>>,
    /// Lines of the second direction.
    lines: Aligned<T>,
    /// For each source: lines of the third direction.
    columns: Vec<Aligned<T>>,
    /// Lines of an output.
    product: Aligned<T>,
    /// What lines are multiplied by, up to the Nyquist frequency.
    weights: Aligned<T>,
    /// Factors of the lines.
    across: Aligned<T>,
}

/// Columns that are worked on together: their place among all, and what they belong to.
#[derive(Clone, Copy)]
struct Span {
    /// The first plane.
    plane: usize,
    /// The first column of the planes.
    start: usize,
}

impl Span {
    /// Where the column that is `column` further lies in the first two directions: its wave number, and its place in a transform.
    /// None for what lies between rows.
    fn place<T: Real>(self, engine: &Engine<T>, column: usize) -> Option<[usize; 2]> {
        let [x, y, _] = &engine.axes;
        let column = self.start + column;
        let place = if y.len == 1 { [self.plane + column, 0] } else { [self.plane, column] };
        (place[0] < x.half() && place[1] < y.len).then_some(place)
    }
}

impl<T: Real> Tile<T> {
    pub(super) fn new(engine: &Engine<T>, sources: usize, recipe: &Recipe<T>) -> Self {
        let [_, y, z] = &engine.axes;
        let (zeros, lanes) = (Aligned::zeros, engine.machine.lanes());
        let rows = if y.len > 1 { sources.max(recipe.middle) } else { 0 };
        Self {
            rows: (0..rows).map(|_| zeros(z.n * 2 * pitch(y.len, lanes))).collect(),
            lines: zeros(2 * lanes * y.len),
            columns: (0..sources).map(|_| zeros(2 * lanes * z.len)).collect(),
            product: zeros(2 * lanes * z.len),
            weights: zeros(lanes * z.half()),
            across: zeros(2 * lanes),
        }
    }

    /// Works on the planes from `plane` on; `parts` has for each source or array of the recipe, and for each row, the lines of
    /// these planes.
    pub(super) fn convolve(
        &mut self,
        engine: &Engine<T>,
        plane: usize,
        parts: &mut [&mut [T]],
        recipe: &Recipe<T>,
    ) {
        let ([_, y, z], lanes) = (&engine.axes, engine.machine.lanes());
        if y.len == 1 {
            let width = parts.first().map_or(0, |p| p.len() / 2);
            for start in (0..width).step_by(lanes) {
                self.columns(engine, Span { plane, start }, parts, recipe);
            }
            return;
        }
        let mut arrays = std::mem::take(&mut self.rows);
        {
            let mut rows: Vec<&mut [T]> =
                arrays.iter_mut().flat_map(|rows| rows.chunks_exact_mut(2 * pitch(y.len, lanes))).collect();
            let sources = self.columns.len() * z.n;
            for (from, to) in parts[..sources].chunks(z.n).zip(rows[..sources].chunks_mut(z.n)) {
                for (from, to) in from.chunks(lanes).zip(to.chunks_mut(lanes)) {
                    forward(&engine.machine, y, from, to, &mut self.lines);
                }
            }
            for start in (0..y.len).step_by(lanes) {
                self.columns(engine, Span { plane, start }, &mut rows, recipe);
            }
            let arrays = recipe.middle * z.n;
            for (from, to) in rows[..arrays].chunks(z.n).zip(parts[..arrays].chunks_mut(z.n)) {
                for (from, to) in from.chunks(lanes).zip(to.chunks_mut(lanes)) {
                    inverse(&engine.machine, y, from, to, &mut self.lines);
                }
            }
        }
        self.rows = arrays;
    }

    /// Transforms, multiplies and transforms back some columns of the rows.
    fn columns(&mut self, engine: &Engine<T>, span: Span, rows: &mut [&mut [T]], recipe: &Recipe<T>) {
        let (machine, z) = (&engine.machine, &engine.axes[2]);
        let width = 2 * machine.lanes();
        for (rows, columns) in rows.chunks(z.n).zip(&mut self.columns) {
            let rows = &rows[..z.n.min(z.len)];
            machine.run(FromColumns { rows, at: span.start, values: &mut columns[..z.filled() * width] });
            z.continue_packs(columns, width);
        }
        if let (Some(deep), [columns]) = (recipe.alone(), &mut self.columns[..]) {
            weights(engine, span, deep, &mut self.weights);
            z.lines.convolve(machine, columns, &self.weights, z.halved);
            return put(machine, z, columns, &mut rows[..z.n], span.start);
        }
        for columns in &mut self.columns {
            z.lines.forward(machine, columns, z.halved);
        }
        for deep in &recipe.deep {
            for (index, term) in deep.terms.iter().enumerate() {
                factors(engine, span, term, &mut self.across);
                let along = (term.axis == Some(2)).then_some(&z.wave_at[..]);
                let factor = Factor { along, across: &self.across, turned: term.axis.is_some() };
                let source = &self.columns[term.source];
                machine.run(Accumulate { source, factor, add: index > 0, values: &mut self.product });
            }
            weights(engine, span, deep, &mut self.weights);
            let (values, fold) = (&mut self.product[..], z.lines.fold());
            machine.run(Weigh { values, weights: &self.weights, fold });
            if let Some(phases) = &recipe.phases {
                moves(engine, span, phases, &mut self.across);
                machine.run(Move { along: &phases[2], across: &self.across, values });
            }
            z.lines.inverse(machine, values, z.halved);
            if let Some(middle) = deep.plain {
                put(machine, z, values, &mut rows[middle * z.n..][..z.n], span.start);
            }
            if let Some(middle) = deep.along {
                let term = Term { source: 0, axis: Some(1), sign: 1.0 };
                factors(engine, span, &term, &mut self.across);
                let filled = z.filled() * width;
                machine.run(Turn { across: &self.across, values: &mut values[..filled] });
                put(machine, z, values, &mut rows[middle * z.n..][..z.n], span.start);
            }
        }
    }
}

/// Lines of the second direction, from where they are stored to padded rows.
fn forward<T: Real>(
    machine: &Machine,
    y: &Axis<T>,
    from: &[&mut [T]],
    to: &mut [&mut [T]],
    values: &mut [T],
) {
    let width = 2 * machine.lanes();
    let mut lines = [&[][..]; MOST];
    lines.iter_mut().zip(from).for_each(|(line, from)| *line = from);
    let lines = &lines[..from.len()];
    machine.run(FromLines { lines, count: y.own(), values: &mut values[..y.filled() * width] });
    y.continue_packs(values, width);
    y.lines.forward(machine, values, y.halved);
    machine.run(ToLines { lines: to, count: y.len, values });
}

/// And back.
fn inverse<T: Real>(
    machine: &Machine,
    y: &Axis<T>,
    from: &[&mut [T]],
    to: &mut [&mut [T]],
    values: &mut [T],
) {
    let mut lines = [&[][..]; MOST];
    lines.iter_mut().zip(from).for_each(|(line, from)| *line = from);
    machine.run(FromLines { lines: &lines[..from.len()], count: y.len, values });
    y.lines.inverse(machine, values, y.halved);
    let once = y.n.min(y.len);
    machine.run(ToLines { lines: to, count: once, values });
    // Beyond a period the values begin again.
    for line in to {
        line.copy_within(..2 * (y.n - once), 2 * once);
    }
}

/// Columns back to rows; beyond a period they begin again.
fn put<T: Real>(machine: &Machine, z: &Axis<T>, values: &[T], rows: &mut [&mut [T]], at: usize) {
    let (rows, again) = rows.split_at_mut(z.len.min(z.n));
    machine.run(ToColumns { rows, at, values });
    machine.run(ToColumns { rows: again, at, values });
}

/// The factor of a term for each line.
fn factors<T: Real>(engine: &Engine<T>, span: Span, term: &Term, across: &mut [T]) {
    let [x, y, _] = &engine.axes;
    for (factor, &column) in across.iter_mut().zip(engine.machine.columns()) {
        let place = span.place(engine, column);
        let wave = match (term.axis, place) {
            (Some(0), Some([place, _])) => x.wave[place],
            (Some(1), Some([_, place])) => y.wave_at[place],
            (_, Some(_)) => T::one(),
            (_, None) => T::zero(),
        };
        *factor = T::rounded(term.sign) * wave;
    }
}

/// What moves each line, real parts before imaginary ones.
fn moves<T: Real>(engine: &Engine<T>, span: Span, phases: &[Vec<[T; 2]>; 3], across: &mut [T]) {
    let (re, im) = across.split_at_mut(engine.machine.lanes());
    for ((re, im), &column) in re.iter_mut().zip(im).zip(engine.machine.columns()) {
        let Some([i, j]) = span.place(engine, column) else { continue };
        let ([a, b], [c, d]) = (phases[0][i], phases[1][j]);
        (*re, *im) = (a * c - b * d, a * d + b * c);
    }
}

/// Ĝ, or the estimate of its error, for each line.
fn weights<T: Real>(engine: &Engine<T>, span: Span, deep: &Deep, weights: &mut [T]) {
    let [_, y, z] = &engine.axes;
    let (lanes, half, columns) = (engine.machine.lanes(), z.half(), engine.machine.columns());
    if let (true, Some(estimate)) = (deep.estimate, &engine.estimate) {
        for (lane, &column) in columns.iter().enumerate() {
            let Some([i, j]) = span.place(engine, column) else { continue };
            let line = estimate.line([i, y.lines.fold()[j] as usize]);
            weights.iter_mut().skip(lane).step_by(lanes).zip(line).for_each(|(w, value)| *w = value);
        }
        return;
    }
    // Between rows there is nothing but zeros: any weights do.
    let mut lines = [&engine.kernel[..half]; MOST];
    for (line, &column) in lines.iter_mut().zip(columns) {
        let Some([i, j]) = span.place(engine, column) else { continue };
        *line = &engine.kernel[(i * y.half() + y.lines.fold()[j] as usize) * half..][..half];
    }
    engine.machine.run(FromReals {
        lines: &lines[..lanes],
        count: half,
        values: weights,
        first: 0,
        stride: 1,
    });
}
