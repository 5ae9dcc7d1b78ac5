//! Plans: everything that a mesh and a kernel determine, for as many sources as wanted.

mod axis;
mod bare;
mod cosine;
mod engine;
mod memory;
mod octant;
mod output;
mod real;
mod tile;

use crate::error::FreeSpaceError;
use crate::kernel::{Gaussian, Kernel, Spectral, Truncated, default_smoothing};
use crate::mesh::Mesh;
use axis::{Axis, RealTransforms, fast_length};
use engine::{Engine, Spectra};
use octant::Octant;

pub use output::Output;
pub use real::Real;

/// How a plan is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanParams {
    /// The Green's function.
    pub kernel: Kernel,
    /// Megabytes that the plan and a solve for phi may take; `None` takes what the system says is available.
    pub memory_mb: Option<u64>,
}

impl Default for PlanParams {
    /// Order 10.
    fn default() -> Self {
        Self { kernel: Kernel::gaussian(10), memory_mb: None }
    }
}

impl From<Kernel> for PlanParams {
    fn from(kernel: Kernel) -> Self {
        Self { kernel, ..Self::default() }
    }
}

/// A convolution with a Green's function in free space, planned once and used for many sources.
///
/// ```
/// use meshless_freespace::{Centring, Kernel, Mesh, Output, Plan};
///
/// // A Gaussian of total 1 looks like a point charge from afar.
/// let mesh = Mesh::of_box([-1.0; 3], [1.0; 3], [32; 3], Centring::Cell)?;
/// let width: f64 = 0.15;
/// let source = mesh.sample(|p| {
///     let r2 = p.iter().map(|x| x * x).sum::<f64>();
///     (-r2 / (2.0 * width * width)).exp() / (width * (2.0 * std::f64::consts::PI).sqrt()).powi(3)
/// });
/// let plan: Plan<3> = Plan::new(&mesh, Kernel::gaussian(10))?;
/// let phi = plan.potential(&source)?;
/// let corner = mesh.point(0);
/// let r = corner.iter().map(|x| x * x).sum::<f64>().sqrt();
/// assert!((phi[0] * 4.0 * std::f64::consts::PI * r - 1.0).abs() < 1e-6);
/// # Ok::<(), meshless_freespace::FreeSpaceError>(())
/// ```
#[derive(Debug)]
pub struct Plan<const D: usize, T: Real = f64> {
    mesh: Mesh<D>,
    kernel: Kernel,
    engine: Engine<T>,
}

/// Memory that solves use, to be kept between them.
#[derive(Debug, Default)]
pub struct Workspace<T: Real = f64> {
    spectra: Spectra<T>,
}

/// The direction of the engine that a direction of the mesh is: planes of two-dimensional meshes are lines.
fn slot<const D: usize>(axis: usize) -> usize {
    if D == 2 && axis == 1 { 2 } else { axis }
}

impl<const D: usize, T: Real> Plan<D, T> {
    /// Plans convolutions on `mesh`: pads every direction to at least twice its points and to a fast length, and
    /// transforms the Green's function.
    ///
    /// # Errors
    /// A kernel that does not exist, or more memory than there is.
    pub fn new(mesh: &Mesh<D>, params: impl Into<PlanParams>) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "meshes have one, two or three dimensions") };
        let params = params.into();
        let (mut points, mut spacing) = ([1; 3], [1.0; 3]);
        for axis in 0..D {
            (points[slot::<D>(axis)], spacing[slot::<D>(axis)]) = (mesh.points()[axis], mesh.spacing()[axis]);
        }
        let lengths: [usize; 3] =
            std::array::from_fn(
                |slot| {
                    if slot_is_used::<D>(slot) { fast_length(2 * points[slot]) } else { 1 }
                },
            );
        let wide = match params.kernel {
            Kernel::Truncated => Some(wide_lengths(mesh, lengths, truncation_radius(mesh))),
            _ => None,
        };
        memory::check::<T>(points, lengths, wide, params.memory_mb)?;
        let octant = octant(mesh, params.kernel, lengths, wide, spacing)?;
        let all: f64 = lengths.iter().map(|&n| n as f64).product();
        let engine = Engine {
            axes: std::array::from_fn(|a| Axis::new(points[a], lengths[a], spacing[a])),
            real: RealTransforms::new(lengths[0]),
            kernel: octant.values.iter().map(|g| T::rounded(g / all)).collect(),
        };
        Ok(Self { mesh: *mesh, kernel: params.kernel, engine })
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh<D> {
        &self.mesh
    }

    /// The kernel.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Lengths of the transforms in each direction.
    pub fn lengths(&self) -> [usize; D] {
        std::array::from_fn(|a| self.engine.axes[slot::<D>(a)].len)
    }

    /// phi with `-lap phi = source` at the points of the mesh.
    ///
    /// # Errors
    /// A source of the wrong length or with values that are not finite.
    pub fn potential(&self, source: &[T]) -> Result<Vec<T>, FreeSpaceError> {
        let mut outputs = Vec::new();
        let wanted = [Output::Potential { source: 0 }];
        self.solve(&[source], &wanted, &mut Workspace::default(), &mut outputs)?;
        Ok(outputs.pop().unwrap_or_default())
    }

    /// The fields `wanted` of `sources`, computed together: each source is transformed once, and of the fields only
    /// those wanted are transformed back. `outputs` is resized to them; `workspace` may be reused to save allocations.
    ///
    /// # Errors
    /// Sources of the wrong length or with values that are not finite, outputs that refer to sources or directions that
    /// are not there.
    pub fn solve(
        &self,
        sources: &[&[T]],
        wanted: &[Output],
        workspace: &mut Workspace<T>,
        outputs: &mut Vec<Vec<T>>,
    ) -> Result<(), FreeSpaceError> {
        for source in sources {
            check_values("source", source, self.mesh.len())?;
        }
        let mut terms = Vec::with_capacity(wanted.len());
        for output in wanted {
            let mut of_output = output.terms::<D>(sources.len())?;
            of_output.iter_mut().for_each(|t| t.axis = t.axis.map(slot::<D>));
            terms.push(of_output);
        }
        outputs.resize_with(wanted.len(), Vec::new);
        self.engine.run(sources, &terms, &mut workspace.spectra, outputs);
        Ok(())
    }
}

