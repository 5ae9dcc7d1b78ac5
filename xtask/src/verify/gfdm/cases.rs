//! The four problems.

use meshless_tests::kraus;

use super::{BY_REGION, CONSERVATIVE, HYBRID, POSITIVE, Variant};
use crate::verify::options::Effort;

/// A problem with its parameter, the jump of the coefficient.
#[derive(Debug, Clone, Copy)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) about: &'static str,
    /// Text of the scene for a jump, an interaction radius and a seed.
    pub(super) scene: fn(f64, f64, u64) -> String,
    /// Whether the jump goes in both directions.
    both_directions: bool,
    /// Whether there are conditions on the flux, so that conservative Neumann rows matter.
    pub(super) strips: bool,
    /// The jump of the picture and that of the diagrams over the spacing.
    pub(super) shown: f64,
    /// Powers of ten of the jumps at which claims look at the strong forms on the finest cloud.
    pub(super) compared: &'static [i32],
}

/// The jump from the middle to the right strip is the same for all jumps from the left to the middle one.
pub(super) const RIGHT_JUMP: f64 = 1e-4;

pub(super) const CASES: [Case; 4] = [
    Case {
        name: "two-strip",
        title: "Two strips",
        about: "A solution that is linear in each strip; values on the left and the right, no flux through bottom and \
                top. The jump is that of the coefficient from left to right.",
        scene: kraus::two_strip,
        both_directions: true,
        strips: true,
        shown: 1e10,
        compared: &[2, 4, 10],
    },
    Case {
        name: "curved",
        title: "Curved interface",
        about: "The interface y = 2x³, prescribed values all round, a source. The smaller coefficient is 1.",
        scene: curved,
        both_directions: true,
        strips: false,
        shown: 1e10,
        compared: &[2, 4, 10],
    },
    Case {
        name: "interior",
        title: "Interior interface",
        about: "A stiff region that touches no boundary: its values hang by the flux through the interface alone.",
        scene: kraus::interior,
        both_directions: false,
        strips: false,
        shown: 1e10,
        compared: &[4, 10],
    },
    Case {
        name: "three-strip",
        title: "Three strips",
        about: "The middle strip touches only boundaries with a prescribed flux. The jump is that from the left to the \
                middle strip; from there to the right one it is 1e-4.",
        scene: |jump, h, seed| kraus::three_strip(jump, RIGHT_JUMP, h, seed),
        both_directions: false,
        strips: true,
        shown: 1e6,
        compared: &[],
    },
];

/// Both coefficients at least 1, so that the gradient stays bounded.
fn curved(jump: f64, h: f64, seed: u64) -> String {
    if jump >= 1.0 { kraus::curved(1.0, jump, h, seed) } else { kraus::curved(1.0 / jump, 1.0, h, seed) }
}

impl Case {
    /// The jumps of the sweep.
    pub(super) fn jumps(&self, effort: Effort) -> Vec<f64> {
        let exponents: &[i32] = match (self.name, effort) {
            ("three-strip", Effort::Quick) => &[2, 6, 10],
            ("three-strip", _) => &[2, 4, 6, 8, 10],
            (_, Effort::Quick) => &[0, 1, 2, 4, 10],
            _ => &[0, 1, 2, 4, 6, 8, 10],
        };
        let mut jumps: Vec<f64> = exponents.iter().map(|&k| power_of_ten(k)).collect();
        if self.both_directions {
            jumps.extend(exponents.iter().filter(|&&k| k > 0).map(|&k| power_of_ten(-k)));
        }
        jumps
    }

    /// The methods of the sweep.
    pub(super) fn variants(&self) -> Vec<Variant> {
        let mut variants = Vec::new();
        for log in [false, true] {
            variants.extend((0..=2).map(|cycles| Variant::strong(cycles, log)));
        }
        variants.extend([POSITIVE, HYBRID, CONSERVATIVE, BY_REGION]);
        if self.strips {
            variants.push(HYBRID.with_strong_neumann());
        }
        variants
    }
}

/// `10^k`, correctly rounded, which `powi` is not.
pub(super) fn power_of_ten(k: i32) -> f64 {
    format!("1e{k}").parse().unwrap_or(f64::NAN)
}

/// A case by its name.
pub(super) fn case(name: &str) -> &'static Case {
    CASES.iter().find(|c| c.name == name).unwrap_or(&CASES[0])
}
