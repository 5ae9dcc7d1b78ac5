//! The diffusivity as the strong form sees it: scaled and smoothed (Kraus et al. 2022, section 2.2.1).

use crate::Problem;
use crate::gfdm::StrongParams;
use crate::parallel;

/// Exponent of the smoothing weights `exp(-3 r^2 / h_i^2)`.
const SMOOTHING_DECAY: f64 = 3.0;

/// Nodal values of eta or of `mu = log eta`, after smoothing.
#[derive(Debug)]
pub(super) struct StrongDiffusivity {
    values: Vec<f64>,
    logarithmic: bool,
}

impl StrongDiffusivity {
    /// Scales and smooths; `None` where the diffusivity is the same everywhere, so that its gradient is never taken.
    pub(super) fn new<const D: usize>(problem: &Problem<'_, D>, params: &StrongParams) -> Option<Self> {
        if problem.uniform_diffusivity().is_some() {
            return None;
        }
        let mut values: Vec<f64> = if params.log_scaling {
            problem.eta.iter().map(|e| e.ln()).collect()
        } else {
            problem.eta.to_vec()
        };
        for _ in 0..params.smoothing {
            values = smooth(problem, &values);
        }
        Some(Self { values, logarithmic: params.log_scaling })
    }

    /// Diffusivity and its gradient at node i, from the coefficients of the partial derivatives
    /// (`partials[k]` has one coefficient for each entry of `neighbors`).
    pub(super) fn at<const D: usize>(
        &self,
        i: usize,
        neighbors: &[u32],
        partials: &[Vec<f64>; D],
    ) -> (f64, [f64; D]) {
        let centre = self.values[i];
        let mut gradient = std::array::from_fn(|k| {
            partials[k].iter().zip(neighbors).map(|(c, &j)| c * (self.values[j as usize] - centre)).sum()
        });
        if !self.logarithmic {
            return (centre, gradient);
        }
        let eta = centre.exp();
        gradient.iter_mut().for_each(|g| *g *= eta);
        (eta, gradient)
    }

    /// Whether the diffusivity varies over the support of node i.
    pub(super) fn varies(&self, i: usize, neighbors: &[u32]) -> bool {
        neighbors.iter().any(|&j| self.values[j as usize] != self.values[i])
    }

    /// Diffusivity of node i.
    pub(super) fn value(&self, i: usize) -> f64 {
        if self.logarithmic { self.values[i].exp() } else { self.values[i] }
    }
}

/// One smoothing cycle: a convex combination over the support.
fn smooth<const D: usize>(problem: &Problem<'_, D>, values: &[f64]) -> Vec<f64> {
    let points = problem.cloud.points();
    parallel::map(points.len(), |i| {
        let (mut sum, mut weights) = (values[i], 1.0);
        let scale = SMOOTHING_DECAY / problem.supports.radius[i].powi(2);
        for &j in problem.supports.lists.of(i) {
            let j = j as usize;
            let weight = (-scale * squared_distance(&points[i], &points[j])).exp();
            sum += weight * values[j];
            weights += weight;
        }
        sum / weights
    })
}

fn squared_distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}
