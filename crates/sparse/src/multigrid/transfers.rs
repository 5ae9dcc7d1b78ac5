//! Prolongation and restriction between two levels.

use super::aggregation::Aggregates;
use super::interpolation::Interpolation;
use super::params::{Coarsening, MultigridParams, ProlongationKind, Restriction, StrengthKind};
use super::prolongation::{self, Step};
use super::strength::Bonds;
use super::{aggregation, energy, evolution, kept, marks, pairwise, ruge_stueben};
use crate::csr::Csr;
use crate::difference::DifferenceMatrix;
use crate::solver::SolveError;

/// A level that has more than this part of the unknowns of the one above is not worth having.
const LEAST_COARSENING: f64 = 0.8;

/// Weights of prolongation and restriction to the next level; `None` where there is none that is worth having. Of a level that there
/// is `kept` says which unknowns stay, before and after. `inverse` has the reciprocals of the diagonal. Coarse unknowns of 1 are `units`, where these are not ones; rows count for
/// `weights`. Aggregates are smoothed by `step`, if there is one.
pub(super) fn transfers(
    a: &DifferenceMatrix,
    inverse: &[f64],
    [units, weights]: [Option<&[f64]>; 2],
    kept: &mut Vec<bool>,
    params: &MultigridParams,
    step: Option<Step>,
) -> Result<Option<(Interpolation, Interpolation)>, SolveError> {
    let symmetric = marks::symmetric(a, inverse, units, params.threshold);
    let unit = |j: usize| units.map_or(1.0, |c| c[j]);
    let in_units = [units, weights];
    let made = match (params.coarsening, params.strength) {
        (Coarsening::SmoothedAggregation, StrengthKind::Symmetric) => {
            aggregated(a, in_units, symmetric, kept, params, step)?
        }
        (Coarsening::SmoothedAggregation, StrengthKind::Evolution) => {
            let graph = evolution::evolution(&a.scaled_csr(|_| 1.0, unit), &symmetric);
            aggregated(a, in_units, graph, kept, params, step)?
        }
        (Coarsening::PairwiseAggregation, strength) => {
            let aggregates = match strength {
                StrengthKind::Symmetric => pairwise::pairwise(a, units, &symmetric.listed()),
                StrengthKind::Evolution => pairwise::pairwise(
                    a,
                    units,
                    &evolution::evolution(&a.scaled_csr(|_| 1.0, unit), &symmetric),
                ),
            };
            is_worth(aggregates.count, a.n()).then(|| (prolongation::tentative(&aggregates), None))
        }
        (Coarsening::RugeStuebenDirect | Coarsening::RugeStuebenExtended, _) => {
            let a = a.scaled_csr(|_| 1.0, unit);
            let dependence = ruge_stueben::dependence(&a, params.threshold, &symmetric);
            let (number, count) = ruge_stueben::splitting(&dependence);
            let extended = params.coarsening == Coarsening::RugeStuebenExtended;
            let interpolation = || ruge_stueben::interpolation(&a, &dependence, &number, count, extended);
            is_worth(count, a.nrows()).then(|| (interpolation(), None))
        }
    };
    let Some((p, left)) = made else { return Ok(None) };
    let p = Interpolation::new(p);
    let r = left.map_or_else(|| p.transposed(), |left| Interpolation::new(left).transposed());
    Ok(Some((p, r)))
}

fn is_worth(count: usize, n: usize) -> bool {
    count > 0 && count as f64 <= LEAST_COARSENING * n as f64
}

/// A prolongation, and the one of the transpose where the restriction is its own.
type Pair = (Csr, Option<Csr>);

fn aggregated(
    a: &DifferenceMatrix,
    in_units: [Option<&[f64]>; 2],
    graph: impl Bonds,
    kept: &mut Vec<bool>,
    params: &MultigridParams,
    step: Option<Step>,
) -> Result<Option<Pair>, SolveError> {
    let graph = if kept.contains(&true) { graph.without(kept) } else { graph };
    let mut aggregates = aggregation::standard(a, in_units[0], &graph);
    *kept = kept::single_out(&mut aggregates, kept);
    if !is_worth(aggregates.count, a.n()) {
        return Ok(None);
    }
    match step {
        None => Ok(Some((prolongation::tentative(&aggregates), None))),
        Some(step) => smoothed(a, in_units, (&graph, &aggregates), params, step).map(Some),
    }
}

/// The smoothed prolongation.
fn smoothed(
    a: &DifferenceMatrix,
    [units, weights]: [Option<&[f64]>; 2],
    (graph, aggregates): (&impl Bonds, &Aggregates),
    params: &MultigridParams,
    step: Step,
) -> Result<Pair, SolveError> {
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
