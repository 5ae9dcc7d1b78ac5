#![doc = include_str!("../README.md")]

mod error;
mod fft;
mod kernel;
mod mesh;
mod particles;
mod plan;
mod refine;
mod special;
mod spectrum;

pub use error::FreeSpaceError;
pub use kernel::{BandPass, Gaussian, Kernel, Radial, Spectral, Truncated, default_smoothing};
pub use mesh::{Centring, Mesh};
pub use particles::Spread;
pub use plan::{Boundary, Face, Output, Plan, PlanParams, Real, Workspace};
pub use refine::{
    Fields, Patch, RefineParams, RefinedPlan, Superposition, TreeParams, m4_prime, m6_star, suggest,
    suggest_tree,
};
pub use spectrum::{Choice, Spectrum};
