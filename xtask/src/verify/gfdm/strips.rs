//! Sections 3.1 and 3.4: two and three strips.

use super::checks::{FIRST_ORDER, overshoot};
use super::sweep::{CLAIMED, SEED};
use super::view::View;
use super::{HYBRID, POSITIVE, STRONG, Variant, radius};
use crate::verify::claims::Claims;
use crate::verify::options::Effort;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::Key;
use meshless::Solution;

/// Orders below this count as no convergence.
pub(super) const NO_ORDER: f64 = 0.3;

/// Rung for single looks at a solution, h = 0.05.
const LOOK: usize = 2;

/// Interaction radius on grids: no distance that occurs in a lattice, where round-off would decide who is a neighbour.
const GRID_SUPPORT: f64 = 3.1;

pub(super) fn two_strip(runner: &Runner<'_>, claims: &mut Claims) {
    let view = View::new(runner, "two-strip");
    smoothing_and_scaling(&view, claims);
    overshoots(&view, claims);
    hybrids(&view, claims);
    neumann(&view, claims);
    uniform_cloud(runner, claims);
}

/// Section 3.1, figures 5 and 6; also holds for the curved interface (section 3.2, figures 9 and 10).
pub(super) fn smoothing_and_scaling(view: &View<'_>, claims: &mut Claims) {
    let level = view.common_level();
    for jump in [1e2, 1e4, 1e10] {
        let claim =
            format!("strong form without scaling or smoothing does not converge, jump {jump:e}: order");
        claims.at_most(view.case, claim, view.order(Variant::strong(0, false), jump), NO_ORDER);
        for cycles in [1, 2] {
            let claim = format!("smoothing by {cycles} gives first order without scaling, jump {jump:e}");
            claims.at_least(view.case, claim, view.order(Variant::strong(cycles, false), jump), 0.75);
            let gain = view.ratio(
                (Variant::strong(cycles, false), jump),
                (Variant::strong(cycles, true), jump),
                level,
            );
            let claim = format!("scaling reduces the error, {cycles} cycles, jump {jump:e}: factor");
            claims.at_least(view.case, claim, gain, 1.0);
        }
        let gain = view.ratio((Variant::strong(0, false), jump), (Variant::strong(0, true), jump), level);
        claims.at_least(
            view.case,
            format!("scaling reduces the error, no smoothing, jump {jump:e}: factor"),
            gain,
            1.0,
        );
    }
    let susceptible = |cycles| {
        view.ratio((Variant::strong(cycles, true), 1e10), (Variant::strong(cycles, true), 1e2), level)
    };
    let relative = susceptible(0).zip(susceptible(2)).map(|(plain, smoothed)| plain / smoothed);
    claims.at_least(
        view.case,
        "smoothing makes the error depend less on the jump: growth from 1e2 to 1e10 without over with",
        relative,
        1.0,
    );
    let more = view.ratio((Variant::strong(2, true), 1e2), (Variant::strong(1, true), 1e2), level);
    claims.at_least(
        view.case,
        "more smoothing is not always better: error with 2 cycles over that with 1, jump 1e2",
        more,
        1.0,
    );
    let plain =
        view.error(Variant::strong(0, true), 1e2, 0).zip(view.error(STRONG, 1e2, 0)).map(|(a, b)| a / b);
    claims.at_most(
        view.case,
        "on a coarse cloud the unsmoothed coefficient can be better: error over that with 2 cycles, jump 1e2",
        plain,
        1.0,
    );
}

fn overshoots(view: &View<'_>, claims: &mut Claims) {
    let Some(overshoot) = overshoot(view.case) else { return };
    let at = |variant| view.at(variant, 1e10, view.common_level()).map(overshoot);
    claims.at_least(
        view.case,
        "strong form without scaling overshoots, jump 1e10",
        at(Variant::strong(0, false)),
        1e-4,
    );
    claims.at_least(
        view.case,
        "smoothing does not remove the overshoot, jump 1e10",
        at(Variant::strong(2, false)),
        1e-4,
    );
    let strong_neumann = view.at(HYBRID.with_strong_neumann(), 1e10, view.common_level()).map(overshoot);
    claims.at_least(
        view.case,
        "conservative hybrid with strong Neumann rows overshoots (ours), jump 1e10",
        strong_neumann,
        1e-6,
    );
}

fn hybrids(view: &View<'_>, claims: &mut Claims) {
    let level = view.common_level();
    let same = view.ratio((POSITIVE, 1e1), (Variant::strong(0, true), 1e1), level);
    claims.within(view.case, "a jump of 10 hides from the criterion: positivity-preserving error over that of the scaled strong form", same, [0.5, 2.0]);
    claims.at_most(
        view.case,
        "so it does not converge: order of the positivity-preserving hybrid, jump 10",
        view.order(POSITIVE, 1e1),
        FIRST_ORDER,
    );
    let better = view.ratio((POSITIVE, 1e10), (STRONG, 1e10), level);
    claims.at_most(
        view.case,
        "at a jump of 1e10 the hybrid is better than the strong form: error over error",
        better,
        1.0,
    );
    if view.effort > Effort::Quick {
        let error = |variant, jump| view.error(variant, jump, CLAIMED);
        claims.within(
            view.case,
            "strong form, no scaling, no smoothing, jump 1e10, h = 0.025",
            error(Variant::strong(0, false), 1e10),
            [0.05, 0.3],
        );
        claims.within(
            view.case,
            "strong form, scaled, 2 cycles, jump 1e10, h = 0.025",
            error(STRONG, 1e10),
            [5e-3, 2e-2],
        );
    }
    claims.at_most(
        view.case,
        "conservative hybrid, jump 1e10, h = 0.025",
        view.error(HYBRID, 1e10, CLAIMED),
        4e-4,
    );
}

