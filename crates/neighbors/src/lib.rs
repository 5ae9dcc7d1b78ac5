//! Neighbour lists of point clouds in one, two and three dimensions.
//!
//! [`within_radius`] finds all points within an interaction radius, the same for all or one for each, by sorting the
//! points into nested grids of cells: its work is in proportion to what it finds, for any density. [`nearest`] finds a
//! number of nearest points by a k-d tree. Both give [`NeighborLists`], which own their invariants: no point is its own
//! neighbour, none is listed twice. [`CellList`] answers queries around any position. Points that are not finite or
//! coincide and points without neighbours are errors that name them and say what would do.
//!
//! **Not for** clouds that change point by point, and not for more than a few dimensions.
//!
//! # Example
//!
//! ```
//! use meshless_neighbors::{Distance, Radius, within_radius};
//!
//! let points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10)]).collect();
//! let lists = within_radius(&points, Radius::Uniform(1.5), Distance::D2)?;
//! assert_eq!(lists.of(0).len(), 3); // a corner
//! assert_eq!(lists.of(55).len(), 8);
//! assert!(lists.is_symmetric());
//! # Ok::<(), meshless_neighbors::NeighborError>(())
//! ```

mod cell_list;
mod check;
mod error;
mod grid;
mod lists;
mod nearest;
mod radius;
mod search;

pub use cell_list::CellList;
pub use error::NeighborError;
pub use lists::NeighborLists;
pub use nearest::nearest;
pub use radius::{COINCIDENCE, Distance, Radius, require_neighbors, within_radius};
