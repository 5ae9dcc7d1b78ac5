//! What must hold with refinement patches.

use super::checks::CURVATURE;
use super::patches::{CASE, COARSE, PAYING, SCALES, UNIFORM};
use super::patches_in_space::{
    self, CASE as IN_SPACE, FINE, ONE, ONE_BY_M6, TORUS_BASES, TORUS_BY_M6, TORUS_ONE, TORUS_ORDERS, TWO,
};
use super::runs::Run;
use super::trees::{TREES, levels};
use super::{PATCH_ORDERS, SCALES_ORDER, paper};
use crate::verify::claims::Claims;
use crate::verify::options::{Effort, Options};

/// How far an observed order may be from that on one mesh.
const ORDER_MARGIN: f64 = 0.05;

/// Least order of M6*, whose error is of fifth order.
const M6_ORDER: f64 = 4.5;

/// How far the order of polynomials may stay below the number of their points: as far as that of M6*.
const POLYNOMIAL_MARGIN: f64 = 0.5;

/// Errors on nodes over those on cells.
const CENTRINGS: [f64; 2] = [0.95, 1.05];

/// How far from figures that have two digits.
const TWO_DIGITS: [f64; 2] = [0.9, 1.1];

/// Errors measured before with the same formulas: N0 = 256, orders 4, 6, 8, 10.
const FIGURES: [(&str, [f64; 4]); 2] = [
    ("one patch, shift", [3.7e-5, 2.8e-7, 4.5e-9, 1.4e-10]),
    ("ratio 3, shift", [7.4e-6, 2.5e-8, 1.9e-10, 2.8e-12]),
];

/// The error of a way of refining, by order and cells of the base mesh.
type Errors<'a> = dyn Fn(&str, usize, usize) -> Option<f64> + 'a;

pub(super) fn all(runs: &[Run], options: &Options, claims: &mut Claims) {
    let sizes = super::bases(options.effort);
    let (finest, before) = (sizes[sizes.len() - 1], sizes[sizes.len() - 2]);
    let found = |case: &str, name: &str, order: usize, n: usize| {
        runs.iter()
            .find(|r| r.case == case && r.variant == name && r.kernel == paper(order) && r.n == n)
            .map(|r| r.l2)
    };
    let error = |name: &str, order: usize, n: usize| found(CASE, name, order, n);
    let rate = |name: &str, order: usize| {
        error(name, order, before)
            .zip(error(name, order, finest))
            .map(|(coarse, fine)| (coarse / fine).log2())
    };
    for order in PATCH_ORDERS {
        let uniform = |n: usize| {
            runs.iter().find(|r| r.case == "bump" && r.kernel == paper(order) && r.n == n).map(|r| r.l2)
        };
        let reference = uniform(before).zip(uniform(finest)).map(|(coarse, fine)| (coarse / fine).log2());
        let difference =
            rate("one patch, shift", order).zip(reference).map(|(patch, one)| (patch - one).abs());
        let claim = format!("figure 5 (a), one patch, shift, m = {order}: order less that on one fine mesh");
        claims.at_most(CASE, claim, difference, ORDER_MARGIN);
        let ratio =
            error("one patch, shift", order, finest).zip(uniform(finest)).map(|(patch, one)| patch / one);
        claims.within(
            CASE,
            format!("m = {order}: one patch, shift, over the error of one fine mesh"),
            ratio,
            [0.98, 1.02],
        );
        for how in ["shift", "M6*"] {
            let one = error(&format!("one patch, {how}"), order, finest);
            let four = error(&format!("four patches, {how}"), order, finest);
            let claim = format!("figure 6 (a), m = {order}, {how}: four bordering patches over one");
            claims.within(CASE, claim, four.zip(one).map(|(four, one)| four / one), [0.99, 1.01]);
        }
    }
    for order in [6, 8, 10] {
        let claim = format!("figure 5 (b), one patch, M6*: order at m = {order}");
        claims.at_least(CASE, claim, rate("one patch, M6*", order), M6_ORDER);
    }
    let lifted = error("one patch, ten points", 10, finest).zip(error("one patch, M6*", 10, finest));
    claims.at_most(
        CASE,
        "polynomials through ten points lift the limit of M6*: error at m = 10 over that with M6*",
        lifted.map(|(ten, six)| ten / six),
        0.05,
    );
    for how in ["shift", "ten points"] {
        let [cells, nodes] =
            ["one patch", "nodes"].map(|centring| error(&format!("{centring}, {how}"), 6, finest));
        let claim = format!("m = 6, {how}: error on nodes over that on cells");
        claims.within(CASE, claim, nodes.zip(cells).map(|(nodes, cells)| nodes / cells), CENTRINGS);
    }
    if options.effort > Effort::Quick {
        for (points, name) in [(6.0, "one patch, six points"), (8.0, "one patch, eight points")] {
            let claim = format!("{name}: order at m = 10, {points} in theory");
            claims.at_least(CASE, claim, rate(name, 10), points - POLYNOMIAL_MARGIN);
        }
        figures(&error, claims);
    }
    if options.effort > Effort::Quick {
        let in_3d = |name: &str, order: usize, n: usize| found(IN_SPACE, name, order, n);
        in_space(&in_3d, claims);
        torus(runs, options.effort, [&in_3d, &error], claims);
    }
    scales(runs, options, claims);
}

