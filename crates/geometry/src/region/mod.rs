//! Regions by shape, and how they lie next to each other.

mod contacts;
mod foresee;
mod gaps;
mod graph;
mod layers;
mod map;

pub use contacts::Contact;
pub use gaps::GapParams;
pub use graph::{Component, RegionGraph};
pub use layers::ThinLayer;
pub use map::{RegionMap, RegionShape, TIE};
