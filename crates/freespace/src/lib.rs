//! Poisson's equation `-lap phi = f` in free space, by convolution with regularised Green's functions.

mod error;
mod kernel;
mod mesh;
mod plan;
mod special;

pub use error::FreeSpaceError;
pub use kernel::{BandPass, Gaussian, Kernel, Radial, Spectral, Truncated, default_smoothing};
pub use mesh::{Centring, Mesh};
pub use plan::{Output, Plan, PlanParams, Real, Workspace};
