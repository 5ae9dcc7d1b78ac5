//! The matrix of the next level.

use crate::csr::{Csr, LooseRows, computed_rows};
use crate::difference::{DifferenceMatrix, ROUNDING};
use crate::parallel;

/// `A (c / s)`, for ones where no `c` or `s` is given: the sums of rows where unknowns are values over `s`, exactly zero where
/// nothing but rounding is left of the entries, and the rest by differences, so that weak bonds of a stiff region in which `c`
/// is constant are not lost.
pub(crate) fn row_sums(a: &DifferenceMatrix, c: Option<&[f64]>, s: &[f64]) -> Vec<f64> {
    let inverse = |i: usize| s.get(i).map_or(1.0, |s| 1.0 / s);
    parallel::map_rows(a.n(), |i| {
        let (columns, values) = a.row(i);
        let own = inverse(i);
        let (mut sum, mut size) = (a.row_sum(i) * own, (a.diagonal(i) * own).abs());
        for (&j, v) in columns.iter().zip(values) {
            let other = inverse(j as usize);
            size += v.abs() * other;
            if other != own {
                sum += v * (other - own);
            }
        }
        let sum = if f64::abs(sum) <= ROUNDING * size { 0.0 } else { sum };
        let Some(c) = c else { return sum };
        let change = |(&j, v): (&u32, &f64)| v * inverse(j as usize) * (c[j as usize] - c[i]);
        columns.iter().zip(values).fold(sum * c[i], |sum, entry| sum + change(entry))
    })
}

/// `R A P` for a prolongation whose rows add up to `c` (1 where none is given), or to 0 where they are empty; `row_sums` are those
/// of `A c`.
///
/// The sums are carried along: those of `R A P` are `R s` with `s_i = (A c)_i`, less or plus the terms between rows with entries
/// and rows without; the diagonal follows from them and from the other entries, as in every matrix in difference form. So a stiff
/// region that weak bonds hold keeps them on every level, where a diagonal that is a rounded sum would lose them.
pub(crate) fn product(
    a: &DifferenceMatrix,
    row_sums: &[f64],
    c: Option<&[f64]>,
    p: &Csr,
    r: &Csr,
) -> DifferenceMatrix {
    let covered: Vec<bool> = (0..p.nrows()).map(|i| !p.row(i).0.is_empty()).collect();
    let of = |j: usize| c.map_or(1.0, |c| c[j]);
    let carried: Vec<f64> = if covered.iter().all(|&covered| covered) {
        row_sums.to_vec()
    } else {
        parallel::map_rows(a.n(), |i| {
            let mut sum = if covered[i] { row_sums[i] } else { 0.0 };
            let (columns, values) = a.row(i);
            for (&j, a_ij) in columns.iter().zip(values) {
                let j = j as usize;
                if covered[j] != covered[i] {
                    sum += if covered[i] { -a_ij * of(j) } else { a_ij * of(j) };
                }
            }
            sum
        })
    };
    let mut sums = vec![0.0; r.nrows()];
    r.mul_vec(&carried, &mut sums);
    let ap = LooseRows::new(a.n(), p.ncols(), |i, places, block| {
        let (columns, values) = a.row(i);
        let diagonal = a.diagonal(i);
        for (&k, a_ik) in columns.iter().zip(values).chain([(&(i as u32), &diagonal)]) {
            let (columns, values) = p.row(k as usize);
            for (&j, p_kj) in columns.iter().zip(values) {
                block.add(places, j, a_ik * p_kj);
            }
        }
    });
    let off = computed_rows(r.nrows(), p.ncols(), |i, places, block| {
        let (columns, values) = r.row(i);
        for (&k, r_ik) in columns.iter().zip(values) {
            let (columns, values) = ap.row(k as usize);
            for (&j, b) in columns.iter().zip(values) {
                if j as usize != i {
                    block.add(places, j, r_ik * b);
                }
            }
        }
    });
    DifferenceMatrix::from_trusted(off, sums)
}
