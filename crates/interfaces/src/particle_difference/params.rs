//! What can be chosen about the interface-immersed particle difference method.

use meshless_stencils::Weight;

/// How the other side of an interface continues the polynomial of a node's own side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wedge {
    /// As in the paper, by one slope: the interface is the tangent plane at the foot of the node, and the slope jumps by what the
    /// condition says at the foot (Yoon & Song, (26) to (35)).
    Plane,
    /// By a slope that varies along the interface to first order, over the distance from the interface itself: exact
    /// for all piecewise quadratic solutions whose second normal derivative does not jump.
    Varying,
    /// As before, and with the second derivative across the interface that the equation on both sides gives: exact for
    /// all piecewise quadratic solutions.
    Quadratic,
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
    /// Values beyond the stiffer side count less in a fit, by the ratio of the diffusivities: in units of the flux.
    pub flux_weights: bool,
    /// A node behind a slit is no neighbour of one before it. Without, as in the paper, whoever is beyond the line of the
    /// slit at the foot of a node is across it, also past the tip.
    pub visibility: bool,
    /// Fits near the tips of slits have the singular functions there, as far as the slits ask for it.
    pub enrichment: bool,
    /// In time: where the own value of a row has the wrong sign, or hardly any weight, all neighbours count alike; and jumps that are
    /// unknowns follow from fits for both sides.
    pub decaying: bool,
}

impl Default for ParticleDifferenceParams {
    fn default() -> Self {
        Self {
            degree: 2,
            weight: Weight::Quartic,
            wedge: Wedge::Quadratic,
            flux_weights: true,
            visibility: true,
            enrichment: true,
            decaying: false,
        }
    }
}

impl ParticleDifferenceParams {
    /// The method of the paper.
    pub fn paper() -> Self {
        let wedge = Wedge::Plane;
        Self { wedge, flux_weights: false, visibility: false, enrichment: false, ..Self::default() }
    }
}
