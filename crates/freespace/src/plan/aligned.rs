//! Arrays that suit the cache.

use std::ops::{Deref, DerefMut};

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
