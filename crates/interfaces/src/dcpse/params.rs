//! What can be chosen.

/// Choices of the immersed interface method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImmersedParams {
    /// Order of the DC-PSE operators.
    pub order: usize,
    /// How values beyond an interface or on the boundary are made.
    pub ghosts: Ghosts,
    /// Whether the equation has a `du/dt`: constrained fits then know of it only that it is the same on both sides of an
    /// interface, where nothing but data of the problem stands for it otherwise.
    pub unsteady: bool,
}

impl Default for ImmersedParams {
    fn default() -> Self {
        Self { order: 2, ghosts: Ghosts::Constrained { degree: 2 }, unsteady: false }
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
    /// The paper's: interpolation at the mirror image, and a Taylor expansion of first order.
    Image(Interpolation),
}

/// How the value at an image point is interpolated from the nearest nodes of its region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The paper's (4.8): products of different coordinates, from as many nodes.
    Trilinear,
    /// All polynomials of a degree.
    Complete {
        /// The degree, at least 1.
        degree: usize,
    },
}

/// Degree of the polynomials for which the operators of an order are exact: those of second derivatives.
pub(super) fn operator_degree(order: usize) -> usize {
    order + 1
}
