//! What can be chosen.

/// Choices of the immersed interface method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImmersedParams {
    /// Order of the DC-PSE operators.
    pub order: usize,
    /// How values beyond an interface or on the boundary are made.
    pub ghosts: Ghosts,
}

impl Default for ImmersedParams {
    fn default() -> Self {
        Self { order: 2, ghosts: Ghosts::Constrained { degree: 2 } }
    }
}

/// How the value of a ghost is made from values at nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ghosts {
    /// One polynomial on each side, fitted to the nodes of that side under the conditions at the interface.
    Constrained {
        /// Degree of the polynomials, at least 2.
        degree: usize,
    },
}

/// Degree of the polynomials for which the operators of an order are exact: those of second derivatives.
pub(super) fn operator_degree(order: usize) -> usize {
    order + 1
}
