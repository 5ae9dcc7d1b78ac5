//! What the report shows of each case.

use super::cases::Ladder;
use super::checks::{Error, rungs};
use super::others;
use crate::verify::figure::{Curve, Figure};
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Picture, Section, find};
use crate::verify::variant::Variant;

pub(super) fn sections(runner: &Runner<'_>, ladders: &[Ladder]) -> Vec<Section> {
    let wanted = |case: &str| runner.options.wants_case(case);
    ladders.iter().filter(|l| wanted(l.case)).map(|ladder| section(runner, ladder)).collect()
}

fn section(runner: &Runner<'_>, ladder: &Ladder) -> Section {
    let variants: Vec<Variant> = ladder.variants.iter().copied().chain(others(ladder)).collect();
    let jump = ladder.contrasts[0];
    let key = |variant| Key { case: ladder.case, variant, jump, level: 0, seed: ladder.seeds[0] };
    let curves = |error: Error| -> Vec<Curve> {
        let curve = |&v: &Variant| Curve { label: v.label(), points: rungs(runner, &key(v), error) };
        variants.iter().map(curve).filter(|c| !c.points.is_empty()).collect()
    };
    let figure = |kind: &str, caption: String, x, y, curves, slope| Figure {
        name: format!("sharp-{}-{kind}", ladder.case),
        caption,
        x,
        y,
        curves,
        slope,
    };
    let (h, l2) = ("spacing of nodes", "relative L2 error of u");
    let cost = variants
        .iter()
        .map(|&v| Curve { label: v.label(), points: seconds(runner, ladder, &key(v)) })
        .filter(|c| !c.points.is_empty())
        .collect();
    Section {
        case: ladder.case,
        title: ladder.title,
        about: ladder.about,
        figures: vec![
            figure(
                "u",
                format!("Error of u, contrast {jump:e}. Dashed: fourth order."),
                h,
                l2,
                curves(|r| r.err_l2),
                Some(4.0),
            ),
            figure(
                "gradient",
                format!("Error of the gradient, contrast {jump:e}. Dashed: third order."),
                h,
                "relative maximum error of grad u",
                curves(|r| r.err_grad_linf),
                Some(3.0),
            ),
            figure(
                "cost",
                format!("Error against seconds from points to solution, same clouds.{}", beyond(ladder)),
                "seconds",
                l2,
                cost,
                None,
            ),
        ],
        pictures: picture(ladder).into_iter().collect(),
        tables: Vec::new(),
    }
}

/// Which methods cannot solve the problem, and why.
fn beyond(ladder: &Ladder) -> String {
    let all: Vec<String> = ladder.beyond.iter().map(|(method, why)| format!("{method} ({why})")).collect();
    if all.is_empty() { String::new() } else { format!(" Cannot solve it: {}.", all.join("; ")) }
}

/// Seconds and error of every rung.
fn seconds(runner: &Runner<'_>, ladder: &Ladder, key: &Key) -> Vec<(f64, f64)> {
    let rung = |level| {
        let row = &find(&runner.outcomes, &Key { level, ..*key })?.row;
        Some((row.t_total, row.err_l2?))
    };
    ladder.levels.clone().filter_map(rung).collect()
}

fn picture(ladder: &Ladder) -> Option<Picture> {
    let (jump, level, seed) = (ladder.contrasts[0], ladder.levels.start, ladder.seeds[0]);
    let key = Key { case: ladder.case, variant: ladder.variants[0], jump, level, seed };
    let text = (ladder.scene)(jump, super::spacing(level), seed);
    let solution = runner::solve(&text, &key, Extra { picture: true, ..Extra::default() }).ok()?;
    Some(Picture {
        name: format!("sharp-{}-solution", ladder.case),
        caption: "The solution on the coarsest cloud.".to_owned(),
        svg: solution.picture?.svg,
    })
}
