//! Between rows, of which a line takes one number each, and lines that lie in one piece to be transformed.
//!
//! Four lines at a time: a cache line of `f64` complex numbers from each row, one stream of reads and four of writes or the
//! other way round.

use std::ops::{Deref, DerefMut};

use rustfft::num_complex::Complex;

use super::real::Real;

/// Bytes of a cache line.
const CACHE_LINE: usize = 64;

/// An array that begins where a cache line does: numbers that are moved or worked on together would lie on two of them else.
#[derive(Debug)]
pub(super) struct Aligned<V> {
    values: Vec<V>,
    skip: usize,
}

impl<V> Default for Aligned<V> {
    fn default() -> Self {
        Self { values: Vec::new(), skip: 0 }
    }
}

impl<V: Copy + Default> Aligned<V> {
    pub(super) fn zeros(n: usize) -> Self {
        let more = CACHE_LINE / size_of::<V>().max(1);
        let values = vec![V::default(); n + more];
        // Where the machine does not say, anywhere.
        let skip = values.as_ptr().align_offset(CACHE_LINE).min(more);
        let mut values = values;
        values.truncate(skip + n);
        Self { values, skip }
    }
}

impl<V> Deref for Aligned<V> {
    type Target = [V];
    fn deref(&self) -> &[V] {
        &self.values[self.skip..]
    }
}

impl<V> DerefMut for Aligned<V> {
    fn deref_mut(&mut self) -> &mut [V] {
        &mut self.values[self.skip..]
    }
}

/// Lines that are moved at once.
pub(super) const GROUP: usize = 4;

/// Numbers between two lines, and between two rows: without them, places whose distance is a power of two would all fall on
/// the same few lines of the cache.
const GAP: usize = 4;

/// From one line or row of `n` numbers to the next; whole groups of lines fit into a row.
pub(super) fn pitch(n: usize) -> usize {
    if n > 1 { n.next_multiple_of(GROUP) + GAP } else { n }
}

/// Copies up to four columns of `rows`, from `at` on, to lines that are `stride` apart.
pub(super) fn gather<'a, T: Real>(
    rows: impl Iterator<Item = &'a [Complex<T>]>,
    at: usize,
    lines: &mut [Complex<T>],
    stride: usize,
) {
    let mut lines = lines.chunks_exact_mut(stride);
    let (Some(a), Some(b), Some(c), Some(d)) = (lines.next(), lines.next(), lines.next(), lines.next())
    else {
        return;
    };
    let places = a.iter_mut().zip(b).zip(c).zip(d);
    for (row, (((a, b), c), d)) in rows.zip(places) {
        match row[at..].first_chunk::<GROUP>() {
            Some(&[p, q, r, s]) => (*a, *b, *c, *d) = (p, q, r, s),
            // The last columns of rows without a gap.
            None => [a, b, c].into_iter().zip(&row[at..]).for_each(|(to, from)| *to = *from),
        }
    }
}

/// Copies up to four lines back.
pub(super) fn scatter<'a, T: Real>(
    lines: &[Complex<T>],
    stride: usize,
    rows: impl Iterator<Item = &'a mut [Complex<T>]>,
    at: usize,
) {
    let mut lines = lines.chunks_exact(stride);
    let (Some(a), Some(b), Some(c), Some(d)) = (lines.next(), lines.next(), lines.next(), lines.next())
    else {
        return;
    };
    let places = a.iter().zip(b).zip(c).zip(d);
    for (row, (((a, b), c), d)) in rows.zip(places) {
        match row[at..].first_chunk_mut::<GROUP>() {
            Some(to) => *to = [*a, *b, *c, *d],
            None => row[at..].iter_mut().zip([a, b, c]).for_each(|(to, from)| *to = *from),
        }
    }
}

#[cfg(test)]
mod tests {
    use rustfft::num_complex::Complex;

    use super::{GROUP, gather, pitch, scatter};

    #[test]
    fn there_and_back_is_nothing_and_no_other_place_is_touched() {
        let (width, height) = (6, 5);
        let before: Vec<Complex<f64>> =
            (0..width * height).map(|i| Complex::new(i as f64, -(i as f64))).collect();
        let stride = pitch(height);
        for at in [0, 2, 4] {
            let mut lines = vec![Complex::default(); GROUP * stride];
            gather(before.chunks_exact(width), at, &mut lines, stride);
            for column in 0..GROUP.min(width - at) {
                assert!((0..height).all(|j| lines[column * stride + j] == before[j * width + at + column]));
            }
            let mut after = vec![Complex::new(-1.0, 0.0); width * height];
            scatter(&lines, stride, after.chunks_exact_mut(width), at);
            for (place, value) in after.iter().enumerate() {
                let moved = (at..at + GROUP).contains(&(place % width));
                assert_eq!(*value, if moved { before[place] } else { Complex::new(-1.0, 0.0) });
            }
        }
    }
}
