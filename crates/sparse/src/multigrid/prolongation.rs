//! From aggregates to interpolation.

use super::aggregation::{Aggregates, NONE};
use super::strength::Bonds;
use crate::csr::{Csr, computed_rows};
use crate::difference::DifferenceMatrix;

/// Damping of the Jacobi step that smooths the prolongation. 4/3 over the largest eigenvalue of `D^-1 A` (Vaněk, Mandel and
/// Brezina 1996) is 2/3 for Gershgorin's bound on filtered rows, 2, and more for wide stencils, whose eigenvalues stay below it.
/// Measured in `docs/multigrid.md`.
const DAMPING: f64 = 0.8;

/// Weights below this go to the aggregate that the node is in: coarse matrices have fewer entries.
const LEAST_WEIGHT: f64 = 0.06;

/// The same on coarse levels, whose rows have more entries and matter less.
const LEAST_WEIGHT_COARSE: f64 = 0.08;

/// The Jacobi step that smooths the prolongation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    damping: f64,
    /// Weights below this are lumped.
    least_weight: f64,
}

impl Step {
    /// For rows whose entries outside of the diagonal are mostly of one sign.
    pub(crate) const LONG: Self = Self { damping: DAMPING, least_weight: LEAST_WEIGHT };
    /// The same for coarse levels.
    pub(crate) const COARSE: Self = Self { damping: DAMPING, least_weight: LEAST_WEIGHT_COARSE };
    /// For rows with large entries of either sign, those that need a restriction of their own: their eigenvalues are bounded by
    /// Gershgorin's bound alone.
    pub(crate) const SAFE: Self = Self { damping: 2.0 / 3.0, least_weight: 0.0 };
}

/// The prolongation that is constant on aggregates.
pub(crate) fn tentative(aggregates: &Aggregates) -> Csr {
    computed_rows(aggregates.of.len(), aggregates.count, |i, places, block| {
        if aggregates.of[i] != NONE {
            block.add(places, aggregates.of[i], 1.0);
        }
    })
}

/// The prolongation after one damped Jacobi step with the filtered matrix, in difference form:
/// `P_i = T_i - omega / d_i sum_j a_ij (T_j - T_i)` over strong neighbours `j`, with `d_i = -sum_j a_ij`, without its small entries. So its
/// rows add up to 1 whatever is filtered out, and constants are reproduced exactly. `units` multiply the columns of the matrix.
pub(crate) fn smoothed(
    a: &DifferenceMatrix,
    units: Option<&[f64]>,
    graph: &impl Bonds,
    aggregates: &Aggregates,
    step: Step,
) -> Csr {
    let of = &aggregates.of;
    let unit = |j: u32| units.map_or(1.0, |c| c[j as usize]);
    computed_rows(a.n(), aggregates.count, |i, places, block| {
        let own = of[i];
        if own == NONE {
            return;
        }
        let mut size = 0.0;
        graph.entries(a, i, |j, a_ij| {
            if of[j as usize] != NONE {
                size -= a_ij * unit(j);
            }
        });
        if size == 0.0 {
            block.add(places, own, 1.0);
            return;
        }
        let mut kept = 1.0;
        block.add(places, own, 0.0);
        graph.entries(a, i, |j, a_ij| {
            let other = of[j as usize];
            if other != NONE && other != own {
                let weight = -step.damping * a_ij * unit(j) / size;
                block.add(places, other, weight);
                kept -= weight;
            }
        });
        block.add(places, own, kept);
        block.lump(places, own, step.least_weight);
    })
}
