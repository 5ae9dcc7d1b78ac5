//! Scenes in free space: a mesh, a convolution, and what is derived from the field.

mod carried;
mod draw;
mod probes;
mod report;

use std::time::Instant;

use meshless_freespace::{Kernel, Mesh, Output, Plan as Convolution, Spectrum, Workspace, default_smoothing};

use super::{Progress, Solution};
use crate::plan::{FreeSpaceParams, MethodParams, Plan, Stage, Transforms};
use crate::report::Seconds;
use crate::scene::{GreenName, Scene};
use crate::{Error, MAX_NODES, NodalField, build};
use carried::Carried;

/// The part of a vorticity that may be a gradient: round-off.
const DIVERGENCE: f64 = 1e-10;

/// How many times what a mesh does not resolve the gradient in the samples of a curl may be.
const UNRESOLVED: f64 = 10.0;

/// The source on a mesh.
struct Source<const D: usize> {
    mesh: Mesh<D>,
    points: Vec<[f64; D]>,
    labels: Vec<u16>,
    /// Over the diffusivity.
    values: Vec<f64>,
    /// Components of the vorticity, if there is one.
    vorticity: Vec<Vec<f64>>,
    /// What another mesh of the same spacing says otherwise of the whole: what samples miss of a source that is not smooth.
    missed: f64,
    /// Particles that a part of it was deposited from.
    carried: Option<Carried<D>>,
}

impl<const D: usize> Source<D> {
    /// What is transformed: the vorticity, and then the source.
    fn transformed(&self, transforms: Transforms) -> Vec<&[f64]> {
        let mut sources: Vec<&[f64]> = self.vorticity.iter().map(Vec::as_slice).collect();
        sources.extend(transforms.source.then_some(&self.values[..]));
        sources
    }
}

/// The kernel that the source calls for, and the relative L2 error that is expected of it.
#[derive(Clone, Copy)]
struct Chosen {
    kernel: Kernel,
    error: f64,
    /// The part of a vorticity in space that is a gradient, where it is more than what the mesh does not resolve.
    gradient: Option<f64>,
}

pub(super) fn execute<const D: usize>(
    scene: &Scene,
    plan: &Plan,
    progress: &mut dyn Progress,
) -> Result<Solution, Error> {
    let all = Instant::now();
    let mut seconds = Seconds::default();
    progress.stage(Stage::Points);
    let params = match plan.method.params {
        MethodParams::FreeSpace(params) => params,
        _ => FreeSpaceParams::of(scene),
    };
    let transforms = params.transforms;
    let start = Instant::now();
    let (source, chosen) = source(scene, params)?;
    seconds.points = start.elapsed().as_secs_f64();
    progress.stage(Stage::Solve);
    let start = Instant::now();
    let convolution: Convolution<D> = Convolution::new(&source.mesh, chosen.kernel)?;
    seconds.assembly = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut fields = Vec::new();
    let sources = source.transformed(transforms);
    convolution.solve(&sources, &outputs::<D>(transforms), &mut Workspace::default(), &mut fields)?;
    let mut fields = fields.into_iter();
    let velocity: Option<Vec<[f64; D]>> =
        (transforms.vorticity > 0).then(|| vectors(&mut fields, source.points.len()));
    let u = if transforms.potential { fields.next() } else { None };
    let u = u.unwrap_or_else(|| vec![0.0; source.points.len()]);
    seconds.solve = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let gradient: Option<Vec<[f64; D]>> =
        transforms.gradient.then(|| vectors(&mut fields, source.points.len()));
    let particles = source
        .carried
        .as_ref()
        .map(|carried| carried.read(&source.mesh, &u, gradient.as_deref(), velocity.as_deref()));
    let particles = particles.transpose()?;
    let exact =
        plan.runs(Stage::Errors).then(|| build::exact(scene, &source.points, &source.labels)).transpose()?;
    let errors = match (&exact, &gradient) {
        (Some(exact), Some(gradient)) => Some(report::errors(scene, &source, &u, gradient, exact)),
        _ => None,
    };
    let probes = probes::probes(scene, &source, chosen.kernel, transforms)?;
    let speed: Option<Vec<f64>> = velocity.as_ref().map(|v| v.iter().map(report::length).collect());
    let drawn = speed.as_ref().map_or(("u", &u), |speed| ("speed", speed));
    let picture = plan.runs(Stage::Plot).then(|| draw::draw(scene, &source, drawn)).transpose()?;
    seconds.post = start.elapsed().as_secs_f64();
    seconds.total = all.elapsed().as_secs_f64();
    let solved = report::Solved { u: &u, speed: speed.as_deref(), chosen, errors, probes };
    let report = report::report(scene, plan, &source, solved, seconds);
    let pad = |p: &[f64; D]| std::array::from_fn(|a| if a < D { p[a] } else { 0.0 });
    let field = NodalField {
        estimate: None,
        indicator: None,
        spacing: vec![source.mesh.spacing().into_iter().fold(f64::INFINITY, f64::min); source.points.len()],
        dimension: D,
        points: source.points.iter().map(pad).collect(),
        gradient: gradient.map(|g| g.iter().map(pad).collect()),
        velocity: velocity.map(|v| v.iter().map(pad).collect()),
        exact: exact.map(|e| e.values),
        eta: vec![diffusivity(scene); source.points.len()],
        region: source.labels,
        kind: Vec::new(),
        diagnosis: None,
        u,
    };
    Ok(Solution { report, field, picture, frames: Vec::new(), particles })
}

