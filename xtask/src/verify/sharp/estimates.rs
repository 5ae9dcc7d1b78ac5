//! The estimate of the error against the error itself.

use super::cases::Ladder;
use super::{sharp, spacing};
use crate::verify::claims::Claims;
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::{Key, find};
use crate::verify::variant::Variant;

/// By what factor the estimate may differ from the error, either way.
const FACTOR: f64 = 5.0;

/// Errors that only round-off is left of have no estimate to speak of.
const ROUND_OFF: f64 = 1e-12;

/// Orders whose estimates are compared with their errors, on the second cloud of each problem in the plane and the first one in
/// space.
const ORDERS: [usize; 2] = [4, 6];

/// Of another solver than the ladders, so that it is no rung of theirs: up to this size the plan's own is the same one.
fn key(ladder: &Ladder, order: usize, jump: f64) -> Key {
    let variant = Variant { solver: None, ..sharp(order) };
    let level = if ladder.space { 0 } else { ladder.levels.start.max(1) };
    Key { case: ladder.case, variant, jump, level, seed: ladder.seeds[0] }
}

fn keys(ladders: &[Ladder], effort: Effort) -> Vec<(&Ladder, Key)> {
    let mut keys = Vec::new();
    for ladder in ladders.iter().filter(|_| effort > Effort::Quick) {
        for order in ORDERS {
            keys.extend(ladder.contrasts.iter().map(|&jump| (ladder, key(ladder, order, jump))));
        }
    }
    keys
}

pub(super) fn jobs(ladders: &[Ladder], effort: Effort) -> Vec<Job> {
    let job = |(ladder, key): (&Ladder, Key)| Job {
        problem: (ladder.scene)(key.jump, spacing(key.level), key.seed),
        key,
        extra: Extra { estimate: true, ..Extra::default() },
    };
    keys(ladders, effort).into_iter().map(job).collect()
}

pub(super) fn check(runner: &Runner<'_>, ladders: &[Ladder], effort: Effort, claims: &mut Claims) {
    for (ladder, key) in keys(ladders, effort) {
        if !runner.options.wants(ladder.case, "sharp") {
            continue;
        }
        let ratio = find(&runner.outcomes, &key).and_then(|outcome| {
            let (error, estimate) = (outcome.row.err_l2?, outcome.report.estimate.l2?);
            if error.max(estimate) < ROUND_OFF {
                return Some(1.0);
            }
            Some((estimate / error).max(error / estimate))
        });
        let p = key.variant.order.unwrap_or(0);
        let claim = format!("contrast {:e}, p = {p}: factor between the error and its estimate", key.jump);
        claims.at_most(ladder.case, claim, ratio, FACTOR);
    }
}
