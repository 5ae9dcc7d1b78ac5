//! What tells good nodes from bad ones, node by node, to be plotted.

use meshless_stencils::{SignDiagnosis, Weight};

use crate::local::NodeFit;
use crate::parallel;
use crate::{Discretization, Problem, RowKind};

/// Figures about one node, all without unit; zero where they have no meaning.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NodeDiagnosis {
    /// Condition of the least-squares fit over the support of the node, infinite where the support does not determine
    /// a polynomial of the degree; zero at nodes that have no stencil.
    pub condition: f64,
    /// How exactly the Laplacian of polynomials is reproduced, see
    /// [`StencilDiagnosis::residual`](meshless_stencils::StencilDiagnosis::residual); zero at nodes without a stencil.
    pub residual: f64,
    /// Largest off-diagonal entry of the wrong sign over the diagonal of the row; zero for a prescribed value.
    pub wrong_sign: f64,
    /// The diagonal-dominance error of the row (Kraus et al. 2022, (23)); zero for a prescribed value.
    pub dominance_error: f64,
}

/// Diagnoses every node: its row as the method made it, and the fit of `degree` over its support.
pub fn diagnose_nodes<const D: usize>(
    problem: &Problem<'_, D>,
    discretization: &Discretization,
    degree: usize,
) -> Vec<NodeDiagnosis> {
    let fit = NodeFit::<D>::new(degree, Weight::Exponential);
    let most = problem.supports.lists.max_count();
    parallel::map_with(
        problem.cloud.len(),
        || (fit.scratch(most), Vec::new()),
        |(scratch, row), i| {
            let kind = discretization.kinds[i];
            if kind == RowKind::Dirichlet {
                return NodeDiagnosis::default();
            }
            row.clear();
            row.extend(discretization.rows.row(i).1.iter().map(|a| -a));
            let signs = SignDiagnosis::of_row(row.iter());
            let (condition, residual) = match kind {
                RowKind::Strong | RowKind::StrongBoundary => {
                    fit.quality(problem, i, scratch).unwrap_or((f64::INFINITY, f64::INFINITY))
                }
                _ => (0.0, 0.0),
            };
            NodeDiagnosis {
                condition,
                residual,
                wrong_sign: signs.wrong_sign,
                dominance_error: signs.dominance_error,
            }
        },
    )
}
