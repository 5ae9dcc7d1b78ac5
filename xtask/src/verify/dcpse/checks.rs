//! Claims about the problems: what the paper says, and what is measured.

use super::{
    CONSTRAINED, HYBRID, JITTERED, LATTICE, LAYOUTS, PAPER_REACTION, REACTION, SCATTERED, TRILINEAR,
};
use crate::verify::claims::Claims;
use crate::verify::options::Effort;
use crate::verify::order;
use crate::verify::runner::Runner;
use crate::verify::study::{Key, find, ladder};
use crate::verify::variant::Variant;

/// Order that the paper reports for everything, with the room of a plot that is read by eye.
const SECOND: f64 = 1.8;

/// Largest error of the shells at the spacing 2, and of the inclusions.
const SHELLS_AT_2: f64 = 3.2e-3;
const INCLUSIONS_AT_2: f64 = 2.7e-3;

/// Least order of the shells with constrained ghosts.
const SHELLS_ORDER: f64 = 2.3;

fn key(case: &'static str, variant: Variant, level: usize, layout: u64) -> Key {
    Key { case, variant, jump: 0.0, level, seed: layout }
}

fn l2(runner: &Runner<'_>, key: &Key) -> Option<f64> {
    find(&runner.outcomes, key)?.row.err_l2
}

fn rate(runner: &Runner<'_>, case: &'static str, variant: Variant, layout: u64) -> Option<f64> {
    order::fit(&ladder(&runner.outcomes, &key(case, variant, 0, layout)))
}

pub(super) fn dipole(runner: &Runner<'_>, claims: &mut Claims) {
    let case = "dipole";
    for (layout, name) in LAYOUTS {
        let errors = (0..super::cases::DIPOLE.len()).map(|k| l2(runner, &key(case, CONSTRAINED, k, layout)));
        let worst = errors.collect::<Option<Vec<f64>>>().map(|e| e.into_iter().fold(0.0, f64::max));
        // Rounding, 640 unknowns at the finest spacing: 1e-16 times the condition of the matrix.
        claims.at_most(
            case,
            format!("constrained ghosts, {name}: largest error of all spacings"),
            worst,
            1e-9,
        );
        claims.explained(
            case,
            format!("surface reaction as in the paper, {name}: order of u"),
            rate(runner, case, PAPER_REACTION, layout),
            [SECOND, f64::INFINITY],
            [-0.3, SECOND],
            "sigma lap u is no divergence: the flux through the interface is off by a share that no spacing reduces",
        );
        claims.at_most(
            case,
            format!("surface reaction, corrected, {name}: largest error of all spacings"),
            (0..super::cases::DIPOLE.len())
                .map(|k| l2(runner, &key(case, REACTION, k, layout)))
                .collect::<Option<Vec<f64>>>()
                .map(|e| e.into_iter().fold(0.0, f64::max)),
            2e-3,
        );
    }
}

pub(super) fn shells(runner: &Runner<'_>, claims: &mut Claims) {
    let case = "shells";
    let effort = runner.options.effort;
    let finest = usize::from(effort != Effort::Quick) + 1;
    for (layout, name) in [LAYOUTS[0], LAYOUTS[2]] {
        claims.at_least(
            case,
            format!("constrained ghosts, {name}: order of u"),
            rate(runner, case, CONSTRAINED, layout),
            SHELLS_ORDER,
        );
        if finest == 2 {
            let measured = l2(runner, &key(case, CONSTRAINED, 2, layout));
            claims.at_most(
                case,
                format!("constrained ghosts, {name}, h = 2: error of u"),
                measured,
                SHELLS_AT_2,
            );
        }
        let measured = l2(runner, &key(case, CONSTRAINED, 1, layout));
        claims.at_most(case, format!("constrained ghosts, {name}, h = 4: error of u"), measured, 6e-3);
    }
    claims.explained(
        case,
        "the paper's ghosts, lattice: order of u",
        rate(runner, case, TRILINEAR, LATTICE),
        [SECOND, f64::INFINITY],
        [0.9, SECOND],
        "an image point and a Taylor expansion of first order leave an error of second order in every ghost, which the \
         Laplacian divides by h^2; and the interfaces lie on lattice planes",
    );
    claims.explained(
        case,
        "surface reaction as in the paper, lattice: order of u",
        rate(runner, case, PAPER_REACTION, LATTICE),
        [SECOND, f64::INFINITY],
        [-0.2, SECOND],
        "sigma lap u is no divergence: without a source the flux does not change with sigma at all",
    );
    claims.at_least(
        case,
        "surface reaction, harmonic sigma, lattice: order of u",
        rate(runner, case, REACTION, LATTICE),
        1.5,
    );
    let ratio = l2(runner, &key(case, HYBRID, 1, SCATTERED))
        .zip(l2(runner, &key(case, CONSTRAINED, 1, SCATTERED)))
        .map(|(other, ours)| other / ours);
    claims.at_least(
        case,
        "error of the conservative hybrid over that of constrained ghosts, ±h/2, h = 4",
        ratio,
        3.0,
    );
    if effort != Effort::Quick {
        let measured = l2(runner, &key(case, CONSTRAINED, 1, JITTERED));
        claims.at_most(case, "constrained ghosts, ±h/4, h = 4: error of u", measured, 6e-3);
    }
}

pub(super) fn inclusions(runner: &Runner<'_>, claims: &mut Claims) {
    let case = "inclusions";
    let at = |level| l2(runner, &key(case, CONSTRAINED, level, SCATTERED));
    claims.at_most(case, "±h/2, h = 4: error at the points of the reference", at(1), 4.5e-3);
    if runner.options.effort != Effort::Quick {
        claims.at_most(case, "±h/2, h = 2: error at the points of the reference", at(2), INCLUSIONS_AT_2);
    }
}
