//! Incomplete factors without fill, ILU(0) (Meijerink and van der Vorst 1977; Saad, "Iterative methods for sparse
//! linear systems", algorithm 10.4).

use super::factors::{IncompleteLu, safe_reciprocal};
use crate::csr::Csr;
use crate::error::MatrixError;

/// Not a place of the row at hand.
const ABSENT: u32 = u32::MAX;

/// Factors on the pattern of the matrix, with the diagonal added where it is missing. Pivots that are almost zero
/// are replaced and counted.
///
/// # Errors
/// [`MatrixError::NotSquare`], and [`MatrixError::TooLarge`] for 2^32 or more entries in a row.
pub fn ilu0(matrix: &Csr) -> Result<IncompleteLu, MatrixError> {
    matrix.require_square()?;
    let n = matrix.nrows();
    let mut lu = with_diagonal(matrix);
    let mut place = vec![ABSENT; n];
    for i in 0..n {
        let (start, end, diagonal) = (lu.offsets[i], lu.offsets[i + 1], lu.diagonal[i]);
        let (done, row) = lu.values.split_at_mut(start);
        let row = &mut row[..end - start];
        let row_max = row.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (k, &j) in lu.indices[start..end].iter().enumerate() {
            place[j as usize] = k as u32;
        }
        for k in 0..diagonal - start {
            let pivot_row = lu.indices[start + k] as usize;
            let multiplier = row[k] * done[lu.diagonal[pivot_row]];
            row[k] = multiplier;
            let upper = lu.diagonal[pivot_row] + 1..lu.offsets[pivot_row + 1];
            for (&j, u) in lu.indices[upper.clone()].iter().zip(&done[upper]) {
                let target = place[j as usize];
                if target != ABSENT {
                    row[target as usize] -= multiplier * u;
                }
            }
        }
        let (reciprocal, replaced) = safe_reciprocal(row[diagonal - start], row_max);
        row[diagonal - start] = reciprocal;
        lu.replaced += usize::from(replaced);
        for &j in &lu.indices[start..end] {
            place[j as usize] = ABSENT;
        }
    }
    Ok(lu)
}

/// Copies the matrix and inserts missing diagonal entries as zeros.
fn with_diagonal(matrix: &Csr) -> IncompleteLu {
    let n = matrix.nrows();
    let mut lu = IncompleteLu {
        name: "ILU(0)".to_owned(),
        offsets: Vec::with_capacity(n + 1),
        diagonal: Vec::with_capacity(n),
        indices: Vec::with_capacity(matrix.nnz()),
        values: Vec::with_capacity(matrix.nnz()),
        replaced: 0,
    };
    lu.offsets.push(0);
    for i in 0..n {
        let (columns, values) = matrix.row(i);
        let below = columns.partition_point(|&j| (j as usize) < i);
        let has_diagonal = columns.get(below) == Some(&(i as u32));
        lu.diagonal.push(lu.indices.len() + below);
        lu.indices.extend_from_slice(&columns[..below]);
        lu.values.extend_from_slice(&values[..below]);
        if !has_diagonal {
            lu.indices.push(i as u32);
            lu.values.push(0.0);
        }
        lu.indices.extend_from_slice(&columns[below..]);
        lu.values.extend_from_slice(&values[below..]);
        lu.offsets.push(lu.indices.len());
    }
    lu
}
