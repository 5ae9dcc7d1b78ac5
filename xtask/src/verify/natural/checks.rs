//! The claims: true errors, and estimates that are not far too small.

use super::cases::{Bound, Case};
use super::judge::judge;
use super::{AUTO, COMPARED, sharp};
use crate::verify::claims::Claims;
use crate::verify::runner::Runner;
use crate::verify::study::{Key, find};

/// How many times smaller than the true error an estimate may be.
const HONEST: f64 = 10.0;

/// Errors below this are round-off, which no estimate knows.
const ROUND_OFF: f64 = 1e-10;

pub(super) fn check(runner: &Runner<'_>, case: &Case, claims: &mut Claims) {
    let effort = runner.options.effort;
    for &parameter in case.parameters(effort) {
        let about = |bound: &&Bound| {
            let here = bound.parameter.is_none_or(|p| p == parameter);
            here && (case.levels(effort).contains(&bound.level)
                && (bound.order.is_none() || super::has_orders(effort)))
        };
        for bound in case.bounds.iter().filter(about) {
            accuracy(runner, case, parameter, bound, claims);
        }
        let variants = std::iter::once(AUTO).chain(COMPARED);
        let runs = variants.flat_map(|variant| {
            let key = move |level| Key { case: case.case, variant, jump: parameter, level, seed: 1 };
            case.levels(effort).filter_map(move |level| find(&runner.outcomes, &key(level)))
        });
        let worst = runs.filter_map(|run| {
            let judged = judge(case, run);
            let large = judged.values.map_or(0.0, |v| v[1]).max(judged.flux.unwrap_or(0.0)) > ROUND_OFF;
            if large { judged.over_estimate } else { None }
        });
        // An answer without an estimate is honest, one without a known error proves nothing.
        let worst = worst.fold(0.0, f64::max);
        let key = Key { case: case.case, variant: AUTO, jump: parameter, level: 1, seed: 1 };
        let known = find(&runner.outcomes, &key)
            .map(|run| judge(case, run))
            .filter(|j| j.values.is_some() || j.flux.is_some());
        claims.at_most(
            case.case,
            format!("{parameter:e}: true error over the estimate, largest of all probes, fluxes, methods and clouds"),
            known.map(|_| worst),
            HONEST,
        );
    }
}

fn accuracy(runner: &Runner<'_>, case: &Case, parameter: f64, bound: &Bound, claims: &mut Claims) {
    let variant = bound.order.map_or(AUTO, sharp);
    let key = Key { case: case.case, variant, jump: parameter, level: bound.level, seed: 1 };
    let run = find(&runner.outcomes, &key);
    let judged = run.map(|run| judge(case, run));
    let method = bound.order.map_or_else(|| "the plan's choice".to_owned(), |order| format!("order {order}"));
    let what = format!("{parameter:e}, {method}, spacing {}", case.spacing(bound.level));
    let closed = run.is_some_and(|run| run.report.errors.is_some());
    let over =
        if closed { "relative maximum error" } else { "largest error of a probe, over u in its region" };
    let why = bound.missed.as_ref().map(|m| m.why);
    let mut at_most =
        |claim: String, measured: Option<f64>, bound: f64, missed: Option<f64>| match missed.zip(why) {
            Some((missed, why)) => {
                claims.explained(case.case, claim, measured, [0.0, bound], [bound, missed], why);
            }
            None => claims.at_most(case.case, claim, measured, bound),
        };
    if case.probes {
        let values = judged.and_then(|j| j.values).map(|v| v[1]);
        at_most(format!("{what}: {over}"), values, bound.values, bound.missed.as_ref().map(|m| m.values));
    }
    if !case.conditions.is_empty() {
        let flux = judged.and_then(|j| j.flux);
        at_most(
            format!("{what}: largest error of a flux"),
            flux,
            bound.flux,
            bound.missed.as_ref().map(|m| m.flux),
        );
    }
}
