//! The problems, and how far they are refined.

use std::ops::Range;

use meshless_tests::kraus::{self, SUPPORT};
use meshless_tests::particle_difference::{Regularity, circle, cylinder};
use meshless_tests::sharp::{ball_mode, circle_mode, ellipse, graded, pair, quadrants, star, torus};

use super::{at_least, sharp, sharp_in_space};
use crate::verify::options::Effort;
use crate::verify::variant::Variant;

/// A scene for a contrast, a spacing and a seed.
pub(super) type Scene = fn(f64, f64, u64) -> String;

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
    /// Orders of u and of its gradient are claimed.
    pub(super) smooth: bool,
    /// In three dimensions.
    pub(super) space: bool,
    /// Other methods that cannot solve it, and why; all the rest run on the same clouds.
    pub(super) beyond: Beyond,
}

/// Methods that cannot solve a problem, and why.
pub(super) type Beyond = &'static [(&'static str, &'static str)];

const NO_VALUE_JUMPS: Beyond =
    &[("gfdm-classical", "no prescribed jumps"), ("surface-reaction", "no jumps of u")];

const NO_FLUX_JUMPS: Beyond = &[("gfdm-classical", "no prescribed jumps")];

/// Nodes along an edge of length 2.
pub(super) fn along(h: f64) -> usize {
    (2.0 / h).round() as usize + 1
}

fn disc(contrast: f64, h: f64, seed: u64) -> String {
    circle(contrast, 0.1, along(h), Regularity::Irregular(seed))
}

pub(super) fn interior(contrast: f64, h: f64, seed: u64) -> String {
    kraus::interior(contrast, SUPPORT * h, seed)
}

fn curved(contrast: f64, h: f64, seed: u64) -> String {
    kraus::curved(1.0, contrast, SUPPORT * h, seed)
}

fn flow(_contrast: f64, h: f64, seed: u64) -> String {
    cylinder(along(h), Regularity::Irregular(seed))
}

pub(super) fn ladders(effort: Effort) -> Vec<Ladder> {
    let quick = effort == Effort::Quick;
    let (seeds, finest) = if quick { (vec![1], 3) } else { (vec![1, 2, 3], 4) };
    let plain = |case, title, about, scene: Scene, contrast: f64| Ladder {
        case,
        title,
        about,
        scene,
        variants: vec![sharp(2), sharp(4), sharp(6)],
        contrasts: vec![contrast],
        seeds: seeds.clone(),
        levels: 0..finest,
        smooth: true,
        space: false,
        beyond: &[],
    };
    let mut ladders = vec![
        Ladder {
            contrasts: if quick { vec![1e2, 1e10] } else { vec![1e2, 1e6, 1e10] },
            ..plain(
                "interior",
                "Interior interface",
                "Kraus et al., section 3.3: the stiff region floats.",
                interior,
                0.0,
            )
        },
        Ladder {
            beyond: NO_FLUX_JUMPS,
            ..plain(
                "disc",
                "Disc of variable conductivity",
                "Yoon and Song, section 3.2: the diffusivity varies inside, and the flux jumps.",
                disc,
                1e2,
            )
        },
        plain(
            "graded",
            "Diffusivity that varies",
            "By the contrast, exponentially; it does not jump.",
            graded,
            1e4,
        ),
        Ladder {
            beyond: NO_VALUE_JUMPS,
            ..plain("star", "Star", "u and its flux jump along a star-shaped interface.", star, 1e2)
        },
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
            Ladder {
                beyond: NO_VALUE_JUMPS,
                ..from_first(plain(
                    "ellipse",
                    "Ellipse",
                    "u and its flux jump along an ellipse.",
                    ellipse,
                    1e2,
                ))
            },
            Ladder {
                beyond: NO_VALUE_JUMPS,
                ..from_first(plain("pair", "Two discs", "At a distance of half a spacing.", pair, 1e2))
            },
            Ladder {
                beyond: &[("immersed-interface", "four regions meet")],
                ..from_first(plain("quadrants", "Four materials", "They meet at a point.", quadrants, 1e4))
            },
            Ladder {
                ..from_first(plain(
                    "curved",
                    "Curved interface",
                    "Kraus et al., section 3.2: it meets the boundary.",
                    curved,
                    1e2,
                ))
            },
            Ladder {
                beyond: NO_FLUX_JUMPS,
                ..finer(plain(
                    "cylinder",
                    "Flow about a cylinder",
                    "The flux jumps, the conductivity does not.",
                    flow,
                    1.0,
                ))
            },
            Ladder {
                variants: vec![sharp_in_space(4), sharp_in_space(6)],
                contrasts: vec![1e10, 1e-10],
                seeds: vec![1],
                levels: 0..2,
                smooth: false,
                space: true,
                beyond: &[(
                    "gfdm-classical",
                    "smeared over the interface, it has no solution to 1e-11 at 1e10",
                )],
                ..plain("ball", "Ball in a field of mode 3", "In space.", ball_mode, 0.0)
            },
            Ladder {
                variants: vec![sharp_in_space(4)],
                seeds: vec![1],
                levels: 0..2,
                smooth: false,
                space: true,
                beyond: NO_VALUE_JUMPS,
                ..plain("torus", "Torus", "In space; u and its flux jump.", torus, 1e2)
            },
        ]);
    }
    ladders
}
