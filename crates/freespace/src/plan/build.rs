//! From a mesh, a kernel and boundaries to transforms and Ĝ.

use super::axis::{Axis, fast_even_length, fast_length};
use super::boundary::{Boundary, Continuation};
use super::engine::{self, Engine};
use super::estimate::Estimate;
use super::memory;
use super::octant::{Mixed, Octant};
use super::real::Real;
use crate::error::FreeSpaceError;
use crate::fft::Machine;
use crate::kernel::{Gaussian, Kernel, Radial, Smooth, Spectral, Truncated, default_smoothing, passed};
use crate::mesh::Mesh;

/// Smoothing radii that the density of any order ends within, to round-off.
const DENSITY_REACH: f64 = 13.0;

/// Points of a mirrored direction whose images are some hundred megabytes.
const MANY: usize = 1 << 22;

/// The direction of the engine that a direction of the mesh is: planes of two-dimensional meshes are lines.
pub(super) fn slot<const D: usize>(axis: usize) -> usize {
    if D == 2 && axis == 1 { 2 } else { axis }
}

/// The three directions of the engine.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub(super) points: [usize; 3],
    pub(super) spacing: [f64; 3],
    pub(super) lines: [Continuation; 3],
}

impl Layout {
    fn of<const D: usize>(mesh: &Mesh<D>, line: impl Fn(usize) -> Continuation) -> Self {
        let mut layout = Self {
            points: [1; 3],
            spacing: [1.0; 3],
            lines: std::array::from_fn(|_| Continuation::trivial()),
        };
        for axis in 0..D {
            let slot = slot::<D>(axis);
            layout.points[slot] = mesh.points()[axis];
            layout.spacing[slot] = mesh.spacing()[axis];
            layout.lines[slot] = line(axis);
        }
        layout
    }

    /// Lines that are continued as the boundaries say.
    pub(super) fn with_boundaries<const D: usize>(
        mesh: &Mesh<D>,
        boundaries: [Boundary; D],
        memory_mb: Option<u64>,
    ) -> Result<Self, FreeSpaceError> {
        // Lists of images take memory before anything else does.
        let mirrored = (0..D).filter(|a| !matches!(boundaries[*a], Boundary::OPEN | Boundary::Periodic));
        if mirrored.map(|a| mesh.points()[a]).any(|n| n > MANY) {
            let trivial = Self::of(mesh, |_| Continuation::trivial());
            memory::check::<f32>(trivial.points, trivial.points, &[], memory_mb)?;
        }
        for axis in 0..D {
            if boundaries[axis] != Boundary::OPEN && mesh.points()[axis] < 2 {
                return Err(FreeSpaceError::Kernel {
                    what: format!("direction {axis} has one point, which is too few for mirrors or a period"),
                });
            }
        }
        Ok(Self::of(mesh, |axis| Continuation::new(boundaries[axis], mesh.points()[axis], mesh.centring())))
    }

    /// Lines without padding, for kernels that end before the mesh does.
    pub(super) fn compact<const D: usize>(mesh: &Mesh<D>) -> Self {
        Self::of(mesh, |axis| {
            let n = mesh.points()[axis];
            Continuation { len: fast_length(n), own: n, images: Vec::new(), open_span: Some(n) }
        })
    }

    pub(super) fn lengths(&self) -> [usize; 3] {
        std::array::from_fn(|a| self.lines[a].len)
    }

    /// What Ĝ is divided by: transforms there and back multiply by their lengths, and spectra of the first direction are twice what they
    /// should be.
    fn all(&self) -> f64 {
        2.0 * self.lengths().iter().map(|&n| n as f64).product::<f64>()
    }

    fn half(&self) -> [usize; 3] {
        self.lengths().map(|n| n / 2 + 1)
    }

    /// Directions that are open.
    fn open(&self) -> [bool; 3] {
        std::array::from_fn(|a| self.lines[a].open_span.is_some())
    }

    /// Length of the box with its images, in open directions.
    fn side(&self, a: usize) -> f64 {
        self.lines[a].open_span.unwrap_or(0) as f64 * self.spacing[a]
    }

    /// The distance that no two points exceed in the open directions.
    fn diagonal(&self) -> f64 {
        (0..3).map(|a| self.side(a).powi(2)).sum::<f64>().sqrt()
    }

    /// Lengths of transforms into which the box fits together with `beyond`.
    fn wide(&self, beyond: f64) -> [usize; 3] {
        std::array::from_fn(|a| match self.lines[a].open_span {
            Some(span) => fast_even_length(span.saturating_add((beyond / self.spacing[a]).ceil() as usize))
                .max(self.lines[a].len),
            None => self.lines[a].len,
        })
    }

