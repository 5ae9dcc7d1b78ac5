//! The Voronoi cell of one point, built from the point's neighbourhood and clipped to a domain.
//!
//! The cell of a node `x_i` is the part of the domain that is nearer to `x_i` than to any other node
//! (Kraus et al. 2022, "A meshfree point collocation method for elliptic interface problems", sec. 2.2.2,
//! eq. 19). A conservative scheme needs its volume and, for every neighbour, the size of the common face; it
//! needs them only at the nodes where it is conservative. [`voronoi_cell`] therefore builds one cell at a
//! time by clipping, in one, two or three dimensions, and never a tessellation of the whole cloud.
//!
//! Flat boundaries ([`Plane`]) are met exactly, also those with re-entrant edges ([`Walls`]). A curved boundary ([`Cut`]) is a level set that is evaluated at
//! the corners of the cell and met exactly on its edges, so that the faces between neighbours agree; what lies
//! between the edges is replaced by a chord (2-D) or a fan of triangles (3-D), which leaves an error of
//! `O(h^2)` in the volume of the domain.
//!
//! This crate is *not* for Delaunay triangulations, for periodic domains, for weighted (power) cells, or for
//! finding the neighbours: the caller searches, and is told when it has to search farther
//! ([`CellError::Incomplete`]).
//!
//! ```
//! use meshless_cells::{CellScratch, Container, FaceKind, box_planes, voronoi_cell};
//!
//! // Four nodes of the unit square; the cell of the first, which lies at the corner (0, 0).
//! let planes = box_planes(&[0.0, 0.0], &[1.0, 1.0]);
//! let container = Container { min: [0.0, 0.0], max: [1.0, 1.0], planes: &planes, cuts: &[], walls: None };
//! let others = [(1, [1.0, 0.0]), (2, [0.0, 1.0]), (3, [1.0, 1.0])];
//! let cell = voronoi_cell(&[0.0, 0.0], &others, f64::INFINITY, &container, &mut CellScratch::default())?;
//!
//! assert!((cell.volume - 0.25).abs() < 1e-15);
//! let neighbours: Vec<_> = cell.faces.iter().filter(|f| matches!(f.kind, FaceKind::Neighbor(_))).collect();
//! assert_eq!(neighbours.len(), 2); // node 3 touches the cell in a point only
//! # Ok::<(), meshless_cells::CellError>(())
//! ```

mod body;
mod cell;
mod container;
mod error;
mod faces;
mod interval;
mod polygon;
mod polyhedron;
mod root;
mod split;
mod voronoi;

pub use cell::{Cell, CellFace, FaceKind};
pub use container::{Container, Cut, Interfaces, MOST_WALLS, Plane, Wall, Walls, box_planes};
pub use error::CellError;
pub use voronoi::{CellScratch, voronoi_cell, voronoi_parts};
