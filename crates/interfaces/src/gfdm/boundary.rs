//! Boundary conditions on the flux by collocation: `a u + b eta du/dn = g` at the node.

use meshless_stencils::{Functional, SignDiagnosis, StencilError, Weight};

use crate::gfdm::strong::add_correction;
use crate::local::{NodeFit, enlarged_support};
use crate::{MethodError, Problem};

/// Polynomial degree of the normal derivative.
const DEGREE: usize = 2;

/// Diagonal-dominance error (23) of a row beyond which it is not used. One-sided rows with the correction vector have
/// 1.1 to 1.7; where the arrangement of nodes is unlucky, at a few nodes in a thousand, it is above 40 or infinite, and a
/// single such row can spoil the solution everywhere (quarter of a tube in 3-D: 1e-1 instead of 2e-3).
const MOST_DOMINANCE_ERROR: f64 = 10.0;

/// The row of a boundary node: `sum_j c_j (u_j - u_i) + r u_i = g`.
#[derive(Debug, Clone)]
pub(super) struct BoundaryRow {
    pub(super) neighbors: Vec<u32>,
    pub(super) coefficients: Vec<f64>,
    pub(super) row_sum: f64,
    pub(super) rhs: f64,
}

impl BoundaryRow {
    /// Whether the row couples its node to the neighbours as a derivative into the domain does.
    pub(super) fn is_sound(&self) -> bool {
        let negated: Vec<f64> = self.coefficients.iter().map(|c| -c).collect();
        SignDiagnosis::of_row(&negated).dominance_error <= MOST_DOMINANCE_ERROR
    }
}

/// Collocates the conditions of boundary node `index` (its place in `cloud.boundary()`).
///
/// At an edge or a corner the conditions of all faces are added: with normals n_f that is the derivative along
/// their sum, which every smooth solution satisfies.
pub(super) fn collocate<const D: usize>(
    problem: &Problem<'_, D>,
    index: usize,
) -> Result<BoundaryRow, MethodError> {
    let node = &problem.cloud.boundary()[index];
    let i = node.node as usize;
    let position = || problem.cloud.points()[i].to_vec();
    let (mut direction, mut row_sum, mut rhs) = ([0.0; D], 0.0, 0.0);
    for (touch, condition) in node.touches.iter().zip(&problem.conditions[index]) {
        let (a, g) = condition
            .as_flux(problem.eta[i])
            .ok_or_else(|| MethodError::RobinWithoutFlux { node: i, position: position() })?;
        row_sum += a;
        rhs += g;
        direction.iter_mut().zip(touch.normal).for_each(|(d, n)| *d += n);
    }
    let fit = NodeFit::new(DEGREE, Weight::Exponential);
    let inward = Functional::Directional(direction.map(|d| -d));
    let row = |neighbors: Vec<u32>| -> Result<BoundaryRow, StencilError> {
        let mut coefficients = inward_derivative(problem, &fit, i, &neighbors, &inward)?;
        coefficients.iter_mut().for_each(|c| *c *= -problem.eta[i]);
        Ok(BoundaryRow { neighbors, coefficients, row_sum, rhs })
    };
    row(problem.supports.lists.of(i).to_vec())
        .or_else(|_| row(enlarged_support(problem, i)))
        .map_err(|source| MethodError::stencil(i, &problem.cloud.points()[i], source))
}

/// Coefficients of the derivative into the domain, corrected towards diagonal dominance like those of the equation:
/// one-sided stencils without the correction make the system nearly singular in three dimensions.
fn inward_derivative<const D: usize>(
    problem: &Problem<'_, D>,
    fit: &NodeFit<D>,
    i: usize,
    neighbors: &[u32],
    inward: &Functional<D>,
) -> Result<Vec<f64>, StencilError> {
    let mut scratch = fit.scratch(neighbors.len());
    fit.factor(problem, i, neighbors, &mut scratch)?;
    let mut coefficients = vec![0.0; neighbors.len()];
    fit.coefficients(inward, &mut scratch, &mut coefficients)?;
    let mut xi = vec![0.0; neighbors.len()];
    fit.correction(&mut scratch, &mut xi)?;
    add_correction(&mut coefficients, &xi);
    Ok(coefficients)
}
