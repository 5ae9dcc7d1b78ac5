//! What can be chosen.

/// Choices of the continuum surface reaction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReactionParams {
    /// Order of the DC-PSE operators.
    pub order: usize,
    /// How indicators of regions are smoothed.
    pub smoothing: Smoothing,
    /// Standard deviation of the smoothing in units of the spacing: the paper's `sqrt(2 T_w)`.
    pub width: f64,
    /// The diffusivity across an interface.
    pub sigma: Sigma,
    /// How a jump of the flux becomes a source.
    pub source: ReactionSource,
    /// Whether the equation has a `du/dt`: fits on the boundary then leave it out.
    pub unsteady: bool,
}

impl Default for ReactionParams {
    fn default() -> Self {
        Self {
            order: 2,
            smoothing: Smoothing::Distance,
            width: 1.5,
            sigma: Sigma::Harmonic,
            source: ReactionSource::Operator,
            unsteady: false,
        }
    }
}

impl ReactionParams {
    /// As the paper has it: averages of labels, `sigma(x) lap u`, and sources `S_s delta_w`, with the sign put right.
    pub fn paper() -> Self {
        Self {
            smoothing: Smoothing::Convolution,
            sigma: Sigma::Sharp,
            source: ReactionSource::Smoothed,
            ..Self::default()
        }
    }
}

/// How indicators of regions are smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Smoothing {
    /// A sum over the nodes within four widths, weighted by the Green's function of diffusion (4.26), (4.27).
    Convolution,
    /// Explicit steps of the diffusion equation (4.28).
    Diffusion,
    /// A function of the distance from the shapes of the regions, with the resistance of the sharp interface where that is
    /// curved.
    Distance,
}

/// The diffusivity across an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sigma {
    /// Resistances are averaged: right for the flux through an interface.
    Harmonic,
    /// Conductivities are averaged: right for the flux along it.
    Arithmetic,
    /// The paper's: that of the node's region, outside of the divergence.
    Sharp,
}

/// How a jump b of the flux becomes a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReactionSource {
    /// The discrete operator applied to a ramp whose flux jumps by b.
    Operator,
    /// The paper's (4.37): b times the normal derivative of the smoothed indicator.
    Smoothed,
}
