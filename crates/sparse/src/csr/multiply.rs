//! Products of sparse matrices (Gustavson, ACM Trans. Math. Softw. 4, 1978), in parallel over blocks of rows.

use super::Csr;
use super::build::joined;
use crate::error::MatrixError;
use crate::parallel;

/// Rows of the product that one task computes into buffers of its own.
const ROWS_PER_BLOCK: usize = 4096;

/// Not a place of the row at hand.
const ABSENT: u32 = u32::MAX;

/// Where the columns of a row stand in it, for one task.
pub(crate) struct Places {
    place: Vec<u32>,
}

impl Places {
    pub(crate) fn new(ncols: usize) -> Self {
        Self { place: vec![ABSENT; ncols] }
    }
}

/// Rows of a matrix that one task has computed.
#[derive(Default)]
pub(crate) struct RowBlock {
    lengths: Vec<usize>,
    indices: Vec<u32>,
    values: Vec<f64>,
    order: Vec<(u32, f64)>,
    start: usize,
}

impl RowBlock {
    /// Adds to an entry of the row that is being computed.
    #[inline]
    pub(crate) fn add(&mut self, places: &mut Places, column: u32, value: f64) {
        let place = &mut places.place[column as usize];
        if *place == ABSENT {
            *place = (self.indices.len() - self.start) as u32;
            self.indices.push(column);
            self.values.push(value);
        } else {
            self.values[self.start + *place as usize] += value;
        }
    }

    /// Moves entries of the row below `least` to the one in column `own`.
    pub(crate) fn lump(&mut self, places: &mut Places, own: u32, least: f64) {
        let mut k = self.start;
        while k < self.indices.len() {
            let (column, value) = (self.indices[k], self.values[k]);
            if column == own || value.abs() >= least {
                k += 1;
                continue;
            }
            self.indices.swap_remove(k);
            self.values.swap_remove(k);
            places.place[column as usize] = ABSENT;
            if let Some(&moved) = self.indices.get(k) {
                places.place[moved as usize] = (k - self.start) as u32;
            }
            self.add(places, own, value);
        }
    }

    /// Ends the row.
    fn finish(&mut self, places: &mut Places) {
        let (start, end) = (self.start, self.indices.len());
        self.indices[start..end].iter().for_each(|&j| places.place[j as usize] = ABSENT);
        self.lengths.push(end - start);
        self.start = end;
    }

    /// Ends the row: sorts its columns.
    fn finish_sorted(&mut self, places: &mut Places) {
        let start = self.start;
        self.finish(places);
        let (columns, values) = (&mut self.indices[start..], &mut self.values[start..]);
        if columns.is_sorted() {
            return;
        }
        self.order.clear();
        self.order.extend(columns.iter().copied().zip(values.iter().copied()));
        self.order.sort_unstable_by_key(|e| e.0);
        for ((column, value), sorted) in columns.iter_mut().zip(values).zip(&self.order) {
            (*column, *value) = *sorted;
        }
    }
}

/// Adds the entries of a row.
type Fill<'a> = dyn Fn(usize, &mut Places, &mut RowBlock) + Sync + 'a;

fn blocks(nrows: usize, ncols: usize, fill: &Fill<'_>, end: fn(&mut RowBlock, &mut Places)) -> Vec<RowBlock> {
    parallel::map_with(
        nrows.div_ceil(ROWS_PER_BLOCK),
        || Places::new(ncols),
        |places, b| {
            let mut block = RowBlock::default();
            for i in b * ROWS_PER_BLOCK..nrows.min((b + 1) * ROWS_PER_BLOCK) {
                fill(i, places, &mut block);
                end(&mut block, places);
            }
            block.indices.shrink_to_fit();
            block.values.shrink_to_fit();
            block
        },
    )
}

/// Computes the rows of a matrix in parallel; `fill(i, places, block)` adds the entries of row `i`. Values may come out
/// infinite: the caller checks what must be finite.
pub(crate) fn computed_rows(
    nrows: usize,
    ncols: usize,
    fill: impl Fn(usize, &mut Places, &mut RowBlock) + Sync,
) -> Csr {
    let blocks = blocks(nrows, ncols, &fill, RowBlock::finish_sorted);
    let parts = blocks.iter().map(|b| (&b.lengths[..], &b.indices[..], &b.values[..])).collect();
    joined(nrows, ncols, parts)
}

