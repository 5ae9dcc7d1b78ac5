//! What can be chosen about the interface-immersed particle difference method.

use meshless_stencils::Weight;

/// How the other side of an interface continues the polynomial of a node's own side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wedge {
    /// By one slope: the interface is the tangent plane at the foot of the node, and the slope jumps by what the
    /// condition says at the foot (Yoon & Song, (26) to (35)).
    Plane,
    /// By a slope that varies along the interface to first order, over the distance from the interface itself: exact
    /// for all piecewise quadratic solutions whose second normal derivative does not jump.
    Varying,
}

/// Parameters of the interface-immersed particle difference method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleDifferenceParams {
    /// Degree of the polynomials.
    pub degree: usize,
    /// Weight of a neighbour by its distance; the paper has an exponential and a quartic one.
    pub weight: Weight,
    /// The other side of an interface.
    pub wedge: Wedge,
}

impl Default for ParticleDifferenceParams {
    fn default() -> Self {
        Self { degree: 2, weight: Weight::Quartic, wedge: Wedge::Plane }
    }
}