    /// Ĝ of a kernel of the distance in open directions, which may be known to be smooth.
    pub(super) fn radial(&self, kernel: &dyn Radial, smooth: Option<Smooth>) -> Octant {
        Octant::of_samples(kernel, smooth, self.half(), self.spacing, self.all())
    }

    /// The engine with this Ĝ.
    pub(super) fn engine<T: Real>(&self, octant: Octant, estimate: Option<(usize, f64)>) -> Engine<T> {
        let axes = std::array::from_fn(|a| Axis::new(self.points[a], &self.lines[a], self.spacing[a]));
        let machine = Machine::new::<T>();
        let packs = engine::packs(&axes, machine.lanes());
        Engine {
            kernel: octant.packed(&packs),
            axes,
            machine,
            packs,
            estimate: estimate
                .map(|(order, sigma)| Estimate::new(order, sigma, self.lengths(), self.spacing, self.all())),
        }
    }

    /// Whether no direction is open, so that the constant is not determined.
    pub(super) fn is_closed<const D: usize>(&self) -> bool {
        (0..D).all(|axis| self.lines[slot::<D>(axis)].open_span.is_none())
    }
}

/// Smoothing radius and order of a Gaussian kernel.
fn gaussian<const D: usize>(mesh: &Mesh<D>, kernel: Kernel) -> Result<Option<(usize, f64)>, FreeSpaceError> {
    let Kernel::Gaussian { order, smoothing } = kernel else { return Ok(None) };
    let smoothing = smoothing.map_or_else(|| default_smoothing(order), Ok)?;
    let kernel = Gaussian::<D>::new(order, smoothing * coarsest(mesh))?;
    Ok(Some((order, kernel.sigma())))
}

fn coarsest<const D: usize>(mesh: &Mesh<D>) -> f64 {
    mesh.spacing().into_iter().fold(0.0, f64::max)
}

/// The engine of a kernel with boundaries.
pub(super) fn planned<const D: usize, T: Real>(
    mesh: &Mesh<D>,
    layout: &Layout,
    kernel: Kernel,
    memory_mb: Option<u64>,
) -> Result<Engine<T>, FreeSpaceError> {
    let gaussian = gaussian(mesh, kernel)?;
    let all_open = (0..D).all(|axis| layout.lines[slot::<D>(axis)].open_span.is_some());
    let reach = match gaussian {
        Some((_, sigma)) if !all_open => DENSITY_REACH * sigma,
        _ => 0.0,
    };
    let radius = layout.diagonal() + reach;
    let in_fourier_space = !all_open || kernel == Kernel::Truncated;
    let wide = in_fourier_space.then(|| layout.wide(radius + reach));
    // With the first direction done, and before where all of it is stored.
    let done = wide.map(|[_, y, z]| [layout.lengths()[0], y, z]);
    let before = wide.filter(|_| !all_open);
    let arrays: Vec<[usize; 3]> = done.into_iter().chain(before).collect();
    memory::check::<T>(layout.points, layout.lengths(), &arrays, memory_mb)?;
    let octant = match (wide, gaussian) {
        (Some(wide), _) if !all_open => {
            let cut = std::f64::consts::PI / coarsest(mesh);
            let filter = |k: f64| match (kernel, gaussian) {
                (_, Some((order, sigma))) => passed(order, k * sigma),
                (Kernel::Spectral, _) => f64::from(u8::from(k <= cut)),
                _ => 1.0,
            };
            let mixed =
                Mixed { open: layout.open(), radius, wide, half: layout.half(), spacing: layout.spacing };
            Octant::of_mixed(&mixed, &filter, layout.all())?
        }
        (Some(wide), _) => {
            let kernel = Truncated::<D>::new(radius)?;
            kernel.check_period(
                std::array::from_fn(|a| layout.side(slot::<D>(a))),
                std::array::from_fn(|a| wide[slot::<D>(a)] as f64 * mesh.spacing()[a]),
            )?;
            let wide = wide.map(|n| n / 2 + 1);
            Octant::of_truncated(&kernel, wide, layout.half(), layout.spacing, layout.all())
        }
        (None, Some((order, sigma))) => layout.radial(&Gaussian::<D>::new(order, sigma)?, None),
        (None, None) => {
            let kernel = Spectral::<D>::new(coarsest(mesh) / std::f64::consts::PI)?;
            layout.radial(&kernel, kernel.smooth())
        }
    };
    Ok(layout.engine(octant, gaussian))
}
