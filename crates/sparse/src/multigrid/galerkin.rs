//! The matrix of the next level.

use super::interpolation::Interpolation;
use crate::csr::{LooseRows, computed_rows, for_each_row};
use crate::difference::{DifferenceMatrix, ROUNDING};
use crate::parallel;

/// Parts of the rows of A that are multiplied one after the other: `A P` would take as many bytes as a quarter of A, and a few rows of
/// it at a time are enough.
const PARTS: usize = 8;

/// Rows of a part are a multiple of this, enough for several threads.
const LEAST_ROWS: usize = 16_384;

/// `A (c / s)`, for ones where no `c` or `s` is given: the sums of rows where unknowns are values over `s`, exactly zero where
/// nothing but rounding is left of the entries, and the rest by differences, so that weak bonds of a stiff region in which `c`
/// is constant are not lost.
pub(crate) fn row_sums(
    a: &DifferenceMatrix,
    c: Option<&(dyn Fn(usize) -> f64 + Sync)>,
    s: &[f64],
) -> Vec<f64> {
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
        let here = c(i);
        let change = |(&j, v): (&u32, &f64)| v * inverse(j as usize) * (c(j as usize) - here);
        columns.iter().zip(values).fold(sum * here, |sum, entry| sum + change(entry))
    })
}

/// `R A P` where prolongation is `diag(c)` times the weights in `p`, restriction the weights in `r` times `diag(w)`, with ones where no
/// `c` or `w` is given; rows of `p` add up to 1 or are empty, and `row_sums` are those of `A c`.
///
/// The sums are carried along: those of `R A P` are `R s` with `s_i = (A c)_i`, less or plus the terms between rows with entries
/// and rows without; the diagonal follows from them and from the other entries, as in every matrix in difference form. So a stiff
/// region that weak bonds hold keeps them on every level, where a diagonal that is a rounded sum would lose them.
pub(crate) fn product(
    a: &DifferenceMatrix,
    mut row_sums: Vec<f64>,
    [c, w]: [Option<&[f64]>; 2],
    p: &Interpolation,
    r: &Interpolation,
) -> DifferenceMatrix {
    let factor = |x: Option<&[f64]>, i: usize| x.map_or(1.0, |x| x[i]);
    let all_covered = !(0..a.n()).any(|i| p.is_empty(i));
    for_each_row(&mut row_sums, |i, sum| {
        if !all_covered {
            let covered = !p.is_empty(i);
            if !covered {
                *sum = 0.0;
            }
            let (columns, values) = a.row(i);
            for (&j, a_ij) in columns.iter().zip(values) {
                let j = j as usize;
                if p.is_empty(j) == covered {
                    *sum += if covered { -a_ij * factor(c, j) } else { a_ij * factor(c, j) };
                }
            }
        }
        *sum *= factor(w, i);
    });
    let mut sums = vec![0.0; r.nrows()];
    r.mul_vec(&row_sums, &mut sums);
    drop(row_sums);
    let at_once = a.n().div_ceil(PARTS).next_multiple_of(LEAST_ROWS);
    let part = |first: usize| {
        let rows = first..a.n().min(first + at_once);
        let ap = LooseRows::new(rows.len(), p.ncols(), |k, places, block| {
            let i = first + k;
            let (columns, values) = a.row(i);
            let diagonal = a.diagonal(i);
            for (&k, a_ik) in columns.iter().zip(values).chain([(&(i as u32), &diagonal)]) {
                let k = k as usize;
                let a_ik = factor(w, i) * a_ik * factor(c, k);
                p.row(k).for_each(|(j, p_kj)| block.add(places, j as u32, a_ik * p_kj));
            }
        });
        LooseRows::new(r.nrows(), p.ncols(), |i, places, block| {
            for (k, r_ik) in r.row_within(i, rows.clone()) {
                let (columns, values) = ap.row(k - first);
                for (&j, b) in columns.iter().zip(values).filter(|(j, _)| **j as usize != i) {
                    block.add(places, j, r_ik * b);
                }
            }
        })
    };
    let parts: Vec<LooseRows> = (0..a.n()).step_by(at_once).map(part).collect();
    let off = computed_rows(r.nrows(), p.ncols(), |i, places, block| {
        for (&j, v) in parts.iter().flat_map(|part| part.row(i).0.iter().zip(part.row(i).1)) {
            block.add(places, j, *v);
        }
    });
    DifferenceMatrix::from_trusted(off, sums)
}
