//! Suite `natural`: problems that are given by their data alone, against closed forms, closed balances and high-order finite elements.
//!
//! Errors of a row: `err_l2` and `err_linf` are those of the probes (root mean square and largest, each over the root mean square
//! of u in the probe's region), `err_grad_linf` is the largest error of a flux over the largest flux.

mod cases;
mod checks;
mod judge;
mod sections;

use super::claims::Claims;
use super::jobs::Job;
use super::options::{Effort, Options};
use super::runner::{Extra, Runner};
use super::study::{self, Key, Outcome, Study};
use super::variant::Variant;
use cases::Case;

const SUITE: &str = "natural";

pub(super) const ABOUT: &str = "Problems that are given by their data: heated parts with corners, walls, things from an engineer's desk. The references are closed \
    forms, closed balances, and finite elements of high order that are refined towards corners.";

pub(super) const CASES: [&str; cases::CASES.len()] = {
    let mut names = [""; cases::CASES.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = cases::CASES[k].case;
        k += 1;
    }
    names
};

/// What a scene gets that names no method.
const AUTO: Variant = Variant { support: None, ..Variant::plain("auto") };

/// Methods that conserve, for comparison.
const COMPARED: [Variant; 2] = [
    Variant { support: None, ..Variant::plain("gfdm-conservative") },
    Variant { support: None, ..Variant::plain("gfdm-hybrid") },
];

/// The sharp method at an order.
const fn sharp(order: usize) -> Variant {
    Variant { order: Some(order), support: None, ..Variant::plain("sharp") }
}

/// Whether claims about named orders are part of a sweep.
fn has_orders(effort: Effort) -> bool {
    effort > Effort::Quick
}

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    runner.run_all(cases::CASES.iter().flat_map(|case| jobs(case, options.effort)).collect());
    true_errors(&mut runner);
    let mut sections = Vec::new();
    let takes_part = |case: &&Case| !case.parameters(options.effort).is_empty();
    for case in cases::CASES.iter().filter(takes_part).filter(|c| options.wants(c.case, AUTO.method)) {
        checks::check(&runner, case, &mut claims);
        sections.push(sections::section(&runner, case));
    }
    runner.failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}

/// The plan's choice for all parameters, named methods for the first one.
fn jobs(case: &Case, effort: Effort) -> Vec<Job> {
    let parameters = case.parameters(effort);
    let job = |variant: Variant, parameter: f64, level: usize| {
        let text = (case.scene)(parameter, case.spacing(level), 1);
        Job {
            problem: text,
            key: Key { case: case.case, variant, jump: parameter, level, seed: 1 },
            extra: Extra { estimate: true, ..Extra::default() },
        }
    };
    let mut jobs: Vec<Job> = parameters
        .iter()
        .flat_map(|&p| case.levels(effort).map(move |level| (p, level)))
        .map(|(p, l)| job(AUTO, p, l))
        .collect();
    if has_orders(effort) {
        let compared = parameters.first().filter(|_| case.compared);
        jobs.extend(compared.iter().flat_map(|&&first| {
            COMPARED.iter().flat_map(move |&v| case.levels(effort).map(move |level| job(v, first, level)))
        }));
        for bound in case.bounds {
            if let Some(order) = bound.order {
                let about = parameters.iter().filter(|&&p| bound.parameter.is_none_or(|only| only == p));
                jobs.extend(about.map(|&p| job(sharp(order), p, bound.level)));
            }
        }
    }
    jobs
}

/// Puts the errors against the references into the rows of runs whose scene has no closed form.
fn true_errors(runner: &mut Runner<'_>) {
    let mut outcomes: Vec<Outcome> = Vec::new();
    for mut outcome in runner.outcomes.drain(..) {
        if let Some(case) =
            cases::CASES.iter().find(|c| c.case == outcome.key.case && outcome.row.err_l2.is_none())
        {
            let judged = judge::judge(case, &outcome);
            let row = &mut outcome.row;
            (row.err_l2, row.err_linf) = (judged.values.map(|v| v[0]), judged.values.map(|v| v[1]));
            row.err_grad_linf = judged.flux;
            row.params += "; errors: probes, flux as err_grad_linf";
        }
        study::push(&mut outcomes, outcome);
    }
    runner.outcomes = outcomes;
}
