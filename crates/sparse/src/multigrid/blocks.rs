//! Incomplete factors of the diagonal blocks of a matrix.

use crate::csr::{Csr, computed_rows};
use crate::error::MatrixError;
use crate::precond::{IncompleteLu, Preconditioner, ilu0};
use rayon::prelude::*;

/// Rows of a block: enough for what couples blocks to be a small part, few enough for several threads to have blocks. Blocks
/// are of a fixed size, so that results do not depend on the number of threads.
const BLOCK: usize = 16_384;

/// ILU(0) of each diagonal block; what couples blocks is left to the coarse levels.
#[derive(Debug)]
pub(crate) struct BlockIlu {
    blocks: Vec<IncompleteLu>,
}

impl BlockIlu {
    pub(crate) fn new(a: &Csr) -> Result<Self, MatrixError> {
        let n = a.nrows();
        if n <= BLOCK {
            return Ok(Self { blocks: vec![ilu0(a)?] });
        }
        let blocks = (0..n.div_ceil(BLOCK)).into_par_iter().map(|k| ilu0(&diagonal_block(a, k)));
        Ok(Self { blocks: blocks.collect::<Result<_, _>>()? })
    }

    pub(crate) fn bytes(&self) -> usize {
        self.blocks.iter().map(IncompleteLu::bytes).sum()
    }

    /// `z = M^-1 r`
    pub(crate) fn apply(&self, r: &[f64], z: &mut [f64]) {
        z.par_chunks_mut(BLOCK)
            .zip(r.par_chunks(BLOCK))
            .zip(&self.blocks)
            .for_each(|((z, r), block)| block.apply(r, z, &mut []));
    }
}

fn diagonal_block(a: &Csr, k: usize) -> Csr {
    let first = k * BLOCK;
    let rows = (a.nrows() - first).min(BLOCK);
    computed_rows(rows, rows, |i, places, block| {
        let (columns, values) = a.row(first + i);
        for (&j, v) in columns.iter().zip(values) {
            let j = (j as usize).wrapping_sub(first);
            if j < rows {
                block.add(places, j as u32, *v);
            }
        }
    })
}
