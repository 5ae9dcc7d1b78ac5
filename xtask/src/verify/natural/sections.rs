//! What the report shows of each case.

use super::cases::Case;
use super::judge::judge;
use super::{AUTO, COMPARED, sharp};
use crate::verify::claims::short;
use crate::verify::figure::{Curve, Figure};
use crate::verify::ladder::{Error, rungs};
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Outcome, Picture, Section, Table};
use crate::verify::variant::Variant;

pub(super) fn section(runner: &Runner<'_>, case: &Case) -> Section {
    let parameters = case.parameters(runner.options.effort);
    let curves = |error: Error| -> Vec<Curve> {
        let plan = parameters.iter().map(|&jump| (format!("{jump:e}"), AUTO, jump));
        let others = COMPARED
            .into_iter()
            .chain([sharp(6)])
            .map(|v| (format!("{}, {:e}", v.label(), parameters[0]), v, parameters[0]));
        let curve = |(label, variant, jump): (String, Variant, f64)| {
            let key = Key { case: case.case, variant, jump, level: 0, seed: 1 };
            Curve { label, points: rungs(runner, &key, error) }
        };
        plan.chain(others).map(curve).filter(|c| !c.points.is_empty()).collect()
    };
    let figure = |kind: &str, caption: &str, y, error| Figure {
        name: format!("natural-{}-{kind}", case.case),
        caption: caption.to_owned(),
        x: "spacing of nodes",
        y,
        curves: curves(error),
        slope: Some(4.0),
    };
    let table = Table {
        caption: "Every run: true errors, and what the report said.".to_owned(),
        head: [
            "parameter",
            "method",
            "unknowns",
            "probes",
            "flux",
            "estimate",
            "error over estimate",
            "total (s)",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: runner.outcomes.iter().filter(|o| o.key.case == case.case).map(|o| row(case, o)).collect(),
    };
    Section {
        case: case.case,
        title: case.title,
        about: case.about,
        figures: vec![
            figure("probes", "Error of the probes. Dashed: fourth order.", "error of the probes", |r| {
                r.err_l2
            }),
            figure("flux", "Error of the flux. Dashed: fourth order.", "error of the flux", |r| {
                r.err_grad_linf
            }),
        ],
        pictures: picture(case, parameters[0]).into_iter().collect(),
        tables: vec![table],
    }
}

fn row(case: &Case, outcome: &Outcome) -> Vec<String> {
    let judged = judge(case, outcome);
    let figure = |x: Option<f64>| x.map_or_else(String::new, short);
    vec![
        format!("{:e}", outcome.key.jump),
        format!("{} ({})", outcome.key.variant.label(), outcome.report.method),
        outcome.row.unknowns.to_string(),
        figure(judged.values.map(|v| v[1])),
        figure(judged.flux),
        figure(outcome.report.estimate.l2),
        figure(judged.over_estimate),
        short(outcome.row.t_total),
    ]
}

fn picture(case: &Case, parameter: f64) -> Option<Picture> {
    let key = Key { case: case.case, variant: AUTO, jump: parameter, level: 1, seed: 1 };
    let text = (case.scene)(parameter, case.spacing(1), 1);
    let solution = runner::solve(&text, &key, Extra { picture: true, ..Extra::default() }).ok()?;
    Some(Picture {
        name: format!("natural-{}-solution", case.case),
        caption: format!("The solution, parameter {parameter:e}."),
        svg: solution.picture?.svg,
    })
}
