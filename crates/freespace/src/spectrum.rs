//! How well a mesh resolves a source, and which kernel makes the most of it.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
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

/// The least error that is promised: the round-off of transforms.
const ROUND_OFF: f64 = 1e-15;

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
    /// Magnitude of the wave number, times the largest spacing, and sum of the squares there.
    shells: Vec<(f64, f64)>,
    /// Sum of the squares of phi beyond what the mesh resolves in some direction.
    beyond: f64,
    /// Whether it is the same in all directions, up to round-off.
    equal_sides: bool,
    dimension: usize,
    /// Of a vector field, the part that is a gradient.
    gradient: Option<f64>,
}

impl Spectrum {
    /// The spectrum of a source that vanishes at the edge of its box.
    ///
    /// # Errors
    /// A source of the wrong length or with values that are not finite.
    pub fn new<const D: usize>(mesh: &Mesh<D>, source: &[f64]) -> Result<Self, FreeSpaceError> {
        Self::of_all(mesh, &[source])
    }

    fn of_transform<const D: usize>(mesh: &Mesh<D>, values: &[Complex<f64>]) -> Self {
        let spacing = coarsest(mesh);
        let units = units(mesh).map(|unit| unit * spacing);
        let width = units.iter().copied().fold(f64::INFINITY, f64::min);
        let waves = waves(mesh, units);
        // Beyond as many shells as points, as there are where cells are long in one direction, shells grow with their wave number.
        let (linear, per_octave) = (mesh.len().max(64), 64.0);
        let shell_of = |k: f64| match k / width {
            ratio if ratio < linear as f64 => ratio.round() as usize,
            ratio => linear + ((ratio / linear as f64).log2() * per_octave).round() as usize,
        };
        let wave_of = |shell: usize| {
            let octaves = shell.saturating_sub(linear) as f64 / per_octave;
            shell.min(linear) as f64 * width * octaves.exp2()
        };
        let limits: [f64; D] = std::array::from_fn(|a| RESOLVED * PI * spacing / mesh.spacing()[a]);
        let (mut shells, mut beyond): (Vec<(f64, f64)>, f64) = (Vec::new(), 0.0);
        for (index, value) in values.iter().enumerate() {
            let places = mesh.indices(index);
            let square: f64 = (0..D).map(|a| waves[a][places[a]].powi(2)).sum();
            let shell = shell_of(square.sqrt());
            if shell >= shells.len() {
                shells.resize(shell + 1, (0.0, 0.0));
            }
            shells[shell].1 += value.norm_sqr();
            if (0..D).any(|a| waves[a][places[a]] > limits[a]) {
                beyond += value.norm_sqr() / (square * square);
            }
        }
        shells.iter_mut().enumerate().for_each(|(i, shell)| shell.0 = wave_of(i));
        // What belongs to the constant is no oscillation; beyond it nothing is divided by zero.
        shells.first_mut().into_iter().for_each(|s| s.0 = 0.5 * width);
        Self { shells, beyond, ..Self::nothing(mesh) }
    }

    fn nothing<const D: usize>(mesh: &Mesh<D>) -> Self {
        let spacing = coarsest(mesh);
        let equal_sides = mesh.spacing().iter().all(|h| *h > (1.0 - 1e-9) * spacing);
        Self { shells: Vec::new(), beyond: 0.0, equal_sides, dimension: D, gradient: None }
    }

    /// Shells of one mesh are the same.
    fn add(&mut self, other: Self) {
        self.beyond += other.beyond;
        self.shells.resize(self.shells.len().max(other.shells.len()), (0.0, 0.0));
        for (sum, (k, power)) in self.shells.iter_mut().zip(other.shells) {
            *sum = (k, sum.1 + power);
        }
    }

