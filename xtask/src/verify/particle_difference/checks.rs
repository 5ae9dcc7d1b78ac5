//! Claims about the ladders.

use super::cases::{Expected, Ladder};
use super::{FORMER, FORMER_VARYING, GRID, OURS, PAPER, SEEDS};
use crate::verify::claims::Claims;
pub(super) use crate::verify::ladder::{Error, rungs};
use crate::verify::order;
use crate::verify::runner::Runner;
use crate::verify::study::{Key, find};
use crate::verify::variant::Variant;

/// The two errors that the paper has.
const ERRORS: [(&str, Error); 2] = [("u", |r| r.err_linf), ("gradient", |r| r.err_grad_linf)];

/// Gradient errors of one side over those of the other, below which neither is smeared.
const ONE_SIDED: f64 = 30.0;

/// Largest error of u over the smallest, over all contrasts of one sign.
const INSENSITIVE: f64 = 2.0;

fn fitted(runner: &Runner<'_>, key: &Key, error: Error) -> Option<f64> {
    let rungs = rungs(runner, key, error);
    // The paper has three rungs; more are shown.
    (rungs.len() > 2).then(|| order::fit(&rungs[..3])).flatten()
}

pub(super) fn ladder(runner: &Runner<'_>, ladder: &Ladder, claims: &mut Claims) {
    let key =
        |variant: Variant, seed| Key { case: ladder.case, variant, jump: ladder.contrast, level: 0, seed };
    let cloud = |seed| if seed == GRID { "regular" } else { "scattered" };
    for (which, (name, error)) in ERRORS.into_iter().enumerate() {
        if let Some(paper) = ladder.paper {
            let (measured, claim) = (
                fitted(runner, &key(PAPER, GRID), error),
                format!("as in the paper, regular cloud: order of {name}"),
            );
            match ladder.otherwise {
                Some((ours, why)) => claims.explained(
                    ladder.case,
                    claim,
                    measured,
                    [paper[which], f64::INFINITY],
                    [ours[which], paper[which]],
                    why,
                ),
                None => claims.at_least(ladder.case, claim, measured, paper[which]),
            }
        }
        for seed in SEEDS {
            match ladder.ours {
                Expected::Orders(orders) => claims.at_least(
                    ladder.case,
                    format!("ours, {} cloud: order of {name}", cloud(seed)),
                    fitted(runner, &key(OURS, seed), error),
                    orders[which],
                ),
                Expected::Errors(limits) => claims.at_most(
                    ladder.case,
                    format!("ours, {} cloud: largest error of {name} of all rungs", cloud(seed)),
                    rungs(runner, &key(OURS, seed), error).into_iter().map(|r| r.1).reduce(f64::max),
                    limits[which],
                ),
            }
        }
    }
    if let Expected::Orders(_) = ladder.ours {
        sides(runner, ladder, claims);
    }
    against_the_paper(runner, ladder, claims);
}

/// No smearing: the gradient is as good on one side of the interface as on the other.
fn sides(runner: &Runner<'_>, ladder: &Ladder, claims: &mut Claims) {
    let level = 2.min(ladder.most_rungs - 1);
    let key = Key { case: ladder.case, variant: OURS, jump: ladder.contrast, level, seed: 1 };
    let Some(errors) = find(&runner.outcomes, &key).and_then(|o| o.report.errors.as_ref()) else { return };
    let of: Vec<f64> = errors.regions.values().map(|r| r.gradient_linf).collect();
    let ratio = of.iter().copied().fold(0.0, f64::max) / of.iter().copied().fold(f64::INFINITY, f64::min);
    claims.at_most(
        ladder.case,
        "ours: gradient error of one side over that of the other",
        Some(ratio),
        ONE_SIDED,
    );
}

/// The changes are worth having: the error of the paper's variant over ours, at 6400 nodes.
fn against_the_paper(runner: &Runner<'_>, ladder: &Ladder, claims: &mut Claims) {
    let level = 2.min(ladder.most_rungs - 1);
    let error = |variant| {
        let key = Key { case: ladder.case, variant, jump: ladder.contrast, level, seed: 1 };
        find(&runner.outcomes, &key)?.row.err_linf
    };
    let ratio = error(PAPER).zip(error(OURS)).map(|(paper, ours)| paper / ours);
    claims.at_least(ladder.case, "error of the paper's variant over ours, scattered cloud", ratio, 4.0);
}

pub(super) fn contrast(runner: &Runner<'_>, contrasts: &[f64], claims: &mut Claims) {
    let key = |jump, level| Key { case: "contrast", variant: OURS, jump, level, seed: 1 };
    for &jump in contrasts {
        for ((name, error), least) in ERRORS.into_iter().zip([1.8, 1.1]) {
            let measured = fitted(runner, &key(jump, 0), error);
            claims.at_least("contrast", format!("{jump:e}: order of {name}"), measured, least);
        }
    }
    for (name, range) in [("1e-10 to 1e-4", 1e-10..=1e-4), ("1e4 to 1e10", 1e4..=1e10)] {
        let errors: Vec<f64> = contrasts
            .iter()
            .filter(|c| range.contains(*c))
            .filter_map(|&c| find(&runner.outcomes, &key(c, 2))?.row.err_linf)
            .collect();
        let spread =
            errors.iter().copied().fold(0.0, f64::max) / errors.iter().copied().fold(f64::INFINITY, f64::min);
        let measured = (!errors.is_empty()).then_some(spread);
        claims.at_most(
            "contrast",
            format!("{name}: largest error of u over the smallest"),
            measured,
            INSENSITIVE,
        );
    }
}

/// The jump of the slope as an unknown: orders of u and of the jump, and what the further unknowns cost.
pub(super) fn former(runner: &Runner<'_>, claims: &mut Claims) {
    for (case, contrast) in [("circle", 100.0), ("cylinder", 1.0)] {
        for (variant, label) in [(FORMER, "former method"), (FORMER_VARYING, "former method, varying")] {
            let key = Key { case, variant, jump: contrast, level: 0, seed: GRID };
            let order = fitted(runner, &key, |r| r.err_linf);
            claims.at_least(case, format!("{label}, regular cloud: order of u"), order, 0.8);
            let jumps: Vec<(f64, f64)> = (0..3)
                .filter_map(|level| {
                    let outcome = find(&runner.outcomes, &Key { level, ..key })?;
                    Some((outcome.row.spacing, outcome.report.errors.as_ref()?.jump_linf?))
                })
                .collect();
            // With one conductivity the equation of an unknown says what it is.
            if case == "circle" {
                let measured = (jumps.len() > 2).then(|| order::fit(&jumps)).flatten();
                claims.at_least(
                    case,
                    format!("{label}, regular cloud: order of the jump of the slope"),
                    measured,
                    0.7,
                );
            } else {
                let worst = jumps.iter().map(|j| j.1).reduce(f64::max);
                claims.at_most(
                    case,
                    format!("{label}, regular cloud: error of the jump of the slope"),
                    worst,
                    1e-9,
                );
            }
        }
    }
}
