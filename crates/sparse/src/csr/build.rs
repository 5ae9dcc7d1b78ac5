//! Building a matrix row by row, in parallel, straight into compressed rows.

use super::Csr;
use crate::error::MatrixError;
use crate::parallel;

/// Rows that one task builds into buffers of its own before they are joined.
const ROWS_PER_BLOCK: usize = 1024;

/// Collects the entries of one row in any order; repeated columns are added in the order of the pushes.
#[derive(Debug, Default)]
pub struct RowBuilder {
    entries: Vec<(u32, f64)>,
    /// A column that does not fit into 32 bits; reported when the row is finished.
    too_large: Option<usize>,
    row_sum: f64,
}

impl RowBuilder {
    /// Adds `value` to the entry in `column`.
    #[inline]
    pub fn push(&mut self, column: usize, value: f64) {
        match u32::try_from(column) {
            Ok(column) => self.entries.push((column, value)),
            Err(_) => self.too_large = Some(column),
        }
    }

    /// Adds `value` to the sum of the row. Means something in difference form only
    /// ([`DifferenceMatrix`](crate::DifferenceMatrix)); a plain [`Csr`] ignores it.
    #[inline]
    pub fn add_to_row_sum(&mut self, value: f64) {
        self.row_sum += value;
    }

    pub(crate) fn drop_column(&mut self, column: usize) {
        self.entries.retain(|e| e.0 as usize != column);
    }

    /// Forgets what was pushed.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.too_large = None;
        self.row_sum = 0.0;
    }

    /// Sorts, merges, checks and appends the row to the block.
    fn finish(&mut self, row: usize, ncols: usize, block: &mut Block) -> Result<(), MatrixError> {
        self.entries.sort_by_key(|e| e.0);
        let last = self.entries.last().map_or(0, |e| e.0 as usize);
        if let Some(column) = self.too_large.or((last >= ncols && !self.entries.is_empty()).then_some(last)) {
            return Err(MatrixError::ColumnOutOfRange { row, column, ncols });
        }
        let start = block.indices.len();
        for &(column, value) in &self.entries {
            if block.indices.len() > start && block.indices.last() == Some(&column) {
                let end = block.values.len() - 1;
                block.values[end] += value;
            } else {
                block.indices.push(column);
                block.values.push(value);
            }
        }
        if let Some(k) = (start..block.values.len()).find(|&k| !block.values[k].is_finite()) {
            let (column, value) = (block.indices[k] as usize, block.values[k]);
            return Err(MatrixError::NotFinite { row, column, value });
        }
        if !self.row_sum.is_finite() {
            return Err(MatrixError::NotFinite { row, column: row, value: self.row_sum });
        }
        block.lengths.push(block.indices.len() - start);
        block.row_sums.push(self.row_sum);
        Ok(())
    }
}

#[derive(Default)]
struct Block {
    lengths: Vec<usize>,
    indices: Vec<u32>,
    values: Vec<f64>,
    row_sums: Vec<f64>,
}

/// Builds `nrows` rows in parallel and gives the matrix and the row sums. `scratch` makes what one task needs;
/// of several errors the one of the lowest row is returned, whatever the number of threads.
pub(crate) fn build_rows<S: Send, E: From<MatrixError> + Send>(
    nrows: usize,
    ncols: usize,
    scratch: impl Fn() -> S + Sync,
    fill: impl Fn(&mut S, usize, &mut RowBuilder) -> Result<(), E> + Sync,
) -> Result<(Csr, Vec<f64>), E> {
    if ncols.max(nrows) > u32::MAX as usize {
        return Err(MatrixError::TooLarge { size: ncols.max(nrows) }.into());
    }
    let build_block = |state: &mut (S, RowBuilder), b: usize| -> Result<Block, E> {
        let mut block = Block::default();
        for row in b * ROWS_PER_BLOCK..nrows.min((b + 1) * ROWS_PER_BLOCK) {
            state.1.clear();
            fill(&mut state.0, row, &mut state.1)?;
            state.1.finish(row, ncols, &mut block)?;
        }
        Ok(block)
    };
    let blocks: Vec<Result<Block, E>> = parallel::map_with(
        nrows.div_ceil(ROWS_PER_BLOCK),
        || (scratch(), RowBuilder::default()),
        build_block,
    );
    let blocks = blocks.into_iter().collect::<Result<Vec<_>, E>>()?;
    Ok(join(nrows, ncols, &blocks))
}

