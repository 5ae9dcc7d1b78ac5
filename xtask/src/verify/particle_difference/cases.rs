//! The problems, and what the paper says about them.

use meshless_tests::particle_difference::{Regularity, ball, circle, corner_45, corner_90, cylinder};

use super::GRID;
use crate::verify::jobs::Job;
use crate::verify::runner::Extra;
use crate::verify::study::Key;
use crate::verify::variant::Variant;

/// One problem, refined.
#[derive(Debug)]
pub(super) struct Ladder {
    pub(super) case: &'static str,
    pub(super) title: &'static str,
    pub(super) about: &'static str,
    pub(super) contrast: f64,
    pub(super) scene: fn(usize, Regularity) -> String,
    pub(super) most_rungs: usize,
    /// Least orders of u and of its gradient that are expected of the paper's variant on the regular cloud.
    pub(super) paper: Option<[f64; 2]>,
    /// The paper's orders that are measured otherwise: what they are here at least, and why.
    pub(super) otherwise: Option<([f64; 2], &'static str)>,
    pub(super) ours: Expected,
}

/// What is expected of the method as it is here, on both clouds.
#[derive(Debug, Clone, Copy)]
pub(super) enum Expected {
    /// Least orders of u and of its gradient.
    Orders([f64; 2]),
    /// Largest errors of u and of its gradient at any rung: the solution is in the space.
    Errors([f64; 2]),
}

/// Nodes along an edge of the square: 20, 40, 80, ...
fn nodes(level: usize) -> usize {
    20 << level
}

pub(super) const LADDERS: [Ladder; 5] = [
    Ladder {
        case: "circle",
        title: "Disc of variable conductivity",
        about: "Section 3.2: kappa = r^2 + 1 inside, 100 outside, C = 0.1.",
        contrast: 100.0,
        scene: |level, regularity| circle(100.0, 0.1, nodes(level), regularity),
        most_rungs: 5,
        paper: Some([2.0, 1.0]),
        otherwise: None,
        ours: Expected::Orders([2.3, 1.1]),
    },
    Ladder {
        case: "corner-90",
        title: "Corner of 90 degrees",
        about: "Section 3.3. Both sides of the solution are quadratic.",
        contrast: 10.0,
        scene: |level, regularity| corner_90(nodes(level), regularity),
        most_rungs: 5,
        paper: Some([1.85, 0.95]),
        otherwise: None,
        ours: Expected::Errors([1e-5, 1e-4]),
    },
    Ladder {
        case: "corner-45",
        title: "Corner of 45 degrees",
        about: "Section 3.3. Both sides of the solution are quadratic.",
        contrast: 10.0,
        scene: |level, regularity| corner_45(nodes(level), regularity),
        most_rungs: 5,
        paper: Some([0.95, 0.85]),
        otherwise: None,
        ours: Expected::Errors([1e-11, 1e-10]),
    },
    Ladder {
        case: "cylinder",
        title: "Flow about a cylinder",
        about: "Section 3.5: one conductivity, the flux jumps along the circle.",
        contrast: 1.0,
        scene: |level, regularity| cylinder(nodes(level), regularity),
        most_rungs: 5,
        paper: Some([1.45, 0.95]),
        otherwise: Some((
            [0.8, 0.7],
            "the second derivative jumps by the curvature times the jump of the slope, which one slope leaves out: with it \
             (the next rows) the same clouds give order 2",
        )),
        ours: Expected::Orders([1.85, 1.6]),
    },
    Ladder {
        case: "ball",
        title: "Ball of variable conductivity",
        about: "The disc in three dimensions; spacing 0.2, 0.1, 0.067.",
        contrast: 100.0,
        scene: |level, regularity| ball(100.0, 0.1, [0.2, 0.1, 2.0 / 30.0][level], regularity),
        most_rungs: 3,
        paper: None,
        otherwise: None,
        ours: Expected::Orders([1.9, 1.1]),
    },
];

/// Of them, those that are run where time is short.
pub(super) const FEW_CONTRASTS: [f64; 5] = [1e-10, 1e-4, 1.0, 1e4, 1e10];

/// Outside over inside, of the disc of section 3.2.
pub(super) const CONTRASTS: [f64; 11] = [1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6, 1e8, 1e10];

/// A run of the sweep over contrasts: on scattered clouds.
pub(super) fn contrast(variant: Variant, contrast: f64, level: usize) -> Job {
    Job {
        problem: circle(contrast, 0.1, nodes(level), Regularity::Irregular(1)),
        key: Key { case: "contrast", variant, jump: contrast, level, seed: 1 },
        extra: Extra::default(),
    }
}

pub(super) fn regularity(seed: u64) -> Regularity {
    if seed == GRID { Regularity::Grid } else { Regularity::Irregular(seed) }
}
