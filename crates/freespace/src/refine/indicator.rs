//! Where to refine.

use crate::error::FreeSpaceError;
use crate::kernel::{BandPass, Kernel};
use crate::mesh::Mesh;
use crate::plan::{Output, Plan, Workspace};
use crate::spectrum::Spectrum;

use super::boxes::Blocks;
use super::taper::{TAPER, taper};
use super::{Patch, RefineParams, SMOOTHING, part};

/// Patches of the base mesh that cover every cell in which `error`, the estimate of a solve on it, exceeds `tolerance` times
/// the largest magnitude of `field`, and the cells around it: blocks of eight cells, joined to boxes. One level; for as many as a
/// tolerance needs, [`suggest_tree`].
///
/// # Errors
/// Arrays of the wrong length, a tolerance that is not positive, or a ratio below 2.
pub fn suggest<const D: usize>(
    mesh: &Mesh<D>,
    error: &[f64],
    field: &[f64],
    tolerance: f64,
    ratio: usize,
) -> Result<Vec<Patch<D>>, FreeSpaceError> {
    FreeSpaceError::unless_positive("tolerance", tolerance)?;
    crate::plan::check_values("estimate of the error", error, mesh.len())?;
    crate::plan::check_values("field", field, mesh.len())?;
    let limit = tolerance * field.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    patches(mesh, None, error, limit, ratio, &RefineParams::default())
}

/// Patches of a mesh, which is that of a patch or the base, where `error` is above `limit`.
fn patches<const D: usize>(
    mesh: &Mesh<D>,
    parent: Option<usize>,
    error: &[f64],
    limit: f64,
    ratio: usize,
    params: &RefineParams,
) -> Result<Vec<Patch<D>>, FreeSpaceError> {
    // Each patch samples a band as well, in units of its own cells.
    let kernel = BandPass::<D>::new(params.order, params.smoothing.unwrap_or(SMOOTHING), ratio as f64)?;
    let band = 2.0 * (kernel.reach(params.tolerance) + TAPER as f64);
    let cost = |cells: [usize; D]| cells.iter().map(|&n| n as f64 * ratio as f64 + band).product();
    let above = error.iter().enumerate().filter(|(_, e)| e.abs() > limit);
    let blocks = Blocks::new(mesh.cells(), above.map(|(point, _)| mesh.indices(point)));
    let boxes = blocks.covers(&cost).into_iter();
    Ok(boxes.map(|(first, cells)| Patch { parent, first, cells, ratio }).collect())
}

/// How [`suggest_tree`] chooses patches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreeParams {
    /// Largest error of phi, or of its gradient, over the largest magnitude of it.
    pub tolerance: f64,
    /// Whether the tolerance is that of the gradient.
    pub gradient: bool,
    /// Parts that a cell is divided into in each direction from level to level.
    pub ratio: usize,
    /// Levels of patches that there may be.
    pub levels: usize,
    /// How the patches are going to be solved on. The tolerance does not know of what an interpolation adds; a shift adds nothing, but takes
    /// `ratio^D` times as many transforms of each mesh for each level below it.
    pub refine: RefineParams,
}

impl Default for TreeParams {
    /// A potential to 1e-4 with up to eight levels of ratio 2, order 6, superposed by polynomials through 16 points: waves of six cells of a mesh are
    /// brought to a finer one with 3e-6 of them, waves of twelve with 5e-11.
    fn default() -> Self {
        let superposition = super::Superposition::Lagrange(16);
        let refine = RefineParams { order: 6, superposition, ..RefineParams::default() };
        Self { tolerance: 1e-4, gradient: false, ratio: 2, levels: 8, refine }
    }
}

/// Part of the tolerance above which an estimate is refined: it is good to some tenths.
const MARGIN: f64 = 0.5;

/// Smoothing radius over the spacing of the kernel that another one is compared with: less, and it would not be summed as
/// accurately as it is integrated.
const SHARPER: f64 = 1.25;

/// The least ratio of the radii that are compared.
const LEAST_RATIO: f64 = 1.1;

/// Patches, and patches within them, wherever the error of a solve exceeds a tolerance: the base mesh first, then level by level, each judged
/// by the source on its own mesh. The error is local, `(G - G_m) * source`, and estimated in all its terms as what a radius
/// smaller by a ratio a changes, over `1 - a^-m`. `source` must vanish beyond the base mesh, whose points must resolve it:
/// patches add what a mesh smooths, not what it samples wrongly.
///
/// # Errors
/// [`FreeSpaceError::Edge`] where more of the source than the tolerance is left at the edge of the base mesh, [`FreeSpaceError::Tolerance`] where
/// the mesh does not resolve it, [`FreeSpaceError::Levels`] where more levels would be needed, a ratio below 2, and the errors of kernels and plans.
pub fn suggest_tree<const D: usize>(
    base: &Mesh<D>,
    source: impl Fn([f64; D]) -> f64,
    params: TreeParams,
) -> Result<Vec<Patch<D>>, FreeSpaceError> {
    let TreeParams { tolerance, ratio, levels, refine, .. } = params;
    FreeSpaceError::unless_positive("tolerance", tolerance)?;
    let wanted: Vec<Output> = if params.gradient {
        (0..D).map(|axis| Output::Gradient { source: 0, axis }).collect()
    } else {
        vec![Output::Potential { source: 0 }]
    };
    if ratio < 2 {
        let value = ratio as f64;
        return Err(FreeSpaceError::Invalid { what: "ratio of spacings", value, expected: "at least 2" });
    }
    let values = base.sample(&source);
    let edge = base.edge_ratio(&values);
    if edge > tolerance {
        return Err(FreeSpaceError::Edge { edge, tolerance });
    }
    let unresolved =
        Spectrum::new(base, &values)?.error(Kernel::Spectral).max(missed(base, &values, &source));
    if unresolved > tolerance {
        return Err(FreeSpaceError::Tolerance { tolerance, error: unresolved });
    }
    let smoothing = Some(refine.smoothing.unwrap_or(SMOOTHING));
    let plan: Plan<D> = Plan::new(base, Kernel::Gaussian { order: refine.order, smoothing })?;
    let size = magnitudes(&plan, &values, &wanted)?.into_iter().fold(0.0_f64, f64::max);
    let limit = MARGIN * tolerance * size;
    let (mut tree, mut front) = (Vec::new(), vec![(None, *base)]);
    for level in 0..=levels {
        let (mut next, mut worst) = (Vec::new(), 0.0_f64);
        for (parent, mesh) in front {
            let error = estimate(&mesh, &source, &wanted, &params)?;
            worst = error.iter().fold(worst, |m, e| m.max(*e));
            for patch in patches(&mesh, parent, &error, limit, ratio, &refine)? {
                next.push((Some(tree.len()), patch.mesh(tree.len(), &mesh)?));
                tree.push(patch);
            }
        }
        if next.is_empty() {
            return Ok(tree);
        }
        if level == levels {
            return Err(FreeSpaceError::Levels { levels, tolerance, error: worst / size });
        }
        front = next;
    }
    Ok(tree)
}

