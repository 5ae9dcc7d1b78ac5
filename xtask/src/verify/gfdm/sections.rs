//! What the report shows of each case: diagrams, pictures, tables.

use meshless::Solution;
use meshless_output::Profile;

use super::cases::{CASES, Case};
use super::sweep::{CLAIMED, SEED};
use super::tables::{self, Fractions, Iterations};
use super::view::{EXACT, View};
use super::{HYBRID, POSITIVE, STRONG, Variant, radius};
use crate::verify::figure::{Curve, Figure};
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Outcome, Picture, Section};

/// The pictures and profiles are drawn at h = 0.05.
const DRAWN: usize = 2;

/// Size of a profile in pixels.
const PROFILE_SIZE: (u32, u32) = (560, 380);

pub(super) fn sections(
    runner: &Runner<'_>,
    fractions: &[Fractions],
    iterations: &[Iterations],
) -> Vec<Section> {
    let wanted = |case: &&Case| runner.options.wants_case(case.name);
    CASES
        .iter()
        .filter(wanted)
        .map(|case| {
            let view = View::new(runner, case.name);
            let mut tables = Vec::new();
            match case.name {
                "two-strip" if !fractions.is_empty() => tables.push(tables::show_fractions(fractions)),
                "interior" => tables.push(tables::show_iterations(iterations)),
                _ => {}
            }
            Section {
                case: case.name,
                title: case.title,
                about: case.about,
                figures: figures(&view, case),
                pictures: pictures(case),
                tables,
            }
        })
        .collect()
}

fn figures(view: &View<'_>, case: &Case) -> Vec<Figure> {
    let curves = |x: fn(&Outcome) -> f64| -> Vec<Curve> {
        let curve = |variant: Variant| {
            let mut rungs: Vec<&Outcome> =
                view.of(variant).filter(|o| o.key.jump == case.shown && o.key.seed == SEED).collect();
            rungs.sort_by_key(|o| o.key.level);
            Curve { label: variant.label(), points: rungs.iter().map(|o| (x(o), o.l2())).collect() }
        };
        shown_variants(case).into_iter().map(curve).filter(|c| !c.points.is_empty()).collect()
    };
    let figure = |kind: &str, caption: String, x, curves, slope| Figure {
        name: format!("gfdm-{}-{kind}", case.name),
        caption,
        x,
        y: "relative L2 error",
        curves,
        slope,
    };
    let level = CLAIMED - 1;
    vec![
        figure(
            "convergence",
            format!("Error against spacing, jump {:e}. Dashed: first order.", case.shown),
            "spacing of nodes",
            curves(|o| o.row.spacing),
            Some(1.0),
        ),
        figure(
            "cost",
            format!("Error against seconds from points to solution, all methods, jump {:e}.", case.shown),
            "seconds",
            curves(|o| o.row.t_total),
            None,
        ),
        figure(
            "jump",
            format!("Error against the jump, h = {}.", radius(level)),
            "jump of the coefficient",
            over_jumps(view, case, level),
            None,
        ),
    ]
}

/// Ours first, so that a method has the same colour in all diagrams.
fn shown_variants(case: &Case) -> Vec<Variant> {
    let mut variants = case.variants();
    variants.sort_by_key(|v| v.method == STRONG.method);
    variants
}

fn over_jumps(view: &View<'_>, case: &Case, level: usize) -> Vec<Curve> {
    let curve = |variant: Variant| {
        let mut points: Vec<(f64, f64)> = view
            .of(variant)
            .filter(|o| o.key.level == level && o.l2() > EXACT)
            .map(|o| (o.key.jump, o.l2()))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Curve { label: variant.label(), points }
    };
    shown_variants(case).into_iter().map(curve).filter(|c| !c.points.is_empty()).collect()
}

fn pictures(case: &Case) -> Vec<Picture> {
    let mut pictures = Vec::new();
    let text = (case.scene)(case.shown, radius(DRAWN), SEED);
    let solve = |variant: Variant| {
        let key = Key { case: case.name, variant, jump: case.shown, level: DRAWN, seed: SEED };
        runner::solve(&text, &key, Extra { picture: variant == HYBRID, ..Extra::default() }).ok()
    };
    let hybrid = solve(HYBRID);
    if let Some(picture) = hybrid.as_ref().and_then(|s| s.picture.as_ref()) {
        pictures.push(Picture {
            name: format!("gfdm-{}-solution", case.name),
            caption: format!(
                "The solution by the conservative hybrid, jump {:e}, h = {}.",
                case.shown,
                radius(DRAWN)
            ),
            svg: picture.svg.clone(),
        });
    }
    let plain = Variant::strong(0, true);
    let others = [plain, STRONG, POSITIVE].map(|variant| (variant.label(), solve(variant)));
    let solutions = others.into_iter().chain([(HYBRID.label(), hybrid)]);
    let methods: Vec<(String, Solution)> = solutions.filter_map(|(label, s)| Some((label, s?))).collect();
    pictures.extend(profile(case, &methods));
    pictures
}

/// The solutions of several methods near y = 0 beside the exact one.
fn profile(case: &Case, methods: &[(String, Solution)]) -> Option<Picture> {
    let near = |s: &Solution| -> Vec<usize> {
        (0..s.field.u.len()).filter(|&i| s.field.points[i][1].abs() < 0.5 * s.report.spacing).collect()
    };
    let along = |s: &Solution, values: &[f64]| -> Vec<(f64, f64)> {
        near(s).into_iter().map(|i| (s.field.points[i][0], values[i])).collect()
    };
    let (_, last) = methods.last()?;
    let mut exact = along(last, last.field.exact.as_ref()?);
    exact.sort_by(|a, b| a.0.total_cmp(&b.0));
    let profile = Profile {
        title: String::new(),
        x_label: "x".to_owned(),
        u_label: "u at y ≈ 0".to_owned(),
        regions: methods.iter().map(|(label, s)| (label.clone(), along(s, &s.field.u))).collect(),
        exact,
    };
    Some(Picture {
        name: format!("gfdm-{}-profile", case.name),
        caption: format!("Nodes near y = 0, jump {:e}, h = {}.", case.shown, radius(DRAWN)),
        svg: profile.to_svg(PROFILE_SIZE.0, PROFILE_SIZE.1).ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::{CASES, shown_variants};

    #[test]
    fn the_strong_forms_come_last() {
        for case in &CASES {
            let variants = shown_variants(case);
            let first = variants.iter().position(|v| v.method == "gfdm-classical").unwrap_or(0);
            assert!(variants[first..].iter().all(|v| v.method == "gfdm-classical"));
        }
    }
}
