//! The problems, and how far they are refined.

use std::ops::Range;

use meshless_tests::kraus::{self, SUPPORT};
use meshless_tests::particle_difference::{Regularity, circle, corner_45, corner_90, cylinder};
use meshless_tests::sharp::{ball_mode, circle_mode, ellipse, pair, quadrants, rings, star, torus};

use super::{at_least, sharp, sharp_in_space, spacing};
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::Extra;
use crate::verify::study::Key;
use crate::verify::variant::Variant;

/// A scene for a contrast, a spacing and a seed.
type Scene = fn(f64, f64, u64) -> String;

/// A problem, refined.
#[derive(Debug)]
pub(super) struct Ladder {
    pub(super) case: &'static str,
    pub(super) title: &'static str,
    pub(super) about: &'static str,
    pub(super) scene: Scene,
    pub(super) variants: Vec<Variant>,
    pub(super) contrasts: Vec<f64>,
    pub(super) seeds: Vec<u64>,
    pub(super) levels: Range<usize>,
    /// Other methods on the same clouds.
    pub(super) compared: bool,
    /// Orders of u and of its gradient are claimed.
    pub(super) smooth: bool,
}

/// Nodes along an edge of length 2.
fn along(h: f64) -> usize {
    (2.0 / h).round() as usize + 1
}

fn disc(contrast: f64, h: f64, seed: u64) -> String {
    circle(contrast, 0.1, along(h), Regularity::Irregular(seed))
}

fn interior(contrast: f64, h: f64, seed: u64) -> String {
    kraus::interior(contrast, SUPPORT * h, seed)
}

fn curved(contrast: f64, h: f64, seed: u64) -> String {
    kraus::curved(1.0, contrast, SUPPORT * h, seed)
}

fn flow(_contrast: f64, h: f64, seed: u64) -> String {
    cylinder(along(h), Regularity::Irregular(seed))
}

fn soft_ring(contrast: f64, h: f64, seed: u64) -> String {
    rings([1.0, 1.0 / contrast, 1.0], h, seed)
}

pub(super) fn ladders(effort: Effort) -> Vec<Ladder> {
    let quick = effort == Effort::Quick;
    let (seeds, finest) = if quick { (vec![1], 3) } else { (vec![1, 2, 3], 4) };
    let plain = |case, title, about, scene: Scene, contrast: f64| Ladder {
        case,
        title,
        about,
        scene,
        variants: vec![sharp(4), sharp(6)],
        contrasts: vec![contrast],
        seeds: seeds.clone(),
        levels: 0..finest,
        compared: false,
        smooth: true,
    };
    let mut ladders = vec![
        Ladder {
            contrasts: if quick { vec![1e2, 1e10] } else { vec![1e2, 1e6, 1e10] },
            compared: true,
            ..plain(
                "interior",
                "Interior interface",
                "Kraus et al., section 3.3: the stiff region floats.",
                interior,
                0.0,
            )
        },
        Ladder {
            compared: true,
            ..plain(
                "disc",
                "Disc of variable conductivity",
                "Yoon and Song, section 3.2: the general form inside, the harmonic one outside; the flux jumps.",
                disc,
                1e2,
            )
        },
        plain("star", "Star", "u and its flux jump along a star-shaped interface.", star, 1e2),
    ];
    if at_least(effort, Effort::Default) {
        let from_first = |ladder: Ladder| Ladder { levels: 1..finest, seeds: vec![1, 2], ..ladder };
        // Whose coarse clouds are far from the asymptotic order.
        let finer = |ladder: Ladder| Ladder { levels: 1..finest + 1, seeds: vec![1, 2], ..ladder };
        ladders.extend([
            Ladder {
                contrasts: vec![1e10, 1e-10],
                ..finer(plain("mode-3", "Disc in a field of mode 3", "No source, no jump.", circle_mode, 0.0))
            },
            from_first(plain("ellipse", "Ellipse", "u and its flux jump along an ellipse.", ellipse, 1e2)),
            from_first(plain("pair", "Two discs", "At a distance of half a spacing.", pair, 1e2)),
            from_first(plain("quadrants", "Four materials", "They meet at a point.", quadrants, 1e4)),
            from_first(plain(
                "curved",
                "Curved interface",
                "Kraus et al., section 3.2: it meets the boundary.",
                curved,
                1e2,
            )),
            finer(plain(
                "cylinder",
                "Flow about a cylinder",
                "The flux jumps, the conductivity does not.",
                flow,
                1.0,
            )),
            Ladder {
                variants: vec![sharp_in_space(4), sharp_in_space(6)],
                contrasts: vec![1e10, 1e-10],
                seeds: vec![1],
                levels: 0..2,
                smooth: false,
                ..plain("ball", "Ball in a field of mode 3", "In space.", ball_mode, 0.0)
            },
            Ladder {
                variants: vec![sharp_in_space(4)],
                seeds: vec![1],
                levels: 0..2,
                smooth: false,
                ..plain("torus", "Torus", "In space; u and its flux jump.", torus, 1e2)
            },
        ]);
    }
    ladders
}

