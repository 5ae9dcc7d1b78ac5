//! What a plan is expected to take.

use meshless_interfaces::sharp::Conservation;
use meshless_sparse::SolverKind;

use super::effects::{Effect, Survey};
use super::steps::{self, PredictedSteps};
use super::{MethodParams, MethodPlan, choose};
use crate::Error;
use crate::build;
use crate::scene::Scene;

/// Expected cost of a plan, on one core like the one that the constants below were measured on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predicted {
    /// Nodes.
    pub unknowns: f64,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Those of them that the estimate of the error takes.
    pub estimate_seconds: f64,
    /// Memory in units of 1e6 bytes.
    pub memory_mb: f64,
    /// Steps in time, in scenes that have them.
    pub steps: Option<PredictedSteps>,
}

/// Microseconds a node, by dimension, for the parts of a solve.
struct Rates {
    points: f64,
    neighbors: f64,
    stencil: f64,
    cell: f64,
    /// A cell by region with the fits of its fluxes, at order 4.
    balance: f64,
    /// Of the solve at 1e4 unknowns; it grows like `unknowns^SOLVE_GROWTH`.
    solve: f64,
    kilobytes: f64,
}

/// Measured with `cargo xtask bench` on one core.
const RATES: [Rates; 3] = [
    Rates { points: 0.5, neighbors: 0.5, stencil: 1.0, cell: 1.0, balance: 0.0, solve: 2.0, kilobytes: 1.0 },
    Rates {
        points: 3.0,
        neighbors: 1.5,
        stencil: 4.0,
        cell: 4.0,
        balance: 80.0,
        solve: 20.0,
        kilobytes: 3.0,
    },
    Rates {
        points: 10.0,
        neighbors: 6.0,
        stencil: 15.0,
        cell: 30.0,
        balance: 280.0,
        solve: 60.0,
        kilobytes: 6.0,
    },
];

/// Exponent by which the time of a solve exceeds its unknowns.
const SOLVE_GROWTH: f64 = 0.3;

/// What every solve with a matrix of the steps in time takes over a steady solve: such systems are better conditioned, and factors
/// are kept.
const SOLVE_SHARE: f64 = 0.12;

/// The same of a matrix: of factors, and of preconditioners.
const FACTORS_SHARE: f64 = 0.5;
const PRECONDITIONER_SHARE: f64 = 0.15;

/// Kilobytes a node that factors take, by dimension; twice as many where the steps change them.
const FACTORS_KILOBYTES: [f64; 3] = [0.5, 6.0, 12.0];

/// Points of a surface at which the balance takes fluxes, a node of it.
const FLUX_POINTS: [f64; 3] = [1.0, 4.0, 4.0];

/// Nodes with a balance: so many times those of a face, where stencils cross an interface. Fits of the estimate take so many times as long.
const BALANCED: f64 = 3.5;
const FINER_BALANCE: f64 = 1.4;

/// Memory of the program itself, in units of 1e6 bytes.
const BASE_MEMORY_MB: f64 = 10.0;

pub(super) fn predict(scene: &Scene, survey: &Survey, method: &MethodPlan) -> Result<Predicted, Error> {
    let unknowns = build::estimated_nodes(scene, method.at_corners(scene))?;
    let rates = &RATES[scene.dimension - 1];
    let steps = method.params.steps(survey);
    let varies = survey.has(|effect| matches!(effect, Effect::VariableDiffusivity));
    let stencils = |params: &MethodParams| match steps.stencils {
        true => params.stencil_microseconds(scene.dimension, varies).unwrap_or(rates.stencil),
        false => 0.0,
    };
    let solve = rates.solve * (unknowns / 1e4).max(1.0).powf(SOLVE_GROWTH);
    let balanced =
        rates.balance * balanced_share(&method.params, steps.may_need_cells, unknowns, scene.dimension);
    let made = steps.cells * rates.cell + stencils(&method.params) + balanced;
    let in_time = steps::predict(scene, unknowns)?;
    let factors = choose::solver(scene, survey, method.name, unknowns).kind == SolverKind::Direct;
    let matrix_share = if factors { FACTORS_SHARE } else { PRECONDITIONER_SHARE };
    let solves = in_time.map_or(solve, |time| {
        let once = rates.solve * (unknowns / 1e4).powf(SOLVE_GROWTH);
        once * (matrix_share * time.matrices + SOLVE_SHARE * time.solves) + time.changes * made
    });
    let own = rates.points + rates.neighbors + made + solves;
    // The method at a higher order on the same nodes, or half as many nodes in every direction.
    let finer =
        method.params.finer(scene.dimension).filter(|_| scene.time.is_none() && scene.output.estimate);
    let estimate = match &finer {
        _ if !scene.output.estimate => 0.0,
        Some(finer) => stencils(finer) + solve + FINER_BALANCE * balanced,
        None => own * 0.5_f64.powi(scene.dimension as i32),
    };
    // Fluxes by the method, and by its higher order or other fits.
    let fits = flux_fits(unknowns, scene.dimension, finer.is_some()) / unknowns;
    let balance =
        fits * (rates.stencil.max(stencils(&method.params)) + finer.as_ref().map_or(rates.stencil, stencils));
    // Fields that are kept, and factors.
    let kept = scene.time.as_ref().map_or(0, |time| time.output.len());
    let renewed = if in_time.is_some() { 2.0 } else { 1.0 };
    let factored = if factors { renewed * FACTORS_KILOBYTES[scene.dimension - 1] } else { 0.0 };
    let kilobytes = rates.kilobytes + factored + 8e-3 * kept as f64;
    Ok(Predicted {
        unknowns,
        seconds: 1e-6 * (own + balance + estimate) * unknowns,
        estimate_seconds: 1e-6 * estimate * unknowns,
        memory_mb: BASE_MEMORY_MB + kilobytes * unknowns / 1e3,
        steps: in_time,
    })
}

/// The part of the nodes that have a balance over a cell by region.
fn balanced_share(params: &MethodParams, has_cells: bool, nodes: f64, dimension: usize) -> f64 {
    let MethodParams::Sharp(params) = params else { return 0.0 };
    match params.conservation {
        _ if !has_cells => 0.0,
        Conservation::None => 0.0,
        Conservation::Crossing => (BALANCED * nodes.powf(-1.0 / dimension as f64)).min(1.0),
        Conservation::All => 1.0,
    }
}

/// Fits that fluxes take: one a point of the faces and of interfaces of about their extent, or, for a method whose fits serve many points,
/// one a node beside them.
fn flux_fits(nodes: f64, dimension: usize, shared: bool) -> f64 {
    let d = dimension as f64;
    let beside = 4.0 * d * nodes.powf(1.0 - 1.0 / d);
    if shared { beside.min(nodes) } else { beside * FLUX_POINTS[dimension - 1] }
}
