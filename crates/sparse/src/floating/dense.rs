//! Small dense systems.

use crate::solver::SolveError;

/// A pivot below this part of its row's largest entry means that the row depends on the others.
const PIVOT_FLOOR: f64 = 1e-14;

/// A dense square matrix factorised by Gaussian elimination with scaled partial pivoting.
#[derive(Debug, Clone)]
pub(crate) struct DenseLu {
    n: usize,
    lu: Vec<Vec<f64>>,
    order: Vec<usize>,
}

impl DenseLu {
    /// # Errors
    /// [`SolveError::Undetermined`] with the column that has no pivot.
    pub(crate) fn new(mut a: Vec<Vec<f64>>) -> Result<Self, SolveError> {
        let n = a.len();
        let mut size: Vec<f64> =
            a.iter().map(|row| row.iter().fold(0.0, |m: f64, v| m.max(v.abs()))).collect();
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let relative = |i: usize| a[i][k].abs() / size[i];
            let best = (k..n).max_by(|&i, &j| relative(i).total_cmp(&relative(j))).unwrap_or(k);
            if relative(best).is_nan() || relative(best) <= PIVOT_FLOOR || a[best][k].is_infinite() {
                return Err(SolveError::Undetermined { extra: k });
            }
            a.swap(k, best);
            size.swap(k, best);
            order.swap(k, best);
            let (above, below) = a.split_at_mut(k + 1);
            for row in below {
                row[k] /= above[k][k];
                for j in k + 1..n {
                    row[j] -= row[k] * above[k][j];
                }
            }
        }
        Ok(Self { n, lu: a, order })
    }

    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = self.order.iter().map(|&i| b[i]).collect();
        for i in 0..self.n {
            for j in 0..i {
                x[i] -= self.lu[i][j] * x[j];
            }
        }
        for i in (0..self.n).rev() {
            for j in i + 1..self.n {
                x[i] -= self.lu[i][j] * x[j];
            }
            x[i] /= self.lu[i][i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_rows_of_very_different_size() {
        let a = vec![vec![1e-12, 2e-12, 0.0], vec![3.0, 1.0, 1.0], vec![0.0, 1e9, -1e9]];
        let x = DenseLu::new(a).unwrap().solve(&[5e-12, 6.0, 1e9]);
        for (x, exact) in x.iter().zip([1.0, 2.0, 1.0]) {
            assert!((x - exact).abs() < 1e-14, "{x} {exact}");
        }
    }

    #[test]
    fn names_the_undetermined_column() {
        let a = vec![vec![1.0, 2.0], vec![2.0, 4.0]];
        assert_eq!(DenseLu::new(a).unwrap_err(), SolveError::Undetermined { extra: 1 });
        assert_eq!(DenseLu::new(vec![vec![0.0]]).unwrap_err(), SolveError::Undetermined { extra: 0 });
    }
}
