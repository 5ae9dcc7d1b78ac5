//! Green's functions of `-lap`, made smooth on the scale of a mesh.

mod band_pass;
mod gaussian;
mod laguerre;
mod screened;
mod spectral;
mod truncated;

pub use band_pass::BandPass;
pub use gaussian::Gaussian;
pub(crate) use screened::Screened;
pub use spectral::Spectral;
pub use truncated::Truncated;

use crate::error::FreeSpaceError;

/// A Green's function that depends on the distance alone.
pub trait Radial: Sync {
    /// Value at distance `r >= 0`.
    fn value(&self, r: f64) -> f64;
}

/// Which kernel a plan convolves with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kernel {
    /// Gaussian regularisation of even order 2 to 20 (Hejlesen and Walther 2016, eq. 13).
    Gaussian {
        /// Order m: the error falls like `sigma^m`.
        order: usize,
        /// Smoothing radius over the largest spacing; `None` takes [`default_smoothing`].
        smoothing: Option<f64>,
    },
    /// The limit of infinite order: wave numbers up to pi over the largest spacing, no others.
    Spectral,
    /// The singular kernel, cut off beyond the diagonal of the box, in Fourier space (Vico, Greengard and Ferrando
    /// 2016): exact for sources that the mesh resolves, with cells of any aspect ratio. The set-up needs up to
    /// `((1 + sqrt 3)/2)^3 = 2.5` times the memory of the others for a cube.
    Truncated,
}

impl Kernel {
    /// The Gaussian kernel of an order with its default smoothing.
    pub fn gaussian(order: usize) -> Self {
        Self::Gaussian { order, smoothing: None }
    }
}

/// The ratio sigma/h that suits an order where nothing is known of the source.
///
/// # Errors
/// [`FreeSpaceError::Order`].
pub fn default_smoothing(order: usize) -> Result<f64, FreeSpaceError> {
    gaussian::check_order(order)?;
    Ok(2.0)
}
