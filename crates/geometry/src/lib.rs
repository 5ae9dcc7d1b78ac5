//! Shapes, domains with named faces and holes, regions, and point clouds in one, two and three dimensions.
//!
//! A [`Shape`] is a primitive, a [`LevelSet`] or made of other shapes; it can tell the level of a point (negative
//! inside), its gradient, and the nearest point of its surface. A [`Domain`] is a shape less some holes, with a name
//! for every face. [`generate`] fills a domain with nodes, evenly or graded; those on the boundary know which faces
//! they touch and the outward normals there. A [`RegionMap`] labels the nodes by shapes, and a [`RegionGraph`] tells
//! which connected parts there are and which of them meet.
//!
//! Not here: neighbour lists, cells and meshes. Nothing in this crate knows an equation.
//!
//! ```
//! use meshless_geometry::{CloudParams, Domain, Layout, Shape, Spacing, generate, quality};
//!
//! let domain = Domain::boxed([0.0, 0.0], [2.0, 1.0])?.with_hole("rod", Shape::ball([0.5, 0.5], 0.2)?)?;
//! let params = CloudParams {
//!     spacing: Spacing::Uniform(0.05),
//!     layout: Layout::Irregular,
//!     seed: 1,
//!     max_nodes: 10_000,
//! };
//! let cloud = generate(&domain, &params)?;
//! assert!(quality(&cloud, &domain).relative_separation > 0.75);
//!
//! let rod = domain.face("rod").expect("named above");
//! let on_rod = cloud.boundary().iter().filter(|b| b.touches[0].face == rod).count();
//! assert_eq!(on_rod, 25); // circumference over spacing
//! # Ok::<(), meshless_geometry::GeometryError>(())
//! ```

mod aabb;
mod boundary;
mod cells;
mod cloud;
mod domain;
mod edges;
mod elements;
mod error;
mod level_set;
mod morton;
mod newton;
mod patches;
mod planar;
mod projection;
mod quadrature;
mod quasi_random;
mod random;
mod region;
mod shape;
mod slit;
mod spatial_hash;
mod surface;
mod vector;

pub use aabb::Aabb;
pub use cloud::{
    BoundaryNode, Cloud, CloudParams, CloudQuality, GivenCloud, GivenParams, Layout, Size, Spacing,
    SpacingFn, Touch, around, check_size, estimate_nodes, generate, quality,
};
pub use domain::{Domain, FaceId};
pub use edges::{Edge, Frame, edges};
pub use elements::{Element, side_elements};
pub use error::GeometryError;
pub use level_set::{GRADIENT_STEP, LevelSet, LevelSetFn};
pub use newton::SURFACE_TOLERANCE;
pub use patches::{Patch, side_patch};
pub use planar::{PlanarPiece, PlanarPieces, Ray, Vertex};
pub use projection::{Projection, ProjectionError};
pub use quadrature::{gauss, gauss_from_corner};
pub use region::{Component, Contact, GapParams, RegionGraph, RegionMap, RegionShape, TIE, ThinLayer};
pub use shape::{Ball, Cylinder, FlatFace, HalfSpace, Polygon, Shape};
pub use slit::{Sight, Slit, SlitFoot, SlitPoint};
pub use surface::{DEFAULT_CREASE, MAX_STL_TRIANGLES, SurfaceParams, TriangleSurface, read_stl};
