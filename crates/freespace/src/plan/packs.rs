//! Which columns are transformed together, and what they are multiplied by.

/// Columns in packs, a lane for each. They run along the third direction and belong to wave numbers of the direction before it.
#[derive(Debug)]
pub(super) struct Packs {
    lanes: usize,
    /// Length of the transform whose wave numbers are opposites of each other; none if very large.
    period: usize,
    /// The wave number of each lane of each pack; none where a pack is not full.
    waves: Vec<Option<usize>>,
    /// The block of Ĝ that belongs to each pack.
    blocks: Vec<usize>,
    /// Its place in a transform; one beyond all for none.
    places: Vec<u32>,
}

impl Packs {
    /// Packs of the first `half` wave numbers.
    pub(super) fn of_half(half: usize, lanes: usize) -> Self {
        let count = half.div_ceil(lanes);
        let waves: Vec<Option<usize>> = (0..count * lanes).map(|k| (k < half).then_some(k)).collect();
        Self { lanes, period: usize::MAX, blocks: (0..count).collect(), places: Vec::new(), waves }
    }

    /// Packs of all wave numbers of a transform of length `len`. Ĝ is even: where a pack has the opposites of the wave numbers of another
    /// one, both are multiplied by the same block.
    pub(super) fn of_all(len: usize, lanes: usize) -> Self {
        let pairs: Vec<usize> = (1..len.div_ceil(2)).collect();
        let (mut waves, mut blocks) = (Vec::new(), Vec::new());
        let whole = pairs.chunks_exact(lanes);
        let mut rest: Vec<usize> = whole.remainder().iter().flat_map(|k| [*k, len - k]).collect();
        for (block, chunk) in whole.enumerate() {
            waves.extend(chunk.iter().map(|k| Some(*k)));
            waves.extend(chunk.iter().map(|k| Some(len - k)));
            blocks.extend([block; 2]);
        }
        rest.push(0);
        rest.extend(len.is_multiple_of(2).then_some(len / 2));
        for chunk in rest.chunks(lanes) {
            blocks.push(blocks.last().map_or(0, |b| b + 1));
            waves.extend((0..lanes).map(|lane| chunk.get(lane).copied()));
        }
        Self { lanes, period: len, blocks, places: Vec::new(), waves }
    }

    /// With the places of wave numbers; of those that are none, `beyond`.
    pub(super) fn at(mut self, place: impl Fn(usize) -> usize, beyond: usize) -> Self {
        self.places = self.waves.iter().map(|wave| wave.map_or(beyond, &place) as u32).collect();
        self
    }

    /// Columns of a pack.
    pub(super) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Number of packs.
    pub(super) fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Places of the columns of all packs.
    pub(super) fn places(&self) -> &[u32] {
        &self.places
    }

    /// The wave numbers of a pack.
    pub(super) fn waves(&self, pack: usize) -> &[Option<usize>] {
        &self.waves[pack * self.lanes..][..self.lanes]
    }

    /// Their magnitudes.
    pub(super) fn magnitudes(&self, pack: usize) -> impl Iterator<Item = Option<usize>> {
        self.waves(pack).iter().map(|wave| wave.map(|k| k.min(self.period - k)))
    }

    /// The block of Ĝ of a pack.
    pub(super) fn block(&self, pack: usize) -> usize {
        self.blocks[pack]
    }

    /// Number of blocks.
    pub(super) fn blocks(&self) -> usize {
        self.blocks.last().map_or(0, |last| last + 1)
    }

    /// For each block, a pack that it belongs to.
    pub(super) fn of_blocks(&self) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(|&pack| pack == 0 || self.blocks[pack] != self.blocks[pack - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::Packs;

    #[test]
    fn every_wave_number_is_in_one_pack() {
        for lanes in [1, 2, 4, 8] {
            for len in 1..70 {
                for packs in [Packs::of_all(len, lanes), Packs::of_half(len, lanes)] {
                    let mut waves: Vec<usize> = packs.waves.iter().flatten().copied().collect();
                    waves.sort_unstable();
                    assert!(waves.into_iter().eq(0..len), "{lanes} {len}");
                    assert_eq!(packs.waves.len(), packs.len() * lanes);
                }
            }
        }
        assert_eq!(Packs::of_all(256, 4).len(), 64);
        assert_eq!(Packs::of_all(256, 4).of_blocks().count(), 33);
    }

    #[test]
    fn packs_of_a_block_have_the_same_magnitudes() {
        let packs = Packs::of_all(90, 4);
        let fold = |pack: usize| packs.magnitudes(pack).collect::<Vec<_>>();
        for pack in 1..packs.len() {
            assert_eq!(packs.block(pack) == packs.block(pack - 1), fold(pack) == fold(pack - 1), "{pack}");
        }
    }
}
