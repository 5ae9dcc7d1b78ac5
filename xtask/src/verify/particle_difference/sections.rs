//! What the report shows of each case.

use super::cases::{CONTRASTS, LADDERS, Ladder};
use super::checks::{Error, rungs};
use super::{OURS, PAPER, SEEDS, VARIANTS, cases};
use crate::verify::figure::{Curve, Figure};
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Picture, Section, find};

/// Seed of the diagrams: scattered clouds.
const SHOWN: u64 = SEEDS[1];

pub(super) fn sections(runner: &Runner<'_>) -> Vec<Section> {
    let wanted = |case: &str| runner.options.wants_case(case);
    let mut sections: Vec<Section> =
        LADDERS.iter().filter(|l| wanted(l.case)).map(|ladder| section(runner, ladder)).collect();
    if wanted("slit") {
        sections.push(super::slit::section(runner));
    }
    if wanted("contrast") {
        sections.push(contrast(runner));
    }
    sections
}

fn section(runner: &Runner<'_>, ladder: &Ladder) -> Section {
    let key = |variant| Key { case: ladder.case, variant, jump: ladder.contrast, level: 0, seed: SHOWN };
    let curves = |error: Error| -> Vec<Curve> {
        VARIANTS
            .into_iter()
            .map(|v| Curve { label: v.label(), points: rungs(runner, &key(v), error) })
            .filter(|c| !c.points.is_empty())
            .collect()
    };
    let figure = |kind: &str, caption: &str, y, curves, slope| Figure {
        name: format!("particle-difference-{}-{kind}", ladder.case),
        caption: caption.to_owned(),
        x: if kind == "cost" { "seconds" } else { "spacing of nodes" },
        y,
        curves,
        slope,
    };
    let cost = VARIANTS
        .into_iter()
        .map(|variant| Curve { label: variant.label(), points: seconds(runner, &key(variant)) })
        .filter(|c| !c.points.is_empty())
        .collect();
    let u = "relative maximum error of u";
    Section {
        case: ladder.case,
        title: ladder.title,
        about: ladder.about,
        figures: vec![
            figure(
                "u",
                "Error of u, scattered clouds. Dashed: second order.",
                u,
                curves(|r| r.err_linf),
                Some(2.0),
            ),
            figure(
                "gradient",
                "Error of the gradient. Dashed: first order.",
                "relative maximum error of grad u",
                curves(|r| r.err_grad_linf),
                Some(1.0),
            ),
            figure("cost", "Error against seconds from points to solution, same clouds.", u, cost, None),
        ],
        pictures: picture(ladder).into_iter().collect(),
        tables: Vec::new(),
    }
}

/// Seconds and error of every rung.
fn seconds(runner: &Runner<'_>, key: &Key) -> Vec<(f64, f64)> {
    (0..LADDERS[0].most_rungs)
        .filter_map(|level| {
            let row = &find(&runner.outcomes, &Key { level, ..*key })?.row;
            Some((row.t_total, row.err_linf?))
        })
        .collect()
}

fn picture(ladder: &Ladder) -> Option<Picture> {
    let key = Key { case: ladder.case, variant: OURS, jump: ladder.contrast, level: 1, seed: SHOWN };
    let text = (ladder.scene)(1, cases::regularity(SHOWN));
    let solution = runner::solve(&text, &key, Extra { picture: true, ..Extra::default() }).ok()?;
    Some(Picture {
        name: format!("particle-difference-{}-solution", ladder.case),
        caption: "The solution on the second cloud.".to_owned(),
        svg: solution.picture?.svg,
    })
}

/// Error against the contrast.
fn contrast(runner: &Runner<'_>) -> Section {
    let curve = |variant| Curve {
        label: crate::verify::variant::Variant::label(&variant),
        points: CONTRASTS
            .into_iter()
            .filter_map(|jump| {
                let key = Key { case: "contrast", variant, jump, level: 2, seed: 1 };
                Some((jump, find(&runner.outcomes, &key)?.row.err_linf?))
            })
            .collect(),
    };
    let figure = Figure {
        name: "particle-difference-contrast".to_owned(),
        caption: "Error against the contrast, 6400 scattered nodes.".to_owned(),
        x: "conductivity outside",
        y: "relative maximum error of u",
        curves: [OURS, PAPER].map(curve).into_iter().filter(|c| !c.points.is_empty()).collect(),
        slope: None,
    };
    Section {
        case: "contrast",
        title: "Contrasts",
        about: "The disc of section 3.2 in surroundings of conductivity 1e-10 to 1e10. A stiff disc floats in soft \
                surroundings: the largest values are outside, where the flux that leaves the disc decides.",
        figures: vec![figure],
        pictures: Vec::new(),
        tables: Vec::new(),
    }
}
