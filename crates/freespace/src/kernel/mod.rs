//! Green's functions of `-lap`, made smooth on the scale of a mesh.

mod band_pass;
mod gaussian;
mod laguerre;
mod pieces;
mod screened;
mod spectral;
mod truncated;

pub use band_pass::BandPass;
pub use gaussian::Gaussian;
pub(crate) use gaussian::passed;
pub(crate) use pieces::{Pieces, Smooth};
pub(crate) use screened::Screened;
pub use spectral::Spectral;
pub use truncated::Truncated;

use crate::error::FreeSpaceError;

/// A Green's function that depends on the distance alone.
pub trait Radial: Sync {
    /// Value at distance `r >= 0`.
    fn value(&self, r: f64) -> f64;

    /// Replaces squares of distances, in units of `unit` squared, by the values there: for kernels of which many values together take less
    /// time than one by one.
    fn values(&self, unit: f64, squares: &mut [f64]) {
        squares.iter_mut().for_each(|s| *s = self.value(unit * s.sqrt()));
    }
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
    /// 2016): exact for sources that the mesh resolves, with cells of any aspect ratio.
    Truncated,
}

impl Kernel {
    /// The Gaussian kernel of an order with its default smoothing.
    pub fn gaussian(order: usize) -> Self {
        Self::Gaussian { order, smoothing: None }
    }
}

/// What a kernel may leave of the wave number of the mesh itself, `2 pi / h`: as much as round-off.
const IMAGE: f64 = 1e-14;

/// The ratio sigma/h that suits an order where nothing is known of the source: the least at which the sum over the points of
/// a mesh is as good as an integral, so that the error falls like `h^m` down to round-off. 1.28 for order 2, 1.50 for order 10,
/// 1.69 for order 20; others use 2 for all, which is `(2/1.5)^10 = 18` times less accurate at order 10.
///
/// # Errors
/// [`FreeSpaceError::Order`].
pub fn default_smoothing(order: usize) -> Result<f64, FreeSpaceError> {
    gaussian::check_order(order)?;
    let (mut low, mut high) = (1.0, 2.0);
    // To three digits, which is all that matters.
    while high - low > 1e-3 {
        let middle = 0.5 * (low + high);
        if passed(order, std::f64::consts::TAU * middle) > IMAGE { low = middle } else { high = middle }
    }
    Ok(high)
}
