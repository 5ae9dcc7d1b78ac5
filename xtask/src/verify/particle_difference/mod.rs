//! Suite `particle-difference`: the problems of Yoon and Song (2021), section 3, a ball, and contrasts.

mod cases;
mod checks;
mod points;
mod prescribed;
mod reproduce;
mod sections;
mod slit;

use super::claims::Claims;
use super::jobs::Job;
use super::options::{Effort, Options};
use super::runner::{Extra, Runner};
use super::study::{Key, Study};
use super::variant::Variant;
use cases::{CONTRASTS, LADDERS, Ladder};

const SUITE: &str = "particle-difference";

pub(super) const ABOUT: &str = "Interface-immersed particle differences: as Yoon and Song (2021) have them, and as they are here, with a slope that \
    varies along the interface, the second derivative that the equation gives, and weights in units of the flux; against \
    the conservative hybrid on the same clouds. Seed 0 is the regular cloud of the paper.";

pub(super) const CASES: [&str; 8] =
    ["circle", "corner-90", "corner-45", "cylinder", prescribed::CASE, "slit", "ball", "contrast"];

/// As the plan chooses it.
const OURS: Variant = Variant { support: None, ..Variant::plain("particle-difference").directly() };
/// As in the paper.
const PAPER: Variant = Variant { wedge: Some("plane"), flux_weights: Some(false), ..OURS };
/// Parts of what is ours: what each of them brings.
const EQUAL_WEIGHTS: Variant = Variant { flux_weights: Some(false), ..OURS };
const VARYING: Variant = Variant { wedge: Some("varying"), ..OURS };
/// What it is compared with.
const HYBRID: Variant = Variant::plain("gfdm-hybrid").directly();
const CONSERVATIVE: Variant = Variant::plain("gfdm-conservative").directly();
/// The former method: the jump of the slope as an unknown, one for each point of the interface.
const FORMER: Variant = Variant { wedge: Some("plane"), ..FORMER_VARYING };
/// The same with the distance from the interface itself, and the jump where a neighbour's foot is.
const FORMER_VARYING: Variant = Variant {
    support: None,
    wedge: Some("varying"),
    ..Variant::plain("particle-difference-extended").directly()
};
const VARIANTS: [Variant; 8] =
    [OURS, PAPER, EQUAL_WEIGHTS, VARYING, FORMER, FORMER_VARYING, HYBRID, CONSERVATIVE];

/// The regular cloud.
const GRID: u64 = 0;
/// Regular, and scattered.
const SEEDS: [u64; 2] = [GRID, 1];

/// Rungs of the ladders: 400, 1600 and 6400 nodes in the paper.
fn rungs(effort: Effort) -> usize {
    match effort {
        Effort::Quick => 3,
        Effort::Default => 4,
        Effort::Full => 5,
    }
}

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let rungs = rungs(options.effort);
    let quick = options.effort == Effort::Quick;
    let mut jobs: Vec<Job> = LADDERS.iter().flat_map(|ladder| jobs(ladder, rungs, quick)).collect();
    let contrasts = if quick { &cases::FEW_CONTRASTS[..] } else { &CONTRASTS };
    for variant in [OURS, PAPER].into_iter().filter(|v| *v == OURS || !quick) {
        for &contrast in contrasts {
            jobs.extend((0..3).map(|level| cases::contrast(variant, contrast, level)));
        }
    }
    jobs.extend(slit::jobs(rungs.min(4)));
    jobs.extend(points::jobs());
    jobs.extend(prescribed::jobs(rungs.max(4)));
    runner.run_all(jobs);
    for ladder in LADDERS.iter().filter(|l| options.wants(l.case, OURS.method)) {
        checks::ladder(&runner, ladder, &mut claims);
    }
    checks::contrast(&runner, contrasts, &mut claims);
    slit::claims(&runner, &mut claims);
    points::claims(&runner, &mut claims);
    checks::former(&runner, &mut claims);
    prescribed::claims(&runner, &mut claims);
    let reproduced = reproduce::run(options, 3);
    reproduce::claims(&reproduced, &mut claims);
    runner.failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
    let mut sections = sections::sections(&runner);
    if options.wants("reproduction", OURS.method) {
        sections.push(reproduce::section(&reproduced));
    }
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}

/// Residual at which the iterative solver stops, which is used in three dimensions.
const TOLERANCE: f64 = 1e-11;

fn jobs(ladder: &Ladder, rungs: usize, quick: bool) -> impl Iterator<Item = Job> {
    let rungs = rungs.min(ladder.most_rungs);
    let krylov = (ladder.case == "ball").then_some(TOLERANCE);
    VARIANTS.into_iter().flat_map(move |variant| {
        // Where time is short: what claims and the diagram of costs rest on.
        let wanted = move |seed: &u64| match variant {
            OURS | PAPER => true,
            FORMER | FORMER_VARYING => ladder.case != "ball" && (*seed == GRID || !quick),
            HYBRID => *seed != GRID || !quick,
            _ => !quick,
        };
        SEEDS.into_iter().filter(wanted).flat_map(move |seed| {
            (0..rungs).map(move |level| Job {
                problem: (ladder.scene)(level, cases::regularity(seed)),
                key: Key { case: ladder.case, variant, jump: ladder.contrast, level, seed },
                extra: Extra { krylov, ..Extra::default() },
            })
        })
    })
}
