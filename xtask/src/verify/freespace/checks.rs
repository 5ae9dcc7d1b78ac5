//! What must hold.

use meshless_freespace::Kernel;

use super::patch_checks;
use super::runs::Run;
use super::{ORDERS, paper};
use crate::verify::claims::Claims;
use crate::verify::options::{Effort, Options};

/// How far an observed order may be from the order of the kernel.
const ORDER_MARGIN: f64 = 0.15;

/// Relative error below which round-off shows in observed orders.
const ROUND_OFF: f64 = 3e-13;

/// Why a high order is not seen.
const FROM_BELOW: &str = "orders are reached from below as the mesh is refined, the later the higher they are; with sigma = 2h the tenth \
    reaches round-off first";

/// Errors on the torus over those on the bump.
pub(super) const CURVATURE: [f64; 2] = [0.85, 1.15];

/// How far from figures that others measured for the same formulas: they have two or three digits.
const DIGITS: [f64; 2] = [0.97, 1.03];

/// Figures of an earlier implementation of the same formulas, sigma = 2h: order, points, relative L2 error of the velocity.
const BUMP: [(usize, usize, f64); 10] = [
    (2, 64, 9.75e-2),
    (4, 64, 8.10e-3),
    (6, 64, 7.41e-4),
    (8, 64, 1.07e-4),
    (10, 64, 2.34e-5),
    (2, 256, 6.56e-3),
    (4, 256, 3.71e-5),
    (6, 256, 2.77e-7),
    (8, 256, 4.49e-9),
    (10, 256, 1.41e-10),
];
const TORUS: [(usize, usize, f64); 10] = [
    (2, 64, 0.320),
    (4, 64, 8.83e-2),
    (6, 64, 2.29e-2),
    (8, 64, 6.54e-3),
    (10, 64, 2.37e-3),
    (2, 128, 9.87e-2),
    (4, 128, 8.30e-3),
    (6, 128, 7.59e-4),
    (8, 128, 1.08e-4),
    (10, 128, 2.35e-5),
];

/// Largest errors of another code with the same kernels, sigma = 2h.
const OTHER_3D: [(usize, [f64; 3]); 5] = [
    (2, [0.330, 0.107, 0.0286]),
    (4, [0.0914, 8.68e-3, 6.06e-4]),
    (6, [2.19e-2, 5.80e-4, 1.04e-5]),
    (8, [4.59e-3, 3.19e-5, 1.44e-7]),
    (10, [8.15e-4, 3.17e-6, 8.48e-9]),
];
const OTHER_2D: [(usize, [f64; 3]); 5] = [
    (2, [0.0726, 0.0192, 4.9e-3]),
    (4, [4.61e-3, 3.15e-4, 2.01e-5]),
    (6, [2.45e-4, 4.23e-6, 6.78e-8]),
    (8, [1.58e-5, 1.04e-7, 4.74e-10]),
    (10, [2.52e-6, 7.70e-9, 1.14e-11]),
];
const OTHER_SPECTRAL_3D: [(usize, f64); 3] = [(32, 2.8e-8), (64, 1.5e-12), (128, 2.3e-15)];

