//! Products of sparse matrices (Gustavson, ACM Trans. Math. Softw. 4, 1978), in parallel over blocks of rows.

use super::Csr;
use super::build::joined;
use crate::error::MatrixError;
use rayon::prelude::*;

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

    /// Ends the row: sorts its columns.
    pub(crate) fn finish(&mut self, places: &mut Places) {
        let (start, end) = (self.start, self.indices.len());
        self.order.clear();
        for k in start..end {
            places.place[self.indices[k] as usize] = ABSENT;
            self.order.push((self.indices[k], self.values[k]));
        }
        self.order.sort_unstable_by_key(|e| e.0);
        for (k, &(column, value)) in self.order.iter().enumerate() {
            self.indices[start + k] = column;
            self.values[start + k] = value;
        }
        self.lengths.push(end - start);
        self.start = end;
    }
}

/// Computes the rows of a matrix in parallel; `fill(i, places, block)` adds the entries of row `i`. Values may come out
/// infinite: the caller checks what must be finite.
pub(crate) fn computed_rows(
    nrows: usize,
    ncols: usize,
    fill: impl Fn(usize, &mut Places, &mut RowBlock) + Sync,
) -> Csr {
    let blocks: Vec<RowBlock> = (0..nrows.div_ceil(ROWS_PER_BLOCK))
        .into_par_iter()
        .map_init(
            || Places::new(ncols),
            |places, b| {
                let mut block = RowBlock::default();
                for i in b * ROWS_PER_BLOCK..nrows.min((b + 1) * ROWS_PER_BLOCK) {
                    fill(i, places, &mut block);
                    block.finish(places);
                }
                block
            },
        )
        .collect();
    let parts = blocks.iter().map(|b| (&b.lengths[..], &b.indices[..], &b.values[..])).collect();
    joined(nrows, ncols, parts)
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
        let Some(k) = self.values.par_iter().with_min_len(1 << 16).position_first(|v| !v.is_finite()) else {
            return Ok(());
        };
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
    fn an_overflow_is_named() {
        let a = Csr::from_triplets(1, 1, &[(0, 0, 1e200)]).unwrap();
        assert!(matches!(a.multiply(&a), Err(MatrixError::NotFinite { row: 0, column: 0, .. })));
    }
}
