//! Section 3.3: the interior interface.

use super::cases::case;
use super::checks::overshoot;
use super::sweep::{self, BEYOND, CLAIMED};
use super::view::{View, largest};
use super::{CONSERVATIVE, HYBRID, POSITIVE, Variant};
use crate::verify::claims::Claims;
use crate::verify::runner::Runner;
use crate::verify::study::{self, Key};

/// Error above which a method has failed.
const FAILED: f64 = 0.3;

pub(super) fn check(runner: &Runner<'_>, claims: &mut Claims) {
    let view = View::new(runner, "interior");
    let level = view.common_level();
    for variant in case("interior").variants().into_iter().filter(|v| v.method == "gfdm-classical") {
        for jump in [1e4, 1e10] {
            let claim = format!("{} fails: error, jump {jump:e}", variant.label());
            claims.at_least("interior", claim, view.error(variant, jump, level), FAILED);
        }
    }
    let negative = |variant| {
        largest(
            view.of(variant)
                .filter(|o| o.key.jump >= 1e4)
                .filter_map(|o| overshoot("interior").map(|f| f(o))),
        )
    };
    claims.at_least(
        "interior",
        "strong form without smoothing gives negative values",
        negative(Variant::strong(0, true)),
        1e-3,
    );
    for jump in [1e4, 1e10] {
        let claim = format!(
            "positivity-preserving hybrid violates the flux condition and does not converge: order, jump {jump:e}"
        );
        claims.at_most("interior", claim, view.order(POSITIVE, jump), 0.5);
        let worse = view.ratio((POSITIVE, jump), (HYBRID, jump), level);
        let claim =
            format!("conservative rows at the neighbours are needed: error without over with, jump {jump:e}");
        claims.at_least("interior", claim, worse, 10.0);
    }
    seeds(runner, claims);
    for jump in [1e2, 1e4, BEYOND] {
        let claim = format!("conservative hybrid, h = 0.025: error at a jump of {jump:e} over that at 1e10");
        claims.within("interior", claim, view.ratio((HYBRID, jump), (HYBRID, 1e10), CLAIMED), [0.8, 1.1]);
    }
    let lost = view.ratio((CONSERVATIVE, 1e10), (CONSERVATIVE, 1e8), CLAIMED);
    claims.at_most(
        "interior",
        "conservative method loses no digits to round-off (ours): error at 1e10 over that at 1e8, h = 0.025",
        lost,
        1.1,
    );
    let lost = view.ratio((CONSERVATIVE, BEYOND), (CONSERVATIVE, 1e8), CLAIMED);
    claims.at_most("interior", "nor at 1e12", lost, 1.1);
}

/// The constant inside depends on how the cells' faces lie along the interface, and so the error on the cloud.
fn seeds(runner: &Runner<'_>, claims: &mut Claims) {
    let of = |seed| Key { case: "interior", variant: HYBRID, jump: 1e10, level: CLAIMED, seed };
    let seeds = sweep::seeds(runner.options.effort);
    let errors: Option<Vec<f64>> =
        seeds.iter().map(|&seed| study::find(&runner.outcomes, &of(seed)).map(study::Outcome::l2)).collect();
    let sorted = errors.map(|mut e| {
        e.sort_by(f64::total_cmp);
        e
    });
    let median = sorted.as_ref().map(|e| e[e.len() / 2]);
    claims.at_most(
        "interior",
        format!("conservative hybrid, jump 1e10, h = 0.025: median over {} clouds", seeds.len()),
        median,
        7e-4,
    );
    let worst = sorted.as_ref().and_then(|e| e.last().copied());
    claims.at_most("interior", "the worst of these clouds", worst, 9e-4);
}
