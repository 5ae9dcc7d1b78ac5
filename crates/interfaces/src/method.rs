//! What a method is: a function from a discretised problem to a linear system, with the way back to a field.

use meshless_sparse::{DifferenceMatrix, Split};

use crate::gfdm::CellFlows;
use crate::{Corner, GradientRow, MethodError, Problem, Sample, SystemSolution, gradient};

/// A meshless discretisation of an elliptic interface problem.
pub trait Method<const D: usize>: Sync {
    /// The rows of the linear system, one for each node.
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError>;

    /// The gradient of a nodal field, every node in its own region.
    ///
    /// Unless a method knows better: the gradient of a least-squares fit to the nodes of the same region.
    fn gradient(&self, problem: &Problem<'_, D>, u: &[f64]) -> Result<Vec<[f64; D]>, MethodError> {
        gradient::recover(problem, u)
    }

    /// The gradient of a solution, every node in its own region: that of its nodal values, unless the method has unknowns
    /// of its own that say more than these.
    fn gradient_of(
        &self,
        problem: &Problem<'_, D>,
        solution: &SystemSolution,
    ) -> Result<Vec<[f64; D]>, MethodError> {
        self.gradient(problem, &solution.u)
    }

    /// Values and gradients of a solution anywhere, each point in its own region and `None` where no node of that is
    /// near; `None` as a whole for methods that leave this to a [`Sampler`](crate::Sampler).
    fn samples(
        &self,
        _problem: &Problem<'_, D>,
        _solution: &SystemSolution,
        _points: &[[f64; D]],
    ) -> Result<Option<Vec<Option<Sample<D>>>>, MethodError> {
        Ok(None)
    }

    /// The fluxes of a solution as balances over cells have them; `None` for methods without such balances.
    fn cell_flows(
        &self,
        _problem: &Problem<'_, D>,
        _solution: &SystemSolution,
    ) -> Result<Option<CellFlows<D>>, MethodError> {
        Ok(None)
    }
}

/// A linear system over the nodes, in difference form.
#[derive(Debug, Clone)]
pub struct Discretization {
    /// Rows of the nodes and, where there are any, of further unknowns. Row i reads `sum_j a_ij (u_j - u_i) + r_i u_i = b_i`. Rows of nodes whose value is prescribed read
    /// `u_i = value`: the shared layer eliminates them.
    pub rows: DifferenceMatrix,
    /// Right-hand side b.
    pub rhs: Vec<f64>,
    /// Where a method splits off the constants of stiff regions itself: what its rows act on. `None` for rows in
    /// nodal values, whose constants the shared layer splits off.
    pub constants: Option<SplitRows>,
    /// The rows of M in `M du/dt + A u = b`, over the values of the nodes. `None` for the capacity of every row on the diagonal,
    /// and zero for prescribed values and collocated boundary conditions.
    pub mass: Option<DifferenceMatrix>,
    /// The integral of the capacity that belongs to every row, where that is not the volume times the capacity at the node.
    pub capacities: Option<Vec<f64>>,
    /// How every row was made.
    pub kinds: Vec<RowKind>,
    /// Measure that belongs to every node: the volume of its cell where there is one, else `spacing^D`.
    pub volumes: Vec<f64>,
    /// What was built and why.
    pub counts: Counts,
    /// Wall-clock seconds spent on stencils and cells, before assembly.
    pub stencil_seconds: f64,
    /// Unknowns beside the values of the nodes: jumps of the slope at points of interfaces. Their rows and right-hand
    /// sides come after those of the nodes.
    pub interface_points: Vec<InterfacePoint>,
    /// The gradient at every node, where the method has kept it from what its rows are made of; see
    /// [`Discretization::gradient`].
    pub gradients: Option<Vec<GradientRow>>,
    /// The vertices at which the solution is no polynomial, and which of them the method has functions for; `None` for a method that
    /// does not look for them.
    pub corners: Option<Vec<Corner>>,
    /// Fluxes through interfaces as balances have them, where a method has balances all along an interface on which the slope of u may be
    /// infinite.
    pub interface_fluxes: Vec<InterfaceFlux>,
}

