//! The report of a solve: what the command prints as JSON (field names are a contract).

use std::collections::BTreeMap;

use serde::Serialize;

/// Everything about a solve but the field itself.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Nodes whose value was solved for.
    pub unknowns: usize,
    /// Typical distance of nodes (the least one for graded clouds).
    pub spacing: f64,
    /// Name of the method.
    pub method: String,
    /// Order of the method: the polynomial degree that its stencils reproduce.
    pub order: usize,
    /// Why another method ran than the plan says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fallback: Option<String>,
    /// The layer, gap or inclusion that the fits of the sharp method resolve least, absent where all are two spacings thick; with
    /// another method, one that its nodes do not see.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thin_layer: Option<ThinLayerReport>,
    /// Where stiff regions touch each other or a wall in a point; empty where none do.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactReport>,
    /// The vertices at which the solution has a power of the distance below the order that is no polynomial, and in space edges; empty
    /// where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<CornerReport>,
    /// Largest diffusivity of a node over the smallest.
    pub contrast: f64,
    /// What the scene calls for.
    pub effects: Vec<String>,
    /// What it does not call for, and so was not built.
    pub skipped: Vec<String>,
    /// Errors against the exact solution, where the scene has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors: Option<Errors>,
    /// Errors estimated without it.
    pub estimate: Estimate,
    /// What enters, arises, is stored, and is left over; absent in free space, which has no boundary.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub balance: Option<BalanceReport>,
    /// How the tolerance was reached, where the scene has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<AccuracyReport>,
    /// Smallest and largest value.
    pub extrema: Extrema,
    /// Smallest and largest magnitude of the velocity, where the scene has a vorticity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<Extrema>,
    /// How the linear system was solved.
    pub solver: SolverReport,
    /// How nodes were treated.
    pub nodes: NodeReport,
    /// Properties of the matrix.
    pub matrix: MatrixSummary,
    /// How an unsteady scene was stepped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<TimeReport>,
    /// Wall-clock seconds of the stages.
    pub seconds: Seconds,
    /// Largest memory of the process so far, in units of 1e6 bytes; 0 where the system does not tell.
    pub peak_memory_mb: f64,
    /// Values at the probes.
    pub probes: Vec<Probe>,
    /// Fluxes through the parts of the boundary and the interfaces, where the scene asks for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fluxes: Option<FluxReport>,
}

/// Totals of `eta du/dn`.
#[derive(Debug, Clone, Default, Serialize)]
pub struct FluxReport {
    /// Through the part of the boundary of every condition, in the order of the scene.
    pub boundaries: Vec<BoundaryFlux>,
    /// Through every interface of two regions.
    pub interfaces: Vec<InterfaceFlux>,
    /// The relative part of the [balance](BalanceReport) that is left over: about the relative error of the fluxes.
    pub left_over: f64,
}

/// What enters through the boundary and arises inside, less what is stored: nothing is left over of an exact solution.
#[derive(Debug, Clone, Default, Serialize)]
pub struct BalanceReport {
    /// What enters through the part of the boundary of every condition, in the order of the scene.
    #[serde(rename = "in")]
    pub into: Vec<BoundaryFlux>,
    /// What arises inside.
    pub sources: SourceReport,
    /// The rate of what is stored at the end, in scenes with time: the integral of `capacity du/dt`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stored: Option<f64>,
    /// What the reaction takes up: the integral of `reaction u`. Where the equation has neither that nor a velocity, there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reacted: Option<f64>,
    /// What the velocity carries away: the integral of `velocity . grad u`; likewise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<f64>,
    /// What enters and arises, less what is stored, reacts, and is carried away.
    pub left_over: f64,
    /// The size of that over the sum of the sizes of the parts, the integrals of the flux's size among them.
    pub relative: f64,
    /// The same for each region by itself, by name.
    pub regions: BTreeMap<String, RegionBalance>,
}

/// What arises inside.
#[derive(Debug, Clone, Default, Serialize)]
pub struct SourceReport {
    /// All of it.
    pub total: f64,
    /// Integrals of the source over the regions, by name.
    pub regions: BTreeMap<String, f64>,
    /// What prescribed jumps of the flux on interfaces make.
    pub flux_jumps: f64,
}