fn join(nrows: usize, ncols: usize, blocks: &[Block]) -> (Csr, Vec<f64>) {
    let row_sums = blocks.iter().flat_map(|b| b.row_sums.iter().copied()).collect();
    let parts = blocks.iter().map(|b| (&b.lengths[..], &b.indices[..], &b.values[..])).collect();
    (joined(nrows, ncols, parts), row_sums)
}

/// The matrix that blocks of rows, each with its lengths of rows, its columns and its values, make up. Copies in parallel.
pub(crate) fn joined(nrows: usize, ncols: usize, parts: Vec<(&[usize], &[u32], &[f64])>) -> Csr {
    let nnz = parts.iter().map(|p| p.1.len()).sum();
    let mut offsets = Vec::with_capacity(nrows + 1);
    let mut end = 0;
    offsets.push(0);
    for (lengths, _, _) in &parts {
        offsets.extend(lengths.iter().map(|length| {
            end += length;
            end
        }));
    }
    let (mut indices, mut values) = (vec![0; nnz], vec![0.0; nnz]);
    let mut places = Vec::with_capacity(parts.len());
    let (mut rest_indices, mut rest_values) = (&mut indices[..], &mut values[..]);
    for (_, columns, row) in parts {
        let (own_indices, others) = rest_indices.split_at_mut(columns.len());
        rest_indices = others;
        let (own_values, others) = rest_values.split_at_mut(row.len());
        rest_values = others;
        places.push((own_indices, columns, own_values, row));
    }
    parallel::for_each_task(
        places,
        |(own_indices, columns, own_values, row): (&mut [u32], &[u32], &mut [f64], &[f64])| {
            own_indices.copy_from_slice(columns);
            own_values.copy_from_slice(row);
        },
    );
    Csr::from_trusted(ncols, offsets, indices, values)
}

impl Csr {
    /// Builds a matrix in parallel: `fill(i, row)` pushes the entries of row `i`, in any order; repeated columns
    /// add up in the order of the pushes.
    ///
    /// # Errors
    /// A column that is not below `ncols`, or a value that is not finite, with its row.
    pub fn from_rows(
        nrows: usize,
        ncols: usize,
        fill: impl Fn(usize, &mut RowBuilder) + Sync,
    ) -> Result<Self, MatrixError> {
        Self::try_from_rows(
            nrows,
            ncols,
            || (),
            |(), i, row| {
                fill(i, row);
                Ok(())
            },
        )
    }

    /// Like [`Csr::from_rows`], with a closure that may fail and scratch for each task, which is made by `scratch`
    /// a few times per thread and not per row.
    ///
    /// # Errors
    /// Those of the closure and those of [`Csr::from_rows`]; of several, the one of the lowest row.
    pub fn try_from_rows<S: Send, E: From<MatrixError> + Send>(
        nrows: usize,
        ncols: usize,
        scratch: impl Fn() -> S + Sync,
        fill: impl Fn(&mut S, usize, &mut RowBuilder) -> Result<(), E> + Sync,
    ) -> Result<Self, E> {
        build_rows(nrows, ncols, scratch, fill).map(|(matrix, _)| matrix)
    }

    /// A matrix from triplets (row, column, value) in any order; repeated places add up in the order given. Building by rows
    /// takes less memory.
    ///
    /// # Errors
    /// A row or column out of range, or a value that is not finite.
    pub fn from_triplets(
        nrows: usize,
        ncols: usize,
        triplets: &[(usize, usize, f64)],
    ) -> Result<Self, MatrixError> {
        let mut ends = vec![0; nrows];
        for &(row, _, _) in triplets {
            *ends.get_mut(row).ok_or(MatrixError::RowOutOfRange { row, nrows })? += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum - *end;
        }
        // Ends are starts until all entries have their places.
        let mut sorted = vec![(0, 0.0); triplets.len()];
        for &(row, column, value) in triplets {
            sorted[ends[row]] = (column, value);
            ends[row] += 1;
        }
        Self::from_rows(nrows, ncols, |i, row| {
            let start = if i == 0 { 0 } else { ends[i - 1] };
            sorted[start..ends[i]].iter().for_each(|&(column, value)| row.push(column, value));
        })
    }
}