/// What is transformed back: the velocity, u and its gradient, as far as they are asked for.
fn outputs<const D: usize>(transforms: Transforms) -> Vec<Output> {
    let source = transforms.vorticity;
    let each = |of: fn(usize) -> Output| (0..D).map(of);
    let mut wanted: Vec<Output> = match (source, transforms.source) {
        (0, _) => Vec::new(),
        (_, true) => each(|axis| Output::Velocity { axis }).collect(),
        (_, false) => each(|axis| Output::Curl { axis }).collect(),
    };
    if transforms.potential {
        wanted.push(Output::Potential { source });
    }
    if transforms.gradient {
        wanted.extend((0..D).map(|axis| Output::Gradient { source, axis }));
    }
    wanted
}

/// The next D fields as vectors.
fn vectors<const D: usize>(fields: &mut impl Iterator<Item = Vec<f64>>, count: usize) -> Vec<[f64; D]> {
    let mut vectors = vec![[0.0; D]; count];
    for axis in 0..D {
        let field = fields.next().unwrap_or_default();
        vectors.iter_mut().zip(field).for_each(|(vector, value)| vector[axis] = value);
    }
    vectors
}

/// The one diffusivity; the plan has checked that there is one.
fn diffusivity(scene: &Scene) -> f64 {
    scene.regions[0].diffusivity.expr.as_constant().unwrap_or(1.0)
}

/// The source on the mesh of the scene, or on one fine enough for the tolerance.
fn source<const D: usize>(scene: &Scene, params: FreeSpaceParams) -> Result<(Source<D>, Chosen), Error> {
    let mut times = 1;
    loop {
        let source = sample(scene, times, params.transforms)?;
        let spectrum = spectrum(&source, params.transforms)?;
        let chosen = choose(&spectrum, params)?;
        let chosen = Chosen { error: chosen.error.max(source.missed), ..chosen };
        let Some(tolerance) = params.tolerance.filter(|t| chosen.error > *t) else {
            return Ok((source, chosen));
        };
        if source.mesh.len() << D > MAX_NODES {
            return Err(
                meshless_freespace::FreeSpaceError::Tolerance { tolerance, error: chosen.error }.into()
            );
        }
        times *= 2;
    }
}

/// The spectrum of all sources; of a vorticity in space, also the part that is a gradient.
fn spectrum<const D: usize>(source: &Source<D>, transforms: Transforms) -> Result<Spectrum, Error> {
    let all = source.transformed(transforms);
    Ok(match all.split_first_chunk::<D>() {
        Some((vorticity, others)) if D == 3 && transforms.vorticity == D => {
            Spectrum::of_vector(&source.mesh, *vorticity, others)?
        }
        _ => Spectrum::of_all(&source.mesh, &all)?,
    })
}

