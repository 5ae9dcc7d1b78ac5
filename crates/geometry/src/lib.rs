//! Shapes, domains, regions and point clouds in one, two and three dimensions.

mod aabb;
mod boundary;
mod cells;
mod cloud;
mod domain;
mod error;
mod level_set;
mod morton;
mod newton;
mod projection;
mod quasi_random;
mod random;
mod region;
mod shape;
mod spatial_hash;
mod vector;

pub use aabb::Aabb;
pub use cloud::{
    BoundaryNode, Cloud, CloudParams, CloudQuality, Layout, Spacing, Touch, estimate_nodes, generate, quality,
};
pub use domain::{Domain, FaceId};
pub use error::GeometryError;
pub use level_set::{GRADIENT_STEP, LevelSet, LevelSetFn};
pub use newton::SURFACE_TOLERANCE;
pub use projection::{Projection, ProjectionError};
pub use region::{Component, RegionGraph, RegionMap, RegionShape, TIE};
pub use shape::{Ball, Cylinder, HalfSpace, Polygon, Shape};
