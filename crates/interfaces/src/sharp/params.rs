//! What can be chosen about the sharp method.

/// Highest order that is offered, by dimension.
pub const MAX_ORDER: [usize; 3] = [16, 16, 8];

/// Nodes of a stencil in two dimensions for the orders 2, 4, 6, …: about two and a half times as many as there are
/// harmonic polynomials of that degree.
const NODES_2D: [usize; 8] = [12, 24, 32, 50, 60, 75, 87, 100];

/// The same in three dimensions.
const NODES_3D: [usize; 4] = [24, 50, 110, 190];

/// Nodes of a stencil in one dimension beyond the order.
const NODES_1D_BEYOND: usize = 3;

/// At order 2 as well: with polynomials of degree 2 errors are 10 to 100 times as large and clouds decide about the order; see
/// `docs/sharp.md`.
const LEAST_DEGREE: usize = 3;

/// Degrees that the polynomials of sources have beyond those of the order, in Trefftz's form: a particular part that
/// is better than the rest makes the form as accurate as the general one, whose equation rows see the source as well.
const SOURCE_DEGREES_BEYOND: usize = 2;

/// How the equation enters a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// As rows, with all polynomials up to the order; for any diffusivity.
    General,
    /// Solved beforehand: harmonic polynomials and a particular part where the diffusivity of a region is constant, and
    /// what solves the equation up to the degree of the fit where it varies.
    Trefftz,
}

/// Which nodes have the balance of heat over their cell for a row, where there is a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conservation {
    /// None: their values are what others predict.
    None,
    /// Those whose stencils cross an interface.
    Crossing,
    /// All nodes whose value is not prescribed.
    All,
}

/// Parameters of the sharp method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharpParams {
    /// Order of the error in u, even.
    pub order: usize,
    /// Degree of the polynomials; `None` for the order, or one more at order 2.
    pub degree: Option<usize>,
    /// Nodes of a stencil, the node itself included; `None` for the number that suits the order.
    pub nodes: Option<usize>,
    /// Weight of the rows that say how u and its flux jump.
    pub jump_weight: f64,
    /// Weight of the rows that say that the equation holds.
    pub equation_weight: f64,
    /// How the equation enters a fit.
    pub form: Form,
    /// Degree of the polynomials that sources are fitted by in Trefftz's form; `None` for one that suits the order.
    pub source_degree: Option<usize>,
    /// Which nodes have a balance for a row; in two and three dimensions, in steady problems.
    pub conservation: Conservation,
    /// The equation has a `du/dt`: rows get a mass.
    pub unsteady: bool,
    /// Keep the gradients at the nodes with the rows, from the same factors: else every stencil is factored again where they are
    /// wanted. They take D numbers for each node of a stencil. In time they see the rates, and are not kept.
    pub keep_gradients: bool,
}

impl Default for SharpParams {
    fn default() -> Self {
        Self {
            order: 4,
            degree: None,
            nodes: None,
            jump_weight: 10.0,
            equation_weight: 100.0,
            form: Form::Trefftz,
            source_degree: None,
            conservation: Conservation::Crossing,
            unsteady: false,
            keep_gradients: false,
        }
    }
}

impl SharpParams {
    /// Degree of the polynomials.
    pub fn degree(&self) -> usize {
        self.degree.unwrap_or(self.order.max(LEAST_DEGREE))
    }

    /// Degree of the polynomials that sources are fitted by in Trefftz's form.
    pub fn source_degree(&self) -> usize {
        self.source_degree.unwrap_or(self.degree() - 2 + SOURCE_DEGREES_BEYOND)
    }

    /// Nodes of a stencil in `dimension` dimensions, the node itself included.
    pub fn stencil_nodes(&self, dimension: usize) -> usize {
        self.nodes.unwrap_or_else(|| {
            let table: &[usize] = match dimension {
                1 => return self.order + NODES_1D_BEYOND,
                2 => &NODES_2D,
                _ => &NODES_3D,
            };
            table[(self.order / 2).clamp(1, table.len()) - 1]
        })
    }
}
