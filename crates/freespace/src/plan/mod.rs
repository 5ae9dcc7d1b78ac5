//! Plans: everything that a mesh and a kernel determine, for as many sources as wanted.

mod aligned;
mod axis;
mod bare;
mod boundary;
mod build;
mod columns;
mod cosine;
mod engine;
mod estimate;
mod first;
mod memory;
mod octant;
mod output;
mod packs;
mod real;
mod recipe;
mod sample;
mod separable;
mod square;
mod tile;

use crate::error::FreeSpaceError;
use crate::kernel::{Kernel, Radial, Smooth};
use crate::mesh::Mesh;
use build::{Layout, slot};
use engine::{Engine, Spectra};

pub use boundary::{Boundary, Face};
pub use output::Output;
use output::Wanted;
pub use real::Real;
use recipe::Recipe;

/// How a plan is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanParams<const D: usize> {
    /// The Green's function.
    pub kernel: Kernel,
    /// What holds in each direction; free space unless said otherwise.
    pub boundaries: [Boundary; D],
    /// Where no direction is open, a potential belongs only to a source whose mean is zero: subtract the mean of others
    /// rather than refuse them. The potential has zero mean then.
    pub remove_mean: bool,
    /// Megabytes that the plan and a solve for phi may take; `None` takes what the system says is available.
    pub memory_mb: Option<u64>,
}

impl<const D: usize> Default for PlanParams<D> {
    /// Order 10 in free space.
    fn default() -> Self {
        Self {
            kernel: Kernel::gaussian(10),
            boundaries: [Boundary::OPEN; D],
            remove_mean: false,
            memory_mb: None,
        }
    }
}

impl<const D: usize> From<Kernel> for PlanParams<D> {
    fn from(kernel: Kernel) -> Self {
        Self { kernel, ..Self::default() }
    }
}

/// Mean of a source over its largest magnitude that counts as zero: the round-off of sums.
const NO_MEAN: f64 = 1e-10;

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
    engine: Engine<T>,
    /// Where no direction is open and a constant is not determined: how often each point counts in its period, in each
    /// direction, and whether a mean is taken away.
    closed: Option<([Vec<f64>; D], bool)>,
}

/// Memory that solves use, to be kept between them.
#[derive(Debug, Default)]
pub struct Workspace<T: Real = f64> {
    spectra: Spectra<T>,
}

