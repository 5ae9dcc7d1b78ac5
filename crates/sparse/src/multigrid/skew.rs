//! Whether convection outweighs diffusion: rows that depend on others that do not depend on them.

use crate::difference::DifferenceMatrix;
use crate::parallel;

/// Rows that are looked at, evenly spread: enough to tell a matrix from another kind.
const SAMPLE: usize = 4096;

/// What of the sizes of entries is not mirrored, in the mean over rows, from which on a matrix is convective. Upwind differences of
/// cell Péclet numbers P have P / (2 + P); stencils on irregular clouds stay below 0.3 (`docs/multigrid.md`).
const CONVECTIVE: f64 = 0.4;

/// Whether entries and their mirror images differ as they do for upwind differences of cell Péclet numbers beyond about 3. Entries are
/// compared as they stand, and in parts of the diagonals, and what differs less counts: a matrix that was symmetric may have had
/// its rows divided, or have coefficients that jump anywhere.
pub(crate) fn is_convective(a: &DifferenceMatrix) -> bool {
    let n = a.n();
    let count = n.min(SAMPLE);
    let skews = parallel::map_rows(count, |k| skew(a, (k as u64 * n as u64 / count as u64) as usize));
    let mean = |of: fn(&[f64; 2]) -> f64| skews.iter().map(of).sum::<f64>() / count as f64;
    count > 0 && mean(|s| s[0]).min(mean(|s| s[1])) > CONVECTIVE
}

/// The sum of differences between entries and their mirror images over that of their sizes: as they stand, and in parts of the
/// diagonals.
fn skew(a: &DifferenceMatrix, i: usize) -> [f64; 2] {
    let here = a.diagonal(i).abs();
    let (mut apart, mut size) = ([0.0; 2], [0.0; 2]);
    let (columns, values) = a.row(i);
    for (&j, v) in columns.iter().zip(values) {
        let j = j as usize;
        let back = a.off_diagonal().get(j, i);
        let there = a.diagonal(j).abs();
        for (k, (v, back)) in [(*v, back), (v / here, back / there)].into_iter().enumerate() {
            apart[k] += (v - back).abs();
            size[k] += v.abs() + back.abs();
        }
    }
    [0, 1].map(|k| if size[k] > 0.0 && apart[k].is_finite() { apart[k] / size[k] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn upwind(m: usize, peclet: f64) -> DifferenceMatrix {
        DifferenceMatrix::from_rows(m * m, |i, row| {
            let at = |k: usize| 2.0 * k as f64 / m as f64 - 1.0;
            for (k, stride, speed) in [(i % m, 1, at(i / m) * peclet), (i / m, m, -at(i % m) * peclet)] {
                if k > 0 {
                    row.push(i - stride, -1.0 - speed.max(0.0));
                }
                if k + 1 < m {
                    row.push(i + stride, -1.0 + speed.min(0.0));
                }
            }
        })
        .expect("entries are in range")
    }

    #[test]
    fn upwind_differences_are_told_from_diffusion() {
        assert!([10.0, 100.0, 1000.0].iter().all(|&p| is_convective(&upwind(40, p))));
        assert!([0.0, 0.1, 1.0].iter().all(|&p| !is_convective(&upwind(40, p))));
    }

    #[test]
    fn coefficients_that_jump_everywhere_are_no_convection_however_rows_are_scaled() {
        let m = 40;
        let eta = |i: usize| 10.0_f64.powi(((i * 7919) % 13) as i32 - 6);
        let rows = |scale: &(dyn Fn(usize) -> f64 + Sync)| {
            DifferenceMatrix::from_rows(m * m, |i, row| {
                let others = [i.wrapping_sub(1), i + 1, i.wrapping_sub(m), i + m];
                let near = others.into_iter().filter(|&j| j < m * m && (i % m).abs_diff(j % m) <= 1);
                near.for_each(|j| row.push(j, -scale(i) * 2.0 * eta(i) * eta(j) / (eta(i) + eta(j))));
            })
            .expect("entries are in range")
        };
        assert!(!is_convective(&rows(&|_| 1.0)));
        assert!(!is_convective(&rows(&|i| 1.0 + (i % 3) as f64)));
        assert!(!is_convective(&DifferenceMatrix::from_rows(3, |_, _| {}).unwrap()));
    }
}