pub(super) fn all(runs: &[Run], options: &Options, claims: &mut Claims) {
    orders(runs, claims);
    for (case, figures) in [("bump", &BUMP), ("torus", &TORUS)] {
        for &(order, n, figure) in figures {
            if case == "torus" && n > 64 && options.effort == Effort::Quick {
                continue;
            }
            let ratio = find(runs, case, paper(order), n).map(|run| run.l2 / figure);
            let claim = format!(
                "error at m = {order}, N = {n} over {figure:.2e}, measured before with the same formulas"
            );
            claims.within(case, claim, ratio, DIGITS);
        }
    }
    let finest = runs.iter().filter(|r| r.case == "torus").map(|r| r.n).max().unwrap_or(64);
    torus_is_bump(runs, finest, claims);
    others(runs, "product-2d", &[64, 128, 256], &OTHER_2D, claims);
    let sizes = if options.effort == Effort::Quick { &[32, 64][..] } else { &[32, 64, 128] };
    others(runs, "product-3d", sizes, &OTHER_3D, claims);
    for &(n, figure) in OTHER_SPECTRAL_3D.iter().filter(|(n, _)| sizes.contains(n)) {
        let ours = find(runs, "product-3d", Kernel::Spectral, n).map(|run| run.worst);
        // The last of the figures is a few units of round-off.
        let limit = (1.1 * figure).max(2e-14);
        claims.at_most(
            "product-3d",
            format!("spectral, N = {n}: largest error; another code has {figure:.1e}"),
            ours,
            limit,
        );
    }
    floors(runs, claims);
    patch_checks::all(runs, options, claims);
}

fn find<'a>(runs: &'a [Run], case: &str, kernel: Kernel, n: usize) -> Option<&'a Run> {
    runs.iter().find(|r| r.case == case && r.kernel == kernel && r.n == n)
}

/// Orders on the finest pair of meshes that is not at round-off.
fn orders(runs: &[Run], claims: &mut Claims) {
    for order in ORDERS.into_iter().filter(|m| *m <= 10) {
        let ladder: Vec<&Run> = runs
            .iter()
            .filter(|r| r.case == "bump" && r.kernel == paper(order) && r.l2 > ROUND_OFF)
            .collect();
        let rate = match ladder[..] {
            [.., coarse, fine] => Some((coarse.l2 / fine.l2).ln() / (coarse.spacing / fine.spacing).ln()),
            _ => None,
        };
        let (m, claim) = (order as f64, format!("order of m = {order} on the finest meshes above round-off"));
        let band = [m - ORDER_MARGIN, m + ORDER_MARGIN];
        claims.explained("bump", claim, rate, band, [m - 1.0, m + ORDER_MARGIN], FROM_BELOW);
    }
}

/// The core of the torus has half as many points as the patch: the errors are those of the bump at N/2, curvature aside.
fn torus_is_bump(runs: &[Run], finest: usize, claims: &mut Claims) {
    for order in ORDERS {
        let pair =
            find(runs, "torus", paper(order), finest).zip(find(runs, "bump", paper(order), finest / 2));
        let claim =
            format!("m = {order}: error at N = {finest} over that of the bump in 2-D at N = {}", finest / 2);
        claims.within("torus", claim, pair.map(|(torus, bump)| torus.l2 / bump.l2), CURVATURE);
    }
}

/// The same errors as another code with the same kernels.
fn others(
    runs: &[Run],
    case: &'static str,
    sizes: &[usize],
    figures: &[(usize, [f64; 3])],
    claims: &mut Claims,
) {
    for &(order, errors) in figures {
        let worst = sizes
            .iter()
            .zip(errors)
            .map(|(&n, figure)| find(runs, case, paper(order), n).map(|run| run.worst / figure))
            .try_fold(0.0_f64, |worst, ratio| ratio.map(|r| worst.max((r - 1.0).abs())));
        let claim = format!(
            "m = {order}: largest error relative to another code with the same kernel, how far from 1"
        );
        claims.at_most(case, claim, worst, 0.03);
    }
}

/// Kernels of infinite order reach round-off.
fn floors(runs: &[Run], claims: &mut Claims) {
    for (case, limit) in [("bump", 1e-12), ("product-2d", 1e-13)] {
        for kernel in [Kernel::Spectral, Kernel::Truncated] {
            let best = runs.iter().filter(|r| r.case == case && r.kernel == kernel).max_by_key(|r| r.n);
            let claim = format!("{}: error on the finest mesh", super::runs::label(kernel));
            claims.at_most(case, claim, best.map(|r| if case == "bump" { r.l2 } else { r.worst }), limit);
        }
    }
}
