//! Regions by shape, and how they lie next to each other.

mod graph;
mod map;

pub use graph::{Component, RegionGraph};
pub use map::{RegionMap, RegionShape, TIE};