/// The balance of a region.
#[derive(Debug, Clone, Default, Serialize)]
pub struct RegionBalance {
    /// What enters through the boundary.
    pub boundaries: f64,
    /// What enters through interfaces.
    pub interfaces: f64,
    /// What arises inside.
    pub sources: f64,
    /// The rate of what is stored, in scenes with time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stored: Option<f64>,
    /// What the reaction takes up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reacted: Option<f64>,
    /// What the velocity carries away.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<f64>,
    /// What enters and arises, less what is stored, reacts, and is carried away.
    pub left_over: f64,
    /// The size of that over the sum of the sizes of the parts.
    pub relative: f64,
}

/// What enters through a part of the boundary.
#[derive(Debug, Clone, Default, Serialize)]
pub struct BoundaryFlux {
    /// The face of the condition.
    pub face: String,
    /// Its place in the scene, from 0.
    pub entry: usize,
    /// The integral of `eta du/dn`, n out of the domain.
    pub flux: f64,
    /// Length or area of the part; the number of points on the line.
    pub area: f64,
    /// Estimated absolute error of the flux, where the scene asks for fluxes and there is an estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimate: Option<f64>,
}

/// What passes an interface.
#[derive(Debug, Clone, Default, Serialize)]
pub struct InterfaceFlux {
    /// Names of the regions A and B, in the order of the scene.
    pub between: Vec<String>,
    /// The integral of `eta du/dn`, n from A to B, on the side that conducts less: what enters A.
    pub flux: f64,
    /// Length or area.
    pub area: f64,
    /// Estimated absolute error of the flux, where there is an estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimate: Option<f64>,
}

/// A layer, gap or inclusion that is thinner than fits want it: the solution is less accurate there.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ThinLayerReport {
    /// Name of the region.
    pub region: String,
    /// The middle of it, where it is thinnest in units of the spacing.
    pub at: Vec<f64>,
    /// How thin it is there.
    pub thickness: f64,
    /// The spacing that would resolve it.
    pub resolving_spacing: f64,
    /// Whether nodes on its two sides are kept apart. Where not, it is partly missing in what was solved, and no estimate of
    /// the error is given.
    pub seen: bool,
}

/// Stiff regions that touch without an angle: no spacing resolves the tip of the gap between them, and no estimate is given.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ContactReport {
    /// Where.
    pub at: Vec<f64>,
    /// Names of the regions that touch, or `boundary`.
    pub between: Vec<String>,
    /// Name of the region in the gap.
    pub gap: String,
}

/// A corner of an interface or of the boundary, or a place where conditions change, at which `u ~ r^exponent`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct CornerReport {
    /// Where; a point of it, of an edge in space.
    pub at: Vec<f64>,
    /// The smallest power of the distance that the solution has there and polynomials have not; 0 where two prescribed values meet.
    pub exponent: f64,
    /// Whether the method has functions with that power there.
    pub served: bool,
    /// Why it has not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
}

/// The time steps of an unsteady scene.
#[derive(Debug, Clone, Default, Serialize)]
pub struct TimeReport {
    /// The time at which it ends; all errors, probes and pictures are about this time.
    pub end: f64,
    /// Steps taken.
    pub steps: usize,
    /// Steps that were tried and rejected.
    pub rejected: usize,
    /// Matrices that were factored, or made a preconditioner for.
    pub matrices: usize,
    /// Times before the end at which the field was kept.
    pub output: Vec<f64>,
}

/// Relative norms of the error; definitions in [`crate::norms`].
#[derive(Debug, Clone, Default, Serialize)]
pub struct Errors {
    /// Relative L2 norm.
    pub l2: f64,
    /// Relative maximum norm.
    pub linf: f64,
    /// Relative maximum norm of the gradient, each node in its own region.
    pub gradient_linf: f64,
    /// Relative maximum norm of the jumps of the slope, for a method that has them as unknowns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jump_linf: Option<f64>,
    /// The same over each region alone, relative to the exact solution there.
    pub regions: BTreeMap<String, RegionErrors>,
}

/// Norms over one region.
#[derive(Debug, Clone, Default, Serialize)]
pub struct RegionErrors {
    /// Relative L2 norm.
    pub l2: f64,
    /// Relative maximum norm.
    pub linf: f64,
    /// Relative maximum norm of the gradient.
    pub gradient_linf: f64,
}

