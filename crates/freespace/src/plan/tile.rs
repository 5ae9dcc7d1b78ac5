//! A few planes of the first direction's spectrum, on their way through the other two directions and back.

use super::aligned::Aligned;
use super::engine::Engine;
use super::output::Term;
use super::real::Real;
use super::recipe::{Deep, Middle, Recipe};
use crate::fft::{Accumulate, Factor, FromColumns, Move, ToColumns, Turn, Weigh};

/// Scratch of one thread.
pub(super) struct Tile<T> {
    /// For each source or array of the recipe, packs of columns: lines of the third direction.
    arrays: Vec<Aligned<T>>,
    /// Lines of the second direction.
    lines: Aligned<T>,
    /// For each source, a pack of columns.
    columns: Vec<Aligned<T>>,
    /// A pack of columns of an output.
    product: Aligned<T>,
    /// What columns are multiplied by, up to the Nyquist frequency.
    weights: Aligned<T>,
    /// Factors of the columns.
    across: Aligned<T>,
}

/// A pack of columns: its plane, and its place among the packs.
#[derive(Clone, Copy)]
struct Place {
    plane: usize,
    pack: usize,
}

impl Place {
    /// The wave numbers in the first two directions of each column; none for columns that there are not.
    fn waves<T: Real>(self, engine: &Engine<T>) -> impl Iterator<Item = Option<[usize; 2]>> {
        let flat = engine.is_flat();
        let of = move |k: usize| if flat { [k, 0] } else { [self.plane, k] };
        engine.packs.waves(self.pack).iter().map(move |wave| wave.map(of))
    }
}

impl<T: Real> Tile<T> {
    pub(super) fn new(engine: &Engine<T>, sources: usize, recipe: &Recipe<T>) -> Self {
        let [_, y, z] = &engine.axes;
        let (zeros, lanes) = (Aligned::zeros, engine.machine.lanes());
        let packs = if engine.is_flat() { 1 } else { engine.packs.len() };
        Self {
            arrays: (0..sources.max(recipe.middle)).map(|_| zeros(packs * engine.column())).collect(),
            lines: zeros(2 * lanes * (y.len + 1)),
            columns: (0..sources).map(|_| zeros(2 * lanes * z.len)).collect(),
            product: zeros(2 * lanes * z.len),
            weights: zeros(lanes * z.half()),
            across: zeros(2 * lanes),
        }
    }

    /// Works on one or some planes from `plane` on; `parts` has for each source or array of the recipe, and for each slab, what
    /// these planes have in it.
    pub(super) fn convolve(
        &mut self,
        engine: &Engine<T>,
        plane: usize,
        parts: &mut [&mut [T]],
        recipe: &Recipe<T>,
    ) {
        let (groups, sources) = (engine.groups(), self.columns.len());
        let mut arrays = std::mem::take(&mut self.arrays);
        if engine.is_flat() {
            self.packs(engine, plane, parts, &mut arrays, recipe);
            self.arrays = arrays;
            return;
        }
        let (y, machine, pitch) = (&engine.axes[1], &engine.machine, engine.column());
        let (line, group) = (2 * machine.lanes() * y.n, 2 * machine.lanes() * machine.lanes());
        let (places, beyond) = (engine.packs.places(), 2 * machine.lanes() * y.len);
        for (parts, columns) in parts.chunks(groups).take(sources).zip(&mut arrays) {
            for (index, part) in parts.iter().enumerate() {
                y.forward(machine, &part[..line], &mut self.lines[..beyond]);
                let (values, at) = (&self.lines[..], index * group);
                machine.run(ToColumns { values, places, columns, pitch, at });
            }
        }
        for pack in 0..engine.packs.len() {
            let mut columns: Vec<&mut [T]> =
                arrays.iter_mut().map(|array| &mut array[pack * pitch..][..pitch]).collect();
            self.columns(engine, Place { plane, pack }, &mut columns, recipe);
        }
        for (parts, columns) in parts.chunks_mut(groups).take(recipe.middle).zip(&arrays) {
            for (index, part) in parts.iter_mut().enumerate() {
                let (values, at) = (&mut self.lines[..], index * group);
                machine.run(FromColumns { columns, places, pitch, at, values });
                y.inverse(machine, &mut self.lines[..beyond], &mut part[..line]);
            }
        }
        self.arrays = arrays;
    }

