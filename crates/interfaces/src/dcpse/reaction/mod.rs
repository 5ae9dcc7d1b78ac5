//! Continuum surface reaction (section 4.3): interfaces smeared over a width, jumps of the flux as sources.
//!
//! The operator sees all regions alike, with a diffusivity that goes from one to the other over the width w. A jump b
//! of the flux is a source `-b delta`. As the paper has it, delta is the gradient of the smoothed indicator: then the
//! kink that the source makes is smeared over w, which leaves an error of `0.4 w` times the jump of the slope. Here it is
//! what the discrete operator makes of a ramp with that kink, so that the kink comes out as sharp as it is.
//!
//! No interface is ever located for that but by its foot near a node, and three regions may meet; the price is an error
//! of first order where the diffusivity jumps, since the kink of u itself is smeared.

mod diffusion;
mod indicator;
mod params;
mod profile;

use std::time::Instant;

use meshless_sparse::{DifferenceMatrix, RowBuilder};
use meshless_stencils::Functional;

use super::constrained::{ConstrainedGhosts, Ghost};
use super::operators;
use super::{ghosts, kinds, params as immersed};
use crate::method::{Counts, Discretization, Method, RowKind};
use crate::operator_rows::OperatorRows;
use crate::parallel;
use crate::{MethodError, Problem};
pub use indicator::{Indicators, Share};
pub use params::{ReactionParams, ReactionSource, Sigma, Smoothing};

/// Degree of the fits by which conditions on the flux are collocated.
const BOUNDARY_DEGREE: usize = 2;

/// Step of difference quotients of the diffusivity, over the spacing, where no derivative is given.
const GRADIENT_STEP: f64 = 1e-4;

/// Continuum surface reaction.
#[derive(Debug, Clone, Copy, Default)]
pub struct SurfaceReaction {
    /// What was chosen.
    pub params: ReactionParams,
}

impl<const D: usize> Method<D> for SurfaceReaction {
    fn discretize(&self, problem: &Problem<'_, D>) -> Result<Discretization, MethodError> {
        problem.check()?;
        if problem.laws.iter().any(|jump| jump.value.is_some()) {
            return Err(MethodError::Unsupported {
                method: "surface-reaction",
                what: "prescribe a jump of u",
                instead: "use immersed-interface or particle-difference",
            });
        }
        let start = Instant::now();
        let known = problem.dirichlet();
        let kinds = kinds(problem, &known);
        let degree = immersed::operator_degree(self.params.order);
        let laplacian = operators::compute(
            problem,
            degree,
            |_| Functional::Laplacian,
            |i| kinds[i] == RowKind::Strong,
            |_, _| true,
        )?;
        let indicators = Indicators::new(problem, self.params.smoothing, self.params.width)?;
        let sigma = parallel::map(kinds.len(), |i| self.diffusivity(problem, &indicators, i));
        let slopes = parallel::map(kinds.len(), |i| resistance_slope(problem, &indicators, i));
        let boundary = ghosts::on_boundary(
            problem,
            &ConstrainedGhosts::new(problem, BOUNDARY_DEGREE, self.params.unsteady)?,
            &kinds,
        )?;
        let stencil_seconds = start.elapsed().as_secs_f64();
        let rows = Rows {
            problem,
            params: &self.params,
            kinds: &kinds,
            known: &known,
            laplacian: &laplacian,
            indicators: &indicators,
            sigma: &sigma,
            slopes: &slopes,
            boundary: &boundary,
        };
        let counts = Counts {
            stencils: kinds.iter().filter(|k| **k != RowKind::Dirichlet).count(),
            enlarged: laplacian.enlarged(),
            ..Counts::default()
        };
        let matrix = rows.matrix()?;
        let rhs = parallel::map(kinds.len(), |i| rows.rhs(i));
        let volumes = problem.cloud.spacing().iter().map(|h| h.powi(D as i32)).collect();
        Ok(Discretization::of_nodes((matrix, rhs), volumes, kinds, counts, stencil_seconds))
    }
}

