//! When levels no longer fit a matrix whose values have changed.

use crate::difference::DifferenceMatrix;
use crate::parallel;

/// A row has another shape once this part of it has moved: bonds that made aggregates are gone, or others have come.
const MOVED: f64 = 0.15;

/// Share of rows of another shape from which on the levels are made anew: a thousandth of the rows already is an interface that has
/// moved by a node.
const MOST: f64 = 1e-3;

/// How far the rows have moved since the levels were made.
#[derive(Debug, Default)]
pub(crate) struct Drift {
    /// By row: what every change has moved, added up.
    moved: Vec<f32>,
}

impl Drift {
    /// Takes note of a change of values; whether the levels no longer fit. Rows are compared in parts of the sizes of their entries, so
    /// factors of rows do not matter, nor does a diffusivity that changes alike in a whole region.
    pub(crate) fn is_too_far(&mut self, before: &DifferenceMatrix, after: &DifferenceMatrix) -> bool {
        if before.off_diagonal().indices() != after.off_diagonal().indices()
            || before.off_diagonal().offsets() != after.off_diagonal().offsets()
        {
            return true;
        }
        self.moved.resize(before.n(), 0.0);
        let by = parallel::map_rows(before.n(), |i| moved(before, after, i) as f32);
        self.moved.iter_mut().zip(by).for_each(|(moved, by)| *moved += by);
        let far = self.moved.iter().filter(|moved| moved.is_nan() || f64::from(**moved) > MOVED).count();
        far as f64 > MOST * before.n() as f64
    }
}

/// Half the sum of the differences between the entries, and the sum, of a row before and after, each in parts of their sizes: 0 to 1.
fn moved(before: &DifferenceMatrix, after: &DifferenceMatrix, i: usize) -> f64 {
    let entries = |a: &'_ DifferenceMatrix| -> f64 {
        a.row(i).1.iter().map(|v| v.abs()).sum::<f64>() + a.row_sum(i).abs()
    };
    let (size_before, size_after) = (entries(before), entries(after));
    if size_before == 0.0 || size_after == 0.0 {
        return if size_before == size_after { 0.0 } else { 1.0 };
    }
    let apart = |b: f64, a: f64| (b / size_before - a / size_after).abs();
    let pairs = before.row(i).1.iter().zip(after.row(i).1);
    let sum: f64 = pairs.map(|(&b, &a)| apart(b, a)).sum();
    0.5 * (sum + apart(before.row_sum(i), after.row_sum(i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A five-point matrix, anisotropic by `ratio`, each row multiplied by a factor.
    fn grid(ratio: f64, factor: impl Fn(usize) -> f64 + Sync) -> DifferenceMatrix {
        let m = 30;
        DifferenceMatrix::from_rows(m * m, |i, row| {
            for (k, stride, a) in [(i % m, 1, 1.0), (i / m, m, ratio)] {
                if k > 0 {
                    row.push(i - stride, -a * factor(i));
                }
                if k + 1 < m {
                    row.push(i + stride, -a * factor(i));
                }
            }
            row.add_to_row_sum(0.1 * factor(i));
        })
        .expect("entries are in range")
    }

    #[test]
    fn factors_of_rows_do_not_matter_and_shapes_do() {
        let before = grid(1.0, |_| 1.0);
        assert!(!Drift::default().is_too_far(&before, &grid(1.0, |i| 1.0 + (i % 5) as f64)));
        assert!(Drift::default().is_too_far(&before, &grid(10.0, |_| 1.0)));
        assert!(Drift::default().is_too_far(&before, &DifferenceMatrix::from_rows(900, |_, _| {}).unwrap()));
    }

    #[test]
    fn small_changes_add_up() {
        let mut drift = Drift::default();
        let steps: Vec<DifferenceMatrix> = (0..20).map(|k| grid(1.1_f64.powi(k), |_| 1.0)).collect();
        let first = steps.windows(2).position(|w| drift.is_too_far(&w[0], &w[1]));
        assert!(first.is_some_and(|k| (4..12).contains(&k)), "{first:?}");
    }
}
