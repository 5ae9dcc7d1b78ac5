//! Which rows are conservative (Kraus et al. 2022, section 2.2.3 and appendix A).

use meshless_stencils::SignDiagnosis;

use crate::Problem;
use crate::gfdm::{GfdmParams, Selection};
use crate::method::RowKind;
use crate::operator_rows::OperatorRows;
use crate::parallel;

/// Dirichlet rows, rows of flux conditions, and strong rows at all other nodes.
pub(super) fn boundary_kinds<const D: usize>(
    problem: &Problem<'_, D>,
    known: &[Option<f64>],
    conservative_neumann: bool,
) -> Vec<RowKind> {
    let mut kinds = vec![RowKind::Strong; known.len()];
    for node in problem.cloud.boundary() {
        let i = node.node as usize;
        kinds[i] = match (known[i], conservative_neumann) {
            (Some(_), _) => RowKind::Dirichlet,
            (None, true) => RowKind::Conservative,
            (None, false) => RowKind::StrongBoundary,
        };
    }
    kinds
}

/// Turns strong rows into conservative ones where the selection wants it; returns how many rows were flagged (23).
pub(super) fn conservative_nodes<const D: usize>(
    problem: &Problem<'_, D>,
    params: &GfdmParams,
    rows: &OperatorRows,
    kinds: &mut [RowKind],
) -> usize {
    if params.selection == Selection::None {
        return 0;
    }
    let by_region = |i: usize| params.select_by_region && crosses_a_region(problem, i);
    let flagged = parallel::map(kinds.len(), |i| {
        let dominated =
            || SignDiagnosis::of_row(rows.row(problem, i).1).dominance_error > params.selection_tolerance;
        kinds[i] == RowKind::Strong && (dominated() || by_region(i))
    });
    let neighbors_too = params.selection == Selection::FlaggedAndNeighbors;
    let chosen = parallel::map(kinds.len(), |i| {
        let near_flagged = || problem.supports.lists.of(i).iter().any(|&j| flagged[j as usize]);
        let at_a_jump = || kinds[i] == RowKind::Strong && crosses_a_jump(problem, i, rows.row(problem, i).0);
        flagged[i] || (neighbors_too && near_flagged()) || at_a_jump()
    });
    for (kind, chosen) in kinds.iter_mut().zip(chosen) {
        if chosen && *kind == RowKind::Strong {
            *kind = RowKind::Conservative;
        }
    }
    flagged.iter().filter(|&&f| f).count()
}

/// Whether a stencil at i over `neighbors` reaches over an interface where u or the flux jumps: stencils do not know of
/// such jumps.
pub(super) fn crosses_a_jump<const D: usize>(problem: &Problem<'_, D>, i: usize, neighbors: &[u32]) -> bool {
    !problem.laws.is_empty()
        && neighbors.iter().any(|&j| {
            let labels = (problem.labels[i], problem.labels[j as usize]);
            labels.0 != labels.1 && problem.law_between(labels.0, labels.1).is_some()
        })
}

/// Whether the support of i reaches into another region.
fn crosses_a_region<const D: usize>(problem: &Problem<'_, D>, i: usize) -> bool {
    problem.supports.lists.of(i).iter().any(|&j| problem.labels[j as usize] != problem.labels[i])
}