impl SurfaceReaction {
    /// The diffusivity at a node, smeared over the interfaces near it.
    fn diffusivity<const D: usize>(
        &self,
        problem: &Problem<'_, D>,
        indicators: &Indicators<D>,
        i: usize,
    ) -> f64 {
        let shares = indicators.at(i);
        if shares.is_empty() || self.params.sigma == Sigma::Sharp {
            return problem.eta[i];
        }
        let x = &problem.cloud.points()[i];
        // Steps of diffusion may overshoot by a little.
        let of = |region: u16| problem.materials[region as usize].diffusivity.at(x);
        let clamped = shares.iter().map(|&(region, share, _)| (of(region), share.clamp(0.0, 1.0)));
        let mass: f64 = clamped.clone().map(|(_, share)| share).sum();
        match self.params.sigma {
            Sigma::Harmonic => mass / clamped.map(|(eta, share)| share / eta).sum::<f64>(),
            Sigma::Arithmetic => clamped.map(|(eta, share)| share * eta).sum::<f64>() / mass,
            Sigma::Sharp => problem.eta[i],
        }
    }
}

/// The gradient of `1 / sigma` at a node, smeared over the interfaces near it.
fn resistance_slope<const D: usize>(
    problem: &Problem<'_, D>,
    indicators: &Indicators<D>,
    i: usize,
) -> [f64; D] {
    let x = &problem.cloud.points()[i];
    let step = GRADIENT_STEP * problem.cloud.spacing()[i];
    let of = |region: u16, share: f64, gradient: &[f64; D]| -> [f64; D] {
        let field = &problem.materials[region as usize].diffusivity;
        let (eta, slope) = (field.at(x), field.gradient(x, step));
        std::array::from_fn(|k| gradient[k] / eta - share * slope[k] / (eta * eta))
    };
    let shares = indicators.at(i);
    if shares.is_empty() {
        return of(problem.labels[i], 1.0, &[0.0; D]);
    }
    shares.iter().fold([0.0; D], |sum, (region, share, gradient)| {
        let own = of(*region, *share, gradient);
        std::array::from_fn(|k| sum[k] + own[k])
    })
}

/// The rows.
struct Rows<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    params: &'a ReactionParams,
    kinds: &'a [RowKind],
    known: &'a [Option<f64>],
    laplacian: &'a OperatorRows,
    indicators: &'a Indicators<D>,
    sigma: &'a [f64],
    /// Gradients of `1 / sigma`.
    slopes: &'a [[f64; D]],
    /// Values at boundary nodes under their conditions, by node.
    boundary: &'a [(u32, Ghost)],
}