fn slot_is_used<const D: usize>(used: usize) -> bool {
    (0..D).any(|axis| slot::<D>(axis) == used)
}

/// The distance of opposite corners, beyond which no two points are.
fn truncation_radius<const D: usize>(mesh: &Mesh<D>) -> f64 {
    let side = |a: usize| mesh.points()[a] as f64 * mesh.spacing()[a];
    (0..D).map(|a| side(a).powi(2)).sum::<f64>().sqrt()
}

/// Lengths of the transforms that a truncated kernel is sampled with.
fn wide_lengths<const D: usize>(mesh: &Mesh<D>, lengths: [usize; 3], radius: f64) -> [usize; 3] {
    let mut wide = [1; 3];
    for axis in 0..D {
        let reach = mesh.points()[axis] + (radius / mesh.spacing()[axis]).ceil() as usize;
        wide[slot::<D>(axis)] = fast_length(reach).max(lengths[slot::<D>(axis)]);
    }
    wide
}

fn octant<const D: usize>(
    mesh: &Mesh<D>,
    kernel: Kernel,
    lengths: [usize; 3],
    wide: Option<[usize; 3]>,
    spacing: [f64; 3],
) -> Result<Octant, FreeSpaceError> {
    let half = lengths.map(|n| n / 2 + 1);
    let coarsest = mesh.spacing().into_iter().fold(0.0, f64::max);
    match (kernel, wide) {
        (Kernel::Truncated, Some(wide)) => {
            let kernel = Truncated::<D>::new(truncation_radius(mesh))?;
            let along = |a: usize, points: usize| points as f64 * mesh.spacing()[a];
            kernel.check_period(
                std::array::from_fn(|a| along(a, mesh.points()[a])),
                std::array::from_fn(|a| along(a, wide[slot::<D>(a)])),
            )?;
            Ok(Octant::of_truncated(&kernel, wide.map(|n| n / 2 + 1), half, spacing))
        }
        (Kernel::Gaussian { order, smoothing }, _) => {
            let smoothing = smoothing.map_or_else(|| default_smoothing(order), Ok)?;
            let kernel = Gaussian::<D>::new(order, smoothing * coarsest)?;
            Ok(Octant::of_radial(&kernel, half, spacing))
        }
        _ => {
            let kernel = Spectral::<D>::new(coarsest / std::f64::consts::PI)?;
            Ok(Octant::of_radial(&kernel, half, spacing))
        }
    }
}

fn check_values<T: Real>(what: &'static str, values: &[T], expected: usize) -> Result<(), FreeSpaceError> {
    if values.len() != expected {
        return Err(FreeSpaceError::Length { what, got: values.len(), expected });
    }
    match values.iter().position(|v| !v.widened().is_finite()) {
        Some(index) => Err(FreeSpaceError::NotFinite { what, value: values[index].widened(), index }),
        None => Ok(()),
    }
}
