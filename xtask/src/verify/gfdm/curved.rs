//! Section 3.2: the curved interface.

use super::strips::smoothing_and_scaling;
use super::sweep::{CLAIMED, climbs};
use super::view::View;
use super::{HYBRID, POSITIVE, STRONG};
use crate::verify::claims::Claims;
use crate::verify::options::Effort;
use crate::verify::runner::Runner;

pub(super) fn check(runner: &Runner<'_>, claims: &mut Claims) {
    let view = View::new(runner, "curved");
    smoothing_and_scaling(&view, claims);
    let level = view.common_level();
    let straight = View::new(runner, "two-strip");
    let higher = view.error(STRONG, 1e4, level).zip(straight.error(STRONG, 1e4, level)).map(|(c, s)| c / s);
    claims.at_least(
        "curved",
        "errors are higher than with two strips: strong form, jump 1e4, error over error",
        higher,
        1.0,
    );
    let better = view.ratio((POSITIVE, 1e10), (STRONG, 1e10), level);
    claims.at_most(
        "curved",
        "at a jump of 1e10 the hybrid is better than the strong form: error over error",
        better,
        1.0,
    );
    if view.effort > Effort::Quick {
        for (jump, figure) in [(1e2, 2.4e-2), (1e4, 2.7e-2), (1e10, 3.7e-2)] {
            let claim = format!("strong form, scaled, 2 cycles, jump {jump:e}, h = 0.025");
            claims.within("curved", claim, view.error(STRONG, jump, CLAIMED), [figure / 1.5, figure * 1.5]);
        }
    }
    for jump in [1e2, 1e4, 1e10].into_iter().filter(|&jump| climbs(view.effort, view.case, jump)) {
        let claim = format!("conservative hybrid, jump {jump:e}, h = 0.025");
        claims.at_most("curved", claim, view.error(HYBRID, jump, CLAIMED), 1e-3);
    }
}
