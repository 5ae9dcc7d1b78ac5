//! Suite `sharp`: orders, errors at given numbers of nodes, contrasts, and what accuracy costs with every method.

mod cases;
mod checks;
mod estimates;
mod gaps;
mod iterations;
mod sections;
mod singles;

use super::claims::Claims;
use super::jobs::Job;
use super::options::{Effort, Options};
use super::runner::{Extra, Runner};
use super::study::{Key, Study};
use super::variant::Variant;
use cases::{Ladder, ladders};

const SUITE: &str = "sharp";

pub(super) const ABOUT: &str = "The sharp method: orders of u and of its gradient on irregular clouds that know nothing of the interface, errors at \
    given numbers of nodes, the spread over contrasts, and the error against seconds of all methods on the same clouds.";

pub(super) const CASES: [&str; 19] = [
    "interior",
    "mode-3",
    "disc",
    "graded",
    "rings",
    "ellipse",
    "star",
    "pair",
    "quadrants",
    "curved",
    "cylinder",
    "flat",
    "corner-90",
    "corner-45",
    "three-strip",
    "ball",
    "torus",
    "shells",
    "inclusions",
];

/// The method at an order, solved directly.
const fn sharp(order: usize) -> Variant {
    Variant { order: Some(order), support: None, ..Variant::plain("sharp").directly() }
}

/// The same by GMRES, which is faster in three dimensions.
const fn sharp_in_space(order: usize) -> Variant {
    Variant { solver: Some("gmres"), ..sharp(order) }
}

/// What it is compared with: all methods of the workspace, as they choose their parameters themselves, and a higher order
/// of its own.
const OTHERS: [Variant; 9] = [
    sharp(8),
    Variant::plain("gfdm-classical").directly(),
    Variant::plain("gfdm-positive").directly(),
    Variant::plain("gfdm-hybrid").directly(),
    Variant::plain("gfdm-conservative").directly(),
    Variant { support: None, ..Variant::plain("particle-difference").directly() },
    Variant { support: None, ..Variant::plain("particle-difference-extended").directly() },
    Variant { support: None, ..Variant::plain("immersed-interface").directly() },
    Variant { support: None, ..Variant::plain("surface-reaction").directly() },
];

/// The problems of which finer clouds are compared, too, and which the quick sweep compares.
const COMPARED: [&str; 4] = ["interior", "disc", "mode-3", "curved"];

/// The finest rung of the others, of about 1500 nodes in the plane, and of those of about 6000.
const FINEST_COMPARED: [usize; 2] = [2, 3];

/// What a problem is solved by for comparison, in space by the solver that the plan chooses.
fn others(ladder: &Ladder) -> impl Iterator<Item = Variant> {
    let (beyond, space) = (ladder.beyond, ladder.space);
    let others = OTHERS.into_iter().filter(move |v| !(space && v.order == Some(8)));
    let others = others.filter(move |v| beyond.iter().all(|(method, _)| *method != v.method));
    others.map(move |v| if space { Variant { solver: None, ..v } } else { v })
}

/// Node spacing of a rung.
fn spacing(level: usize) -> f64 {
    0.2 * 0.5_f64.powi(level as i32)
}

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let effort = options.effort;
    let ladders = ladders(effort);
    let mut jobs: Vec<Job> = ladders.iter().flat_map(|ladder| ladder_jobs(ladder, effort)).collect();
    jobs.extend(singles::single_runs(effort));
    jobs.extend(iterations::jobs(effort));
    jobs.extend(gaps::jobs(effort));
    jobs.extend(estimates::jobs(&ladders, effort));
    runner.run_all(jobs);
    for ladder in &ladders {
        if options.wants(ladder.case, "sharp") {
            checks::ladder(&runner, ladder, &mut claims);
        }
    }
    at_probes(&mut runner);
    checks::single(&runner, effort, &mut claims);
    iterations::check(&runner, effort, &mut claims);
    gaps::check(&runner, effort, &mut claims);
    estimates::check(&runner, &ladders, effort, &mut claims);
    runner.failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
    let sections = sections::sections(&runner, &ladders);
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}

/// The error of a case whose solution is known at some points.
fn at_probes(runner: &mut Runner<'_>) {
    for outcome in runner.outcomes.iter_mut().filter(|o| o.key.case == "inclusions") {
        outcome.row.err_l2 = super::dcpse::at_reference(outcome);
    }
}

fn ladder_jobs(ladder: &Ladder, effort: Effort) -> Vec<Job> {
    let mut jobs = Vec::new();
    for &variant in &ladder.variants {
        for &jump in &ladder.contrasts {
            for &seed in &ladder.seeds {
                let key = |level| Key { case: ladder.case, variant, jump, level, seed };
                jobs.extend(ladder.levels.clone().map(|level| Job {
                    problem: (ladder.scene)(jump, spacing(level), seed),
                    key: key(level),
                    extra: Extra::default(),
                }));
            }
        }
    }
    // The others on the first contrast and cloud only: for the diagram of costs.
    let compared = COMPARED.contains(&ladder.case);
    if compared || effort > Effort::Quick {
        let finest = FINEST_COMPARED[usize::from(compared)];
        for variant in others(ladder) {
            let (jump, seed) = (ladder.contrasts[0], ladder.seeds[0]);
            jobs.extend(ladder.levels.clone().filter(|&level| level <= finest).map(|level| Job {
                problem: (ladder.scene)(jump, spacing(level), seed),
                key: Key { case: ladder.case, variant, jump, level, seed },
                extra: Extra::default(),
            }));
        }
    }
    jobs
}

/// Effort from which a run is worth its time.
fn at_least(effort: Effort, least: Effort) -> bool {
    effort >= least
}