    /// The spectrum of several sources on one mesh together, such as the components of a vector.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn of_all<const D: usize>(mesh: &Mesh<D>, sources: &[&[f64]]) -> Result<Self, FreeSpaceError> {
        Self::of_scaled(mesh, sources, scale(sources))
    }

    fn of_scaled<const D: usize>(
        mesh: &Mesh<D>,
        sources: &[&[f64]],
        scale: f64,
    ) -> Result<Self, FreeSpaceError> {
        let mut all = Self::nothing(mesh);
        for source in sources {
            all.add(Self::of_transform(mesh, &transformed(mesh, source, scale)?));
        }
        Ok(all)
    }

    /// The same of a vector field, such as a vorticity, and of further sources; [`Self::gradient_part`] is known then.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn of_vector<const D: usize>(
        mesh: &Mesh<D>,
        vector: [&[f64]; D],
        sources: &[&[f64]],
    ) -> Result<Self, FreeSpaceError> {
        let scale = scale(&vector).min(scale(sources));
        let mut all = Self::of_scaled(mesh, sources, scale)?;
        // Only ratios of wave numbers matter.
        let units = units(mesh);
        let waves = waves(mesh, units.map(|unit| unit / units[0]));
        let square = |i: [usize; D]| (0..D).map(|a| waves[a][i[a]].powi(2)).sum::<f64>();
        let (mut divergence, mut whole) = (vec![Complex::new(0.0, 0.0); mesh.len()], 0.0);
        for (axis, component) in vector.into_iter().enumerate() {
            let values = transformed(mesh, component, scale)?;
            let signed = signed(&waves[axis]);
            for (index, (sum, value)) in divergence.iter_mut().zip(&values).enumerate().skip(1) {
                let i = mesh.indices(index);
                *sum += value * signed[i[axis]];
                whole += value.norm_sqr() / square(i).powi(2);
            }
            all.add(Self::of_transform(mesh, &values));
        }
        let of =
            |(index, value): (usize, &Complex<f64>)| value.norm_sqr() / square(mesh.indices(index)).powi(3);
        let part: f64 = divergence.iter().enumerate().skip(1).map(of).sum();
        all.gradient = Some(if whole > 0.0 { (part / whole).sqrt() } else { 0.0 });
        Ok(all)
    }

    /// How much of a vector field is a gradient: the L2 norm of what it adds to the potentials, relative to theirs. A vorticity is a curl
    /// and has nothing of it; what it has nevertheless, the curl of [`Output::Curl`](crate::Output::Curl) does not. None without a vector field.
    pub fn gradient_part(&self) -> Option<f64> {
        self.gradient
    }

    /// The error that is expected of a kernel: what it leaves out of the resolved wave numbers, the images of its
    /// spectrum, and what the mesh does not resolve, of a truncated kernel in each direction by itself. At least the round-off of the transforms.
    /// Samples do not tell where exactly a source ends abruptly (a disc with 13 cells on its radius had 1.3e-2 where 2e-4 was expected), nor
    /// what it has beyond its box in free space: a tenth of [`Mesh::edge_ratio`] was seen to come of that.
    pub fn error(&self, kernel: Kernel) -> f64 {
        let error = self.left_out(kernel);
        if error > 0.0 { error.max(ROUND_OFF) } else { error }
    }

    /// The same without round-off, by which kernels can be compared.
    fn left_out(&self, kernel: Kernel) -> f64 {
        let nyquist = PI;
        let (mut error, mut all) = (0.0, 0.0);
        for &(k, power) in &self.shells {
            let phi = power / k.powi(4);
            all += phi;
            let part = match kernel {
                _ if k > RESOLVED * nyquist => 1.0,
                Kernel::Gaussian { order, smoothing } => {
                    let sigma = smoothing.or_else(|| default_smoothing(order).ok()).unwrap_or(2.0);
                    let missing = held_back(order, k * sigma);
                    let image = 2.0 * nyquist - k;
                    let images = (2.0 * self.dimension as f64).sqrt() * passed(order, image * sigma);
                    missing + images * (k / image).powi(2)
                }
                Kernel::Spectral | Kernel::Truncated => 0.0,
            };
            error += part * part * phi;
        }
        if kernel == Kernel::Truncated {
            error = self.beyond;
        }
        if all > 0.0 { (error / all).sqrt() } else { 0.0 }
    }

    /// The order and the smoothing radius with the least expected error; every order costs the same.
    pub fn best(&self) -> Choice {
        let mut best = Choice { kernel: Kernel::gaussian(2), error: f64::INFINITY };
        for order in (2..=20).step_by(2) {
            for smoothing in SMOOTHINGS {
                let kernel = Kernel::Gaussian { order, smoothing: Some(smoothing) };
                let error = self.left_out(kernel);
                if error < best.error {
                    best = Choice { kernel, error };
                }
            }
        }
        Choice { error: self.error(best.kernel), ..best }
    }

    /// The same, if it meets `tolerance`, a relative L2 error of phi. If not, a kernel without smoothing, which leaves out only what the mesh does
    /// not resolve, but has no estimate of its error point by point: spectral for cells with equal sides, truncated for others and where the spectral one is not enough.
    ///
    /// # Errors
    /// [`FreeSpaceError::Tolerance`] with the error that this mesh allows.
    pub fn best_for(&self, tolerance: f64) -> Result<Choice, FreeSpaceError> {
        FreeSpaceError::unless_positive("tolerance", tolerance)?;
        let best = self.best();
        if best.error <= tolerance {
            return Ok(best);
        }
        let mut least = best.error;
        for kernel in [Kernel::Spectral, Kernel::Truncated].into_iter().skip(usize::from(!self.equal_sides)) {
            let error = self.error(kernel);
            if error <= tolerance {
                return Ok(Choice { kernel, error });
            }
            least = least.min(error);
        }
        Err(FreeSpaceError::Tolerance { tolerance, error: least })
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

fn coarsest<const D: usize>(mesh: &Mesh<D>) -> f64 {
    mesh.spacing().into_iter().fold(0.0, f64::max)
}

/// A power of two that brings the largest magnitude of all near one, so that squares neither overflow nor vanish.
fn scale(sources: &[&[f64]]) -> f64 {
    let largest = sources.iter().flat_map(|source| source.iter()).fold(0.0_f64, |m, v| m.max(v.abs()));
    let exponent = if largest > 0.0 && largest.is_finite() { libm::frexp(largest).1 } else { 0 };
    2.0_f64.powi(-exponent.max(-1000))
}

/// The least wave number of each direction.
fn units<const D: usize>(mesh: &Mesh<D>) -> [f64; D] {
    std::array::from_fn(|a| TAU / (mesh.points()[a] as f64 * mesh.spacing()[a]))
}

/// Magnitudes of the wave numbers of each direction.
fn waves<const D: usize>(mesh: &Mesh<D>, units: [f64; D]) -> [Vec<f64>; D] {
    std::array::from_fn(|a| {
        let n = mesh.points()[a];
        (0..n).map(|i| units[a] * i.min(n - i) as f64).collect()
    })
}

/// The factors of a derivative, over i: the Nyquist frequency has none.
fn signed(waves: &[f64]) -> Vec<f64> {
    let n = waves.len();
    let sign = |i: usize| match (2 * i).cmp(&n) {
        std::cmp::Ordering::Less => 1.0,
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => -1.0,
    };
    waves.iter().enumerate().map(|(i, wave)| sign(i) * wave).collect()
}

/// The transform of a source times `scale`, without padding.
fn transformed<const D: usize>(
    mesh: &Mesh<D>,
    source: &[f64],
    scale: f64,
) -> Result<Vec<Complex<f64>>, FreeSpaceError> {
    crate::plan::check_values("source", source, mesh.len())?;
    let mut values: Vec<Complex<f64>> = source.iter().map(|&v| Complex::new(scale * v, 0.0)).collect();
    let mut stride = 1;
    for n in mesh.points() {
        transform(&mut values, n, stride);
        stride *= n;
    }
    Ok(values)
}

/// Lines that are transformed one after the other: places of them that lie side by side are in one or two lines of the cache.
const TOGETHER: usize = 8;

/// Transforms the lines of `n` values that are `stride` apart.
fn transform(values: &mut [Complex<f64>], n: usize, stride: usize) {
    let [forward, _] = f64::complex(n);
    let scratch = || {
        let zeros = |n: usize| vec![Complex::new(0.0, 0.0); n];
        (zeros(n * TOGETHER), zeros(forward.get_inplace_scratch_len()))
    };
    if stride == 1 {
        let all = values.par_chunks_mut(n * TOGETHER);
        return all
            .for_each_init(scratch, |(_, scratch), lines| forward.process_with_scratch(lines, scratch));
    }
    // For each few lines, their places.
    let mut pieces: Vec<Vec<&mut [Complex<f64>]>> = Vec::new();
    for block in values.chunks_exact_mut(n * stride) {
        let first = pieces.len();
        pieces.resize_with(first + stride.div_ceil(TOGETHER), || Vec::with_capacity(n));
        for row in block.chunks_exact_mut(stride) {
            pieces[first..]
                .iter_mut()
                .zip(row.chunks_mut(TOGETHER))
                .for_each(|(piece, part)| piece.push(part));
        }
    }
    pieces.par_iter_mut().for_each_init(scratch, |(lines, scratch), places| {
        let count = places.first().map_or(0, |place| place.len());
        for (i, place) in places.iter().enumerate() {
            place.iter().enumerate().for_each(|(line, value)| lines[line * n + i] = *value);
        }
        forward.process_with_scratch(&mut lines[..count * n], scratch);
        for (i, place) in places.iter_mut().enumerate() {
            place.iter_mut().enumerate().for_each(|(line, value)| *value = lines[line * n + i]);
        }
    });
}
