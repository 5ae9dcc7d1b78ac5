//! What can be chosen about the generalised finite difference methods.

/// How the strong-form operator treats the diffusivity (Kraus et al. 2022, section 2.2.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrongParams {
    /// Polynomial degree that stencils reproduce.
    pub degree: usize,
    /// Smoothing cycles of the diffusivity.
    pub smoothing: usize,
    /// Work with `log eta` (17) instead of eta (16).
    pub log_scaling: bool,
    /// Add the multiple of the correction vector (18) that favours the diagonal.
    pub correction: bool,
}

impl Default for StrongParams {
    fn default() -> Self {
        Self { degree: 2, smoothing: 0, log_scaling: true, correction: true }
    }
}

/// Which interior nodes get a conservative row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection {
    /// None: the classical method.
    None,
    /// Those whose strong row is not diagonally dominant: the "positivity preserving" hybrid.
    Flagged,
    /// These and their neighbours: the "conservative" hybrid.
    FlaggedAndNeighbors,
    /// All.
    All,
}

/// Parameters of a generalised finite difference method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GfdmParams {
    /// The strong-form operator.
    pub strong: StrongParams,
    /// Where the conservative operator replaces it.
    pub selection: Selection,
    /// Tolerance of the diagonal-dominance error (23): a node is flagged where it exceeds this.
    pub selection_tolerance: f64,
    /// Also select the nodes whose support reaches into another region. The diagonal-dominance criterion alone does
    /// not see small jumps (section 4 of the paper); a scene that knows its regions need not rely on it.
    pub select_by_region: bool,
    /// Boundary conditions on the flux by cell balances (21) instead of stencils.
    pub conservative_neumann: bool,
}

impl GfdmParams {
    /// Tolerance of (23) in appendix A of the paper.
    pub const SELECTION_TOLERANCE: f64 = 1e-12;

    /// The strong form alone, with two smoothing cycles and logarithmic scaling: the paper's best strong form.
    pub fn classical() -> Self {
        Self {
            strong: StrongParams { smoothing: 2, ..StrongParams::default() },
            selection: Selection::None,
            selection_tolerance: Self::SELECTION_TOLERANCE,
            select_by_region: false,
            conservative_neumann: false,
        }
    }

    /// Conservative rows at every node.
    pub fn conservative() -> Self {
        Self { selection: Selection::All, ..Self::hybrid() }
    }

    /// Conservative rows where the strong row is not diagonally dominant.
    pub fn positive() -> Self {
        Self { selection: Selection::Flagged, ..Self::hybrid() }
    }

    /// Conservative rows where the strong row is not diagonally dominant, and at the neighbours of such nodes.
    ///
    /// The diffusivity is not smoothed, but scaled logarithmically: without the scaling the flagged nodes do not
    /// depend on the jump.
    pub fn hybrid() -> Self {
        Self {
            strong: StrongParams::default(),
            selection: Selection::FlaggedAndNeighbors,
            selection_tolerance: Self::SELECTION_TOLERANCE,
            select_by_region: false,
            conservative_neumann: true,
        }
    }
}
