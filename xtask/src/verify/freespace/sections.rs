//! What the report shows.

use super::runs::{Run, label};
use super::{CASES, kernels};
use crate::verify::claims::short;
use crate::verify::figure::{Curve, Figure};
use crate::verify::study::{Section, Table};

/// Titles and texts of the cases.
const ABOUT: [(&str, &str); 4] = [
    (
        "Bump in 2-D",
        "Velocity of a circular patch of vorticity with compact support, section 3.1 of Hejlesen and Walther: relative L2 error.",
    ),
    ("Torus in 3-D", "Velocity of a ring of vorticity, section 3.1: relative L2 error."),
    ("Product of bumps, 2-D", "Potential, largest error: the problem that another code was measured on."),
    ("Product of bumps, 3-D", "The same in three dimensions."),
];

pub(super) fn sections(runs: &[Run]) -> Vec<Section> {
    let cases = CASES.iter().zip(ABOUT).filter(|(case, _)| runs.iter().any(|r| r.case == **case));
    cases.map(|(&case, (title, about))| section(runs, case, title, about)).collect()
}

fn section(runs: &[Run], case: &'static str, title: &'static str, about: &'static str) -> Section {
    let error = |r: &Run| if case.starts_with("product") { r.worst } else { r.l2 };
    let curves = |x: fn(&Run) -> f64| -> Vec<Curve> {
        kernels()
            .map(|kernel| Curve {
                label: label(kernel),
                points: runs
                    .iter()
                    .filter(|r| r.case == case && r.kernel == kernel)
                    .map(|r| (x(r), error(r)))
                    .collect(),
            })
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
    let row = |kernel| {
        let at = |n: &usize| {
            let run = runs.iter().find(|r| r.case == case && r.kernel == kernel && r.n == *n);
            run.map_or_else(String::new, |r| short(error(r)))
        };
        std::iter::once(label(kernel)).chain(sizes.iter().map(at)).collect()
    };
    let head = std::iter::once("kernel".to_owned()).chain(sizes.iter().map(|n| format!("N = {n}")));
    let table = Table {
        caption: "Errors by points along the longest direction.".to_owned(),
        head: head.collect(),
        rows: kernels().map(row).collect(),
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
