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
    let mut ladders = in_all_sweeps(effort);
    if at_least(effort, Effort::Default) {
        ladders.extend(in_the_plane(effort));
        ladders.extend(in_space(effort));
    }
    ladders
}

/// In the plane, all orders on all clouds of the quick or the longer sweeps.
fn plain(
    quick: bool,
    case: &'static str,
    [title, about]: [&'static str; 2],
    scene: Scene,
    contrast: f64,
) -> Ladder {
    Ladder {
        case,
        title,
        about,
        scene,
        variants: vec![sharp(2), sharp(4), sharp(6)],
        contrasts: vec![contrast],
        seeds: if quick { vec![1] } else { vec![1, 2, 3] },
        levels: 0..if quick { 3 } else { 4 },
        smooth: true,
        space: false,
        beyond: &[],
    }
}

fn in_all_sweeps(effort: Effort) -> Vec<Ladder> {
    let quick = effort == Effort::Quick;
    let interior_words = ["Interior interface", "Kraus et al., section 3.3: the stiff region floats."];
    let disc_words = [
        "Disc of variable conductivity",
        "Yoon and Song, section 3.2: the diffusivity varies inside, and the flux jumps.",
    ];
    let graded_words = ["Diffusivity that varies", "By the contrast, exponentially; it does not jump."];
    let star_words = ["Star", "u and its flux jump along a star-shaped interface."];
    let contrasts = if quick { vec![1e2, 1e10] } else { vec![1e2, 1e6, 1e10] };
    vec![
        Ladder { contrasts, ..plain(quick, "interior", interior_words, interior, 0.0) },
        Ladder { beyond: NO_FLUX_JUMPS, ..plain(quick, "disc", disc_words, disc, 1e2) },
        plain(quick, "graded", graded_words, graded, 1e4),
        Ladder { beyond: NO_VALUE_JUMPS, ..plain(quick, "star", star_words, star, 1e2) },
    ]
}

fn in_the_plane(effort: Effort) -> Vec<Ladder> {
    // Without the coarsest cloud; and those whose coarse clouds are far from the asymptotic order, up to a finer one. Four clouds
    // of three seeds each in the full sweep.
    let full = effort == Effort::Full;
    let from_first = |case, words, scene: Scene, contrast| Ladder {
        levels: 1..if full { 5 } else { 4 },
        seeds: if full { vec![1, 2, 3] } else { vec![1, 2] },
        ..plain(false, case, words, scene, contrast)
    };
    let finer = |case, words, scene: Scene, contrast| Ladder {
        levels: 1..5,
        ..from_first(case, words, scene, contrast)
    };
    let mode_words = ["Disc in a field of mode 3", "No source, no jump."];
    let ellipse_words = ["Ellipse", "u and its flux jump along an ellipse."];
    let pair_words = ["Two discs", "At a distance of half a spacing."];
    let quadrants_words = ["Four materials", "They meet at a point."];
    let curved_words = ["Curved interface", "Kraus et al., section 3.2: it meets the boundary."];
    let cylinder_words = ["Flow about a cylinder", "The flux jumps, the conductivity does not."];
    vec![
        Ladder { contrasts: vec![1e10, 1e-10], ..finer("mode-3", mode_words, circle_mode, 0.0) },
        Ladder { beyond: NO_VALUE_JUMPS, ..from_first("ellipse", ellipse_words, ellipse, 1e2) },
        Ladder { beyond: NO_VALUE_JUMPS, ..from_first("pair", pair_words, pair, 1e2) },
        Ladder {
            beyond: &[("immersed-interface", "four regions meet")],
            ..from_first("quadrants", quadrants_words, quadrants, 1e4)
        },
        from_first("curved", curved_words, curved, 1e2),
        Ladder { beyond: NO_FLUX_JUMPS, ..finer("cylinder", cylinder_words, flow, 1.0) },
    ]
}

fn in_space(effort: Effort) -> Vec<Ladder> {
    // About 800 and 7,000 nodes, and 60,000 in the full sweep.
    let coarse = |case, words, scene: Scene, contrast| Ladder {
        seeds: vec![1],
        levels: 0..if effort == Effort::Full { 3 } else { 2 },
        smooth: false,
        space: true,
        ..plain(false, case, words, scene, contrast)
    };
    vec![
        Ladder {
            variants: vec![sharp_in_space(4), sharp_in_space(6)],
            contrasts: vec![1e10, 1e-10],
            beyond: &[("gfdm-classical", "smeared over the interface, it has no solution to 1e-11 at 1e10")],
            ..coarse("ball", ["Ball in a field of mode 3", "In space."], ball_mode, 0.0)
        },
        Ladder {
            variants: vec![sharp_in_space(4)],
            beyond: NO_VALUE_JUMPS,
            ..coarse("torus", ["Torus", "In space; u and its flux jump."], torus, 1e2)
        },
    ]
}
