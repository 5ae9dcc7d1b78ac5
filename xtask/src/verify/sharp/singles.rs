//! Runs of which the error itself is claimed.

use meshless_tests::fietier::{Particles, inclusions, shells};
use meshless_tests::kraus::{self, SUPPORT};
use meshless_tests::particle_difference::{Regularity, corner_45, corner_90};
use meshless_tests::sharp::{ball_mode, circle_mode, rings};

use super::cases::{Scene, along, interior};
use super::{at_least, sharp, sharp_in_space, spacing};
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::Extra;
use crate::verify::study::Key;

/// A run of which the error is claimed.
#[derive(Debug)]
pub(super) struct Single {
    pub(super) key: Key,
    scene: Scene,
    /// Node spacing.
    spacing: f64,
    pub(super) what: String,
    /// Largest relative L2 error.
    pub(super) l2: f64,
    /// From which effort on.
    least: Effort,
}

fn flat(contrast: f64, h: f64, seed: u64) -> String {
    kraus::two_strip(contrast, SUPPORT * h, seed)
}

fn strips(contrast: f64, h: f64, seed: u64) -> String {
    kraus::three_strip(contrast, 1.0 / contrast, SUPPORT * h, seed)
}

fn corner_of_90(_contrast: f64, h: f64, seed: u64) -> String {
    corner_90(along(h), Regularity::Irregular(seed))
}

fn corner_of_45(_contrast: f64, h: f64, seed: u64) -> String {
    corner_45(along(h), Regularity::Irregular(seed))
}

fn soft_ring(contrast: f64, h: f64, seed: u64) -> String {
    rings([1.0, 1.0 / contrast, 1.0], h, seed)
}

fn stiff_ring(contrast: f64, h: f64, seed: u64) -> String {
    rings([1.0, contrast, 1.0], h, seed)
}

fn stairs(contrast: f64, h: f64, seed: u64) -> String {
    rings([contrast * contrast, contrast, 1.0], h, seed)
}

fn three_shells(_contrast: f64, h: f64, seed: u64) -> String {
    shells(h, Particles::Jittered(seed))
}

fn two_inclusions(_contrast: f64, h: f64, seed: u64) -> String {
    inclusions(h, Particles::Jittered(seed))
}

/// Runs in the plane: case, scene, order, contrast, rung, what it is, largest error, effort.
type Plane = (&'static str, Scene, usize, f64, usize, &'static str, f64, Effort);

/// Runs in space: case, scene, order, contrast, spacing, what it is, largest error.
type Space = (&'static str, Scene, usize, f64, f64, &'static str, f64);

pub(super) fn singles(effort: Effort) -> Vec<Single> {
    let (quick, default) = (Effort::Quick, Effort::Default);
    // Where the solution is a polynomial in every region what is left is the constants and round-off.
    let plane: [Plane; 16] = [
        ("interior", interior, 6, 1e10, 2, "about 1500 nodes", 5e-8, quick),
        ("interior", interior, 8, 1e10, 2, "about 1500 nodes", 2e-10, quick),
        ("interior", interior, 12, 1e10, 2, "about 1500 nodes", 1e-12, default),
        ("mode-3", circle_mode, 6, 1e10, 3, "about 6000 nodes", 2e-7, quick),
        ("mode-3", circle_mode, 8, 1e10, 3, "about 6000 nodes", 2e-8, default),
        ("mode-3", circle_mode, 12, 1e10, 3, "about 6000 nodes", 2e-10, default),
        ("flat", flat, 4, 1e8, 1, "linear on both sides", 1e-11, quick),
        ("flat", flat, 6, 1e-8, 1, "linear on both sides", 1e-11, quick),
        ("corner-90", corner_of_90, 4, 10.0, 1, "quadratic on both sides", 1e-11, quick),
        ("corner-45", corner_of_45, 4, 10.0, 1, "quadratic on both sides", 1e-11, quick),
        ("three-strip", strips, 4, 1e6, 1, "linear in each strip, the stiff one floats", 1e-11, quick),
        ("three-strip", strips, 4, 1e-6, 1, "linear in each strip, a soft one in the middle", 1e-11, quick),
        ("three-strip", strips, 6, 1e10, 1, "linear in each strip, the stiff one floats", 1e-11, quick),
        ("rings", soft_ring, 4, 1e10, 2, "core in a soft ring", 1e-9, quick),
        ("rings", stiff_ring, 4, 1e10, 2, "core in a stiff ring", 1e-9, quick),
        ("rings", stairs, 4, 1e5, 2, "stiff core in a less stiff ring, 1e5 each", 1e-9, quick),
    ];
    let space: [Space; 8] = [
        ("ball", ball_mode, 4, 1e10, BALL, "about 15000 nodes", 2.5e-4),
        ("ball", ball_mode, 4, 1e-10, BALL, "about 15000 nodes", 2.5e-4),
        ("ball", ball_mode, 6, 1e10, BALL, "about 15000 nodes", 5e-5),
        ("ball", ball_mode, 6, 1e-10, BALL, "about 15000 nodes", 5e-5),
        ("shells", three_shells, 4, 1.0, 8.0, "spacing 8", 1e-2),
        ("shells", three_shells, 4, 1.0, 5.0, "spacing 5", 4e-4),
        ("inclusions", two_inclusions, 4, 1.0, 8.0, "spacing 8, at the points of the reference", 5e-3),
        ("inclusions", two_inclusions, 4, 1.0, 5.0, "spacing 5, at the points of the reference", 5e-4),
    ];
    let mut all = Vec::new();
    for (case, scene, order, jump, level, what, l2, least) in plane {
        let key = Key { case, variant: sharp(order), jump, level, seed: seed_of(what) };
        all.push(Single {
            key,
            scene,
            spacing: spacing(level),
            what: name(what, key.jump, order),
            l2,
            least,
        });
    }
    for (case, scene, order, jump, spacing, what, l2) in space {
        // Beside the rungs of the ladders.
        let level = BESIDE + spacing.ceil() as usize;
        let key = Key { case, variant: sharp_in_space(order), jump, level, seed: 1 };
        all.push(Single { key, scene, spacing, what: name(what, jump, order), l2, least: default });
    }
    all.retain(|s| at_least(effort, s.least));
    all
}

/// Spacing of about 15000 nodes in the cube.
const BALL: f64 = 0.083;

/// Levels of runs that belong to no ladder.
const BESIDE: usize = 100;

fn name(what: &str, jump: f64, order: usize) -> String {
    let contrast = if jump == 1.0 { String::new() } else { format!(", contrast {jump:e}") };
    format!("{what}{contrast}, order {order}")
}

/// Rings differ in what is stiff, not only in how much: each has a seed of its own, so that their keys differ.
fn seed_of(what: &str) -> u64 {
    match what {
        w if w.starts_with("core in a stiff") => 2,
        w if w.starts_with("stiff core") => 3,
        _ => 1,
    }
}

pub(super) fn single_runs(effort: Effort) -> Vec<Job> {
    let job = |single: Single| Job {
        problem: (single.scene)(single.key.jump, single.spacing, single.key.seed),
        key: single.key,
        extra: Extra::default(),
    };
    singles(effort).into_iter().map(job).collect()
}