fn neumann(view: &View<'_>, claims: &mut Claims) {
    let strong = HYBRID.with_strong_neumann();
    let gain = view.ratio((strong, 1e10), (HYBRID, 1e10), CLAIMED);
    claims.at_least(
        view.case,
        "conservative Neumann rows are needed (ours): error without over that with, jump 1e10, h = 0.025",
        gain,
        2.0,
    );
    claims.at_most(
        view.case,
        "with strong Neumann rows the hybrid stagnates (ours): order, jump 1e10",
        view.order(strong, 1e10),
        FIRST_ORDER,
    );
}

/// On a uniform cloud a small jump leaves every row diagonally dominant.
fn uniform_cloud(runner: &Runner<'_>, claims: &mut Claims) {
    let (case, jump) = ("two-strip", 1e1);
    let solve = |variant: Variant| {
        let variant = Variant { support: Some(GRID_SUPPORT), ..variant };
        let key = Key { case, variant, jump, level: LOOK, seed: SEED };
        let text = meshless_tests::kraus::two_strip(jump, radius(LOOK), SEED);
        crate::verify::runner::solve(&text, &key, Extra { grid: true, ..Extra::default() }).ok()
    };
    if !runner.options.wants(case, POSITIVE.method) {
        return;
    }
    let flagged = solve(POSITIVE).map(|s| s.report.nodes.flagged as f64);
    claims.at_most(
        case,
        "on a uniform cloud no row fails the criterion at a jump of 10: flagged nodes",
        flagged,
        0.0,
    );
}

pub(super) fn three_strip(runner: &mut Runner<'_>, claims: &mut Claims) {
    let (case, jump, strong) = ("three-strip", 1e6, HYBRID.with_strong_neumann());
    let view = View::new(runner, case);
    claims.at_most(
        case,
        "hybrid with strong Neumann rows does not converge: order, jumps 1e6 and 1e-4",
        view.order(strong, jump),
        NO_ORDER,
    );
    claims.at_least(
        case,
        "hybrid with conservative Neumann rows: order, jumps 1e6 and 1e-4",
        view.order(HYBRID, jump),
        FIRST_ORDER,
    );
    claims.at_most(
        case,
        "conservative hybrid, jumps 1e6 and 1e-4, h = 0.025",
        view.error(HYBRID, jump, CLAIMED),
        4e-4,
    );
    claims.within(
        case,
        "hybrid with strong Neumann rows, jumps 1e6 and 1e-4, h = 0.025",
        view.error(strong, jump, CLAIMED),
        [1e-2, 0.1],
    );
    flux_errors(runner, claims);
}

/// Figures 17 and 18: the error of the flux must be the same everywhere.
fn flux_errors(runner: &Runner<'_>, claims: &mut Claims) {
    let (case, jump) = ("three-strip", 1e6);
    let solve = |variant: Variant, grid: bool| {
        let key = Key { case, variant, jump, level: LOOK, seed: SEED };
        let text = meshless_tests::kraus::three_strip(jump, super::cases::RIGHT_JUMP, radius(LOOK), SEED);
        crate::verify::runner::solve(&text, &key, Extra { grid, ..Extra::default() }).ok()
    };
    if !runner.options.wants(case, HYBRID.method) {
        return;
    }
    let uniform =
        solve(Variant { support: Some(GRID_SUPPORT), ..HYBRID }, true).as_ref().and_then(fluctuation);
    claims.at_most(
        case,
        "on a uniform cloud the flux is the same everywhere: largest deviation over the flux",
        uniform.map(|f| f.largest),
        1e-6,
    );
    let irregular =
        |variant| solve(variant, false).as_ref().and_then(fluctuation).map(|f| f.mean_square.sqrt());
    let calmer =
        irregular(HYBRID.with_strong_neumann()).zip(irregular(HYBRID)).map(|(strong, kept)| strong / kept);
    claims.at_least(
        case,
        "conservative Neumann rows calm the flux: deviation (root mean square) without over with",
        calmer,
        2.0,
    );
}

/// Deviation of `-eta du/dx` from its mean, relative to the mean.
struct Fluctuation {
    largest: f64,
    mean_square: f64,
}

fn fluctuation(solution: &Solution) -> Option<Fluctuation> {
    let field = &solution.field;
    let flux: Vec<f64> =
        field.gradient.as_ref()?.iter().zip(&field.eta).map(|(g, eta)| -eta * g[0]).collect();
    let n = flux.len() as f64;
    let mean = flux.iter().sum::<f64>() / n;
    let deviation = || flux.iter().map(|q| (q - mean) / mean);
    Some(Fluctuation {
        largest: super::view::largest(deviation().map(f64::abs))?,
        mean_square: deviation().map(|d| d * d).sum::<f64>() / n,
    })
}