    /// Some packs of columns where there is no second direction, from `first` on; they are in pieces, one for each group of lines of the
    /// first direction.
    fn packs(
        &mut self,
        engine: &Engine<T>,
        first: usize,
        parts: &mut [&mut [T]],
        arrays: &mut [Aligned<T>],
        recipe: &Recipe<T>,
    ) {
        let (groups, row, sources) = (engine.groups(), engine.row(), self.columns.len());
        let count = parts.first().map_or(0, |part| part.len() / row);
        for pack in 0..count {
            for (parts, columns) in parts.chunks(groups).take(sources).zip(arrays.iter_mut()) {
                for (part, piece) in parts.iter().zip(columns.chunks_exact_mut(row)) {
                    piece.copy_from_slice(&part[pack * row..][..row]);
                }
            }
            let mut columns: Vec<&mut [T]> = arrays.iter_mut().map(|array| &mut array[..]).collect();
            self.columns(engine, Place { plane: 0, pack: first + pack }, &mut columns, recipe);
            for (parts, columns) in parts.chunks_mut(groups).take(recipe.middle).zip(arrays.iter()) {
                for (part, piece) in parts.iter_mut().zip(columns.chunks_exact(row)) {
                    part[pack * row..][..row].copy_from_slice(piece);
                }
            }
        }
    }

    /// Transforms, multiplies and transforms back a pack of columns of each source, to one of each array.
    fn columns(&mut self, engine: &Engine<T>, place: Place, arrays: &mut [&mut [T]], recipe: &Recipe<T>) {
        let (machine, z) = (&engine.machine, &engine.axes[2]);
        let line = 2 * machine.lanes() * z.n;
        if let (Some(deep), 1, [column, ..]) = (recipe.alone(), self.columns.len(), &mut *arrays) {
            let weights = weights(engine, place, deep, &mut self.weights);
            return z.convolve(machine, &mut column[..line], &mut self.product, weights);
        }
        for (array, columns) in arrays.iter().zip(&mut self.columns) {
            z.forward(machine, &array[..line], columns);
        }
        for deep in &recipe.deep {
            for (index, term) in deep.terms.iter().enumerate() {
                factors(engine, place, term, &mut self.across);
                let along = (term.axis == Some(2)).then_some(&z.wave_at[..]);
                let factor = Factor { along, across: &self.across, turned: term.axis.is_some() };
                let source = &self.columns[term.source];
                machine.run(Accumulate { source, factor, add: index > 0, values: &mut self.product });
            }
            let weights = weights(engine, place, deep, &mut self.weights);
            let (values, fold) = (&mut self.product[..], z.lines.fold());
            machine.run(Weigh { values, weights, fold });
            if let Some(along) = recipe.phases(2, deep.shift) {
                machine.run(Move { along, values });
            }
            let [first, others @ ..] = &deep.middle[..] else { continue };
            z.inverse(machine, values, &mut arrays[first.array][..line]);
            for other in others {
                if let Ok([from, to]) = arrays.get_disjoint_mut([first.array, other.array]) {
                    to[..line].copy_from_slice(&from[..line]);
                }
            }
            for middle in deep.middle.iter().filter(|m| m.along || m.shift.is_some()) {
                turns(engine, place, middle, recipe, &mut self.across);
                machine.run(Turn { across: &self.across, values: &mut arrays[middle.array][..line] });
            }
        }
    }
}

/// The factor of a term for each column.
fn factors<T: Real>(engine: &Engine<T>, place: Place, term: &Term, across: &mut [T]) {
    let [x, y, _] = &engine.axes;
    for (factor, waves) in across.iter_mut().zip(place.waves(engine)) {
        let wave = match (term.axis, waves) {
            (Some(0), Some([wave, _])) => x.wave[wave],
            (Some(1), Some([_, wave])) => y.wave[wave],
            (_, Some(_)) => T::one(),
            (_, None) => T::zero(),
        };
        *factor = T::rounded(term.sign) * wave;
    }
}

/// What each column is multiplied by in the second direction, real parts before imaginary ones.
fn turns<T: Real>(engine: &Engine<T>, place: Place, middle: &Middle, recipe: &Recipe<T>, across: &mut [T]) {
    let (y, phases) = (&engine.axes[1], recipe.phases(1, middle.shift));
    let (re, im) = across.split_at_mut(engine.machine.lanes());
    for ((re, im), waves) in re.iter_mut().zip(im).zip(place.waves(engine)) {
        let Some([_, j]) = waves else { continue };
        let [a, b] = phases.map_or([T::one(), T::zero()], |phases| phases[j]);
        (*re, *im) = if middle.along { (T::zero() - y.wave[j] * b, y.wave[j] * a) } else { (a, b) };
    }
}

/// Ĝ for each column, or the estimate of its error, for which there is `scratch`.
fn weights<'a, T: Real>(
    engine: &'a Engine<T>,
    place: Place,
    deep: &Deep,
    scratch: &'a mut Aligned<T>,
) -> &'a [T] {
    let (true, Some(estimate)) = (deep.estimate, &engine.estimate) else {
        return engine.weights(place.plane, place.pack);
    };
    let (lanes, y) = (engine.machine.lanes(), &engine.axes[1]);
    for (lane, waves) in place.waves(engine).enumerate() {
        let Some([i, j]) = waves else { continue };
        let line = estimate.line([i, j.min(y.len - j)]);
        scratch.iter_mut().skip(lane).step_by(lanes).zip(line).for_each(|(w, value)| *w = value);
    }
    scratch
}
