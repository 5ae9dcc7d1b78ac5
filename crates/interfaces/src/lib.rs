//! Meshless discretisations of elliptic interface problems, one method a folder.
//!
//! A method is a function from a discretised problem – cloud, supports, coefficients, conditions – to a linear system
//! in difference form, with the way back to a field and its gradient. All methods share one layer below them, which
//! eliminates prescribed values, splits off the constants of stiff regions that touch no prescribed value, and solves:
//! [`solve`]. So a method never sees a solver, and a solver never sees a method.
//!
//! **Not for** describing scenes (that is the facade `meshless`), and not for geometry, neighbour lists, stencils,
//! cells or solvers themselves, each of which is a crate that can be used alone.
//!
//! # Example
//!
//! Two materials side by side, conductivities 1 and 1000, values 1 and 0 at the ends:
//!
//! ```
//! use meshless_geometry::{Cloud, CloudParams, Domain, Layout, RegionMap, Shape, Spacing, generate};
//! use meshless_interfaces::gfdm::{Gfdm, GfdmParams};
//! use meshless_interfaces::{Condition, Field, Material, Method, Problem, Supports, solve};
//! use meshless_neighbors::{Distance, Radius, within_radius};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let domain = Domain::boxed([0.0], [2.0])?;
//! let cloud = generate(&domain, &CloudParams {
//!     spacing: Spacing::Uniform(0.05), layout: Layout::Jittered, seed: 1, max_nodes: 1000 })?;
//! let radius = vec![0.16; cloud.len()];
//! let lists = within_radius(cloud.points(), Radius::PerPoint(&radius), Distance::D2)?;
//! let regions = RegionMap::new(vec![Some(Shape::cuboid([0.0], [1.0])?), None])?;
//! let labels = regions.labels(&cloud);
//! let eta: Vec<f64> = labels.iter().map(|&l| if l == 0 { 1.0 } else { 1000.0 }).collect();
//! let materials = [1.0, 1000.0].map(|eta| Material::new(Field::Constant(eta)));
//! let boundary = |_face, x: &[f64; 1]| Some(Condition::Dirichlet(1.0 - 0.5 * x[0]));
//! let conditions = cloud.boundary().iter()
//!     .map(|node| vec![Condition::Dirichlet(1.0 - 0.5 * cloud.points()[node.node as usize][0])]).collect::<Vec<_>>();
//! let problem = Problem {
//!     cloud: &cloud, domain: &domain, supports: Supports { lists: &lists, radius: &radius }, regions: &regions,
//!     labels: &labels, materials: &materials, eta: &eta, source: None, conditions: &conditions,
//!     boundary: &boundary, laws: &[], law_rates: &[], slits: &[] };
//! let discretization = Gfdm { params: GfdmParams::conservative() }.discretize(&problem)?;
//! let solution = solve(&problem, &discretization, &Default::default())?;
//! // Nearly all of the drop is in the first material.
//! let nearest = |x: f64| (0..cloud.len())
//!     .min_by(|&a, &b| (cloud.points()[a][0] - x).abs().total_cmp(&(cloud.points()[b][0] - x).abs())).unwrap();
//! assert!(solution.u[nearest(1.2)] < 0.05);
//! # Ok(()) }
//! ```

mod adjacency;
mod corners;
pub mod dcpse;
mod diagnosis;
mod equation;
mod error;
mod field;
pub mod gfdm;
mod gradient;
mod gradient_rows;
mod instances;
mod local;
mod method;
mod operator_rows;
mod parallel;
pub mod particle_difference;
pub mod phase_field;
mod problem;
mod row_report;
mod sample;
pub mod sharp;
mod slit;
mod support_values;
mod surface_field;
mod system;
pub mod thin_layers;

pub use adjacency::adjacent_pairs;
pub use corners::{Corner, CornerData, Obstacle, corners};
pub use diagnosis::{NodeDiagnosis, diagnose_nodes};
pub use equation::{BoundaryData, Condition, InterfaceLaw, Material};
pub use error::{MethodError, RegionName};
pub use field::{Field, ScalarField};
pub use gradient_rows::GradientRow;
#[doc(hidden)]
pub use instances::instances;
pub use method::{
    Counts, Discretization, InterfaceFlow, InterfaceFlux, InterfacePoint, Method, RowKind, SplitRows,
};
pub use problem::{Problem, Supports};
pub use row_report::RowReport;
pub use sample::{Sample, SampleScratch, Sampler};
pub use slit::{SlitCondition, SlitInterface};
pub use surface_field::SurfaceField;
pub use system::{
    LinearSystem, Mass, MassRows, PreparedSystem, PseudoTimeParams, PseudoTimeSolution, SplitValues,
    SystemParams, SystemSolution, linear_system, pseudo_time, residual, solve,
};
