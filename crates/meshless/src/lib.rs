//! Elliptic interface problems on point clouds: a scene says what is there, a plan says what that calls for, a
//! solution has the field with its error and its cost.
//!
//! The equation is `-div(eta grad u) = f`, with eta that may jump by ten orders of magnitude between regions, in one,
//! two and three dimensions, on clouds of nodes that know nothing of the interfaces.
//!
//! **Not for** using one of the parts alone: neighbour lists, stencils, Voronoi cells, sparse solvers, point
//! generation and expressions are crates of their own, re-exported here under their names.
//!
//! # Example
//!
//! ```
//! use meshless::plan::{Plan, Stage};
//! use meshless::scene::Scene;
//! use meshless::{Silent, execute};
//! # fn main() -> Result<(), meshless::Error> {
//! let scene = Scene::parse(r#"
//! title = "Stiff disc in a plate"
//! dimension = 2
//!
//! [domain]
//! box = { min = [0.0, 0.0], max = [1.0, 1.0] }
//!
//! [points]
//! spacing = 0.05
//! layout = "irregular"
//! seed = 1
//!
//! [[regions]]
//! name = "disc"
//! sphere = { center = [0.5, 0.5], radius = 0.25 }
//! diffusivity = "1e6"
//!
//! [[regions]]
//! name = "plate"
//! diffusivity = "1"
//!
//! [[boundaries]]
//! face = "left"
//! dirichlet = "0"
//!
//! [[boundaries]]
//! face = "right"
//! dirichlet = "1"
//!
//! [[boundaries]]
//! face = "all"
//! neumann = "0"
//!
//! [[probes]]
//! at = [0.5, 0.5]
//! "#, "disc.toml")?;
//!
//! let plan = Plan::new(&scene)?;
//! assert!(plan.runs(Stage::ConstrainedStencils) && !plan.runs(Stage::Source));
//!
//! let solution = execute(&scene, &plan, &mut Silent)?;
//! // The disc floats at the mean of both sides.
//! let centre = solution.report.probes[0].value.unwrap();
//! assert!((centre - 0.5).abs() < 0.01);
//! # Ok(()) }
//! ```

mod build;
pub mod cost;
mod error;
mod execute;
mod field;
mod memory;
mod methods;
pub mod norms;
mod outputs;
mod overrides;
pub mod plan;
pub mod report;
pub mod scene;

pub use error::Error;
pub use execute::{
    Checkpoint, Frame, Picture, Progress, PseudoTimeCost, Reproduction, Silent, Solution, execute,
    execute_from, linear_system, pseudo_time, reproduce,
};
pub use field::{NodalField, ParticleField};
pub use methods::{METHODS, MethodInfo};
pub use outputs::write_outputs;
pub use overrides::{OverrideError, Overrides};

pub use meshless_cells as cells;
pub use meshless_expr as expr;
pub use meshless_freespace as freespace;
pub use meshless_geometry as geometry;
pub use meshless_interfaces as interfaces;
pub use meshless_neighbors as neighbors;
pub use meshless_output as output;
pub use meshless_sparse as sparse;
pub use meshless_stencils as stencils;
pub use meshless_time as time;

/// Nodes that a scene may have: about what fits into the memory of a large workstation.
pub const MAX_NODES: usize = 20_000_000;

/// Runs `work` with a given number of threads; results do not depend on the number.
pub fn on_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> T + Send,
) -> Result<T, rayon::ThreadPoolBuildError> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?.install(work))
}
