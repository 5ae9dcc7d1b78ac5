//! The matrix of the next level.

use crate::csr::{Csr, computed_rows};
use rayon::prelude::*;

/// A sum of entries below this many units in the last place of their sizes is zero, but for rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// `A c`, for ones where no `c` is given; without it exactly zero where nothing but rounding is left of the entries. For another `c`
/// by differences, so that weak bonds of a stiff region in which `c` is constant are not lost.
pub(crate) fn row_sums(a: &Csr, c: Option<&[f64]>) -> Vec<f64> {
    let sum = |i: usize| {
        let (columns, values) = a.row(i);
        let sum: f64 = values.iter().sum();
        let size: f64 = values.iter().map(|v| v.abs()).sum();
        let sum = if sum.abs() <= ROUNDING * size { 0.0 } else { sum };
        let Some(c) = c else { return sum };
        columns.iter().zip(values).fold(sum * c[i], |sum, (&j, a)| sum + a * (c[j as usize] - c[i]))
    };
    (0..a.nrows()).into_par_iter().with_min_len(4096).map(sum).collect()
}

/// `R A P` with the sums of its rows, for a prolongation whose rows add up to `c` (1 where none is given), or to 0 where they are
/// empty; `row_sums` are those of `A c`.
///
/// The sums are carried along: those of `R A P` are `R s` with `s_i = (A c)_i`, less or plus the terms between rows with entries
/// and rows without; and the diagonal follows from them and from the other entries. So a stiff region that weak bonds hold keeps
/// them on every level, where a diagonal that is a rounded sum would lose them.
pub(crate) fn product(a: &Csr, row_sums: &[f64], c: Option<&[f64]>, p: &Csr, r: &Csr) -> (Csr, Vec<f64>) {
    let covered: Vec<bool> = (0..p.nrows()).map(|i| !p.row(i).0.is_empty()).collect();
    let of = |j: usize| c.map_or(1.0, |c| c[j]);
    let carried: Vec<f64> = (0..a.nrows())
        .into_par_iter()
        .with_min_len(4096)
        .map(|i| {
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
        .collect();
    let mut sums = vec![0.0; r.nrows()];
    r.mul_vec(&carried, &mut sums);
    let ap = computed_rows(a.nrows(), p.ncols(), |i, places, block| {
        let (columns, values) = a.row(i);
        for (&k, a_ik) in columns.iter().zip(values) {
            let (columns, values) = p.row(k as usize);
            for (&j, p_kj) in columns.iter().zip(values) {
                block.add(places, j, a_ik * p_kj);
            }
        }
    });
    let coarse = computed_rows(r.nrows(), p.ncols(), |i, places, block| {
        block.add(places, i as u32, 0.0);
        let mut diagonal = sums[i];
        let (columns, values) = r.row(i);
        for (&k, r_ik) in columns.iter().zip(values) {
            let (columns, values) = ap.row(k as usize);
            for (&j, b) in columns.iter().zip(values) {
                if j as usize != i {
                    block.add(places, j, r_ik * b);
                    diagonal -= r_ik * b;
                }
            }
        }
        block.add(places, i as u32, diagonal);
    });
    (coarse, sums)
}
