//! Options of single methods, by the names that they have in a scene.

/// Weight functions of least-squares stencils.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeightName {
    /// `quartic`
    Quartic,
    /// `exponential`
    Exponential,
}

/// How the other side of an interface continues this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WedgeName {
    /// `plane`
    Plane,
    /// `varying`
    Varying,
    /// `quadratic`
    Quadratic,
}

/// How values beyond an interface are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GhostsName {
    /// `constrained`
    Constrained,
    /// `linear`
    Linear,
    /// `trilinear`
    Trilinear,
    /// `quadratic`
    Quadratic,
    /// `cubic`
    Cubic,
}

/// Where interfaces are from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InterfacesName {
    /// `shapes`
    Shapes,
    /// `labels`
    Labels,
}

/// How indicators of regions are smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KernelName {
    /// `convolution`
    Convolution,
    /// `diffusion`
    Diffusion,
    /// `distance`
    Distance,
}

/// The diffusivity across an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SigmaName {
    /// `harmonic`
    Harmonic,
    /// `arithmetic`
    Arithmetic,
    /// `sharp`
    Sharp,
}

/// Which nodes of the sharp method have a balance for a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConservationName {
    /// `none`
    None,
    /// `crossing`
    Crossing,
    /// `all`
    All,
}

/// How a jump of the flux becomes a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReactionName {
    /// `operator`
    Operator,
    /// `smoothed`
    Smoothed,
}

/// Options of single methods (Kraus et al. 2022, "A meshfree point collocation method for elliptic interface
/// problems"; Yoon & Song 2021, "Interface Immersed Particle Difference Method").
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MethodOptions {
    /// Smoothing cycles of the diffusivity.
    pub smoothing: Option<usize>,
    /// Work with log eta.
    pub log_scaling: Option<bool>,
    /// Correct stencils towards diagonal dominance.
    pub correction: Option<bool>,
    /// Boundary conditions on the flux by cell balances.
    pub conservative_neumann: Option<bool>,
    /// Support radius in units of the spacing, above 1.
    pub support: Option<f64>,
    /// Diagonal-dominance error above which a node gets a conservative row, not negative.
    pub selection_tolerance: Option<f64>,
    /// Nodes whose support reaches into another region get a conservative row as well.
    pub select_by_region: Option<bool>,
    /// Weight of neighbours by their distance.
    pub weight: Option<WeightName>,
    /// The other side of an interface.
    pub wedge: Option<WedgeName>,
    /// Values beyond a stiff side count less.
    pub flux_weights: Option<bool>,
    /// Nodes do not see through slits.
    pub visibility: Option<bool>,
    /// Balances in place of collocation.
    pub conservation: Option<ConservationName>,
    /// Values beyond an interface.
    pub ghosts: Option<GhostsName>,
    /// Interfaces from the shapes of the regions, or from the labels of the nodes alone.
    pub interfaces: Option<InterfacesName>,
    /// Smoothing of the indicators of regions.
    pub kernel: Option<KernelName>,
    /// The diffusivity across an interface.
    pub sigma: Option<SigmaName>,
    /// Sources at interfaces.
    pub reaction: Option<ReactionName>,
    /// Width over which interfaces are smeared, in units of the spacing.
    pub width: Option<f64>,
}
