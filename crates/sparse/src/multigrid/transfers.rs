//! Prolongation and restriction between two levels.

use super::aggregation::Aggregates;
use super::interpolation::Interpolation;
use super::params::{Coarsening, MultigridParams, ProlongationKind, Restriction, StrengthKind};
use super::prolongation::{self, Step};
use super::strength::{self, Graph};
use super::{aggregation, energy, evolution, kept, pairwise, ruge_stueben};
use crate::csr::Csr;
use crate::difference::DifferenceMatrix;
use crate::solver::SolveError;

/// A level that has more than this part of the unknowns of the one above is not worth having.
const LEAST_COARSENING: f64 = 0.8;

/// Weights of prolongation and restriction to the next level; `None` where there is none that is worth having. Of a level that there
/// is `kept` says which unknowns stay, before and after. Coarse unknowns of 1 are `units`, where these are not ones; rows count for
/// `weights`. Aggregates are smoothed by `step`, if there is one.
pub(super) fn transfers(
    a: &DifferenceMatrix,
    units: Option<&[f64]>,
    weights: Option<&[f64]>,
    kept: &mut Vec<bool>,
    params: &MultigridParams,
    step: Option<Step>,
) -> Result<Option<(Interpolation, Interpolation)>, SolveError> {
    let symmetric = strength::symmetric(a, units, params.threshold);
    let unit = |j: usize| units.map_or(1.0, |c| c[j]);
    let graph = match params.strength {
        StrengthKind::Symmetric => symmetric,
        StrengthKind::Evolution => evolution::evolution(&a.scaled_csr(|_| 1.0, unit), &symmetric),
    };
    let worth = |count: usize| count > 0 && count as f64 <= LEAST_COARSENING * a.n() as f64;
    let (p, left) = match params.coarsening {
        Coarsening::SmoothedAggregation => {
            let graph = kept::without(graph, kept);
            let mut aggregates = aggregation::standard(a, units, &graph);
            *kept = kept::single_out(&mut aggregates, kept);
            if !worth(aggregates.count) {
                return Ok(None);
            }
            match step {
                None => (prolongation::tentative(&aggregates), None),
                Some(step) => smoothed(a, [units, weights], (&graph, &aggregates), params, step)?,
            }
        }
        Coarsening::PairwiseAggregation => {
            let aggregates = pairwise::pairwise(a, units, &graph);
            if !worth(aggregates.count) {
                return Ok(None);
            }
            (prolongation::tentative(&aggregates), None)
        }
        Coarsening::RugeStuebenDirect | Coarsening::RugeStuebenExtended => {
            let a = a.scaled_csr(|_| 1.0, unit);
            let dependence = ruge_stueben::dependence(&a, params.threshold, &graph);
            let (number, count) = ruge_stueben::splitting(&dependence);
            if !worth(count) {
                return Ok(None);
            }
            let extended = params.coarsening == Coarsening::RugeStuebenExtended;
            (ruge_stueben::interpolation(&a, &dependence, &number, count, extended), None)
        }
    };
    let p = Interpolation::new(p);
    let r = left.map_or_else(|| p.transposed(), |left| Interpolation::new(left).transposed());
    Ok(Some((p, r)))
}

/// The smoothed prolongation, and the one of the transpose where the restriction is its own.
fn smoothed(
    a: &DifferenceMatrix,
    [units, weights]: [Option<&[f64]>; 2],
    (graph, aggregates): (&Graph, &Aggregates),
    params: &MultigridParams,
    step: Step,
) -> Result<(Csr, Option<Csr>), SolveError> {
    let own = params.restriction == Restriction::Own;
    let minimizing = params.prolongation == ProlongationKind::EnergyMinimizing;
    if !own && !minimizing {
        return Ok((prolongation::smoothed(a, units, graph, aggregates, step), None));
    }
    let weight = |i: usize| weights.map_or(1.0, |w| w[i]);
    let balances = a.scaled_csr(weight, |j| units.map_or(1.0, |c| c[j]));
    let of = |balances: &Csr| match minimizing {
        true => energy::minimized(balances, graph, aggregates),
        false => {
            let rows = DifferenceMatrix::from_csr(balances)?;
            Ok(prolongation::smoothed(&rows, None, graph, aggregates, step))
        }
    };
    let left = if own { Some(of(&balances.transpose())?) } else { None };
    Ok((of(&balances)?, left))
}
