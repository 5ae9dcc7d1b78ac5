//! Two discs at a fifth of a spacing in a field that is as large between them as the gap is thin, with the gap refined and without.

use meshless_tests::sharp::two_discs;

use super::sharp;
use crate::verify::claims::Claims;
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::{Key, Outcome, find};

const CASE: &str = "pair";

const SPACING: f64 = 0.05;

const CONTRASTS: [f64; 2] = [10.0, 1e4];

/// Levels of these runs, which belong to no ladder: as it is, refined, and with a gap that needs no refinement.
const LEVELS: [usize; 3] = [2000, 2001, 2002];

/// The gap in spacings, and one that fits have room in.
const GAP: f64 = 0.2;
const WIDE: f64 = 2.0;

/// Largest error of u at order 4, refined, over what the same spacing leaves where the gap has room: what is left is that of the
/// coarse nodes about the discs. Largest error of the gradient, and the least factor that refinement brings.
const OVER_WIDE: f64 = 2.0;
const GRADIENT: f64 = 1e-2;
const GAIN: f64 = 10.0;

fn key(jump: f64, level: usize) -> Key {
    Key { case: CASE, variant: sharp(4), jump, level, seed: 1 }
}

pub(super) fn jobs(effort: Effort) -> Vec<Job> {
    if effort == Effort::Quick {
        return Vec::new();
    }
    let job = |jump: f64, level: usize| {
        let gap = if level == LEVELS[2] { WIDE } else { GAP };
        let text = two_discs(jump, gap * SPACING, SPACING, 1);
        let problem = match level == LEVELS[1] {
            true => text.replace("[points]\n", "[points]\nrefine_gaps_to = 1e-4\n"),
            false => text,
        };
        Job { problem, key: key(jump, level), extra: Extra::default() }
    };
    CONTRASTS.iter().flat_map(|&jump| LEVELS.map(|level| job(jump, level))).collect()
}

pub(super) fn check(runner: &Runner<'_>, effort: Effort, claims: &mut Claims) {
    if effort == Effort::Quick || !runner.options.wants(CASE, "sharp") {
        return;
    }
    for jump in CONTRASTS {
        let [plain, refined, wide] = LEVELS.map(|level| find(&runner.outcomes, &key(jump, level)));
        let l2 = |outcome: Option<&Outcome>| outcome?.row.err_l2;
        let what = format!("contrast {jump:e}, p = 4: gap of a fifth of a spacing");
        let over = l2(refined).zip(l2(wide)).map(|(refined, wide)| refined / wide);
        claims.at_most(
            CASE,
            format!("{what}, refined: error over that of a gap of two spacings"),
            over,
            OVER_WIDE,
        );
        let gradient = refined.and_then(|o| o.row.err_grad_linf);
        claims.at_most(
            CASE,
            format!("{what}, refined: relative maximum error of the gradient"),
            gradient,
            GRADIENT,
        );
        let gain = l2(plain).zip(l2(refined)).map(|(plain, refined)| plain / refined);
        claims.at_least(CASE, format!("{what}: error without over error with refinement"), gain, GAIN);
    }
}