/// The same in three dimensions.
fn in_space(error: &Errors<'_>, claims: &mut Claims) {
    let [before, finest] = patches_in_space::BASES;
    for order in patches_in_space::ORDERS {
        let rate = |name: &str| {
            error(name, order, before)
                .zip(error(name, order, finest))
                .map(|(coarse, fine)| (coarse / fine).log2())
        };
        let difference = rate(ONE).zip(rate(FINE)).map(|(patch, one)| (patch - one).abs());
        let claim = format!("{ONE}, m = {order}: order less that on one fine mesh");
        claims.at_most(IN_SPACE, claim, difference, ORDER_MARGIN);
        if order > 4 {
            let claim = format!("figure 5 (b), {ONE_BY_M6}: order at m = {order}");
            claims.at_least(IN_SPACE, claim, rate(ONE_BY_M6), M6_ORDER);
        }
        for (name, over, band) in [(ONE, FINE, [0.98, 1.02]), (TWO, ONE, [0.99, 1.01])] {
            let ratio = error(name, order, finest).zip(error(over, order, finest)).map(|(a, b)| a / b);
            claims.within(IN_SPACE, format!("m = {order}: error of {name} over that of {over}"), ratio, band);
        }
    }
}

/// The torus of figure 5 (b): what holds on one mesh holds with a patch, and M6* limits it as it limits the bump in two dimensions, whose
/// radius has as many cells at N/2.
fn torus(runs: &[Run], effort: Effort, [error, in_2d]: [&Errors<'_>; 2], claims: &mut Claims) {
    let [before, finest] = TORUS_BASES;
    let orders = if effort == Effort::Full { &PATCH_ORDERS[..] } else { &TORUS_ORDERS };
    for &order in orders {
        let whole = runs.iter().find(|r| r.case == "torus" && r.kernel == paper(order) && r.n == finest);
        let ratio = error(TORUS_ONE, order, finest).zip(whole).map(|(patch, one)| patch / one.l2);
        let claim = format!("figure 5, {TORUS_ONE}, m = {order}: error over that of one fine mesh");
        claims.within(IN_SPACE, claim, ratio, [0.98, 1.02]);
        let pair = error(TORUS_BY_M6, order, finest).zip(in_2d("one patch, M6*", order, finest / 2));
        let claim =
            format!("figure 5 (b), {TORUS_BY_M6}, m = {order}: error over that of the bump in 2-D at N/2");
        claims.within(IN_SPACE, claim, pair.map(|(torus, bump)| torus / bump), CURVATURE);
    }
    let rate =
        error(TORUS_BY_M6, 10, before).zip(error(TORUS_BY_M6, 10, finest)).map(|(a, b)| (a / b).log2());
    claims.at_least(IN_SPACE, format!("figure 5 (b), {TORUS_BY_M6}: order at m = 10"), rate, M6_ORDER);
}

/// Figures at N0 = 256.
fn figures(error: &Errors<'_>, claims: &mut Claims) {
    for (name, figures) in FIGURES {
        for (order, figure) in [4, 6, 8, 10].into_iter().zip(figures) {
            let claim = format!("{name}, N0 = 256, m = {order}: error over {figure:.1e}, measured before");
            claims.within(CASE, claim, error(name, order, 256).map(|e| e / figure), TWO_DIGITS);
        }
    }
}

/// What patches bring, and what they cannot do.
fn scales(runs: &[Run], options: &Options, claims: &mut Claims) {
    let find = |variant: &str, n: usize| {
        runs.iter()
            .find(|r| r.case == SCALES && r.variant == variant && r.kernel == paper(SCALES_ORDER) && r.n == n)
    };
    let one = runs.iter().filter(|r| r.case == SCALES && r.variant == UNIFORM).max_by_key(|r| r.n);
    let pair = one.and_then(|u| find(PAYING, u.n).map(|p| (p, u)));
    let seconds = |r: &Run| r.plan_seconds + r.solve_seconds;
    claims.at_most(
        SCALES,
        "two levels of patches on a base mesh that resolves the source: error over that of one mesh as fine as the finest",
        pair.map(|(p, u)| p.l2 / u.l2),
        1.25,
    );
    claims.at_most(
        SCALES,
        "points with these patches over those of that mesh",
        pair.map(|(p, u)| p.points as f64 / u.points as f64),
        0.2,
    );
    // Meshes that take milliseconds say more of what else the machine does than of patches.
    if options.effort > Effort::Quick {
        claims.at_most(
            SCALES,
            "seconds of plan and solve with these patches over those with that mesh",
            pair.map(|(p, u)| seconds(p) / seconds(u)),
            0.5,
        );
    }
    if options.effort > Effort::Quick {
        trees(runs, claims);
    }
    // Patches add what the base mesh smooths, not what it samples wrongly: its points must resolve the source.
    let limit = super::SCALES_LIMIT;
    claims.at_least(
        SCALES,
        "limit: a base mesh with four cells on the radius aliases, and patches do not repair that: error over that of one mesh",
        find(COARSE, limit).zip(find(UNIFORM, limit)).map(|(p, u)| p.l2 / u.l2),
        5.0,
    );
}

/// Patches by the estimate.
fn trees(runs: &[Run], claims: &mut Claims) {
    for (name, tolerance) in TREES {
        let run = runs.iter().find(|r| r.case == SCALES && r.variant == name);
        let claim = format!("{name} by the estimate: largest error of the velocity over the tolerance");
        claims.at_most(SCALES, claim, run.map(|r| r.linf / tolerance), 1.0);
        claims.at_most(
            SCALES,
            format!("{name}: points over those of one mesh as fine as the finest"),
            run.map(|r| r.points as f64 / (r.n * r.n) as f64),
            0.2,
        );
        claims.at_least(SCALES, format!("{name}: levels that were chosen"), run.map(levels), 2.0);
    }
}
