//! Incomplete factors of the diagonal blocks of a matrix.

use crate::csr::{Csr, computed_rows};
use crate::error::MatrixError;
use crate::parallel;
use crate::precond::{IncompleteLu, Preconditioner, ilu0};
use std::ops::Range;

/// Rows of a block: enough for what couples blocks to be a small part, few enough for several threads to have blocks. Blocks
/// are of a fixed size, so that results do not depend on the number of threads.
const BLOCK: usize = 16_384;

/// The least diagonal entry of a coarse matrix that is factorised, in parts of the sizes of the others of its row together. Products with the
/// prolongation leave a few coarse rows beside soft regions nearly without a diagonal: as pivots they would make large what
/// is to be smoothed.
const LEAST_DIAGONAL: f64 = 0.5;

/// ILU(0) of overlapping diagonal blocks, restricted additive Schwarz (Cai and Sarkis, SIAM J. Sci. Comput. 21, 1999): each
/// block is extended by the columns of its rows, and only its own rows take what its factors say. Without the overlap
/// what couples blocks is left to the coarse levels, and up to a third more iterations are needed.
#[derive(Debug)]
pub(crate) struct BlockIlu {
    blocks: Vec<Block>,
}

#[derive(Debug)]
struct Block {
    factors: IncompleteLu,
    /// Rows of other blocks that come before and after its own, ascending.
    before: Vec<u32>,
    after: Vec<u32>,
}

impl BlockIlu {
    pub(crate) fn new(a: &Csr) -> Result<Self, MatrixError> {
        let blocks = parallel::map(a.nrows().div_ceil(BLOCK), |k| {
            let first = k * BLOCK;
            Block::new(a, first..a.nrows().min(first + BLOCK))
        });
        Ok(Self { blocks: blocks.into_iter().collect::<Result<_, _>>()? })
    }

    /// The same for a product with the prolongation.
    pub(crate) fn of_coarse(a: Csr) -> Result<Self, MatrixError> {
        Self::new(&with_diagonals(a))
    }

    pub(crate) fn bytes(&self) -> usize {
        self.blocks.iter().map(Block::bytes).sum()
    }

    /// `z = M^-1 r`
    pub(crate) fn apply(&self, r: &[f64], z: &mut [f64]) {
        parallel::for_each_part(z, BLOCK, &|k, z| self.blocks[k].apply(r, k * BLOCK, z));
    }
}

/// The matrix with no diagonal entry below [`LEAST_DIAGONAL`].
fn with_diagonals(a: Csr) -> Csr {
    let ncols = a.ncols();
    let (offsets, indices, mut values) = a.into_parts();
    for (i, row) in offsets.windows(2).enumerate() {
        let (columns, values) = (&indices[row[0]..row[1]], &mut values[row[0]..row[1]]);
        if let Ok(k) = columns.binary_search(&(i as u32)) {
            let least = LEAST_DIAGONAL * (values.iter().map(|v| v.abs()).sum::<f64>() - values[k].abs());
            if values[k].abs() < least {
                values[k] = least.copysign(values[k]);
            }
        }
    }
    Csr::from_trusted(ncols, offsets, indices, values)
}

impl Block {
    fn new(a: &Csr, own: Range<usize>) -> Result<Self, MatrixError> {
        if own.len() == a.nrows() {
            return Ok(Self { factors: ilu0(a)?, before: Vec::new(), after: Vec::new() });
        }
        let mut beyond: Vec<u32> = own.clone().flat_map(|i| a.row(i).0).copied().collect();
        beyond.retain(|j| !own.contains(&(*j as usize)));
        beyond.sort_unstable();
        beyond.dedup();
        let after = beyond.split_off(beyond.partition_point(|&j| (j as usize) < own.start));
        let before = beyond;
        let rows = before.len() + own.len() + after.len();
        let place = |j: u32| {
            let i = j as usize;
            if own.contains(&i) {
                return Some(before.len() + i - own.start);
            }
            let (list, first) = if i < own.start { (&before, 0) } else { (&after, before.len() + own.len()) };
            list.binary_search(&j).ok().map(|k| first + k)
        };
        let row = |k: usize| match k.checked_sub(before.len()) {
            None => before[k] as usize,
            Some(k) if k < own.len() => own.start + k,
            Some(k) => after[k - own.len()] as usize,
        };
        let matrix = computed_rows(rows, rows, |k, places, block| {
            let (columns, values) = a.row(row(k));
            for (&j, v) in columns.iter().zip(values) {
                if let Some(column) = place(j) {
                    block.add(places, column as u32, *v);
                }
            }
        });
        Ok(Self { factors: ilu0(&matrix)?, before, after })
    }

    fn bytes(&self) -> usize {
        self.factors.bytes() + size_of_val(&*self.before) + size_of_val(&*self.after)
    }

    /// The rows of `z = M^-1 r` that begin at `first`.
    fn apply(&self, r: &[f64], first: usize, z: &mut [f64]) {
        if self.before.is_empty() && self.after.is_empty() {
            return self.factors.apply(&r[first..first + z.len()], z, &mut []);
        }
        let beyond = |rows: &[u32]| rows.iter().map(|&i| r[i as usize]).collect::<Vec<f64>>();
        let r = [beyond(&self.before), r[first..first + z.len()].to_vec(), beyond(&self.after)].concat();
        let mut all = vec![0.0; r.len()];
        self.factors.apply(&r, &mut all, &mut []);
        z.copy_from_slice(&all[self.before.len()..self.before.len() + z.len()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_hold_but_for_those_at_the_ends_of_blocks() {
        // Without fill the factors of a tridiagonal matrix are exact.
        let n = 2 * BLOCK + 100;
        let a = Csr::from_rows(n, n, |i, row| {
            for j in i.saturating_sub(1)..(i + 2).min(n) {
                row.push(j, if i == j { 4.0 } else { -1.0 });
            }
        })
        .expect("a matrix");
        let b: Vec<f64> = (0..n).map(|i| ((i * 7919) % 101) as f64 - 50.0).collect();
        let (mut z, mut r) = (vec![0.0; n], vec![0.0; n]);
        BlockIlu::new(&a).expect("factors").apply(&b, &mut z);
        a.residual(&z, &b, &mut r);
        let wrong: Vec<usize> = (0..n).filter(|&i| r[i].abs() > 1e-10).collect();
        assert_eq!(wrong, [BLOCK - 1, BLOCK, 2 * BLOCK - 1, 2 * BLOCK]);
        // The overlap: what is wrong there is less than if the other blocks were zero.
        assert!(
            wrong.iter().all(|&i| r[i].abs() < 10.0),
            "{:?}",
            wrong.iter().map(|&i| r[i]).collect::<Vec<_>>()
        );
    }

    #[test]
    fn small_pivots_of_coarse_matrices_do_not_amplify() {
        let n = 100;
        let a = Csr::from_rows(n, n, |i, row| {
            let diagonal = if i == 50 { 1e-3 } else { 4.0 };
            for j in i.saturating_sub(1)..(i + 2).min(n) {
                // Its neighbours do not see row 50, so nothing is added to its pivot.
                let other = if j == 50 { 0.0 } else { -1.0 };
                row.push(j, if i == j { diagonal } else { other });
            }
        })
        .expect("a matrix");
        let (b, mut z) = (vec![1.0; n], vec![0.0; n]);
        BlockIlu::new(&a).expect("factors").apply(&b, &mut z);
        assert!(z[50] > 1e3);
        BlockIlu::of_coarse(a).expect("factors").apply(&b, &mut z);
        assert!((z[50] - 3_f64.sqrt()).abs() < 1e-10, "{}", z[50]);
    }
}
