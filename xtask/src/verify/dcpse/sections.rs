//! What the report shows of each case.

use super::cases::particles;
use super::{CONSTRAINED, LAYOUTS, SCATTERED, VARIANTS};
use crate::verify::claims::short;
use crate::verify::figure::{Curve, Figure};
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Picture, Section, Table, find, ladder};
use crate::verify::variant::Variant;
use meshless_tests::fietier::{inclusions, shells};

/// Spacing of the pictures.
const SHOWN_SPACING: f64 = 5.0;

pub(super) fn sections(runner: &Runner<'_>) -> Vec<Section> {
    let about = [
        (
            "dipole",
            "Dipole in one dimension",
            "Section 3.1. The flux jumps by 480/7, the diffusivity by 31/28.",
        ),
        (
            "shells",
            "Three shells",
            "Section 3.2: spacings 8, 4, 2 and 4/3. Prescribed slope on the outer surface.",
        ),
        ("inclusions", "Two inclusions", "Section 5.3. Errors are over the twelve points of the reference."),
    ];
    about
        .into_iter()
        .filter(|(case, ..)| runner.options.wants_case(case))
        .map(|(case, title, about)| section(runner, case, title, about))
        .collect()
}

fn section(runner: &Runner<'_>, case: &'static str, title: &'static str, about: &'static str) -> Section {
    let key = |variant, seed| Key { case, variant, jump: 0.0, level: 0, seed };
    let curves = |points: &dyn Fn(&Key) -> Vec<(f64, f64)>| -> Vec<Curve> {
        VARIANTS
            .into_iter()
            .map(|v| (v, LAYOUTS.map(|l| points(&key(v, l.0)))))
            // The scattered cloud, or where a variant was not run on it, the lattice.
            .map(|(v, [lattice, _, scattered])| Curve {
                label: v.label(),
                points: if scattered.is_empty() { lattice } else { scattered },
            })
            .filter(|c| !c.points.is_empty())
            .collect()
    };
    let error = |key: &Key| ladder(&runner.outcomes, key);
    let cost = |key: &Key| -> Vec<(f64, f64)> {
        (0..5)
            .filter_map(|level| {
                let row = &find(&runner.outcomes, &Key { level, ..*key })?.row;
                Some((row.t_total, row.err_l2?))
            })
            .collect()
    };
    let y = "relative error of u in l2";
    let figures = vec![
        Figure {
            name: format!("dcpse-{case}-u"),
            caption: "Error of u. Dashed: second order.".to_owned(),
            x: "spacing of nodes",
            y,
            curves: curves(&error),
            slope: Some(2.0),
        },
        Figure {
            name: format!("dcpse-{case}-cost"),
            caption: "Error against seconds from points to solution on one thread.".to_owned(),
            x: "seconds",
            y,
            curves: curves(&cost),
            slope: None,
        },
    ];
    Section {
        case,
        title,
        about,
        figures,
        pictures: picture(case).into_iter().collect(),
        tables: vec![table(runner, case)],
    }
}

/// Every ladder in numbers.
fn table(runner: &Runner<'_>, case: &'static str) -> Table {
    let mut rows = Vec::new();
    for variant in VARIANTS {
        for (seed, layout) in LAYOUTS {
            let rungs = ladder(&runner.outcomes, &Key { case, variant, jump: 0.0, level: 0, seed });
            if rungs.is_empty() {
                continue;
            }
            let errors: Vec<String> = rungs.iter().map(|r| format!("{:.2e}", r.1)).collect();
            let order = crate::verify::order::fit(&rungs).map_or_else(String::new, short);
            rows.push(vec![Variant::label(&variant), layout.to_owned(), errors.join(", "), order]);
        }
    }
    Table {
        caption: "Errors from the coarsest spacing to the finest, and the order over all of them.".to_owned(),
        head: ["method", "cloud", "errors", "order"].map(str::to_owned).to_vec(),
        rows,
    }
}

fn picture(case: &'static str) -> Option<Picture> {
    let text = match case {
        "shells" => shells(SHOWN_SPACING, particles(SCATTERED)),
        "inclusions" => inclusions(SHOWN_SPACING, particles(SCATTERED)),
        _ => return None,
    };
    let key = Key { case, variant: CONSTRAINED, jump: 0.0, level: 0, seed: SCATTERED };
    let solution = runner::solve(&text, &key, Extra { picture: true, ..Extra::default() }).ok()?;
    Some(Picture {
        name: format!("dcpse-{case}-solution"),
        caption: format!("The solution in the plane z = 0, spacing {SHOWN_SPACING}."),
        svg: solution.picture?.svg,
    })
}
