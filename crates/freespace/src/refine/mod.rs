//! Refinement: patches with finer meshes, each of which adds the wave numbers that its parent does not hold.
//!
//! Hejlesen and Walther (2016), section 2.6. The base mesh samples all of the source; nothing is cut out of it under a patch.
//! A patch samples the source on itself and on a band as wide as its kernel reaches, convolves it with the band-pass
//! kernel, and adds what its parent found. The result counts inside of the patch alone, so that neighbours need not know of
//! each other.

mod boxes;
mod indicator;
mod interpolate;
mod patch;
mod shift;
mod taper;

pub use indicator::{TreeParams, suggest, suggest_tree};
pub use interpolate::{Superposition, m4_prime, m6_star};
pub use patch::Patch;

use crate::error::FreeSpaceError;
use crate::kernel::{BandPass, Gaussian};
use crate::mesh::Mesh;
use crate::plan::{Output, Plan, Workspace};
use interpolate::interpolate;
use shift::{Shifted, places};
use taper::{TAPER, taper};

/// Smoothing radius over the spacing: as in the paper. What a mesh finds must be smooth on its own scale to be
/// interpolated, more than its sum must be as good as an integral.
const SMOOTHING: f64 = 2.0;

/// How meshes are refined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefineParams {
    /// Order m of the kernels.
    pub order: usize,
    /// Smoothing radius over the spacing of each mesh; `None` takes 2.
    pub smoothing: Option<f64>,
    /// Kernels of patches are cut off where they are below this part of their value at the origin.
    pub tolerance: f64,
    /// How a patch takes over what its parent found.
    pub superposition: Superposition,
}

impl Default for RefineParams {
    /// Order 10, reach to round-off, polynomials through ten points.
    fn default() -> Self {
        Self { order: 10, smoothing: None, tolerance: 1e-15, superposition: Superposition::Lagrange(10) }
    }
}

/// A base mesh and patches, planned once and used for many sources. Mesh 0 is the base, mesh j + 1 the patch j.
#[derive(Debug)]
pub struct RefinedPlan<const D: usize> {
    params: RefineParams,
    levels: Vec<Level<D>>,
}

#[derive(Debug)]
struct Level<const D: usize> {
    plan: Plan<D>,
    parent: Option<usize>,
    /// The points whose values count.
    mesh: Mesh<D>,
    /// The same with the points that patches within it interpolate from.
    evaluated: Mesh<D>,
    /// Points of the evaluated mesh before the first one that counts.
    margin: usize,
    /// Points of the sampled mesh before the first one that is evaluated.
    band: usize,
}

/// For each mesh, for each source or output, an array of values.
pub type Fields = Vec<Vec<Vec<f64>>>;

impl<const D: usize> RefinedPlan<D> {
    /// Plans a base mesh with patches; parents come before their patches.
    ///
    /// # Errors
    /// A patch outside of its parent, a ratio below 2, and the errors of kernels and plans.
    pub fn new(base: &Mesh<D>, patches: &[Patch<D>], params: RefineParams) -> Result<Self, FreeSpaceError> {
        FreeSpaceError::unless_positive("tolerance of the kernels", params.tolerance)?;
        if let Superposition::Lagrange(points) = params.superposition
            && !(points.is_multiple_of(2) && (2..=16).contains(&points))
        {
            return Err(FreeSpaceError::Invalid {
                what: "number of points to interpolate from",
                value: points as f64,
                expected: "even, from 2 to 16",
            });
        }
        let (meshes, parents) = nested(base, patches)?;
        let margins = margins(&meshes, &parents, params.superposition)?;
        let smoothing = params.smoothing.unwrap_or(SMOOTHING);
        let coarsest = base.spacing().into_iter().fold(0.0, f64::max);
        let kernel = Gaussian::<D>::new(params.order, smoothing * coarsest)?;
        let evaluated = base.grown(margins[0])?;
        let plan = Plan::with_radial(&evaluated, &kernel)?;
        let mut levels =
            vec![Level { plan, parent: None, mesh: *base, evaluated, margin: margins[0], band: 0 }];
        for (index, patch) in patches.iter().enumerate() {
            let (mesh, margin) = (meshes[index + 1], margins[index + 1]);
            let level = Level::of_patch(mesh, patch.ratio, margin, smoothing, params)?;
            levels.push(Level { parent: Some(parents[index]), ..level });
        }
        Ok(Self { params, levels })
    }