fn sample<const D: usize>(scene: &Scene, times: usize, transforms: Transforms) -> Result<Source<D>, Error> {
    let mesh = build::free_mesh::<D>(scene, times)?;
    let points: Vec<[f64; D]> = (0..mesh.len()).map(|i| mesh.point(i)).collect();
    let regions = build::regions::<D>(scene)?;
    let labels: Vec<u16> = points.iter().map(|p| regions.label(p, 0.0)).collect();
    let mut values = build::nodal_source(scene, &build::materials(scene), &points, &labels)?;
    let missed = missed(scene, &points, &values)?;
    let spec = scene.free_space.as_ref().and_then(|s| s.particles.as_ref());
    let carried = spec.map(Carried::from_file).transpose()?;
    if let Some(carried) = &carried {
        let density = carried.density(&mesh)?;
        values.iter_mut().zip(density).for_each(|(value, d)| *value += d);
    }
    let eta = diffusivity(scene);
    values.iter_mut().for_each(|value| *value /= eta);
    let vorticity = (0..transforms.vorticity)
        .map(|component| build::nodal_vorticity(scene, component, &points, &labels))
        .collect::<Result<_, _>>()?;
    Ok(Source { mesh, points, labels, values, vorticity, missed, carried })
}

/// Half of the difference of the totals of the source on this mesh and on one between its points, or of its moments, over that of its
/// size: a spectrum of samples knows nothing of what lies between them, such as where exactly a ball of charge ends.
fn missed<const D: usize>(scene: &Scene, points: &[[f64; D]], values: &[f64]) -> Result<f64, Error> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Ok(0.0) };
    let regions = build::regions::<D>(scene)?;
    let half: [f64; D] = std::array::from_fn(|k| {
        let coordinate = points.iter().map(|p| p[k]).find(|x| (x - first[k]).abs() > 0.0);
        coordinate.map_or(0.0, |next| 0.5 * (next - first[k]).abs())
    });
    let between: Vec<[f64; D]> = points.iter().map(|p| std::array::from_fn(|k| p[k] + half[k])).collect();
    let labels: Vec<u16> = between.iter().map(|p| regions.label(p, 0.0)).collect();
    let others = build::nodal_source(scene, &build::materials(scene), &between, &labels)?;
    let size: f64 = values.iter().map(|v| v.abs()).sum();
    if size == 0.0 {
        return Ok(0.0);
    }
    let total = |values: &[f64]| values.iter().sum::<f64>();
    let moment = |points: &[[f64; D]], values: &[f64], k: usize| {
        let (middle, reach) = (0.5 * (first[k] + last[k]), 0.5 * (last[k] - first[k]));
        points.iter().zip(values).map(|(p, v)| v * (p[k] - middle) / reach).sum::<f64>()
    };
    let moments = (0..D).map(|k| (moment(points, values, k) - moment(&between, &others, k)).abs());
    Ok(0.5 * moments.fold((total(values) - total(&others)).abs(), f64::max) / size)
}

/// What the scene asks for, and of the rest the best.
fn choose(spectrum: &Spectrum, params: FreeSpaceParams) -> Result<Chosen, Error> {
    let kernel = match (params.kernel, params.order, params.sigma) {
        (Some(GreenName::Spectral), ..) => Kernel::Spectral,
        (Some(GreenName::Truncated), ..) => Kernel::Truncated,
        (_, Some(order), Some(sigma)) => Kernel::Gaussian { order, smoothing: Some(sigma) },
        (_, Some(order), None) => Kernel::Gaussian { order, smoothing: Some(default_smoothing(order)?) },
        (_, None, Some(sigma)) => Kernel::Gaussian { order: 10, smoothing: Some(sigma) },
        _ => spectrum.best().kernel,
    };
    // Where a mesh does not resolve a curl, its samples are not quite one.
    let least = DIVERGENCE.max(UNRESOLVED * spectrum.error(Kernel::Spectral));
    let gradient = spectrum.gradient_part().filter(|part| *part > least);
    Ok(Chosen { kernel, error: spectrum.error(kernel), gradient })
}
