//! Multigrid on the matrices of the sharp method: iterations for a whole solve, constants included.

use meshless_tests::sharp::{circle_mode, rings};

use super::cases::{Scene, interior};
use super::sharp;
use crate::verify::claims::Claims;
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::{Key, find};
use crate::verify::variant::Variant;

/// Iterations at most, at any contrast and size. They are all the products with the matrix that there are.
const ITERATIONS: f64 = 15.0;

/// To this residual, as the suite `solvers` counts.
const RESIDUAL: f64 = 1e-10;

const CONTRASTS: [f64; 3] = [1e-10, 1.0, 1e10];

/// Levels of these runs, which belong to no ladder: the number of nodes in hundreds.
const BESIDE: usize = 1000;

fn nested(contrast: f64, h: f64, seed: u64) -> String {
    rings([1.0, contrast, 1.0], h, seed)
}

/// Cases, orders and numbers of nodes in a square of edges of length 2.
type Group = (&'static str, Scene, &'static [usize], &'static [f64]);

fn groups(effort: Effort) -> Vec<Group> {
    match effort {
        Effort::Quick => vec![("mode-3", circle_mode, &[4, 8], &[1e4])],
        Effort::Default => vec![
            ("mode-3", circle_mode, &[4, 6], &[3e4]),
            ("mode-3", circle_mode, &[8], &[1e4]),
            ("interior", interior, &[4], &[1e4]),
            ("rings", nested, &[4], &[1e4]),
        ],
        Effort::Full => vec![
            ("mode-3", circle_mode, &[4, 6, 8], &[1e4, 3e4, 1e5]),
            ("interior", interior, &[4, 6, 8], &[1e4, 3e4, 1e5]),
            ("rings", nested, &[4, 6, 8], &[1e4, 3e4, 1e5]),
        ],
    }
}

fn key(case: &'static str, order: usize, jump: f64, nodes: f64) -> Key {
    let variant = Variant { solver: Some("multigrid"), ..sharp(order) };
    Key { case, variant, jump, level: BESIDE + (nodes / 100.0) as usize, seed: 1 }
}

/// All runs: key and scene.
fn runs(effort: Effort) -> Vec<(Key, Scene, f64)> {
    let mut all = Vec::new();
    for (case, scene, orders, sizes) in groups(effort) {
        for &order in orders {
            for &nodes in sizes {
                let spacing = 2.0 / nodes.sqrt();
                all.extend(CONTRASTS.map(|jump| (key(case, order, jump, nodes), scene, spacing)));
            }
        }
    }
    all
}

pub(super) fn jobs(effort: Effort) -> Vec<Job> {
    let job = |(key, scene, spacing): (Key, Scene, f64)| Job {
        problem: scene(key.jump, spacing, key.seed),
        key,
        extra: Extra { residual: Some(RESIDUAL), ..Extra::default() },
    };
    runs(effort).into_iter().map(job).collect()
}

pub(super) fn check(runner: &Runner<'_>, effort: Effort, claims: &mut Claims) {
    for (key, ..) in runs(effort) {
        if runner.options.wants(key.case, "sharp") {
            let found = find(&runner.outcomes, &key);
            let (order, jump) = (key.variant.order.unwrap_or(0), key.jump);
            let nodes = (key.level - BESIDE) * 100;
            let claim = format!(
                "about {nodes} nodes, contrast {jump:e}, p = {order}: iterations of multigrid to 1e-10"
            );
            let iterations = found.map(|o| o.row.iterations as f64);
            claims.at_most(key.case, claim, iterations, ITERATIONS);
        }
    }
}