    /// Number of meshes, the base included.
    pub fn len(&self) -> usize {
        self.levels.len()
    }

    /// Whether there are no meshes; there is always a base.
    pub fn is_empty(&self) -> bool {
        self.levels.is_empty()
    }

    /// The mesh that results of mesh `index` are given on.
    pub fn mesh(&self, index: usize) -> &Mesh<D> {
        &self.levels[index].mesh
    }

    /// The mesh that the source of mesh `index` is to be sampled on, with its band and what its patches are interpolated from.
    pub fn source_mesh(&self, index: usize) -> &Mesh<D> {
        self.levels[index].plan.mesh()
    }

    /// The patches that lie in mesh `index`, as indices of meshes.
    pub fn patches_of(&self, index: usize) -> impl Iterator<Item = usize> {
        (0..self.levels.len()).filter(move |&i| self.levels[i].parent == Some(index))
    }

    /// The fields `wanted` on every mesh; `sources` has for each mesh the sources on its [`Self::source_mesh`].
    ///
    /// # Errors
    /// As for [`Plan::solve`], or sources for another number of meshes.
    pub fn solve(&self, sources: &[Vec<Vec<f64>>], wanted: &[Output]) -> Result<Fields, FreeSpaceError> {
        if sources.len() != self.levels.len() {
            return Err(FreeSpaceError::Length {
                what: "list of sources",
                got: sources.len(),
                expected: self.levels.len(),
            });
        }
        let mut totals: Fields = Vec::with_capacity(self.levels.len());
        for (index, level) in self.levels.iter().enumerate() {
            let own = self.solve_on(index, &sources[index], &placed(wanted, [0.0; D]))?;
            totals.push(own.iter().map(|field| level.evaluated_part(field)).collect());
        }
        match self.params.superposition {
            Superposition::Shift => self.add_shifted(sources, wanted, &mut totals)?,
            how => self.add_interpolated(how, &mut totals),
        }
        for (level, total) in self.levels.iter().zip(&mut totals) {
            if level.margin > 0 {
                total
                    .iter_mut()
                    .for_each(|field| *field = part(field, &level.evaluated, level.margin, &level.mesh));
            }
        }
        Ok(totals)
    }

    fn solve_on(
        &self,
        index: usize,
        sources: &[Vec<f64>],
        wanted: &[(Output, [f64; D])],
    ) -> Result<Vec<Vec<f64>>, FreeSpaceError> {
        let plan = &self.levels[index].plan;
        // The source goes on beyond the band of a patch, but not beyond the base mesh.
        let tapered: Vec<Vec<f64>>;
        let sources = if self.levels[index].band == 0 {
            sources
        } else {
            tapered = sources.iter().map(|source| taper(plan.mesh(), source)).collect::<Result<_, _>>()?;
            &tapered
        };
        let sources: Vec<&[f64]> = sources.iter().map(Vec::as_slice).collect();
        let mut outputs = Vec::new();
        plan.solve_at(&sources, wanted, &mut Workspace::default(), &mut outputs)?;
        Ok(outputs)
    }

    /// Adds what parents found to their patches, parents first.
    fn add_interpolated(&self, how: Superposition, totals: &mut Fields) {
        for (index, level) in self.levels.iter().enumerate() {
            let Some(parent) = level.parent else { continue };
            let (above, below) = totals.split_at_mut(index);
            let Some(total) = below.first_mut() else { continue };
            for (field, coarse) in total.iter_mut().zip(&above[parent]) {
                let fine = level.taken_over(&self.levels[parent].evaluated, coarse, how);
                field.iter_mut().zip(fine).for_each(|(f, c)| *f += c);
            }
        }
    }

