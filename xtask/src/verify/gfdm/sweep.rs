//! Which methods are run at which jumps on which clouds.

use super::cases::{CASES, Case};
use super::{BY_REGION, CONSERVATIVE, HYBRID, POSITIVE, Variant, radius};
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::Key;

/// Seed of all clouds of the sweep.
pub(super) const SEED: u64 = 1;

/// A jump beyond those of the paper, for the methods that claim not to care.
pub(super) const BEYOND: f64 = 1e12;

/// The finest rung, h = 0.025, at which the claims about figures are checked.
pub(super) const CLAIMED: usize = 3;

/// Seeds over which the interior case is repeated: how far its error depends on the cloud.
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];

/// From this rung on the direct solver needs too much memory.
const ITERATIVE: usize = 5;

/// Residual at which the iterative solver stops there.
const TOLERANCE: f64 = 1e-11;

/// The seeds that an effort affords.
pub(super) fn seeds(effort: Effort) -> &'static [u64] {
    if effort == Effort::Quick { &SEEDS[..3] } else { &SEEDS }
}

/// Whether the conservative hybrid climbs to [`CLAIMED`] at a jump. A quick sweep does where the coefficient jumps up
/// strongly, and on the interior case, whose errors are compared from jump to jump.
pub(super) fn climbs(effort: Effort, case: &str, jump: f64) -> bool {
    effort > Effort::Quick || jump >= 1e4 || case == "interior" && jump >= 1e2
}

pub(super) fn sweep(runner: &mut Runner<'_>) {
    let effort = runner.options.effort;
    let mut jobs = Vec::new();
    for case in &CASES {
        for variant in case.variants() {
            for jump in case.jumps(effort) {
                jobs.extend(ladder(case, variant, jump, rungs(effort, case, &variant, jump)));
            }
        }
        if case.name == "interior" {
            for variant in [HYBRID, CONSERVATIVE] {
                jobs.extend(ladder(case, variant, BEYOND, CLAIMED + 1));
            }
            // Whether the fully conservative method loses digits from 1e8 to 1e10.
            jobs.extend([1e8, 1e10].map(|jump| single(case, CONSERVATIVE, jump, CLAIMED, SEED)));
            jobs.extend(seeds(effort).iter().map(|&seed| single(case, HYBRID, 1e10, CLAIMED, seed)));
        }
    }
    runner.run_all(jobs);
}

/// How many rungs of the ladder are climbed. What no claim and no diagram rests on is left out where time is short.
fn rungs(effort: Effort, case: &Case, variant: &Variant, jump: f64) -> usize {
    let power = jump.log10().round() as i32;
    let shown = jump == case.shown;
    let quick = effort == Effort::Quick;
    let strong = variant.method == "gfdm-classical";
    // A jump of 10 is where the criterion for the selection fails: what is compared there climbs as far.
    let compared =
        case.compared.contains(&power) || shown || power == 1 && *variant == Variant::strong(0, true);
    let to_claims = CLAIMED + 1;
    let rungs = match *variant {
        HYBRID if climbs(effort, case.name, jump) => to_claims,
        HYBRID => CLAIMED,
        BY_REGION if power == 1 && quick => CLAIMED,
        BY_REGION if power == 1 => to_claims,
        BY_REGION => 0,
        v if v == HYBRID.with_strong_neumann() && shown => to_claims,
        v if v == HYBRID.with_strong_neumann() && quick => 0,
        CONSERVATIVE if quick && power.abs() < 4 => 0,
        POSITIVE if quick && !matches!(power, 1 | 4 | 10) && !shown => 0,
        POSITIVE if !quick && matches!(power, 1 | 4 | 10) => to_claims,
        _ if strong && quick && !compared => 0,
        _ if strong && !quick && compared => to_claims,
        _ => CLAIMED,
    };
    let finer = match effort {
        Effort::Full if *variant == HYBRID && case.name == "interior" && shown => 3,
        Effort::Full if *variant == HYBRID && shown => 2,
        Effort::Full if shown && rungs > 0 => 1,
        _ => 0,
    };
    rungs + finer
}

fn ladder(case: &Case, variant: Variant, jump: f64, rungs: usize) -> impl Iterator<Item = Job> {
    (0..rungs).map(move |level| single(case, variant, jump, level, SEED))
}

fn single(case: &Case, variant: Variant, jump: f64, level: usize, seed: u64) -> Job {
    let key = Key { case: case.name, variant, jump, level, seed };
    let extra = Extra { krylov: (level >= ITERATIVE).then_some(TOLERANCE), ..Extra::default() };
    Job { problem: (case.scene)(jump, radius(level), seed), key, extra }
}