impl<const D: usize> Rows<'_, D> {
    fn volume(&self, i: usize) -> f64 {
        self.problem.cloud.spacing()[i].powi(D as i32)
    }

    fn boundary_scale(&self, i: usize) -> f64 {
        2.0 * D as f64 * self.problem.eta[i] * self.problem.cloud.spacing()[i].powi(D as i32 - 2)
    }

    fn on_boundary(&self, i: usize) -> Option<&Ghost> {
        self.boundary.binary_search_by_key(&(i as u32), |b| b.0).ok().map(|k| &self.boundary[k].1)
    }

    /// The diffusivity between two nodes: `div(sigma grad u) = 1/2 (lap(sigma u) - u lap sigma + sigma lap u)`, so that
    /// the coefficients of the Laplacian with the mean of both nodes' sigma are an operator for it of the same order.
    ///
    /// Harmonic: the mean of the resistance on the way, by the trapezoidal rule with the correction of its ends
    /// (Euler and Maclaurin). Supports reach over two widths, and the trapezoidal rule alone makes the flux through the
    /// interface wrong by a share that no spacing reduces.
    fn between(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (self.sigma[i], self.sigma[j]);
        match self.params.sigma {
            Sigma::Harmonic => {
                let points = self.problem.cloud.points();
                let bend: f64 = (0..D)
                    .map(|k| (self.slopes[i][k] - self.slopes[j][k]) * (points[j][k] - points[i][k]))
                    .sum();
                let (a, b) = (1.0 / a, 1.0 / b);
                // No mean is beyond both ends.
                1.0 / (0.5 * (a + b) + bend / 12.0).clamp(a.min(b), a.max(b))
            }
            Sigma::Arithmetic => 0.5 * (a + b),
            Sigma::Sharp => a,
        }
    }

    fn matrix(&self) -> Result<DifferenceMatrix, MethodError> {
        let rows = DifferenceMatrix::from_rows(self.kinds.len(), |i, out| match self.kinds[i] {
            RowKind::Dirichlet => out.add_to_row_sum(1.0),
            RowKind::StrongBoundary => self.boundary_row(i, out),
            _ => {
                let (neighbors, row) = self.laplacian.row(self.problem, i);
                for (&j, c) in neighbors.iter().zip(row).filter(|(_, c)| **c != 0.0) {
                    out.push(j as usize, -self.volume(i) * c * self.between(i, j as usize));
                }
            }
        })?;
        Ok(rows)
    }

    fn boundary_row(&self, i: usize, out: &mut RowBuilder) {
        let scale = self.boundary_scale(i);
        if let Some(value) = self.on_boundary(i) {
            value.subtract(scale, out);
        }
    }

    fn rhs(&self, i: usize) -> f64 {
        match self.kinds[i] {
            RowKind::Dirichlet => self.known[i].unwrap_or(0.0),
            RowKind::StrongBoundary => {
                self.boundary_scale(i) * self.on_boundary(i).map_or(0.0, |value| value.constant)
            }
            _ => self.volume(i) * (self.problem.source.map_or(0.0, |f| f[i]) - self.reaction(i)),
        }
    }

    /// What jumps of the flux add to `div(sigma grad u)` at a node: `b delta`.
    fn reaction(&self, i: usize) -> f64 {
        let jumps = self.problem.laws.iter().filter_map(|j| Some((j.between, j.flux.as_ref()?)));
        jumps
            .map(|([a, b], flux)| {
                let x = &self.problem.cloud.points()[i];
                let h = self.problem.cloud.spacing()[i];
                let reach = self.problem.supports.radius[i].max(4.0 * self.params.width * h);
                let Ok(foot) = self.problem.regions.project_within(self.problem.domain, a, b, x, reach)
                else {
                    return 0.0;
                };
                let jump = flux.at(&foot.point);
                match self.params.source {
                    ReactionSource::Operator => jump * self.ramp(i, b, &foot.point, &foot.normal),
                    ReactionSource::Smoothed => jump * self.delta(i, a),
                }
            })
            .sum()
    }

    /// The discrete operator on the ramp `max(D, 0) / sigma_b`, D the distance from the plane at the foot towards
    /// region b: its flux jumps by one.
    fn ramp(&self, i: usize, b: u16, foot: &[f64; D], normal: &[f64; D]) -> f64 {
        let points = self.problem.cloud.points();
        let slope = 1.0 / self.problem.materials[b as usize].diffusivity.at(foot);
        let ramp = |j: usize| -> f64 {
            let distance: f64 = (0..D).map(|k| (points[j][k] - foot[k]) * normal[k]).sum();
            slope * distance.max(0.0)
        };
        let (neighbors, row) = self.laplacian.row(self.problem, i);
        neighbors
            .iter()
            .zip(row)
            .map(|(&j, c)| c * self.between(i, j as usize) * (ramp(j as usize) - ramp(i)))
            .sum()
    }

    /// `-n . grad S(chi_a)`, where n points out of region a, from the smoothed indicator: (4.37) with the right sign.
    fn delta(&self, i: usize, a: u16) -> f64 {
        let gradient = self.indicators.at(i).iter().find(|s| s.0 == a).map(|s| s.2);
        gradient.map_or(0.0, |g| g.iter().map(|c| c * c).sum::<f64>().sqrt())
    }
}
