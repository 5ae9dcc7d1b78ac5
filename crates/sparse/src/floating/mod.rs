//! Constants of floating stiff regions as unknowns of their own.

mod bordered;
mod clusters;
mod coupled;
mod dense;
mod eliminated;
mod neumann;
mod split;

pub use bordered::{Bordered, BorderedSolution};
pub use clusters::{Cluster, ComponentInfo, DEFAULT_THRESHOLD, clusters};
pub use eliminated::PreparedBordered;
pub use neumann::{NeumannSolution, pure_neumann};
pub use split::{ChainLink, GroupUnknowns, Split};
