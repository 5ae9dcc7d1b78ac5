//! Claims that hold for every case: orders, insensitivity, conservation, maximum principle, reproducibility.

use super::cases::{CASES, case};
use super::sweep::{BEYOND, CLAIMED, SEED, climbs};
use super::view::{EXACT, View, spread};
use super::{BY_REGION, CONSERVATIVE, HYBRID, POSITIVE, radius};
use crate::verify::claims::Claims;
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Outcome};

/// Orders that count as first order.
pub(super) const FIRST_ORDER: f64 = 0.9;

/// How much the error may depend on the jump from 1e4 on.
const INSENSITIVE: f64 = 2.0;

/// Sums of rows and columns, relative to the diagonal.
const SUM_TOLERANCE: f64 = 1e-12;

/// How far the solution may leave its bounds, relative to the range of the data.
pub(super) const MAXIMUM_PRINCIPLE: f64 = 1e-10;

pub(super) fn check(runner: &mut Runner<'_>, claims: &mut Claims) {
    for case in &CASES {
        let view = View::new(runner, case.name);
        first_order(&view, claims);
        insensitive(&view, claims);
        conservation(&view, claims);
        maximum_principle(&view, claims);
    }
    reproducible(runner, claims);
}

fn first_order(view: &View<'_>, claims: &mut Claims) {
    for jump in case(view.case).jumps(view.effort) {
        if jump == 1.0 && case(view.case).strips {
            let largest = view.largest(HYBRID, |o| (o.key.jump == jump).then(|| o.l2()));
            claims.at_most(
                view.case,
                "conservative hybrid is exact where nothing jumps and u is linear",
                largest,
                EXACT,
            );
        } else if SMALL.contains(&jump) {
            small_jump(view, jump, claims);
        } else {
            let claim = format!("conservative hybrid converges at first order, jump {jump:e}");
            claims.at_least(view.case, claim, view.order(HYBRID, jump), FIRST_ORDER);
        }
    }
}

/// Jumps that spoil too few rows for the criterion to find the interface.
const SMALL: [f64; 2] = [1e1, 1e-1];

/// The paper's criterion overlooks small jumps; regions do not.
fn small_jump(view: &View<'_>, jump: f64, claims: &mut Claims) {
    claims.explained(
        view.case,
        format!("conservative hybrid converges at first order, jump {jump:e}"),
        view.order(HYBRID, jump),
        [FIRST_ORDER, f64::INFINITY],
        [-1.0, FIRST_ORDER],
        "The criterion of diagonal dominance does not see a jump of 10 (section 4 of the paper says so): rows across \
         the interface stay strong. Nodes can be chosen by region instead; see the next line.",
    );
    if jump > 1.0 {
        let claim = format!("nodes chosen by region: first order, jump {jump:e}");
        claims.at_least(view.case, claim, view.order(BY_REGION, jump), FIRST_ORDER);
    }
}

fn insensitive(view: &View<'_>, claims: &mut Claims) {
    let mut jumps = case(view.case).jumps(view.effort);
    if view.case == "interior" {
        jumps.push(BEYOND);
    }
    for (variant, level) in [(HYBRID, CLAIMED), (CONSERVATIVE, CLAIMED - 1)] {
        for (direction, upward) in [("up", true), ("down", false)] {
            let high = |j: &f64| if upward { *j >= 1e4 } else { *j <= 1e-4 };
            let high: Vec<f64> = jumps.iter().copied().filter(high).collect();
            let climbed = variant != HYBRID || high.iter().all(|&jump| climbs(view.effort, view.case, jump));
            let level = if climbed { level } else { CLAIMED - 1 };
            let errors: Option<Vec<f64>> =
                high.iter().map(|&jump| view.error(variant, jump, level)).collect();
            let claim = format!(
                "{}: error from a jump of 1e4 on, largest over smallest, {direction}",
                variant.label()
            );
            match errors {
                Some(errors) if errors.is_empty() => {}
                errors => claims.at_most(view.case, claim, errors.and_then(|e| spread(&e)), INSENSITIVE),
            }
        }
    }
}

fn conservation(view: &View<'_>, claims: &mut Claims) {
    let rows = view.largest(HYBRID, |o| Some(o.report.matrix.row_sum));
    claims.at_most(view.case, "conservative hybrid: sums of rows over the diagonal", rows, SUM_TOLERANCE);
    let rows = view.largest(CONSERVATIVE, |o| Some(o.report.matrix.row_sum));
    claims.at_most(view.case, "conservative: sums of rows over the diagonal", rows, SUM_TOLERANCE);
    let columns = view.largest(CONSERVATIVE, |o| Some(o.report.matrix.column_sum));
    claims.at_most(
        view.case,
        "conservative: discrete divergence theorem (22), sums of interior columns over the diagonal",
        columns,
        SUM_TOLERANCE,
    );
}

fn maximum_principle(view: &View<'_>, claims: &mut Claims) {
    for variant in [POSITIVE, HYBRID, CONSERVATIVE] {
        let sign = view.largest(variant, |o| Some(o.report.matrix.wrong_sign));
        let claim = format!("{}: off-diagonal entries of the wrong sign, over the diagonal", variant.label());
        claims.at_most(view.case, claim, sign, super::WRONG_SIGN);
        if let Some(overshoot) = overshoot(view.case) {
            let claim = format!("{}: maximum principle, how far u leaves its bounds", variant.label());
            claims.at_most(
                view.case,
                claim,
                view.largest(variant, |o| Some(overshoot(o))),
                MAXIMUM_PRINCIPLE,
            );
        }
    }
}

/// How far a solution leaves the bounds that the maximum principle gives for it; `None` where it gives none.
pub(super) fn overshoot(case: &str) -> Option<fn(&Outcome) -> f64> {
    match case {
        // Values from 1 to 2 are prescribed, and there is no source.
        "two-strip" | "three-strip" => {
            Some(|o| (1.0 - o.report.extrema.min).max(o.report.extrema.max - 2.0).max(0.0))
        }
        // The source is positive, and u vanishes on the boundary.
        "interior" => Some(|o| (-o.report.extrema.min).max(0.0)),
        _ => None,
    }
}

/// The same bits whatever the number of threads.
fn reproducible(runner: &Runner<'_>, claims: &mut Claims) {
    for case in &CASES {
        if !runner.options.wants(case.name, HYBRID.method) {
            continue;
        }
        let (jump, level) = (case.shown, 1);
        let text = (case.scene)(jump, radius(level), SEED);
        let key = Key { case: case.name, variant: HYBRID, jump, level, seed: SEED };
        let bits = |threads: usize| {
            meshless::on_threads(threads, || runner::solve(&text, &key, Extra::default()))
                .ok()?
                .ok()
                .map(|s| s.field.u.iter().map(|u| u.to_bits()).collect::<Vec<u64>>())
        };
        let different = bits(1).zip(bits(2)).map(|(one, two)| {
            let pairs = one.iter().zip(&two).filter(|(a, b)| a != b).count();
            (pairs + one.len().abs_diff(two.len())) as f64
        });
        claims.at_most(case.name, "nodes whose value depends on the number of threads", different, 0.0);
    }
}

pub(super) fn no_failures(runner: &Runner<'_>, claims: &mut Claims) {
    for failure in &runner.failures {
        eprintln!("run failed: {failure}");
    }
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
}
