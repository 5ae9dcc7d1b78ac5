//! Section 3.5 as the paper solves it: u is prescribed on the circle, the jump of the slope is an unknown.

use meshless_tests::particle_difference::cylinder_prescribed;

use super::{FORMER, FORMER_VARYING, GRID, SEEDS, cases};
use crate::verify::claims::Claims;
use crate::verify::jobs::Job;
use crate::verify::order;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::{Key, Outcome, find};

pub(super) const CASE: &str = "cylinder-prescribed";

/// Rungs of which orders are taken, at least.
const RUNGS: usize = 3;

fn key(varying: bool, level: usize, seed: u64) -> Key {
    let variant = if varying { FORMER_VARYING } else { FORMER };
    Key { case: CASE, variant, jump: 1.0, level, seed }
}

pub(super) fn jobs(rungs: usize) -> impl Iterator<Item = Job> {
    [false, true].into_iter().flat_map(move |varying| {
        SEEDS.into_iter().flat_map(move |seed| {
            (0..rungs).map(move |level| Job {
                problem: cylinder_prescribed(20 << level, cases::regularity(seed)),
                key: key(varying, level, seed),
                extra: Extra::default(),
            })
        })
    })
}

/// The paper's orders on its regular cloud, and ours on both.
pub(super) fn claims(runner: &Runner<'_>, claims: &mut Claims) {
    for (varying, label) in [(false, "as in the paper"), (true, "varying")] {
        for seed in SEEDS.into_iter().filter(|&seed| varying || seed == GRID) {
            let cloud = if seed == GRID { "regular" } else { "scattered" };
            let fitted = |of: fn(&Outcome) -> Option<f64>| {
                let points: Vec<(f64, f64)> = (0..)
                    .map_while(|level| {
                        let outcome = find(&runner.outcomes, &key(varying, level, seed))?;
                        Some((outcome.row.spacing, of(outcome)?))
                    })
                    .collect();
                (points.len() >= RUNGS).then(|| order::fit(&points)).flatten()
            };
            let mut expect = |what: &str, of: fn(&Outcome) -> Option<f64>, least: f64| {
                claims.at_least(CASE, format!("{label}, {cloud} cloud: order of {what}"), fitted(of), least);
            };
            expect("u", |o| o.row.err_linf, 1.45);
            if !varying {
                expect("gradient", |o| o.row.err_grad_linf, 0.95);
                expect("the jump of the slope", |o| o.report.errors.as_ref()?.jump_linf, 0.7);
            }
        }
    }
}
