//! How well a mesh resolves a source, and which kernel makes the most of it.

use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex;

use crate::error::FreeSpaceError;
use crate::kernel::{Kernel, default_smoothing, passed};
use crate::mesh::Mesh;
use crate::plan::Real;

/// Smoothing radii over the spacing that are tried: below 1 the images of the kernel's spectrum overlap for every order.
const SMOOTHINGS: [f64; 9] = [1.0, 1.1, 1.25, 1.4, 1.55, 1.7, 1.85, 2.0, 2.25];

/// Wave numbers beyond this part of the Nyquist frequency count as not resolved: what is there was sampled together with
/// as much from beyond.
const RESOLVED: f64 = 0.9;

/// A kernel, and the relative L2 error of phi that is expected of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The kernel.
    pub kernel: Kernel,
    /// Expected error of phi, relative, in the L2 norm over the box.
    pub error: f64,
}

/// The spectrum of a source: how much of its square belongs to which magnitude of the wave number.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Magnitude of the wave number and sum of the squares there.
    shells: Vec<(f64, f64)>,
    spacing: f64,
    dimension: usize,
}

impl Spectrum {
    /// The spectrum of a source that vanishes at the edge of its box.
    ///
    /// # Errors
    /// A source of the wrong length or with values that are not finite.
    pub fn new<const D: usize>(mesh: &Mesh<D>, source: &[f64]) -> Result<Self, FreeSpaceError> {
        crate::plan::check_values("source", source, mesh.len())?;
        let points = mesh.points();
        let mut values: Vec<Complex<f64>> = source.iter().map(|&v| Complex::new(v, 0.0)).collect();
        let mut stride = 1;
        for n in points {
            transform(&mut values, n, stride);
            stride *= n;
        }
        let units: [f64; D] = std::array::from_fn(|a| TAU / (points[a] as f64 * mesh.spacing()[a]));
        let width = units.iter().copied().fold(f64::INFINITY, f64::min);
        let mut shells: Vec<(f64, f64)> = Vec::new();
        for (index, value) in values.iter().enumerate() {
            let places = mesh.indices(index);
            let square: f64 =
                (0..D).map(|a| (units[a] * places[a].min(points[a] - places[a]) as f64).powi(2)).sum();
            let shell = (square.sqrt() / width).round() as usize;
            if shell >= shells.len() {
                shells.resize(shell + 1, (0.0, 0.0));
            }
            shells[shell].1 += value.norm_sqr();
        }
        shells.iter_mut().enumerate().for_each(|(i, shell)| shell.0 = i as f64 * width);
        // What belongs to the constant is no oscillation; beyond it nothing is divided by zero.
        shells.first_mut().into_iter().for_each(|s| s.0 = 0.5 * width);
        let spacing = mesh.spacing().into_iter().fold(0.0, f64::max);
        Ok(Self { shells, spacing, dimension: D })
    }

    /// The spectrum of several sources on one mesh together, such as the components of a vector.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn of_all<const D: usize>(mesh: &Mesh<D>, sources: &[&[f64]]) -> Result<Self, FreeSpaceError> {
        let spacing = mesh.spacing().into_iter().fold(0.0, f64::max);
        let mut all = Self { shells: Vec::new(), spacing, dimension: D };
        for source in sources {
            let one = Self::new(mesh, source)?;
            // Shells of one mesh are the same.
            all.shells.resize(all.shells.len().max(one.shells.len()), (0.0, 0.0));
            for (sum, (k, power)) in all.shells.iter_mut().zip(one.shells) {
                *sum = (k, sum.1 + power);
            }
        }
        Ok(all)
    }

    /// The error that is expected of a kernel: what it leaves out of the resolved wave numbers, the images of its
    /// spectrum, and what the mesh does not resolve.
    pub fn error(&self, kernel: Kernel) -> f64 {
        let nyquist = PI / self.spacing;
        let (mut error, mut all) = (0.0, 0.0);
        for &(k, power) in &self.shells {
            let phi = power / k.powi(4);
            all += phi;
            let part = match kernel {
                _ if k > RESOLVED * nyquist => 1.0,
                Kernel::Gaussian { order, smoothing } => {
                    let ratio = smoothing.or_else(|| default_smoothing(order).ok()).unwrap_or(2.0);
                    let sigma = ratio * self.spacing;
                    let missing = held_back(order, k * sigma);
                    let image = 2.0 * nyquist - k;
                    let images = (2.0 * self.dimension as f64).sqrt() * passed(order, image * sigma);
                    missing + images * (k / image).powi(2)
                }
                Kernel::Spectral | Kernel::Truncated => 0.0,
            };
            error += part * part * phi;
        }
        if all > 0.0 { (error / all).sqrt() } else { 0.0 }
    }

    /// The order and the smoothing radius with the least expected error; every order costs the same.
    pub fn best(&self) -> Choice {
        let mut best = Choice { kernel: Kernel::gaussian(2), error: f64::INFINITY };
        for order in (2..=20).step_by(2) {
            for smoothing in SMOOTHINGS {
                let kernel = Kernel::Gaussian { order, smoothing: Some(smoothing) };
                let error = self.error(kernel);
                if error < best.error {
                    best = Choice { kernel, error };
                }
            }
        }
        best
    }

    /// The same, if it meets `tolerance`, a relative L2 error of phi.
    ///
    /// # Errors
    /// [`FreeSpaceError::Tolerance`] with the error that this mesh allows.
    pub fn best_for(&self, tolerance: f64) -> Result<Choice, FreeSpaceError> {
        FreeSpaceError::unless_positive("tolerance", tolerance)?;
        let best = self.best();
        if best.error <= tolerance {
            Ok(best)
        } else {
            Err(FreeSpaceError::Tolerance { tolerance, error: best.error })
        }
    }
}

/// `1 - zeta_m^(s)`, the rest of the series, without cancellation where it is small.
fn held_back(order: usize, s: f64) -> f64 {
    let x = s * s / 2.0;
    if x > order as f64 {
        return 1.0 - passed(order, s);
    }
    let first = (1..=order / 2).fold(1.0, |term, j| term * x / j as f64);
    let (mut term, mut sum, mut j) = (first, 0.0, order / 2);
    while sum + term > sum {
        sum += term;
        j += 1;
        term *= x / j as f64;
    }
    (-x).exp() * sum
}

/// Transforms the lines of `n` values that are `stride` apart.
fn transform(values: &mut [Complex<f64>], n: usize, stride: usize) {
    let [forward, _] = f64::complex(n);
    let mut line = vec![Complex::default(); n];
    let mut scratch = vec![Complex::default(); forward.get_inplace_scratch_len()];
    for block in values.chunks_exact_mut(n * stride) {
        for first in 0..stride {
            line.iter_mut().enumerate().for_each(|(i, v)| *v = block[first + i * stride]);
            forward.process_with_scratch(&mut line, &mut scratch);
            line.iter().enumerate().for_each(|(i, v)| block[first + i * stride] = *v);
        }
    }
}