/// The flux through the interface of two regions, `int eta du/dn` with n out of the first one: a functional of what rows act on.
#[derive(Debug, Clone, PartialEq)]
pub struct InterfaceFlux {
    /// The regions, in ascending order.
    pub between: [u16; 2],
    /// Area of the interface.
    pub area: f64,
    /// Nodes and factors of their values, once each.
    pub values: Vec<(u32, f64)>,
    /// Constants and their factors.
    pub constants: Vec<(u32, f64)>,
    /// What the data add, as the first region sees it and as the second one does.
    pub known: [f64; 2],
}

/// The same of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterfaceFlow {
    /// The regions, in ascending order.
    pub between: [u16; 2],
    /// Area of the interface.
    pub area: f64,
    /// `int eta du/dn` with n out of the first region, on either side.
    pub sides: [f64; 2],
}

impl InterfaceFlux {
    /// The flux for values of the nodes and of the constants.
    pub(crate) fn of(&self, values: &[f64], constants: &[f64]) -> InterfaceFlow {
        let sum = |factors: &[(u32, f64)], of: &[f64]| -> f64 {
            factors.iter().map(|(k, factor)| factor * of[*k as usize]).sum()
        };
        let flux = sum(&self.values, values) + sum(&self.constants, constants);
        InterfaceFlow { between: self.between, area: self.area, sides: self.known.map(|known| flux + known) }
    }
}

impl Discretization {
    /// Rows of the values of the nodes alone: none that were split already, none of further unknowns, no mass but volumes, no gradients.
    pub fn of_nodes(
        (rows, rhs): (DifferenceMatrix, Vec<f64>),
        volumes: Vec<f64>,
        kinds: Vec<RowKind>,
        counts: Counts,
        stencil_seconds: f64,
    ) -> Self {
        let (constants, mass, capacities, gradients, corners) = (None, None, None, None, None);
        let (interface_points, interface_fluxes) = (Vec::new(), Vec::new());
        Self {
            rows,
            rhs,
            constants,
            mass,
            capacities,
            kinds,
            volumes,
            counts,
            stencil_seconds,
            interface_points,
            gradients,
            corners,
            interface_fluxes,
        }
    }

    /// The gradient of a solution at every node, in its own region: from what was kept with the rows, else by the method.
    ///
    /// # Errors
    /// Those of [`Method::gradient_of`].
    pub fn gradient<const D: usize>(
        &self,
        method: &dyn Method<D>,
        problem: &Problem<'_, D>,
        solution: &SystemSolution,
    ) -> Result<Vec<[f64; D]>, MethodError> {
        match &self.gradients {
            Some(rows) => Ok(rows.iter().map(|row| row.of(solution)).collect()),
            None => method.gradient_of(problem, solution),
        }
    }
}

/// A point of an interface with an unknown of its own: the jump of the slope along the normal.
#[derive(Debug, Clone, PartialEq)]
pub struct InterfacePoint {
    /// Its coordinates.
    pub at: Vec<f64>,
    /// Unit normal from the first region to the second.
    pub normal: Vec<f64>,
    /// The regions.
    pub between: [u16; 2],
}

/// Rows that act on `w` and `C` of `u_i = offset_i + sum_K sigma_K C_K + s_i w_i` in place of nodal values: methods whose stencils
/// weigh the sides of an interface against each other must know the scales before they make a row.
#[derive(Debug, Clone, PartialEq)]
pub struct SplitRows {
    /// The change of unknowns over all nodes; prescribed nodes have no constant.
    pub split: Split,
    /// Coefficients of every `C_K`: row, value.
    pub columns: Vec<Vec<(u32, f64)>>,
    /// What is known of u beforehand, one number a node; the rows have it on their right-hand sides. Zero in time.
    pub offsets: Vec<f64>,
}

/// How the row of a node was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// The value is prescribed.
    Dirichlet,
    /// Collocation of the equation by a local least-squares stencil.
    Strong,
    /// Collocation of a boundary condition by a local least-squares stencil.
    StrongBoundary,
    /// Collocation of the equation by a stencil that the interface condition is built into.
    Constrained,
    /// Balance of fluxes over the node's Voronoi cell.
    Conservative,
}

/// How much of everything a method built.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Least-squares stencils.
    pub stencils: usize,
    /// Stencils that needed a larger support than the one given.
    pub enlarged: usize,
    /// Interior nodes whose strong row is not diagonally dominant (the set `I_{sigma,0}` of Kraus et al. 2022).
    pub flagged: usize,
    /// Stencils that an interface condition is built into.
    pub constrained: usize,
    /// Voronoi cells.
    pub cells: usize,
}
