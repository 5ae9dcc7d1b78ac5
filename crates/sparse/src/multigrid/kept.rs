//! Unknowns that stay as they are on every level.

use super::aggregation::{Aggregates, NONE};
use crate::difference::DifferenceMatrix;
use crate::parallel;

/// Share of the unknowns above which they are not kept: then it is the kind of matrix, not an interface.
const MOST: f64 = 0.3;

/// The rows whose other entries add up to more than `keep` diagonals, in values of which the unknowns are the parts `s`; none if
/// they are many. `inverse` has the reciprocals of the diagonal.
pub(crate) fn rows(a: &DifferenceMatrix, inverse: &[f64], s: &[f64], keep: f64) -> Vec<bool> {
    let n = a.n();
    if keep == f64::INFINITY {
        return vec![false; n];
    }
    let unit = |i: usize| s.get(i).map_or(1.0, |s| 1.0 / s);
    let kept = parallel::map_rows(n, |i| {
        let (columns, values) = a.row(i);
        let others: f64 = columns.iter().zip(values).map(|(&j, v)| v.abs() * unit(j as usize)).sum();
        others * inverse[i].abs() > keep * unit(i) || (inverse[i] == 0.0 && others > 0.0)
    });
    let count = kept.iter().filter(|k| **k).count();
    if count as f64 > MOST * n as f64 { vec![false; n] } else { kept }
}

/// Gives every kept node an aggregate of its own, after all others; and tells which these are.
pub(crate) fn single_out(aggregates: &mut Aggregates, kept: &[bool]) -> Vec<bool> {
    let mut of_next = vec![false; aggregates.count];
    for (of, _) in aggregates.of.iter_mut().zip(kept).filter(|(_, k)| **k) {
        debug_assert_eq!(*of, NONE);
        *of = aggregates.count as u32;
        aggregates.count += 1;
        of_next.push(true);
    }
    of_next
}
