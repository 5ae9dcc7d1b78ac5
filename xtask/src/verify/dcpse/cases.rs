//! What is run.

use meshless_tests::fietier::{Particles, dipole, inclusions, shells};

use super::{
    CONSTRAINED, HYBRID, JITTERED, LATTICE, LAYOUTS, PAPER_REACTION, REACTION, SCATTERED, TRILINEAR, VARIANTS,
};
use crate::verify::jobs::Job;
use crate::verify::options::Effort;
use crate::verify::runner::Extra;
use crate::verify::study::Key;
use crate::verify::variant::Variant;

/// Residual at which the iterative solver stops in three dimensions.
const TOLERANCE: f64 = 1e-11;

/// Memory of a run in three dimensions at the spacing 2, in GB: 275,682 unknowns of the shells, with ghosts and ILU(0).
const MEMORY_AT_2: f64 = 1.8;

/// Spacings of the paper, coarsest first.
pub(super) const DIPOLE: [f64; 5] = [2.0, 1.0, 0.5, 0.25, 0.125];
pub(super) const SHELLS: [f64; 4] = [8.0, 4.0, 2.0, 4.0 / 3.0];
pub(super) const INCLUSIONS: [f64; 3] = [8.0, 4.0, 2.0];

pub(super) fn particles(layout: u64) -> Particles {
    match layout {
        LATTICE => Particles::Lattice,
        JITTERED => Particles::Jittered(1),
        _ => Particles::Scattered(1),
    }
}

/// A scene by spacing and layout.
type Scene = fn(f64, Particles) -> String;

fn job(case: &'static str, variant: Variant, level: usize, layout: u64) -> Job {
    let (spacings, problem): (&[f64], Scene) = match case {
        "dipole" => (&DIPOLE, dipole),
        "shells" => (&SHELLS, shells),
        _ => (&INCLUSIONS, inclusions),
    };
    let krylov = (case != "dipole").then_some(TOLERANCE);
    let memory = if case == "dipole" { 0.0 } else { MEMORY_AT_2 * (2.0 / spacings[level]).powi(3) };
    Job {
        problem: problem(spacings[level], particles(layout)),
        key: Key { case, variant, jump: 0.0, level, seed: layout },
        extra: Extra { krylov, memory, ..Extra::default() },
    }
}

/// Number of rungs of a ladder; zero where it is not run.
fn rungs(effort: Effort, case: &str, variant: Variant, layout: u64) -> usize {
    let (quick, full) = (effort == Effort::Quick, effort == Effort::Full);
    let constrained = variant == CONSTRAINED;
    match case {
        "dipole" => DIPOLE.len(),
        "shells" => match (full, quick) {
            (true, _) if constrained => SHELLS.len(),
            (true, _) => 3,
            (_, true) => match variant {
                CONSTRAINED if layout != JITTERED => 2,
                TRILINEAR | REACTION | PAPER_REACTION if layout == LATTICE => 2,
                HYBRID if layout == SCATTERED => 2,
                _ => 0,
            },
            _ if constrained && layout != JITTERED => 3,
            _ => 2,
        },
        // The two balls are holes: no interface, so that all kinds of ghosts are the same.
        _ => match (variant, layout) {
            (CONSTRAINED, SCATTERED) => 3 - usize::from(quick),
            (CONSTRAINED | HYBRID, _) => 2 * usize::from(!quick) + usize::from(full && constrained),
            _ => 0,
        },
    }
}

pub(super) fn jobs(effort: Effort) -> Vec<Job> {
    let mut jobs = Vec::new();
    for case in ["dipole", "shells", "inclusions"] {
        for variant in VARIANTS {
            for (layout, _) in LAYOUTS {
                let rungs = rungs(effort, case, variant, layout);
                jobs.extend((0..rungs).map(|level| job(case, variant, level, layout)));
            }
        }
    }
    jobs
}
