//! Constants of floating stiff regions as unknowns of their own.

mod all_rows;
mod bordered;
mod clusters;
mod coupled;
mod dense;
mod direct;
mod eliminated;
mod joined;
mod neumann;
mod nodal;
mod prepared;
mod split;

pub use bordered::{Bordered, BorderedSolution};
pub use clusters::{Cluster, ComponentInfo, DEFAULT_THRESHOLD, clusters};
pub use neumann::{NeumannSolution, pure_neumann};
pub use prepared::PreparedBordered;
pub use split::{ChainLink, GroupUnknowns, Split};
