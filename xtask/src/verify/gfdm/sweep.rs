//! Which methods are run at which jumps on which clouds.

use super::cases::{CASES, Case};
use super::{CONSERVATIVE, HYBRID, Variant, radius};
use crate::verify::options::Effort;
use crate::verify::runner::Runner;
use crate::verify::study::Key;

/// Seed of all clouds of the sweep.
pub(super) const SEED: u64 = 1;

/// A jump beyond those of the paper, for the methods that claim not to care.
pub(super) const BEYOND: f64 = 1e12;

/// The finest rung, h = 0.025, at which the claims about figures are checked.
pub(super) const CLAIMED: usize = 3;

pub(super) fn sweep(runner: &mut Runner<'_>) {
    let effort = runner.options.effort;
    for case in &CASES {
        for variant in case.variants() {
            for jump in case.jumps(effort) {
                ladder(runner, case, variant, jump, rungs(effort, case, &variant, jump));
            }
        }
        if case.name == "interior" {
            for variant in [HYBRID, CONSERVATIVE] {
                ladder(runner, case, variant, BEYOND, CLAIMED + 1);
            }
            // Whether the fully conservative method loses digits from 1e8 to 1e10.
            single(runner, case, CONSERVATIVE, 1e8, CLAIMED);
            single(runner, case, CONSERVATIVE, 1e10, CLAIMED);
        }
    }
}

/// How many rungs of the ladder are climbed.
fn rungs(effort: Effort, case: &Case, variant: &Variant, jump: f64) -> usize {
    let hybrid = *variant == HYBRID;
    match effort {
        Effort::Quick if hybrid || *variant == HYBRID.with_strong_neumann() && jump == case.shown => {
            CLAIMED + 1
        }
        Effort::Quick => CLAIMED,
        Effort::Default => CLAIMED + 1,
        Effort::Full if hybrid && case.name == "interior" && jump == case.shown => CLAIMED + 4,
        Effort::Full if hybrid && jump == case.shown => CLAIMED + 3,
        Effort::Full => CLAIMED + 2,
    }
}

fn ladder(runner: &mut Runner<'_>, case: &Case, variant: Variant, jump: f64, rungs: usize) {
    for level in 0..rungs {
        single(runner, case, variant, jump, level);
    }
}

fn single(runner: &mut Runner<'_>, case: &Case, variant: Variant, jump: f64, level: usize) {
    let key = Key { case: case.name, variant, jump, level, seed: SEED };
    runner.run(&(case.scene)(jump, radius(level), SEED), key);
}