impl<const D: usize, T: Real> Plan<D, T> {
    /// Plans convolutions on `mesh`: pads every open direction to at least twice its points and to a fast length, and
    /// transforms the Green's function.
    ///
    /// # Errors
    /// A kernel that does not exist, more memory than there is, or spacings beyond those of [`Real::spacings`].
    pub fn new(mesh: &Mesh<D>, params: impl Into<PlanParams<D>>) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "meshes have one, two or three dimensions") };
        let params = params.into();
        check_unit::<D, T>(mesh)?;
        let layout = Layout::with_boundaries(mesh, params.boundaries, params.memory_mb)?;
        let engine = build::planned(mesh, &layout, params.kernel, params.memory_mb)?;
        let closed = layout.is_closed::<D>().then(|| {
            (
                std::array::from_fn(|a| layout.lines[slot::<D>(a)].weights(mesh.points()[a])),
                params.remove_mean,
            )
        });
        Ok(Self { mesh: *mesh, engine, closed })
    }

    /// Plans convolutions with any function of the distance, in free space. It must have a finite value at distance zero, too, which is what each
    /// point of the source contributes to phi where it is, over the volume of a cell.
    ///
    /// # Errors
    /// A kernel whose values are not all finite, or more memory than there is.
    pub fn with_radial(mesh: &Mesh<D>, kernel: &dyn Radial) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "meshes have one, two or three dimensions") };
        let layout = Layout::with_boundaries(mesh, [Boundary::OPEN; D], None)?;
        Self::of_layout(mesh, &layout, kernel, None)
    }

    /// The same without padding, for a function that vanishes beyond some distance: results are right at the points that
    /// are farther than that from the edge of the mesh.
    ///
    /// # Errors
    /// As for [`Self::with_radial`].
    pub fn with_compact(mesh: &Mesh<D>, kernel: &dyn Radial) -> Result<Self, FreeSpaceError> {
        const { assert!(D >= 1 && D <= 3, "meshes have one, two or three dimensions") };
        Self::compact(mesh, kernel, None)
    }

    /// The same with a kernel of which it is known how smooth it is.
    pub(crate) fn compact(
        mesh: &Mesh<D>,
        kernel: &dyn Radial,
        smooth: Option<Smooth>,
    ) -> Result<Self, FreeSpaceError> {
        Self::of_layout(mesh, &Layout::compact(mesh), kernel, smooth)
    }

    fn of_layout(
        mesh: &Mesh<D>,
        layout: &Layout,
        kernel: &dyn Radial,
        smooth: Option<Smooth>,
    ) -> Result<Self, FreeSpaceError> {
        check_unit::<D, T>(mesh)?;
        memory::check::<T>(layout.points, layout.lengths(), &[], None)?;
        let octant = layout.radial(kernel, smooth);
        if !octant.is_finite() {
            let origin = kernel.value(0.0);
            return Err(FreeSpaceError::Kernel {
                what: format!(
                    "values of the kernel at the offsets of the mesh are not finite (at distance zero {origin}); a singular kernel needs a value there"
                ),
            });
        }
        Ok(Self { mesh: *mesh, engine: layout.engine(octant, None), closed: None })
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh<D> {
        &self.mesh
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
    /// are not there; where no direction is open, a source with a mean.
    pub fn solve(
        &self,
        sources: &[&[T]],
        wanted: &[Output],
        workspace: &mut Workspace<T>,
        outputs: &mut Vec<Vec<T>>,
    ) -> Result<(), FreeSpaceError> {
        self.solve_shifted(sources, wanted, [0.0; D], workspace, outputs)
    }

    /// The same at points that lie `shift` spacings from those of the mesh, by a shift in Fourier space. What is farther beyond the box than a
    /// spacing is padding and no field.
    ///
    /// # Errors
    /// As for [`Self::solve`].
    pub fn solve_shifted(
        &self,
        sources: &[&[T]],
        wanted: &[Output],
        shift: [f64; D],
        workspace: &mut Workspace<T>,
        outputs: &mut Vec<Vec<T>>,
    ) -> Result<(), FreeSpaceError> {
        let wanted: Vec<(Output, [f64; D])> = wanted.iter().map(|&output| (output, shift)).collect();
        self.solve_at(sources, &wanted, workspace, outputs)
    }

    /// The same with a shift for each output. Outputs share all transforms up to the direction that they differ in, the first of the mesh
    /// last: phi at eight places of each cell takes two transforms of the third direction, four of the second and eight of the
    /// first. Each array of the second direction takes as much memory as the spectra of a source.
    ///
    /// # Errors
    /// As for [`Self::solve`].
    pub fn solve_at(
        &self,
        sources: &[&[T]],
        wanted: &[(Output, [f64; D])],
        workspace: &mut Workspace<T>,
        outputs: &mut Vec<Vec<T>>,
    ) -> Result<(), FreeSpaceError> {
        // Values that are not finite show in the sums of lines, unless some are not looked at.
        let later = self.engine.axes.iter().all(|axis| axis.own() == axis.n);
        for source in sources {
            if !later || source.len() != self.mesh.len() {
                check_values("source", source, self.mesh.len())?;
            }
            self.check_mean(source)?;
        }
        let shifts = wanted.iter().flat_map(|(_, shift)| shift);
        if let Some(&value) = shifts.into_iter().find(|s| !s.is_finite()) {
            return Err(FreeSpaceError::Invalid { what: "shift", value, expected: "finite" });
        }
        let wanted: Vec<Wanted> = wanted
            .iter()
            .map(|&(output, shift)| self.wanted(output, shift, sources.len()))
            .collect::<Result<_, _>>()?;
        outputs.resize_with(wanted.len(), Vec::new);
        let recipe = Recipe::new(wanted, &self.engine.axes);
        if !self.engine.run(sources, &recipe, &mut workspace.spectra, outputs) {
            sources.iter().try_for_each(|source| check_values("source", source, self.mesh.len()))?;
            return Err(FreeSpaceError::Overflow);
        }
        Ok(())
    }

    /// An output in terms of the engine.
    fn wanted(&self, output: Output, shift: [f64; D], sources: usize) -> Result<Wanted, FreeSpaceError> {
        let mut terms = output.terms::<D>(sources)?;
        terms.iter_mut().for_each(|t| t.axis = t.axis.map(slot::<D>));
        if output.is_estimate() && self.engine.estimate.is_none() {
            return Err(FreeSpaceError::Kernel {
                what: "only plans of Gaussian kernels have an estimate of the error".to_owned(),
            });
        }
        let mut along = [0.0; 3];
        (0..D).for_each(|a| along[slot::<D>(a)] = shift[a]);
        Ok(Wanted { terms, estimate: output.is_estimate(), shift: along })
    }

    fn check_mean(&self, source: &[T]) -> Result<(), FreeSpaceError> {
        let Some((weights, false)) = &self.closed else { return Ok(()) };
        let (mut sum, mut all, mut largest) = (0.0, 0.0, 0.0_f64);
        for (point, value) in source.iter().enumerate() {
            let i = self.mesh.indices(point);
            let weight: f64 = (0..D).map(|a| weights[a][i[a]]).product();
            sum += weight * value.widened();
            all += weight.abs();
            largest = largest.max(value.widened().abs());
        }
        let mean = if largest > 0.0 && all > 0.0 { sum / all / largest } else { 0.0 };
        if mean.abs() > NO_MEAN.max(T::epsilon()) { Err(FreeSpaceError::Mean { mean }) } else { Ok(()) }
    }
}

/// Refuses spacings whose squares are beyond the numbers of a type.
fn check_unit<const D: usize, T: Real>(mesh: &Mesh<D>) -> Result<(), FreeSpaceError> {
    let wrong = mesh.spacing().into_iter().find(|h| !T::spacings().contains(h));
    let expected = "between 1e-12 and 1e12 in single precision: take another unit of length";
    wrong.map_or(Ok(()), |value| Err(FreeSpaceError::Invalid { what: "spacing", value, expected }))
}

/// Values that are checked together.
const CHECKED: usize = 1024;

pub(crate) fn check_values<T: Real>(
    what: &'static str,
    values: &[T],
    expected: usize,
) -> Result<(), FreeSpaceError> {
    if values.len() != expected {
        return Err(FreeSpaceError::Length { what, got: values.len(), expected });
    }
    // Counting is done several numbers at a time, looking for the first is not.
    let wrong = |v: &T| !v.widened().is_finite();
    let block = values.chunks(CHECKED).position(|c| c.iter().map(|v| u64::from(wrong(v))).sum::<u64>() > 0);
    let start = block.map_or(values.len(), |b| b * CHECKED);
    match values[start..].iter().position(wrong) {
        Some(index) => {
            let index = start + index;
            Err(FreeSpaceError::NotFinite { what, value: values[index].widened(), index })
        }
        None => Ok(()),
    }
}
