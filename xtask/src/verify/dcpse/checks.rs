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

/// Largest error at the spacing 4: of the shells that of the prototype that the targets at 2 are from, of the inclusions what
/// an operator of second order may have there to reach the target.
const SHELLS_AT_4: f64 = 1.77e-2;
const INCLUSIONS_AT_4: f64 = 4.0 * INCLUSIONS_AT_2;

/// Orders of what does not converge: nearer to zero than to one.
const NO_ORDER: [f64; 2] = [-0.5, 0.5];

/// Order in l2 of a kink that is smeared over a width: an error of the size of the width in a layer as thick as it.
const SMEARED: f64 = 1.5;

/// The error in the maximum norm that the smeared kink of u leaves on the dipole with surface reaction, relative: `w / sqrt(2 pi)`
/// times the jump of the slope that is due to the diffusivity, 31/28 at a slope of 20. The source is a ramp that is not smeared.
fn smeared_dipole(spacing: f64) -> f64 {
    let (kink, width, largest) = (20.0 * (1.0 - 28.0 / 31.0), 1.5 * spacing, 8000.0);
    width * kink / std::f64::consts::TAU.sqrt() / largest
}

/// Least order of the shells with constrained ghosts.
const SHELLS_ORDER: f64 = 2.3;

/// What quadrature between nodes may add to it. The resistance of a link of length L is a trapezoidal rule with the correction of its
/// ends, whose next term is `L^4/720` times the difference of the third derivatives at both (Euler and Maclaurin). Those of a profile of
/// width w and height 1 are at most 0.399 and 0.178 of `1/w^3`, and L at most 3.1 spacings, 2.07 w: 0.0147 w beside `w / sqrt(2 pi)`.
const QUADRATURE: f64 = 1.037;

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
            NO_ORDER,
            "sigma lap u is no divergence: the flux through the interface is off by a share that no spacing reduces",
        );
        let smeared = smeared_dipole(super::cases::DIPOLE[0]);
        claims.explained(
            case,
            format!("surface reaction, corrected, {name}: error in the maximum norm at the coarsest spacing"),
            find(&runner.outcomes, &key(case, REACTION, 0, layout)).and_then(|o| o.row.err_linf),
            [0.0, smeared],
            [0.0, QUADRATURE * smeared],
            "theory has the resistance between two nodes exactly; here it is a quadrature, whose next term is 3.7 % of it",
        );
        claims.at_most(
            case,
            format!(
                "surface reaction, corrected, {name}: largest error of all spacings over that of the coarsest"
            ),
            (0..super::cases::DIPOLE.len())
                .map(|k| find(&runner.outcomes, &key(case, REACTION, k, layout))?.row.err_linf)
                .collect::<Option<Vec<f64>>>()
                .map(|e| e.iter().fold(0.0, |a: f64, &b| a.max(b)) / e[0]),
            1.0,
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
        claims.at_most(case, format!("constrained ghosts, {name}, h = 4: error of u"), measured, SHELLS_AT_4);
    }
    claims.explained(
        case,
        "the paper's ghosts, lattice: order of u",
        rate(runner, case, TRILINEAR, LATTICE),
        [SECOND, f64::INFINITY],
        [1.0, SECOND],
        "an image point and a Taylor expansion of first order leave an error of second order in every ghost, which the \
         Laplacian divides by h^2: first order, from a layer as thick as h",
    );
    claims.explained(
        case,
        "surface reaction as in the paper, lattice: order of u",
        rate(runner, case, PAPER_REACTION, LATTICE),
        [SECOND, f64::INFINITY],
        NO_ORDER,
        "sigma lap u is no divergence: without a source the flux does not change with sigma at all",
    );
    claims.at_least(
        case,
        "surface reaction, harmonic sigma, lattice: order of u",
        rate(runner, case, REACTION, LATTICE),
        SMEARED,
    );
    let ratio = l2(runner, &key(case, HYBRID, 1, SCATTERED))
        .zip(l2(runner, &key(case, CONSTRAINED, 1, SCATTERED)))
        .map(|(other, ours)| other / ours);
    claims.at_least(
        case,
        "error of the conservative hybrid over that of constrained ghosts, ±h/2, h = 4",
        ratio,
        1.0,
    );
    if effort != Effort::Quick {
        let measured = l2(runner, &key(case, CONSTRAINED, 1, JITTERED));
        claims.at_most(case, "constrained ghosts, ±h/4, h = 4: error of u", measured, SHELLS_AT_4);
    }
}

pub(super) fn inclusions(runner: &Runner<'_>, claims: &mut Claims) {
    let case = "inclusions";
    let at = |level| l2(runner, &key(case, CONSTRAINED, level, SCATTERED));
    claims.at_most(case, "±h/2, h = 4: error at the points of the reference", at(1), INCLUSIONS_AT_4);
    if runner.options.effort != Effort::Quick {
        claims.at_most(case, "±h/2, h = 2: error at the points of the reference", at(2), INCLUSIONS_AT_2);
    }
}
