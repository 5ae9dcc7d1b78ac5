//! What the report shows.

use meshless_freespace::Kernel;

use super::runs::{Run, label};
use super::{CASES, paper};
use crate::verify::claims::short;
use crate::verify::figure::{Curve, Figure};
use crate::verify::study::{Section, Table};

/// Curves that can be told apart in a diagram.
const MOST_CURVES: usize = 12;

/// Titles and texts of the cases.
const ABOUT: [(&str, &str); 7] = [
    (
        "Bump in 2-D",
        "Velocity of a circular patch of vorticity with compact support, section 3.1 of Hejlesen and Walther: relative L2 error.",
    ),
    ("Torus in 3-D", "Velocity of a ring of vorticity, section 3.1: relative L2 error."),
    ("Product of bumps, 2-D", "Potential, largest error: the problem that another code was measured on."),
    ("Product of bumps, 3-D", "The same in three dimensions."),
    (
        "Refinement patches",
        "The bump of radius 1/2 with patches, figures 5 and 6: relative L2 error over all points that no patch covers, or inside of the patch \
         where it cuts the source or there are two levels.",
    ),
    (
        "Refinement patches in 3-D",
        "A potential that is a bump of radius 1/2, and the torus of figure 5 (b), N cells across both: relative L2 error of the gradient, or of the velocity, where patches are.",
    ),
    (
        "A source with two scales",
        "A bump of radius 0.9 and one of radius 1/16: one mesh against a base mesh with two levels of patches round the narrow one, and with three \
         levels on a base mesh that is too coarse for it. N counts the finest cells.",
    ),
];

pub(super) fn sections(runs: &[Run]) -> Vec<Section> {
    let cases = CASES.iter().zip(ABOUT).filter(|(case, _)| runs.iter().any(|r| r.case == **case));
    cases.map(|(&case, (title, about))| section(runs, case, title, about)).collect()
}

fn section(runs: &[Run], case: &'static str, title: &'static str, about: &'static str) -> Section {
    let error = |r: &Run| if case.starts_with("product") { r.worst } else { r.l2 };
    // Kernels, and ways of refining, in the order of the runs.
    let mut kinds: Vec<(Kernel, &'static str)> = Vec::new();
    for run in runs.iter().filter(|r| r.case == case) {
        if !kinds.contains(&(run.kernel, run.variant)) {
            kinds.push((run.kernel, run.variant));
        }
    }
    let name = |(kernel, variant): &(Kernel, &'static str)| match *variant {
        "" => label(*kernel),
        variant => format!("{}, {variant}", label(*kernel).replace(", sigma = 2 h", "")),
    };
    let of = |&(kernel, variant): &(Kernel, &'static str)| {
        runs.iter().filter(move |r| r.case == case && r.kernel == kernel && r.variant == variant)
    };
    // Of many curves, those of the highest order tell the ways of refining apart.
    let drawn = |kind: &&(Kernel, &'static str)| kinds.len() <= MOST_CURVES || kind.0 == paper(10);
    let curves = |x: fn(&Run) -> f64| -> Vec<Curve> {
        kinds
            .iter()
            .filter(drawn)
            .map(|kind| Curve { label: name(kind), points: of(kind).map(|r| (x(r), error(r))).collect() })
            .collect()
    };
    let y = if case.starts_with("product") { "largest error" } else { "relative L2 error" };
    let convergence = Figure {
        name: format!("freespace-{case}"),
        caption: "Error against spacing, one curve for each kernel.".to_owned(),
        x: "spacing",
        y,
        curves: curves(|r| r.spacing),
        slope: Some(10.0),
    };
    let cost = Figure {
        name: format!("freespace-{case}-cost"),
        caption: "Error against seconds of the plan and one solve.".to_owned(),
        x: "seconds",
        y,
        curves: curves(|r| r.plan_seconds + r.solve_seconds),
        slope: None,
    };
    let mut sizes: Vec<usize> = runs.iter().filter(|r| r.case == case).map(|r| r.n).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let row = |kind: &(Kernel, &'static str)| {
        let at = |n: &usize| of(kind).find(|r| r.n == *n).map_or_else(String::new, |r| short(error(r)));
        std::iter::once(name(kind)).chain(sizes.iter().map(at)).collect()
    };
    let head = std::iter::once("kernel".to_owned()).chain(sizes.iter().map(|n| format!("N = {n}")));
    let table = Table {
        caption: "Errors by points along the longest direction.".to_owned(),
        head: head.collect(),
        rows: kinds.iter().map(row).collect(),
    };
    Section {
        case,
        title,
        about,
        figures: vec![convergence, cost],
        pictures: Vec::new(),
        tables: vec![table],
    }
}
