//! A run against the references.

use meshless::report::{BoundaryFlux, Report};
use meshless_tests::natural::references::{self, Figure, Quantity};

use super::cases::Case;
use crate::verify::study::Outcome;

/// True errors of a run; `None` where it has no such figure, or the references have none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Judged {
    /// Root mean square and largest error of the probes, each over the root mean square of u in its region.
    pub(super) values: Option<[f64; 2]>,
    /// Largest error of a flux over the largest flux.
    pub(super) flux: Option<f64>,
    /// Largest error, over what the report gives for it: of a probe, its own estimate; of a flux, its own or what is left over of the
    /// balance.
    pub(super) over_estimate: Option<f64>,
}

/// An error by itself and over the estimate that it is to be judged by, `None` where none is given.
type Error = (f64, Option<f64>);

pub(super) fn judge(case: &Case, outcome: &Outcome) -> Judged {
    let (report, parameter) = (&outcome.report, outcome.key.jump);
    if let Some(errors) = &report.errors {
        // In closed form: norms over all nodes.
        let over_estimate = report.estimate.l2.map(|estimate| errors.l2 / estimate);
        return Judged { values: Some([errors.l2, errors.linf]), flux: None, over_estimate };
    }
    let (values, fluxes) = (values(case, parameter, report), fluxes(case, parameter, report));
    let worst = |errors: &[Error]| errors.iter().map(|e| e.0).reduce(f64::max);
    let mean =
        |errors: &[Error]| (errors.iter().map(|e| e.0 * e.0).sum::<f64>() / errors.len() as f64).sqrt();
    let over = values.iter().chain(&fluxes).filter_map(|(error, estimate)| Some(error / estimate.as_ref()?));
    Judged {
        values: worst(&values).map(|largest| [mean(&values), largest]),
        flux: worst(&fluxes),
        over_estimate: over.reduce(f64::max),
    }
}

/// What of a difference the reference is not sure of does not count.
fn beyond(difference: f64, figure: &Figure) -> f64 {
    (difference.abs() - figure.uncertainty).max(0.0)
}

fn values(case: &Case, parameter: f64, report: &Report) -> Vec<Error> {
    let figures = || references::of(case.case, parameter);
    let error = |figure: &Figure| {
        let probe = report.probes.iter().find(|p| p.at == figure.at)?;
        let value = probe.value?;
        let in_region = |f: &&Figure| f.quantity == Quantity::Rms && f.name == figure.name;
        let scale = figures().find(in_region).map_or(figure.value.abs(), |rms| rms.value);
        let estimate = probe.estimate.map(|estimate| estimate / scale);
        Some((beyond(value - figure.value, figure) / scale, estimate))
    };
    figures().filter(|f| f.quantity == Quantity::Value).filter_map(error).collect()
}

fn fluxes(case: &Case, parameter: f64, report: &Report) -> Vec<Error> {
    let known: Vec<&Figure> =
        references::of(case.case, parameter).filter(|f| f.quantity == Quantity::Flux).collect();
    let scale = known.iter().map(|f| f.value.abs()).fold(0.0, f64::max);
    let error = |figure: &&Figure| {
        let entry = case.conditions.iter().position(|name| *name == figure.name)?;
        let balance = report.balance.as_ref()?;
        let BoundaryFlux { flux, estimate, .. } = *balance.into.iter().find(|b| b.entry == entry)?;
        let told = estimate.or(report.estimate.l2.map(|l2| l2 * scale));
        let told = told.map(|estimate| estimate.max(balance.left_over.abs()) / scale);
        Some((beyond(flux - figure.value, figure) / scale, told))
    };
    known.iter().filter_map(error).collect()
}

#[cfg(test)]
mod tests {
    use meshless::report::{BalanceReport, BoundaryFlux, Estimate, Probe, Report};
    use meshless_tests::natural::references::{self, Quantity};

    use super::super::cases::CASES;
    use super::judge;
    use crate::verify::row::Row;
    use crate::verify::study::{Key, Outcome};
    use crate::verify::variant::Variant;

    #[test]
    fn errors_are_those_that_were_put_in() {
        let case = &CASES[0];
        let find = |quantity| {
            references::of(case.case, 10.0)
                .find(|f| f.quantity == quantity && (f.name, quantity) != ("plate", Quantity::Rms))
        };
        let (value, rms, flux) = (
            find(Quantity::Value).expect("a probe"),
            find(Quantity::Rms).expect("a mean"),
            find(Quantity::Flux).expect("a flux"),
        );
        let report = Report {
            probes: vec![Probe {
                at: value.at.clone(),
                value: Some(value.value + 0.02 * rms.value),
                estimate: Some(0.01 * rms.value),
                velocity: None,
            }],
            balance: Some(BalanceReport {
                into: vec![BoundaryFlux { flux: 0.5 * flux.value, ..BoundaryFlux::default() }],
                ..BalanceReport::default()
            }),
            estimate: Estimate { l2: Some(0.1), ..Estimate::default() },
            ..Report::default()
        };
        let key = Key { case: case.case, variant: Variant::plain("auto"), jump: 10.0, level: 1, seed: 1 };
        let judged = judge(case, &Outcome { key, row: Row::default(), report });
        let near = |found: Option<f64>, expected: f64| found.is_some_and(|f| (f - expected).abs() < 1e-6);
        assert!(near(judged.values.map(|v| v[1]), 0.02) && near(judged.flux, 0.5), "{judged:?}");
        assert!(near(judged.over_estimate, 5.0), "{judged:?}");
    }
}
