//! Properties of a discretisation that the discrete maximum principle and conservation rest on.

use crate::{Discretization, RowKind};

/// What was found in the rows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RowReport {
    /// Largest off-diagonal entry of the wrong (positive) sign over the diagonal of its row: 0 for an M-matrix.
    pub wrong_sign: f64,
    /// Largest sum of a row, formed from its stored diagonal and entries, over its diagonal, among rows that
    /// annihilate constants.
    pub row_sum: f64,
    /// Largest sum of a column over its diagonal, among nodes whose neighbours are all conservative: the discrete
    /// divergence theorem (Kraus et al. 2022, (22)). Rows are integrated over their cells, so no volumes enter.
    pub column_sum: f64,
}

impl Discretization {
    /// Looks at all rows that are not prescribed values.
    pub fn report(&self) -> RowReport {
        let n = self.kinds.len();
        let conservative = |i: usize| self.kinds[i] == RowKind::Conservative;
        let mut columns = vec![0.0; n];
        let mut report = RowReport::default();
        for i in (0..n).filter(|&i| self.kinds[i] != RowKind::Dirichlet) {
            let (neighbors, values) = self.rows.row(i);
            let diagonal = self.rows.diagonal(i);
            let (mut sum, mut wrong) = (diagonal, 0.0_f64);
            for (&j, &a) in neighbors.iter().zip(values).filter(|(j, _)| (**j as usize) < n) {
                sum += a;
                wrong = wrong.max(a);
                if conservative(i) {
                    columns[j as usize] += a;
                }
            }
            report.wrong_sign = report.wrong_sign.max(wrong / diagonal.abs());
            if self.rows.row_sum(i) == 0.0 {
                report.row_sum = report.row_sum.max(sum.abs() / diagonal.abs());
            }
        }
        for j in (0..n).filter(|&j| conservative(j)) {
            let (neighbors, _) = self.rows.row(j);
            if self.rows.row_sum(j) == 0.0 && neighbors.iter().all(|&i| conservative(i as usize)) {
                let diagonal = self.rows.diagonal(j);
                report.column_sum = report.column_sum.max((columns[j] + diagonal).abs() / diagonal.abs());
            }
        }
        report
    }
}
