//! Stencils of several operators at all points of a cloud.

use rayon::prelude::*;

use crate::{FitDiagnosis, FitParams, FitScratch, Functional, LocalFit, StencilError, Weight};

/// Points that one task treats.
const POINTS_PER_TASK: usize = 256;

/// The coefficients of some operators at every point of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct StencilSet {
    functionals: usize,
    /// Where the coefficients of a point start; one more than there are points.
    starts: Vec<usize>,
    coefficients: Vec<f64>,
    fits: Vec<FitDiagnosis>,
}

impl StencilSet {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.fits.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.fits.is_empty()
    }

    /// Number of operators.
    pub fn functionals(&self) -> usize {
        self.functionals
    }

    /// Coefficients of an operator at a point: the point itself comes first, its neighbours follow in their order.
    ///
    /// # Panics
    /// For a point or an operator out of range.
    pub fn of(&self, point: usize, functional: usize) -> &[f64] {
        let block = &self.coefficients[self.starts[point]..self.starts[point + 1]];
        let count = block.len() / self.functionals;
        &block[functional * count..(functional + 1) * count]
    }

    /// What the factorisation at a point said.
    ///
    /// # Panics
    /// For a point out of range.
    pub fn fit(&self, point: usize) -> FitDiagnosis {
        self.fits[point]
    }

    /// Applies an operator at a point to a field, given the neighbours that the stencils were built with.
    ///
    /// # Panics
    /// For a point, an operator or a neighbour out of range.
    pub fn apply(&self, point: usize, functional: usize, neighbors: &[u32], field: &[f64]) -> f64 {
        let (own, others) = self.of(point, functional).split_at(1);
        own[0] * field[point] + others.iter().zip(neighbors).map(|(c, &j)| c * field[j as usize]).sum::<f64>()
    }
}

/// The stencils of `functionals` at all `points`, in parallel.
///
/// `supports` are the neighbours of the points, compressed: the neighbours of point i are
/// `supports.1[supports.0[i]..supports.0[i + 1]]`, and point i itself is added in front of them. `radii` are those of
/// the weights, one for each point. Every support is scaled by the distance of its farthest point.
///
/// # Errors
/// Lengths that do not agree, neighbours out of range, and [`StencilError::AtPoint`] for the first point that has no
/// stencil.
pub fn build_stencils<const D: usize>(
    points: &[[f64; D]],
    supports: (&[usize], &[u32]),
    radii: &[f64],
    weight: Weight,
    params: FitParams,
    functionals: &[Functional<D>],
) -> Result<StencilSet, StencilError> {
    let most = check(points.len(), supports, radii)?;
    let cloud = Cloud { points, supports, radii, weight, fit: LocalFit::new(params), functionals };
    let tasks: Vec<usize> = (0..points.len()).step_by(POINTS_PER_TASK).collect();
    let outcomes: Vec<Result<Part, StencilError>> = tasks
        .into_par_iter()
        .map_init(|| Memory::new(&cloud.fit, most), |memory, first| cloud.part(first, memory))
        .collect();
    // Which point an error names must not depend on which thread was faster.
    let parts: Vec<Part> = outcomes.into_iter().collect::<Result<_, _>>()?;
    let starts = supports.0.iter().enumerate().map(|(i, &offset)| functionals.len() * (offset + i)).collect();
    let coefficients = parts.iter().flat_map(|part| &part.coefficients).copied().collect();
    let fits = parts.iter().flat_map(|part| &part.fits).copied().collect();
    Ok(StencilSet { functionals: functionals.len(), starts, coefficients, fits })
}

