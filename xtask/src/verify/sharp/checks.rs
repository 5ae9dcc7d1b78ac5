//! Claims.

use super::cases::Ladder;
use super::singles;
use crate::verify::claims::Claims;
pub(super) use crate::verify::ladder::{Error, rungs};
use crate::verify::options::Effort;
use crate::verify::order;
use crate::verify::runner::Runner;
use crate::verify::study::{Key, find};
use crate::verify::variant::Variant;

/// Least orders of u and of its gradient, by the order of the polynomials: theory has p and p - 1.
const ORDERS: [(usize, [f64; 2]); 3] = [(2, [1.8, 1.3]), (4, [3.7, 3.0]), (6, [5.3, 4.8])];

/// Least orders of u in space on the clouds of about 7,000 and 60,000 nodes, and their largest spacing.
const FINE_ORDERS: [(usize, f64); 2] = [(4, 3.5), (6, 5.0)];
const FINE: f64 = 0.11;

/// Where three rungs are all there is, the coarsest of which resolves the interface by a few nodes.
const QUICK_MARGIN: f64 = 0.4;

/// Errors that only round-off is left of: no order is measured on them.
const ROUND_OFF: f64 = 1e-12;

/// Largest error, over that at the smallest contrast.
const SPREAD: f64 = 3.0;

/// In the quick sweep, the largest error of the gradient on the finest cloud in place of its order: case, order of the polynomials,
/// bound. Balances make the gradient of the star 75, 4 and 0.8 times as accurate as collocation on its three clouds, so that the slope
/// through them says nothing; four clouds and three seeds in longer sweeps give 3.2.
const GRADIENT_BY_ERROR: [(&str, usize, f64); 1] = [("star", 4, 5e-4)];

/// Orders of u and of its gradient over all seeds and contrasts at once, and the spread over the contrasts.
pub(super) fn ladder(runner: &Runner<'_>, ladder: &Ladder, claims: &mut Claims) {
    let errors: [(&str, Error); 2] = [("u in L2", |r| r.err_l2), ("the gradient", |r| r.err_grad_linf)];
    let margin = if runner.options.effort == Effort::Quick { QUICK_MARGIN } else { 0.0 };
    for &variant in &ladder.variants {
        let Some(p) = variant.order else { continue };
        let Some((_, least)) = ORDERS.iter().find(|(order, _)| *order == p) else { continue };
        for &jump in &ladder.contrasts {
            for (which, (name, error)) in errors.into_iter().enumerate() {
                let key = |&seed: &u64| Key { case: ladder.case, variant, jump, level: 0, seed };
                let all: Vec<(f64, f64)> =
                    ladder.seeds.iter().flat_map(|seed| rungs(runner, &key(seed), error)).collect();
                let resolved: Vec<(f64, f64)> = all.iter().copied().filter(|(_, e)| *e > ROUND_OFF).collect();
                if resolved.is_empty() && !all.is_empty() {
                    let claim =
                        format!("contrast {jump:e}, p = {p}: {name} is exact, largest error of all clouds");
                    let largest = all.iter().map(|(_, e)| *e).reduce(f64::max);
                    claims.at_most(ladder.case, claim, largest, ROUND_OFF);
                    continue;
                }
                let by_error = |(case, order, _): &&(&str, usize, f64)| {
                    runner.options.effort == Effort::Quick
                        && which == 1
                        && (*case, *order) == (ladder.case, p)
                };
                if let Some((.., most)) = GRADIENT_BY_ERROR.iter().find(by_error) {
                    let finest = all.iter().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, error)| *error);
                    let claim =
                        format!("contrast {jump:e}, p = {p}: {name}, largest error on the finest cloud");
                    claims.at_most(ladder.case, claim, finest, *most);
                    continue;
                }
                let (clouds, least) = if ladder.smooth {
                    ("all clouds", least[which] - margin)
                } else {
                    ("coarse clouds in space", p as f64 - 1.5 - which as f64)
                };
                let claim = format!("contrast {jump:e}, p = {p}: order of {name}, {clouds}");
                claims.at_least(ladder.case, claim, order::fit(&resolved), least);
            }
        }
        if ladder.case == "ball" && runner.options.effort == Effort::Full {
            fine(runner, ladder, variant, claims);
        }
        if ladder.contrasts.len() > 1 && ladder.contrasts.iter().all(|&c| c >= 1e2) {
            spread(runner, ladder, variant, claims);
        }
    }
}

/// The order of u between 5,000 and 60,000 nodes in space.
fn fine(runner: &Runner<'_>, ladder: &Ladder, variant: Variant, claims: &mut Claims) {
    let Some((p, least)) = FINE_ORDERS.iter().find(|(order, _)| Some(*order) == variant.order) else {
        return;
    };
    for &jump in &ladder.contrasts {
        let key = Key { case: ladder.case, variant, jump, level: 0, seed: ladder.seeds[0] };
        let mut rungs = rungs(runner, &key, |r| r.err_l2);
        rungs.retain(|(spacing, _)| *spacing < FINE);
        let claim = format!("contrast {jump:e}, p = {p}: order of u in L2, 7,000 and 60,000 nodes");
        claims.at_least(ladder.case, claim, order::fit(&rungs), *least);
    }
}

fn spread(runner: &Runner<'_>, ladder: &Ladder, variant: Variant, claims: &mut Claims) {
    let worst = ladder.levels.clone().filter_map(|level| {
        let at = |&jump: &f64| {
            let key = Key { case: ladder.case, variant, jump, level, seed: ladder.seeds[0] };
            find(&runner.outcomes, &key)?.row.err_l2
        };
        let errors: Vec<f64> = ladder.contrasts.iter().map(at).collect::<Option<_>>()?;
        Some(errors.iter().fold(0.0_f64, |most, &e| most.max(e)) / errors.first()?)
    });
    let claim = format!("{}: largest error over that at 1e2, contrasts up to 1e10", variant.label());
    claims.at_most(ladder.case, claim, worst.reduce(f64::max), SPREAD);
}

/// Errors at given numbers of nodes.
pub(super) fn single(runner: &Runner<'_>, effort: Effort, claims: &mut Claims) {
    for single in singles::singles(effort) {
        let key = single.key;
        if runner.options.wants(key.case, "sharp") {
            let measured = find(&runner.outcomes, &key).and_then(|o| o.row.err_l2);
            claims.at_most(key.case, format!("{}: relative L2 error", single.what), measured, single.l2);
        }
    }
    let largest =
        find(&runner.outcomes, &Key { case: "disc", variant: super::sharp(6), jump: 1e2, level: 3, seed: 1 });
    if effort > Effort::Quick && runner.options.wants("disc", "sharp") {
        let measured = largest.and_then(|o| o.row.err_linf);
        claims.at_most("disc", "about 6000 nodes, order 6: relative maximum error", measured, 1e-9);
    }
}
