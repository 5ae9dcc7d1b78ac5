//! What the signs and sums of a matrix say about maximum principle and conservation.

use super::DifferenceMatrix;
use crate::error::MatrixError;

/// An off-diagonal entry that breaks the sign pattern of an M-matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrongSign {
    /// Row of the entry.
    pub row: usize,
    /// Its column.
    pub column: usize,
    /// Its size relative to the diagonal of the row.
    pub relative: f64,
}

/// Signs and sums of a matrix. All of it is independent of how rows are scaled, the sign included: what counts is
/// an entry relative to the diagonal of its own row.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixReport {
    /// The largest off-diagonal entry with the sign of its diagonal, none in an M-matrix.
    pub largest_wrong_sign: Option<WrongSign>,
    /// Number of such entries.
    pub wrong_signs: usize,
    /// First row whose diagonal is zero.
    pub zero_diagonal: Option<usize>,
    /// `max_i |r_i / a_ii|` over rows with a diagonal.
    pub row_sum_max_relative: f64,
    /// `min_i r_i / a_ii`: negative where a row is not even weakly dominant although its signs are right.
    pub row_sum_min_relative: f64,
    /// `max_j |sum_i V_i a_ij| / sum_i V_i |a_ij|`, where the volumes `V` were given: 0 in columns that conserve.
    pub column_sum_max_relative: Option<f64>,
    /// Whether the matrix is a non-singular M-matrix by its signs: off-diagonal entries are opposite to the
    /// diagonal, row sums are not, and from every row a row with a non-zero sum can be reached.
    pub is_m_matrix: bool,
}

impl DifferenceMatrix {
    /// Signs, row sums, and, with the volumes of the nodes, column sums.
    ///
    /// # Errors
    /// [`MatrixError::Length`] where `volumes` does not have one element for each node.
    pub fn report(&self, volumes: Option<&[f64]>) -> Result<MatrixReport, MatrixError> {
        if let Some(v) = volumes {
            MatrixError::check_length("volumes", v.len(), self.n())?;
        }
        let mut report = MatrixReport {
            largest_wrong_sign: None,
            wrong_signs: 0,
            zero_diagonal: None,
            row_sum_max_relative: 0.0,
            row_sum_min_relative: f64::INFINITY,
            column_sum_max_relative: volumes.map(|v| self.column_sums(v)),
            is_m_matrix: false,
        };
        for i in 0..self.n() {
            let diagonal = self.diagonal(i);
            if diagonal == 0.0 {
                report.zero_diagonal.get_or_insert(i);
                continue;
            }
            let sum = self.row_sum(i) / diagonal;
            report.row_sum_max_relative = report.row_sum_max_relative.max(sum.abs());
            report.row_sum_min_relative = report.row_sum_min_relative.min(sum);
            let (columns, values) = self.row(i);
            for (&j, a) in columns.iter().zip(values) {
                let relative = a / diagonal;
                if relative > 0.0 {
                    report.wrong_signs += 1;
                    if report.largest_wrong_sign.is_none_or(|w| relative > w.relative) {
                        report.largest_wrong_sign = Some(WrongSign { row: i, column: j as usize, relative });
                    }
                }
            }
        }
        report.is_m_matrix = report.zero_diagonal.is_none()
            && report.wrong_signs == 0
            && report.row_sum_min_relative >= 0.0
            && self.every_row_is_held();
        Ok(report)
    }

    fn column_sums(&self, volumes: &[f64]) -> f64 {
        let mut sum = vec![0.0; self.n()];
        let mut size = vec![0.0; self.n()];
        for i in 0..self.n() {
            let diagonal = volumes[i] * self.diagonal(i);
            sum[i] += diagonal;
            size[i] += diagonal.abs();
            let (columns, values) = self.row(i);
            for (&j, a) in columns.iter().zip(values) {
                sum[j as usize] += volumes[i] * a;
                size[j as usize] += (volumes[i] * a).abs();
            }
        }
        let ratio = |(s, n): (&f64, &f64)| if *n == 0.0 { 0.0 } else { s.abs() / n };
        sum.iter().zip(&size).map(ratio).fold(0.0, f64::max)
    }

    /// Whether from every row one with a non-zero sum is reached along non-zero entries.
    fn every_row_is_held(&self) -> bool {
        let reverse = self.off_diagonal().transpose();
        let mut held: Vec<bool> = (0..self.n()).map(|i| self.row_sum(i) != 0.0).collect();
        let mut stack: Vec<usize> = (0..self.n()).filter(|&i| held[i]).collect();
        while let Some(j) = stack.pop() {
            let (rows, values) = reverse.row(j);
            for (&i, &a) in rows.iter().zip(values) {
                if a != 0.0 && !held[i as usize] {
                    held[i as usize] = true;
                    stack.push(i as usize);
                }
            }
        }
        held.iter().all(|&h| h)
    }
}
