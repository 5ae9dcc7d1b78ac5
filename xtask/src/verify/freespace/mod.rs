//! Suite `freespace`: the convergence tests of Hejlesen and Walther (2016), section 3, and a comparison with another code.

mod checks;
mod patch_checks;
mod patches;
mod patches_in_space;
mod problems;
mod runs;
mod sections;
mod trees;

use meshless_freespace::Kernel;

use super::claims::Claims;
use super::options::{Effort, Options};
use super::runner::progress;
use super::study::Study;
use problems::Problem;
use runs::Run;

const SUITE: &str = "freespace";

pub(super) const ABOUT: &str = "Poisson's equation in free space: the bump in 2-D and the torus in 3-D of Hejlesen and Walther (2016) with Gaussian \
    kernels of order 2 to 20, the spectral and the truncated kernel; the product of bumps that another code was measured on.";

pub(super) const CASES: [&str; 7] =
    ["bump", "torus", "product-2d", "product-3d", patches::CASE, patches_in_space::CASE, patches::SCALES];

const METHOD: &str = "free-space";

/// As in the paper.
const fn paper(order: usize) -> Kernel {
    Kernel::Gaussian { order, smoothing: Some(2.0) }
}

/// Orders that patches are tried with.
const PATCH_ORDERS: [usize; 5] = [2, 4, 6, 8, 10];

/// The order for a source with two scales.
const SCALES_ORDER: usize = 6;

/// Cells of the finest mesh at which the base mesh of three levels is too coarse.
const SCALES_LIMIT: usize = 1024;

/// Orders that are looked at.
const ORDERS: [usize; 6] = [2, 4, 6, 8, 10, 20];

fn kernels() -> impl Iterator<Item = Kernel> {
    let ours = [10, 20].map(Kernel::gaussian);
    ORDERS.into_iter().map(paper).chain(ours).chain([Kernel::Spectral, Kernel::Truncated])
}

/// Points along the longest direction, for each effort.
fn sizes(case: &str, effort: Effort) -> &'static [usize] {
    match (case, effort) {
        ("bump", Effort::Quick) => &[32, 64, 128, 256, 512],
        ("bump", _) => &[32, 64, 128, 256, 512, 1024],
        ("torus", Effort::Quick) => &[32, 64],
        ("torus", Effort::Default) => &[32, 64, 128],
        ("torus", Effort::Full) => &[32, 64, 128, 256],
        ("product-2d", _) => &[64, 128, 256],
        (_, Effort::Quick) => &[32, 64],
        _ => &[32, 64, 128],
    }
}

/// Cells of the base mesh in each direction, where there are patches.
fn bases(effort: Effort) -> &'static [usize] {
    if effort == Effort::Quick { &[64, 128] } else { &[64, 128, 256] }
}

/// Cells of the one mesh that the source with two scales is solved on.
fn uniform_sizes(effort: Effort) -> &'static [usize] {
    match effort {
        Effort::Quick => &[128, 256, 512, 1024],
        Effort::Default => &[128, 256, 512, 1024, 2048],
        Effort::Full => &[128, 256, 512, 1024, 2048, 4096],
    }
}

fn refined(options: &Options) -> Vec<Result<Run, String>> {
    let mut runs = Vec::new();
    if options.wants(patches::CASE, METHOD) {
        for layout in &patches::LAYOUTS {
            for &n in bases(options.effort) {
                progress(&format!("{SUITE} {} {} {n}", patches::CASE, layout.name));
                runs.extend(PATCH_ORDERS.map(|order| patches::run(layout, order, n)));
            }
        }
    }
    if options.wants(patches_in_space::CASE, METHOD) && options.effort > Effort::Quick {
        for layout in patches_in_space::LAYOUTS {
            for n in layout.bases {
                progress(&format!("{SUITE} {} {} {n}", patches_in_space::CASE, layout.name));
                let orders = layout.orders(options.effort).iter();
                runs.extend(orders.map(|&order| patches_in_space::run(layout, order, n)));
            }
        }
    }
    if options.wants(patches::SCALES, METHOD) {
        let sizes = uniform_sizes(options.effort);
        progress(&format!("{SUITE} {}", patches::SCALES));
        runs.extend(sizes.iter().map(|&n| patches::uniform(SCALES_ORDER, n)));
        for &n in sizes.iter().filter(|n| **n >= 1024) {
            runs.extend(patches::LEVELS.map(|how| patches::refined(SCALES_ORDER, n, how)));
        }
        if options.effort > Effort::Quick {
            runs.extend(trees::TREES.map(|tree| trees::run(SCALES_ORDER, tree)));
        }
    }
    runs
}

pub(super) fn run(options: &Options) -> Study {
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let (mut runs, mut failures) = (Vec::new(), Vec::new());
    for case in CASES.into_iter().take(4).filter(|case| options.wants(case, METHOD)) {
        for &n in sizes(case, options.effort) {
            let done = match case {
                "bump" => ladder(case, problems::patch(n)),
                "torus" => ladder(case, problems::torus(n)),
                "product-2d" => ladder(case, problems::product::<2>(n)),
                _ => ladder(case, problems::product::<3>(n)),
            };
            for outcome in done {
                match outcome {
                    Ok(run) => runs.push(run),
                    Err(error) => failures.push(error),
                }
            }
        }
    }
    for outcome in refined(options) {
        match outcome {
            Ok(run) => runs.push(run),
            Err(error) => failures.push(error),
        }
    }
    checks::all(&runs, options, &mut claims);
    failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(failures.len() as f64), 0.0);
    Study {
        suite: SUITE,
        outcomes: runs.iter().map(|run| runs::outcome(run, &runs)).collect(),
        claims: claims.by_case(&CASES),
        sections: sections::sections(&runs),
    }
}

/// One problem with all kernels.
fn ladder<const D: usize>(
    case: &'static str,
    problem: Result<Problem<D>, String>,
) -> Vec<Result<Run, String>> {
    match problem {
        Err(error) => vec![Err(error)],
        Ok(problem) => kernels()
            .map(|kernel| {
                progress(&format!("{SUITE} {case} {} {}", problem.mesh.points()[0], runs::label(kernel)));
                runs::run(case, kernel, &problem)
            })
            .collect(),
    }
}