    /// Adds what each mesh finds at the points of all patches within it. What patches with the same spacing need of a mesh is found once.
    fn add_shifted(
        &self,
        sources: &[Vec<Vec<f64>>],
        wanted: &[Output],
        totals: &mut Fields,
    ) -> Result<(), FreeSpaceError> {
        for coarse in 0..self.levels.len() {
            let mesh = self.source_mesh(coarse);
            let mut within: Vec<usize> = self.within(coarse).collect();
            while let Some(&first) = within.first() {
                let alike = |&i: &usize| self.levels[i].mesh.spacing() == self.levels[first].mesh.spacing();
                let patches: Vec<usize> = within.iter().copied().filter(alike).collect();
                within.retain(|i| !alike(i));
                let fine: Vec<&Mesh<D>> = patches.iter().map(|&i| &self.levels[i].evaluated).collect();
                for places in places(mesh, &fine) {
                    let at: Vec<(Output, [f64; D])> =
                        places.iter().flat_map(|place| placed(wanted, *place)).collect();
                    let fields = self.solve_on(coarse, &sources[coarse], &at)?;
                    for (place, fields) in places.iter().zip(fields.chunks(wanted.len().max(1))) {
                        for &patch in &patches {
                            let shifted = Shifted::new(mesh, &self.levels[patch].evaluated, *place);
                            for (field, total) in fields.iter().zip(&mut totals[patch]) {
                                shifted.add(field, total);
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The patches within a mesh, and those within them.
    fn within(&self, index: usize) -> impl Iterator<Item = usize> {
        (index + 1..self.levels.len()).filter(move |&i| {
            let above = std::iter::successors(self.levels[i].parent, |p| self.levels[*p].parent);
            above.into_iter().any(|p| p == index)
        })
    }
}

/// Outputs at one place.
fn placed<const D: usize>(wanted: &[Output], place: [f64; D]) -> Vec<(Output, [f64; D])> {
    wanted.iter().map(|&output| (output, place)).collect()
}

impl<const D: usize> Level<D> {
    fn of_patch(
        mesh: Mesh<D>,
        ratio: usize,
        margin: usize,
        smoothing: f64,
        params: RefineParams,
    ) -> Result<Self, FreeSpaceError> {
        let evaluated = mesh.grown(margin)?;
        let coarsest = mesh.spacing().into_iter().fold(0.0, f64::max);
        let kernel = BandPass::<D>::new(params.order, smoothing * coarsest, ratio as f64)?;
        let finest = mesh.spacing().into_iter().fold(f64::INFINITY, f64::min);
        let band = ((kernel.reach(params.tolerance) / finest).ceil() as usize).saturating_add(TAPER);
        let sampled = evaluated.grown(band)?;
        let plan = Plan::compact(&sampled, &kernel, kernel.smooth())?;
        Ok(Self { plan, parent: None, mesh, evaluated, margin, band })
    }

    /// The evaluated part of a field on the sampled mesh.
    fn evaluated_part(&self, field: &[f64]) -> Vec<f64> {
        part(field, self.plan.mesh(), self.band, &self.evaluated)
    }

    /// A field of the parent at the evaluated points.
    fn taken_over(&self, parent: &Mesh<D>, field: &[f64], how: Superposition) -> Vec<f64> {
        let places = self.evaluated.places_in(parent);
        interpolate(field, parent.points(), self.evaluated.points(), places, how)
    }
}

/// The base mesh and those of the patches, and for every patch the mesh that it lies in.
fn nested<const D: usize>(
    base: &Mesh<D>,
    patches: &[Patch<D>],
) -> Result<(Vec<Mesh<D>>, Vec<usize>), FreeSpaceError> {
    let (mut meshes, mut parents) = (vec![*base], Vec::new());
    for (index, patch) in patches.iter().enumerate() {
        let parent = patch.parent.map_or(0, |p| p + 1);
        if parent > index {
            return Err(FreeSpaceError::Patch {
                patch: index,
                what: format!("its parent, patch {}, does not come before it", parent - 1),
            });
        }
        meshes.push(patch.mesh(index, &meshes[parent])?);
        parents.push(parent);
    }
    Ok((meshes, parents))
}

/// Points by which each mesh has to be grown for those of its patches to be interpolated from it: none where they keep far enough from its
/// edge.
fn margins<const D: usize>(
    meshes: &[Mesh<D>],
    parents: &[usize],
    how: Superposition,
) -> Result<Vec<usize>, FreeSpaceError> {
    let mut margins = vec![0; meshes.len()];
    for index in (1..meshes.len()).rev() {
        let (fine, parent) = (meshes[index].grown(margins[index])?, parents[index - 1]);
        margins[parent] = margins[parent].max(patch::shortage(&fine, &meshes[parent], how));
    }
    Ok(margins)
}

/// The values of `field` on `inner`, which begins `skip` points after `outer` in every direction.
fn part<const D: usize>(field: &[f64], outer: &Mesh<D>, skip: usize, inner: &Mesh<D>) -> Vec<f64> {
    (0..inner.len()).map(|point| field[outer.index(inner.indices(point).map(|i| i + skip))]).collect()
}