/// A matrix that is only a step of a computation: its rows are neither sorted nor in one piece.
pub(crate) struct LooseRows {
    blocks: Vec<RowBlock>,
}

impl LooseRows {
    /// As [`computed_rows`].
    pub(crate) fn new(
        nrows: usize,
        ncols: usize,
        fill: impl Fn(usize, &mut Places, &mut RowBlock) + Sync,
    ) -> Self {
        let mut blocks = blocks(nrows, ncols, &fill, RowBlock::finish);
        // From here on, where the rows end.
        for block in &mut blocks {
            let mut end = 0;
            block.lengths.iter_mut().for_each(|length| {
                end += *length;
                *length = end;
            });
        }
        Self { blocks }
    }

    /// Columns and values of row `i`.
    #[inline]
    pub(crate) fn row(&self, i: usize) -> (&[u32], &[f64]) {
        let (block, k) = (&self.blocks[i / ROWS_PER_BLOCK], i % ROWS_PER_BLOCK);
        let range = if k == 0 { 0 } else { block.lengths[k - 1] }..block.lengths[k];
        (&block.indices[range.clone()], &block.values[range])
    }
}

impl Csr {
    /// The product of this matrix with `other`. Entries of a row are added in the order of this matrix' columns,
    /// whatever the number of threads.
    ///
    /// # Errors
    /// [`MatrixError::Length`] where the columns of this matrix are not as many as the rows of the other, and
    /// [`MatrixError::NotFinite`] where a sum overflows.
    pub fn multiply(&self, other: &Self) -> Result<Self, MatrixError> {
        MatrixError::check_length("rows of the second factor", other.nrows(), self.ncols())?;
        let product = computed_rows(self.nrows(), other.ncols(), |i, places, block| {
            let (columns, values) = self.row(i);
            for (&k, a) in columns.iter().zip(values) {
                let (columns, values) = other.row(k as usize);
                for (&j, b) in columns.iter().zip(values) {
                    block.add(places, j, a * b);
                }
            }
        });
        product.require_finite()?;
        Ok(product)
    }

    /// The first entry that is infinite or not a number, as an error.
    pub(crate) fn require_finite(&self) -> Result<(), MatrixError> {
        let blocks = self.values.chunks(1 << 16);
        let first = |k: usize| -> Option<usize> {
            let at = self.values.iter().skip(k << 16).take(1 << 16).position(|v| !v.is_finite())?;
            Some((k << 16) + at)
        };
        let Some(k) = parallel::map(blocks.len(), first).into_iter().flatten().next() else { return Ok(()) };
        let row = self.offsets.partition_point(|&o| o <= k) - 1;
        Err(MatrixError::NotFinite { row, column: self.indices[k] as usize, value: self.values[k] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_of_two_matrices() {
        let a = Csr::from_triplets(2, 3, &[(0, 0, 1.0), (0, 2, 2.0), (1, 1, 3.0)]).unwrap();
        let b = Csr::from_triplets(3, 2, &[(0, 1, 4.0), (2, 0, 5.0), (2, 1, -2.0), (1, 0, 1.0)]).unwrap();
        let product = a.multiply(&b).unwrap();
        assert_eq!(product.row(0), (&[0, 1][..], &[10.0, 0.0][..]));
        assert_eq!(product.row(1), (&[0][..], &[3.0][..]));
        assert!(matches!(a.multiply(&a), Err(MatrixError::Length { .. })));
    }

    #[test]
    fn small_entries_of_a_row_go_to_one_of_them() {
        let rows = computed_rows(2, 5, |i, places, block| {
            for (column, value) in [(4, 0.01), (2, 0.5), (1, -0.02), (3, 0.3), (0, 0.04)] {
                block.add(places, column, value);
            }
            block.lump(places, 2, if i == 0 { 0.05 } else { 10.0 });
            block.add(places, 3, 1.0);
        });
        assert_eq!(rows.row(0).0, [2, 3]);
        assert!((rows.get(0, 2) - 0.53).abs() < 1e-15 && rows.get(0, 3) == 1.3);
        assert!(rows.row(1).0 == [2, 3] && (rows.get(1, 2) - 0.83).abs() < 1e-15);
    }

    #[test]
    fn an_overflow_is_named() {
        let a = Csr::from_triplets(1, 1, &[(0, 0, 1e200)]).unwrap();
        assert!(matches!(a.multiply(&a), Err(MatrixError::NotFinite { row: 0, column: 0, .. })));
    }
}