/// Error estimated by comparison with another solution: of a higher degree on the same cloud, or on a coarser one.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Estimate {
    /// Relative L2 norm; absent where there is nothing to compare with, or where no comparison can be trusted.
    pub l2: Option<f64>,
    /// The same over each region by itself, by name, where there are several: u may be much smaller in one than in another. A region in which u
    /// is round-off has none.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub regions: BTreeMap<String, f64>,
    /// Why there is no estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
    /// What says that the error is larger than the comparison does, where something does: `balance` or `corners`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raised_by: Option<String>,
    /// What the comparison said of the whole, where that was raised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compared: Option<f64>,
}

/// The clouds that were tried for a tolerance; the report is about the last one, and its `seconds.total` about all.
#[derive(Debug, Clone, Default, Serialize)]
pub struct AccuracyReport {
    /// Relative error to reach; twice the estimate of the last cloud is below it.
    pub tolerance: f64,
    /// What it is about: `u`, `fluxes` or `probes`.
    pub of: String,
    /// The clouds, in the order in which they were tried.
    pub rungs: Vec<Rung>,
}

/// A cloud that was tried.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Rung {
    /// Its spacing.
    pub spacing: f64,
    /// Nodes whose value was solved for; 0 where the cloud was too coarse to be solved on.
    pub unknowns: usize,
    /// Estimated relative error of what the tolerance is about.
    pub estimate: Option<f64>,
    /// What raised it, where something did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raised_by: Option<String>,
    /// Why it could not be solved on, or has no estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// Smallest and largest nodal value.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Extrema {
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
    /// Estimated absolute error of both, where there is an estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimate: Option<f64>,
}

/// How the linear system was solved.
#[derive(Debug, Clone, Default, Serialize)]
pub struct SolverReport {
    /// Name of the solver with its preconditioner.
    pub name: String,
    /// Iterations; 0 for a direct solve.
    pub iterations: usize,
    /// Relative true residual.
    pub residual: f64,
    /// Componentwise backward error.
    pub backward_error: f64,
    /// What ended the solve: `residual`, which met the tolerance, or `round-off`, beyond which no solution fits better.
    pub criterion: String,
    /// Constants of floating stiff regions that were solved for beside the nodes.
    pub floating_constants: usize,
}

/// How many nodes were treated in which way.
#[derive(Debug, Clone, Default, Serialize)]
pub struct NodeReport {
    /// Prescribed values.
    pub dirichlet: usize,
    /// Least-squares stencils for the equation.
    pub strong: usize,
    /// Least-squares stencils for boundary conditions.
    pub strong_boundary: usize,
    /// Balances over Voronoi cells.
    pub conservative: usize,
    /// Stencils that an interface condition is built into.
    pub constrained: usize,
    /// Nodes whose strong row is not diagonally dominant.
    pub flagged: usize,
    /// Stencils that needed a larger support than the one given.
    pub enlarged: usize,
}

/// Properties of the matrix that the discrete maximum principle and conservation rest on.
#[derive(Debug, Clone, Default, Serialize)]
pub struct MatrixSummary {
    /// Largest off-diagonal entry of the wrong sign over the diagonal of its row; 0 for an M-matrix.
    pub wrong_sign: f64,
    /// Largest sum of a row that should vanish, over its diagonal.
    pub row_sum: f64,
    /// Largest sum of a column of interior conservative nodes, over its diagonal: the discrete divergence theorem.
    pub column_sum: f64,
    /// How far u leaves the range of the prescribed values, relative to that range; only where there is no source and
    /// no prescribed flux, so that the maximum principle holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overshoot: Option<f64>,
}

/// Wall-clock seconds.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Seconds {
    /// Generation of the cloud.
    pub points: f64,
    /// Neighbour lists, and who is next to whom.
    pub neighbors: f64,
    /// Coefficients, stencils, cells.
    pub stencils: f64,
    /// Assembly of the matrix.
    pub assembly: f64,
    /// Solution of the linear system.
    pub solve: f64,
    /// Gradient, errors, probes.
    pub post: f64,
    /// The error estimate.
    pub estimate: f64,
    /// The balance, with what it says of the estimate.
    pub balance: f64,
    /// All of it.
    pub total: f64,
}

/// A value asked for.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Probe {
    /// Where.
    pub at: Vec<f64>,
    /// The value; absent where the point lies outside of the domain.
    pub value: Option<f64>,
    /// Estimated absolute error, where there is an estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimate: Option<f64>,
    /// The velocity, where the scene has a vorticity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
}