/// A run of which the error is claimed.
#[derive(Debug)]
pub(super) struct Single {
    pub(super) key: Key,
    scene: fn(f64, f64, u64) -> String,
    pub(super) what: &'static str,
    /// Largest relative L2 error.
    pub(super) l2: f64,
    /// From which effort on.
    least: Effort,
}

fn flat(contrast: f64, h: f64, seed: u64) -> String {
    kraus::two_strip(contrast, SUPPORT * h, seed)
}

fn corner_of_90(_contrast: f64, h: f64, seed: u64) -> String {
    corner_90(along(h), Regularity::Irregular(seed))
}

fn corner_of_45(_contrast: f64, h: f64, seed: u64) -> String {
    corner_45(along(h), Regularity::Irregular(seed))
}

pub(super) fn singles(effort: Effort) -> Vec<Single> {
    let single = |case, scene, (order, jump, level): (usize, f64, usize), what, l2, least| Single {
        key: Key { case, variant: sharp(order), jump, level, seed: 1 },
        scene,
        what,
        l2,
        least,
    };
    let (quick, default) = (Effort::Quick, Effort::Default);
    let mut all = vec![
        single(
            "interior",
            interior as Scene,
            (6, 1e10, 2),
            "about 1500 nodes, contrast 1e10, order 6",
            5e-8,
            quick,
        ),
        single("interior", interior, (8, 1e10, 2), "about 1500 nodes, contrast 1e10, order 8", 2e-10, quick),
        single(
            "interior",
            interior,
            (12, 1e10, 2),
            "about 1500 nodes, contrast 1e10, order 12",
            1e-12,
            default,
        ),
        single("mode-3", circle_mode, (6, 1e10, 3), "about 6000 nodes, contrast 1e10, order 6", 2e-7, quick),
        single(
            "mode-3",
            circle_mode,
            (8, 1e10, 3),
            "about 6000 nodes, contrast 1e10, order 8",
            2e-8,
            default,
        ),
        single(
            "mode-3",
            circle_mode,
            (12, 1e10, 3),
            "about 6000 nodes, contrast 1e10, order 12",
            2e-10,
            default,
        ),
        single("flat", flat, (4, 1e8, 1), "linear on both sides, contrast 1e8, order 4", 1e-11, quick),
        single("flat", flat, (6, 1e-8, 1), "linear on both sides, contrast 1e-8, order 6", 1e-11, quick),
        single("corner-90", corner_of_90, (4, 10.0, 1), "quadratic on both sides, order 4", 1e-11, quick),
        single("corner-45", corner_of_45, (4, 10.0, 1), "quadratic on both sides, order 4", 1e-11, quick),
        // Quadratic in every ring: what is left is the constants.
        single("rings", soft_ring, (4, 1e10, 2), "core in a soft ring, contrast 1e10, order 4", 1e-9, quick),
        single(
            "rings",
            stiff_ring,
            (4, 1e10, 2),
            "core in a stiff ring, contrast 1e10, order 4",
            1e-9,
            quick,
        ),
        single(
            "rings",
            stairs,
            (4, 1e5, 2),
            "stiff core in a less stiff ring, 1e5 each, order 4",
            1e-9,
            quick,
        ),
    ];
    all.retain(|s| at_least(effort, s.least));
    all
}

fn stiff_ring(contrast: f64, h: f64, seed: u64) -> String {
    rings([1.0, contrast, 1.0], h, seed)
}

fn stairs(contrast: f64, h: f64, seed: u64) -> String {
    rings([contrast * contrast, contrast, 1.0], h, seed)
}

pub(super) fn single_runs(effort: Effort) -> Vec<Job> {
    let job = |single: Single| Job {
        problem: (single.scene)(single.key.jump, spacing(single.key.level), single.key.seed),
        key: distinct(single.key, single.what),
        extra: Extra::default(),
    };
    singles(effort).into_iter().map(job).collect()
}

/// Rings differ in what is stiff, not only in how much: each has a seed of its own, so that their keys differ.
pub(super) fn distinct(key: Key, what: &str) -> Key {
    let seed = match what {
        w if w.starts_with("core in a stiff") => 2,
        w if w.starts_with("stiff core") => 3,
        _ => key.seed,
    };
    Key { seed, ..key }
}
