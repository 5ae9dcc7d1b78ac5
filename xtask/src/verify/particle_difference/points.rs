//! Interfaces given by points: polygons in place of circles, with the jump of the flux at their vertices.

use meshless_tests::particle_difference::{circle_by_points, cylinder_by_points};

use super::cases::regularity;
use super::checks::rungs;
use super::{GRID, OURS, PAPER};
use crate::verify::claims::Claims;
use crate::verify::jobs::Job;
use crate::verify::order;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::Key;
use crate::verify::variant::Variant;

/// Circle and cylinder, by the `jump` of their keys.
const PROBLEMS: [(&str, f64); 2] = [("circle", 100.0), ("cylinder", 1.0)];

fn key(which: usize, variant: Variant) -> Key {
    Key { case: "points", variant, jump: PROBLEMS[which].1, level: 0, seed: GRID }
}

pub(super) fn jobs() -> Vec<Job> {
    let mut jobs = Vec::new();
    for variant in [PAPER, OURS] {
        for which in 0..PROBLEMS.len() {
            jobs.extend((0..3).map(|level| Job {
                // 40, 80 and 160 points of the interface, as in the paper.
                problem: match which {
                    0 => circle_by_points(20 << level, 40 << level, regularity(GRID)),
                    _ => cylinder_by_points(20 << level, 40 << level, regularity(GRID)),
                },
                key: Key { level, ..key(which, variant) },
                extra: Extra::default(),
            }));
        }
    }
    jobs
}

pub(super) fn claims(runner: &Runner<'_>, claims: &mut Claims) {
    for (which, (name, _)) in PROBLEMS.iter().enumerate() {
        for (variant, label, least) in [(PAPER, "as in the paper", [1.3, 0.8]), (OURS, "ours", [1.3, 0.8])] {
            let found = rungs(runner, &key(which, variant), |r| r.err_linf);
            let measured = (found.len() > 2).then(|| order::fit(&found)).flatten();
            let claim = format!("{name} by 40, 80, 160 points, {label}: order of u");
            claims.at_least("points", claim, measured, least[which]);
        }
    }
}
