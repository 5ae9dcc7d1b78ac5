//! Small dense systems.

use crate::solver::SolveError;

/// A pivot below this, in a matrix whose rows and columns have largest entries near 1, is rounding.
const PIVOT_FLOOR: f64 = 1e-14;

/// A dense square matrix, its rows and then its columns scaled by their largest entries, factorised by Gaussian
/// elimination with partial pivoting.
#[derive(Debug, Clone)]
pub(crate) struct DenseLu {
    lu: Vec<Vec<f64>>,
    /// Row of the matrix that stands in each row of the factors.
    order: Vec<usize>,
    rows: Vec<f64>,
    columns: Vec<f64>,
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m: f64, v| m.max(v.abs()))
}

impl DenseLu {
    /// # Errors
    /// [`SolveError::Undetermined`] with the column that has no pivot.
    pub(crate) fn new(mut a: Vec<Vec<f64>>) -> Result<Self, SolveError> {
        let n = a.len();
        let rows: Vec<f64> = a.iter().map(|row| largest(row.iter().copied())).collect();
        let columns: Vec<f64> = (0..n).map(|j| largest((0..n).map(|i| a[i][j] / rows[i]))).collect();
        for i in 0..n {
            for j in 0..n {
                // A row or column of zeros gives NaN, which the search for a pivot refuses.
                a[i][j] /= rows[i] * columns[j];
            }
        }
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let best = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap_or(k);
            if a[best][k].is_nan() || a[best][k].abs() <= PIVOT_FLOOR {
                return Err(SolveError::Undetermined { extra: k });
            }
            a.swap(k, best);
            order.swap(k, best);
            let (above, below) = a.split_at_mut(k + 1);
            for row in below {
                row[k] /= above[k][k];
                for j in k + 1..n {
                    row[j] -= row[k] * above[k][j];
                }
            }
        }
        Ok(Self { lu: a, order, rows, columns })
    }

    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.order.len();
        let mut x: Vec<f64> = self.order.iter().map(|&i| b[i] / self.rows[i]).collect();
        for i in 0..n {
            for j in 0..i {
                x[i] -= self.lu[i][j] * x[j];
            }
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] -= self.lu[i][j] * x[j];
            }
            x[i] /= self.lu[i][i];
        }
        x.iter().zip(&self.columns).map(|(x, c)| x / c).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_rows_and_columns_of_very_different_size() {
        let a = [vec![1e-12, 2e-12, 0.0], vec![3.0, 1.0, 1.0], vec![0.0, 1e9, -1e9]];
        let factor = [1.0, 1e20, 1e-20];
        let scaled = a.iter().map(|row| row.iter().zip(factor).map(|(a, f)| a * f).collect()).collect();
        let x = DenseLu::new(scaled).unwrap().solve(&[5e-12, 6.0, 1e9]);
        for ((x, factor), exact) in x.iter().zip(factor).zip([1.0, 2.0, 1.0]) {
            assert!((x * factor - exact).abs() < 1e-14, "{x} {exact}");
        }
    }

    #[test]
    fn names_the_undetermined_column() {
        let refused = |a: Vec<Vec<f64>>| DenseLu::new(a).unwrap_err();
        assert_eq!(refused(vec![vec![1.0, 2.0], vec![2.0, 4.0]]), SolveError::Undetermined { extra: 1 });
        assert_eq!(refused(vec![vec![1.0, 0.0], vec![2.0, 0.0]]), SolveError::Undetermined { extra: 1 });
        assert_eq!(refused(vec![vec![0.0]]), SolveError::Undetermined { extra: 0 });
        assert_eq!(refused(vec![vec![f64::NAN]]), SolveError::Undetermined { extra: 0 });
    }

    #[test]
    fn nothing_is_solved_for_nothing() {
        assert!(DenseLu::new(Vec::new()).unwrap().solve(&[]).is_empty());
    }
}