/// Half of the difference of the totals of the source at the points and between them, or of its first moments, over the total of its size: what
/// samples miss of a source that ends abruptly, which no spectrum of samples knows.
fn missed<const D: usize>(mesh: &Mesh<D>, values: &[f64], source: &impl Fn([f64; D]) -> f64) -> f64 {
    let (h, low, high) = (mesh.spacing(), mesh.min(), mesh.max());
    let (mut size, mut sums) = (0.0, [0.0; 4]);
    for (point, value) in values.iter().enumerate() {
        let here = mesh.point(point);
        let there: [f64; D] = std::array::from_fn(|a| here[a] + 0.5 * h[a]);
        let other = source(there);
        let place = |p: [f64; D], a: usize| (2.0 * p[a] - low[a] - high[a]) / (high[a] - low[a]);
        size += value.abs();
        sums[0] += value - other;
        (0..D).for_each(|a| sums[a + 1] += value * place(here, a) - other * place(there, a));
    }
    let most = sums.into_iter().fold(0.0_f64, |m, sum| m.max(sum.abs()));
    if size > 0.0 { 0.5 * most / size } else { 0.0 }
}

/// What the error on a mesh is, point by point: of phi, or the length of that of its gradient.
fn estimate<const D: usize>(
    mesh: &Mesh<D>,
    source: &impl Fn([f64; D]) -> f64,
    wanted: &[Output],
    params: &TreeParams,
) -> Result<Vec<f64>, FreeSpaceError> {
    let smoothing = params.refine.smoothing.unwrap_or(SMOOTHING);
    let spacing = mesh.spacing().into_iter();
    let (finest, coarsest) =
        spacing.fold((f64::INFINITY, 0.0_f64), |(low, high), h| (low.min(h), high.max(h)));
    let ratio = (smoothing / SHARPER).max(LEAST_RATIO);
    let order = params.refine.order;
    let kernel = BandPass::<D>::new(order, smoothing * coarsest / ratio, ratio)?;
    let band = ((kernel.reach(params.refine.tolerance) / finest).ceil() as usize).saturating_add(TAPER);
    let sampled = mesh.grown(band)?;
    let plan = Plan::compact(&sampled, &kernel, kernel.smooth())?;
    let error = magnitudes(&plan, &taper(&sampled, &sampled.sample(source))?, wanted)?;
    let rest = 1.0 - ratio.powi(-(order as i32));
    Ok(part(&error, &sampled, band, mesh).into_iter().map(|e| e / rest).collect())
}

/// The root of the sum of squares of outputs.
fn magnitudes<const D: usize>(
    plan: &Plan<D>,
    source: &[f64],
    wanted: &[Output],
) -> Result<Vec<f64>, FreeSpaceError> {
    let mut fields = Vec::new();
    plan.solve(&[source], wanted, &mut Workspace::default(), &mut fields)?;
    let square = |point: usize| fields.iter().map(|field| field[point] * field[point]).sum::<f64>();
    Ok((0..source.len()).map(|point| square(point).sqrt()).collect())
}

#[cfg(test)]
mod tests {
    use super::suggest;
    use crate::mesh::{Centring, Mesh};

    #[test]
    fn every_point_above_the_tolerance_is_covered_once() -> Result<(), crate::error::FreeSpaceError> {
        let mesh = Mesh::new([0.0; 2], [1.0; 2], [150, 144], Centring::Cell)?;
        let round = |[x, y]: [f64; 2], [a, b]: [f64; 2]| (x - a).hypot(y - b) < 14.0;
        let error = mesh.sample(|p| f64::from(u8::from(round(p, [20.0, 25.0]) || round(p, [120.0, 115.0]))));
        let patches = suggest(&mesh, &error, &vec![1.0; mesh.len()], 0.5, 2)?;
        for (point, error) in error.iter().enumerate() {
            let i = mesh.indices(point);
            let inside =
                |p: &&super::Patch<2>| (0..2).all(|a| i[a] >= p.first[a] && i[a] < p.first[a] + p.cells[a]);
            let count = patches.iter().filter(inside).count();
            assert!(count <= 1 && (count == 1 || *error < 0.5), "{i:?}");
        }
        assert!(patches.len() == 2 && suggest(&mesh, &error, &error, 2.0, 2)?.is_empty());
        Ok(())
    }
}
