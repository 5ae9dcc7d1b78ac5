//! Values and gradients of a nodal field between the nodes, each point in its own region.

use meshless_neighbors::{CellList, NeighborError};
use meshless_stencils::{FitParams, FitScratch, Functional, LocalFit, Weight};

use crate::Problem;

/// Degree of the fit.
const DEGREE: usize = 2;

/// Nodes of the region that a fit should have for each of its monomials.
const NODES_PER_MONOMIAL: f64 = 2.0;

/// How often the search for nodes is widened by half before a lower degree is taken.
const MAX_SEARCHES: usize = 4;

/// Evaluates a nodal field anywhere in the domain by weighted least squares over the nodes of the same region:
/// never an average over an interface.
#[derive(Debug)]
pub struct Sampler<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    u: &'a [f64],
    index: CellList<'a, D>,
    degree: usize,
    fits: [LocalFit<D>; 2],
}

/// Memory of one thread.
#[derive(Debug)]
pub struct SampleScratch<const D: usize> {
    found: Vec<u32>,
    own: Vec<u32>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
    fits: [FitScratch<D>; 2],
}

/// Value and gradient at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<const D: usize> {
    /// The value.
    pub value: f64,
    /// The gradient.
    pub gradient: [f64; D],
    /// Region of the point.
    pub region: u16,
}

impl<'a, const D: usize> Sampler<'a, D> {
    /// Prepares to evaluate the field `u`, one value a node.
    pub fn new(problem: &'a Problem<'a, D>, u: &'a [f64]) -> Result<Self, NeighborError> {
        Self::of_degree(problem, u, DEGREE)
    }

    /// The same by fits of another degree than two.
    ///
    /// # Errors
    /// Those of [`Sampler::new`].
    pub fn of_degree(
        problem: &'a Problem<'a, D>,
        u: &'a [f64],
        degree: usize,
    ) -> Result<Self, NeighborError> {
        let reach = problem.supports.radius.iter().fold(0.0_f64, |a, &b| a.max(b));
        let index = CellList::new(problem.cloud.points(), reach)?;
        let fits = [degree, 1].map(|degree| LocalFit::new(FitParams { degree, ..FitParams::default() }));
        Ok(Self { problem, u, index, degree, fits })
    }

    /// Memory for one thread.
    pub fn scratch(&self) -> SampleScratch<D> {
        let most = 4 * (self.problem.supports.lists.max_count() + 1);
        SampleScratch {
            found: Vec::new(),
            own: Vec::new(),
            offsets: Vec::new(),
            weights: Vec::new(),
            coefficients: Vec::new(),
            fits: self.fits.each_ref().map(|f| f.scratch(most)),
        }
    }

    /// Value and gradient at `x`; `None` where no node of the point's region is near.
    pub fn at(&self, x: &[f64; D], scratch: &mut SampleScratch<D>) -> Option<Sample<D>> {
        let nearest = self.index.nearest_one(x)? as usize;
        let region = self.problem.regions.label(x, self.problem.cloud.spacing()[nearest]);
        let monomials = (1..=D).fold(1.0, |count, k| count * (self.degree + k) as f64 / k as f64);
        let wanted = (NODES_PER_MONOMIAL * monomials).ceil() as usize;
        let mut radius = self.problem.supports.radius[nearest];
        for _ in 0..MAX_SEARCHES {
            self.gather(x, region, radius, scratch);
            if scratch.own.len() >= wanted
                && let Some(sample) = self.fit(0, x, region, radius, scratch)
            {
                return Some(sample);
            }
            radius *= 1.5;
        }
        self.fit(1, x, region, radius, scratch).or_else(|| self.nearest_of_region(x, region, &scratch.own))
    }

    fn gather(&self, x: &[f64; D], region: u16, radius: f64, scratch: &mut SampleScratch<D>) {
        scratch.found.clear();
        self.index.within(x, radius, &mut scratch.found);
        scratch.own.clear();
        scratch
            .own
            .extend(scratch.found.iter().copied().filter(|&j| self.problem.labels[j as usize] == region));
        if !self.problem.slits.is_empty() {
            let points = self.problem.cloud.points();
            scratch.own.retain(|&j| !self.problem.is_hidden(x, &points[j as usize]));
        }
    }

    fn fit(
        &self,
        which: usize,
        x: &[f64; D],
        region: u16,
        radius: f64,
        scratch: &mut SampleScratch<D>,
    ) -> Option<Sample<D>> {
        let points = self.problem.cloud.points();
        scratch.offsets.clear();
        scratch.weights.clear();
        for &j in &scratch.own {
            let offset: [f64; D] = std::array::from_fn(|k| points[j as usize][k] - x[k]);
            let distance = offset.iter().map(|d| d * d).sum::<f64>().sqrt();
            scratch.offsets.push(offset);
            scratch.weights.push(Weight::Gaussian { decay: 4.0 }.value(distance, radius, radius));
        }
        let most = scratch.own.len();
        if most == 0 {
            return None;
        }
        let (fit, memory) = (&self.fits[which], &mut scratch.fits[which]);
        fit.factor(&scratch.offsets, &scratch.weights, radius, memory).ok()?;
        scratch.coefficients.resize(most, 0.0);
        let mut apply = |functional: &Functional<D>| -> Option<f64> {
            fit.coefficients(functional, memory, &mut scratch.coefficients[..most]).ok()?;
            let sum: f64 =
                scratch.own.iter().zip(&scratch.coefficients).map(|(&j, c)| c * self.u[j as usize]).sum();
            sum.is_finite().then_some(sum)
        };
        let value = apply(&Functional::Value)?;
        let mut gradient = [0.0; D];
        for (axis, component) in gradient.iter_mut().enumerate() {
            *component = apply(&Functional::Partial(axis))?;
        }
        Some(Sample { value, gradient, region })
    }

    fn nearest_of_region(&self, x: &[f64; D], region: u16, own: &[u32]) -> Option<Sample<D>> {
        let points = self.problem.cloud.points();
        let squared = |j: u32| (0..D).map(|k| (points[j as usize][k] - x[k]).powi(2)).sum::<f64>();
        let nearest =
            own.iter().copied().min_by(|&a, &b| squared(a).total_cmp(&squared(b)).then(a.cmp(&b)))?;
        Some(Sample { value: self.u[nearest as usize], gradient: [0.0; D], region })
    }
}