/// Points in the largest support.
fn check(points: usize, supports: (&[usize], &[u32]), radii: &[f64]) -> Result<usize, StencilError> {
    let (offsets, indices) = supports;
    if radii.len() != points {
        return Err(StencilError::LengthMismatch { what: "radii", given: radii.len(), expected: points });
    }
    let invalid = |node, reason| Err(StencilError::InvalidSupports { node, points, reason });
    if offsets.len() != points + 1 {
        return invalid(offsets.len(), "there must be one offset more than points");
    }
    if offsets[0] != 0 || offsets[points] != indices.len() {
        return invalid(points, "offsets must start at 0 and end at the number of neighbours");
    }
    if let Some(node) = offsets.windows(2).position(|pair| pair[0] > pair[1]) {
        return invalid(node, "offsets must not decrease");
    }
    if let Some(entry) = indices.iter().position(|&j| j as usize >= points) {
        return invalid(offsets.partition_point(|&o| o <= entry) - 1, "a neighbour is out of range");
    }
    Ok(1 + offsets.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(0))
}

struct Cloud<'a, const D: usize> {
    points: &'a [[f64; D]],
    supports: (&'a [usize], &'a [u32]),
    radii: &'a [f64],
    weight: Weight,
    fit: LocalFit<D>,
    functionals: &'a [Functional<D>],
}

/// Memory of one thread.
struct Memory<const D: usize> {
    fit: FitScratch<D>,
    offsets: Vec<[f64; D]>,
    weights: Vec<f64>,
}

impl<const D: usize> Memory<D> {
    fn new(fit: &LocalFit<D>, most: usize) -> Self {
        Self { fit: fit.scratch(most), offsets: Vec::with_capacity(most), weights: Vec::with_capacity(most) }
    }
}

/// Stencils of the points of one task.
struct Part {
    coefficients: Vec<f64>,
    fits: Vec<FitDiagnosis>,
}

impl<const D: usize> Cloud<'_, D> {
    fn part(&self, first: usize, memory: &mut Memory<D>) -> Result<Part, StencilError> {
        let last = (first + POINTS_PER_TASK).min(self.points.len());
        let offsets = self.supports.0;
        let entries = offsets[last] - offsets[first] + last - first;
        let mut coefficients = vec![0.0; self.functionals.len() * entries];
        let mut fits = Vec::with_capacity(last - first);
        let mut rest = &mut coefficients[..];
        for i in first..last {
            let count = 1 + offsets[i + 1] - offsets[i];
            let (own, others) = rest.split_at_mut(self.functionals.len() * count);
            rest = others;
            let outcome = self.stencils(i, memory, own);
            fits.push(outcome.map_err(|source| StencilError::AtPoint {
                node: i,
                position: self.points[i].to_vec(),
                source: Box::new(source),
            })?);
        }
        Ok(Part { coefficients, fits })
    }

    /// Writes the stencils of point i to `out`, one operator after the other.
    fn stencils(
        &self,
        i: usize,
        memory: &mut Memory<D>,
        out: &mut [f64],
    ) -> Result<FitDiagnosis, StencilError> {
        let centre = &self.points[i];
        memory.offsets.clear();
        memory.weights.clear();
        memory.offsets.push([0.0; D]);
        memory.weights.push(self.weight.value(0.0, self.radii[i], self.radii[i]));
        let mut reach = 0.0_f64;
        for &j in &self.supports.1[self.supports.0[i]..self.supports.0[i + 1]] {
            let offset: [f64; D] = std::array::from_fn(|k| self.points[j as usize][k] - centre[k]);
            let distance = offset.iter().map(|x| x * x).sum::<f64>().sqrt();
            memory.offsets.push(offset);
            memory.weights.push(self.weight.value(distance, self.radii[i], self.radii[j as usize]));
            reach = reach.max(distance);
        }
        // A point without neighbours has no length of its own; any will do to say what it cannot resolve.
        let reach = if reach > 0.0 { reach } else { self.radii[i] };
        let diagnosis = self.fit.factor(&memory.offsets, &memory.weights, reach, &mut memory.fit)?;
        for (functional, out) in self.functionals.iter().zip(out.chunks_exact_mut(memory.offsets.len())) {
            self.fit.coefficients(functional, &mut memory.fit, out)?;
        }
        Ok(diagnosis)
    }
}
