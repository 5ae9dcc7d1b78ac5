//! Suite `adaptive`: scenes with one line of tolerance and none about the cloud, in which something small decides.

use std::f64::consts::PI;

use meshless::report::Report;
use meshless_tests::natural::adaptive::{self, to_tolerance};
use meshless_tests::natural::references::{self, Quantity};
use meshless_tests::natural::{corners, desk, plates};

use super::claims::{Claims, short};
use super::figure::{Curve, Figure};
use super::jobs::Job;
use super::options::{Effort, Options};
use super::order;
use super::runner::{Extra, Runner};
use super::study::{Key, Outcome, Section, Study, Table, find};
use super::variant::Variant;

const SUITE: &str = "adaptive";

pub(super) const ABOUT: &str = "Scenes that give an error to reach and say nothing of the cloud: corners, layers, gaps, films, narrow sources. Errors are against closed \
    forms and the references of the suite natural; times include all clouds that were tried, and the estimates.";

/// The plan chooses everything.
const AUTO: Variant = Variant { support: None, ..Variant::plain("auto") };

/// How many times smaller than the true error an estimate may be.
const HONEST: f64 = 10.0;

/// Errors below this are round-off, which no estimate knows.
const ROUND_OFF: f64 = 1e-10;

/// How the true error is told.
#[derive(Debug, Clone, Copy)]
enum Judged {
    /// By the closed form in the scene, over the whole.
    Exact,
    /// By the probes of a problem of the references, root mean square over that of the region where u is largest.
    Probes,
    /// By probes whose values are known, the largest error over the largest value.
    Known(fn(&[f64]) -> f64),
}

/// A problem.
struct Case {
    case: &'static str,
    title: &'static str,
    about: &'static str,
    scene: fn(f64, f64, u64) -> String,
    judged: Judged,
    runs: &'static [Run],
}

/// What it is solved to.
struct Run {
    parameter: f64,
    tolerance: f64,
    effort: Effort,
    /// Where the tolerance is known to be missed: up to which error, and why. An answer that says so counts as an error of 1.
    missed: Option<(f64, &'static str)>,
}

const fn run(parameter: f64, tolerance: f64) -> Run {
    Run { parameter, tolerance, effort: Effort::Default, missed: None }
}

const fn full(parameter: f64, tolerance: f64) -> Run {
    Run { effort: Effort::Full, ..run(parameter, tolerance) }
}

const HEATED: [Run; 3] = [run(10.0, 1e-4), run(1e-4, 1e-4), run(1e10, 1e-4)];

const fn heated(case: &'static str, title: &'static str, scene: fn(f64, f64, u64) -> String) -> Case {
    Case {
        case,
        title,
        about: "10 is made in each unit of area of a part in a plate whose sides are at 0; the parameter is the diffusivity of the part.",
        scene,
        judged: Judged::Probes,
        runs: &HEATED,
    }
}

const ALL: [Case; 13] = [
    Case {
        case: "l-shape",
        title: "L-shape",
        about: "u = r^(2/3) cos(2 t/3). The diagram has stencils of second order without functions for the corner, on even clouds and on such that adapt.",
        scene: corners::l_shape,
        judged: Judged::Exact,
        runs: &[run(1.0, 1e-6), run(1.0, 1e-8)],
    },
    Case {
        case: "kellogg",
        title: "Kellogg's quadrants",
        about: "u = r^0.1 mu(t), diffusivities of 161 and 1.",
        scene: corners::kellogg,
        judged: Judged::Exact,
        runs: &[run(1.0, 1e-2), run(1.0, 1e-3)],
    },
    Case {
        case: "mixed",
        title: "A side at 0 beside an insulated one",
        about: "u = r^(1/2) sin(t/2).",
        scene: corners::mixed,
        judged: Judged::Exact,
        runs: &[run(1.0, 1e-4), run(1.0, 1e-6)],
    },
    heated("heated-box", "Heated square", plates::heated_box),
    heated("heated-triangle", "Heated triangle", plates::heated_triangle),
    heated("heated-12-gon", "Heated 12-gon", plates::heated_12_gon),
    Case {
        case: "discs",
        title: "Two nearly touching discs",
        about: "The parameter is the gap over the radius; what flows from one to the other is given, and what they differ by is the inverse of the conductance, in closed form by bipolar coordinates.",
        scene: adaptive::discs,
        judged: Judged::Known(|x| x[0].signum()),
        runs: &[run(1e-2, 1e-3), run(1e-3, 1e-3)],
    },
    Case {
        case: "layer",
        title: "Interior layer",
        about: "u = tanh((x - 1/2)/w), the parameter is w. The diagram has it for w = 0.02 by order 6, on even clouds and to tolerances.",
        scene: adaptive::layer,
        judged: Judged::Exact,
        runs: &[
            run(1e-2, 1e-3),
            Run {
                missed: Some((
                    1.0,
                    "1.4e-3 on 122,000 nodes, which are as dense along the layer as across it",
                )),
                ..full(1e-3, 1e-3)
            },
        ],
    },
    Case {
        case: "point",
        title: "Narrow source",
        about: "1 is made in a spot in the middle of a disc; the parameter is the width of the spot.",
        scene: adaptive::point,
        judged: Judged::Known(|x| -x[0].hypot(x[1]).ln() / (2.0 * PI)),
        runs: &[run(1e-2, 1e-4), run(1e-3, 1e-4)],
    },
    Case {
        case: "iso-10211-1",
        title: "ISO 10211, case 1",
        about: "Two values meet in a corner of a column.",
        scene: desk::iso_10211_1,
        judged: Judged::Probes,
        runs: &[run(1.0, 1e-4)],
    },
    Case {
        case: "film",
        title: "Film",
        about: "A film of the parameter's thickness and diffusivity.",
        scene: adaptive::film,
        judged: Judged::Exact,
        runs: &[run(1e-2, 1e-3), full(1e-3, 1e-3)],
    },
    Case {
        case: "heated-cube",
        title: "Heated cube",
        about: "The same as the heated square, in space.",
        scene: desk::heated_cube,
        judged: Judged::Probes,
        runs: &[run(10.0, 1e-2), full(10.0, 1e-3)],
    },
    Case {
        case: "beam",
        title: "Beam with a section of an L",
        about: "u = (1 + z) r^(2/3) cos(2 t/3), in space.",
        scene: adaptive::beam,
        judged: Judged::Exact,
        runs: &[full(1.0, 1e-3)],
    },
];

pub(super) const CASES: [&str; ALL.len()] = {
    let mut names = [""; ALL.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = ALL[k].case;
        k += 1;
    }
    names
};

/// A spacing that is taken out of the scene again.
const ANY: f64 = 0.1;

pub(super) fn run_suite(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let runs =
        || ALL.iter().flat_map(|case| case.runs.iter().enumerate().map(move |(k, run)| (case, k, run)));
    let is_part = |run: &Run| run.effort <= options.effort;
    let job = |(case, number, run): (&Case, usize, &Run)| Job {
        problem: to_tolerance(&(case.scene)(run.parameter, ANY, 1), run.tolerance),
        key: key(case, number, run),
        extra: Extra { estimate: true, ..Extra::default() },
    };
    let mut jobs: Vec<Job> = runs().filter(|(_, _, run)| is_part(run)).map(job).collect();
    if options.effort > Effort::Quick {
        jobs.extend(DIAGRAMS.iter().flat_map(|diagram| diagram.curves.iter().flat_map(Ladder::jobs)));
    }
    runner.run_all(jobs);
    for (case, number, run) in runs().filter(|(_, _, run)| is_part(run)) {
        if options.wants(case.case, AUTO.method) {
            check(&runner, (case, number, run), &mut claims);
        }
    }
    DIAGRAMS.iter().for_each(|diagram| diagram.check(&runner, &mut claims));
    runner.failures.iter().for_each(|failure| eprintln!("run failed: {failure}"));
    let missed = runs()
        .filter(|(case, number, run)| {
            is_part(run)
                && run.missed.is_some()
                && options.wants(case.case, AUTO.method)
                && find(&runner.outcomes, &key(case, *number, run)).is_none()
        })
        .count();
    let failed = runner.failures.len().saturating_sub(missed) as f64;
    claims.at_most(
        "all",
        "runs that ended with an error, but those whose tolerance is known to be missed",
        Some(failed),
        0.0,
    );
    let sections = ALL.iter().filter(|case| options.wants(case.case, AUTO.method));
    let sections =
        sections.map(|case| section(&runner, case)).filter(|s| !s.tables[0].rows.is_empty()).collect();
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}

fn key(case: &Case, number: usize, run: &Run) -> Key {
    Key { case: case.case, variant: AUTO, jump: run.parameter, level: number, seed: 1 }
}

/// The true error of a run, and the estimate of the same.
fn judge(case: &Case, parameter: f64, report: &Report) -> Option<[f64; 2]> {
    let estimate = report.estimate.l2?;
    match case.judged {
        Judged::Exact => Some([report.errors.as_ref()?.l2, estimate]),
        Judged::Probes => {
            let figures = || references::of(case.case, parameter);
            let rms = figures().filter(|f| f.quantity == Quantity::Rms).map(|f| f.value);
            let values: Vec<f64> =
                figures().filter(|f| f.quantity == Quantity::Value).map(|f| f.value).collect();
            let of_values = (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
            // Where the table has no mean of u, that of its values stands for it.
            let scale = rms.reduce(f64::max).unwrap_or(of_values);
            let squares = figures().filter(|f| f.quantity == Quantity::Value).map(|figure| {
                let value = report.probes.iter().find(|p| p.at == figure.at)?.value?;
                Some(((value - figure.value).abs() - figure.uncertainty).max(0.0).powi(2))
            });
            let squares: Vec<f64> = squares.collect::<Option<_>>()?;
            let mean = squares.iter().sum::<f64>() / squares.len() as f64;
            (scale > 0.0 && !squares.is_empty()).then_some([mean.sqrt() / scale, estimate])
        }
        Judged::Known(value) => {
            let known = report.probes.iter().map(|p| Some((p.value? - value(&p.at), value(&p.at))));
            let known: Vec<(f64, f64)> = known.collect::<Option<_>>()?;
            let size = known.iter().map(|k| k.1.abs()).fold(0.0, f64::max);
            let error = known.iter().map(|k| k.0.abs()).fold(0.0, f64::max);
            (size > 0.0).then_some([error / size, estimate])
        }
    }
}

fn check(runner: &Runner<'_>, (case, number, run): (&Case, usize, &Run), claims: &mut Claims) {
    let outcome = find(&runner.outcomes, &key(case, number, run));
    let judged = outcome.and_then(|o| judge(case, run.parameter, &o.report));
    let what = format!("{:e} to {:e}", run.parameter, run.tolerance);
    let error = judged.map(|[error, _]| error);
    match run.missed {
        None => claims.at_most(case.case, format!("{what}: true error"), error, run.tolerance),
        Some((up_to, why)) => {
            let refused = outcome.is_none().then_some(1.0);
            let (holds, ours) = ([0.0, run.tolerance], [run.tolerance, up_to]);
            claims.explained(case.case, format!("{what}: true error"), error.or(refused), holds, ours, why);
        }
    }
    if outcome.is_some() || run.missed.is_none() {
        let ratio = judged.map(|[error, estimate]| if error > ROUND_OFF { error / estimate } else { 0.0 });
        claims.at_most(case.case, format!("{what}: true error over the estimate"), ratio, HONEST);
    }
}

/// Errors against nodes.
struct Diagram {
    case: &'static str,
    name: &'static str,
    caption: &'static str,
    curves: [Ladder; 2],
    /// The order in the nodes to the power of one half that the adapted clouds have at least.
    order: f64,
    /// How many times fewer nodes than even clouds they need at least, for the error of the finest of the latter.
    saved: f64,
}

/// Runs of a curve.
struct Ladder {
    case: &'static str,
    label: &'static str,
    variant: Variant,
    /// What tells it from the other runs of the case.
    seed: u64,
    scene: fn(usize) -> String,
    levels: usize,
}

impl Ladder {
    fn key(&self, level: usize) -> Key {
        Key { case: self.case, variant: self.variant, jump: 0.0, level, seed: self.seed }
    }

    fn jobs(&self) -> Vec<Job> {
        let job = |level| Job {
            problem: (self.scene)(level),
            key: self.key(level),
            extra: Extra { estimate: true, ..Extra::default() },
        };
        (0..self.levels).map(job).collect()
    }

    /// Nodes and true errors.
    fn points(&self, runner: &Runner<'_>) -> Vec<(f64, f64)> {
        let found = (0..self.levels).filter_map(|level| find(&runner.outcomes, &self.key(level)));
        found.map(|o| (o.row.unknowns as f64, o.l2())).collect()
    }
}

const CLASSICAL: Variant = Variant { support: None, ..Variant::plain("gfdm-classical") };
const SHARP_6: Variant = Variant { support: None, order: Some(6), ..Variant::plain("sharp") };

/// A scene with a key in `[points]`.
fn adapting(text: &str) -> String {
    text.replacen("[points]\n", "[points]\nadapt = true\n", 1)
}

fn l_shape_at(level: usize) -> String {
    corners::l_shape(1.0, 0.2 / f64::from(1_u32 << level), 1)
}

/// Width of the layer of the diagram.
const WIDTH: f64 = 0.02;

const DIAGRAMS: [Diagram; 2] = [
    Diagram {
        case: "l-shape",
        name: "adaptive-l-shape",
        caption: "Error against nodes, stencils of second order.",
        curves: [
            Ladder {
                case: "l-shape",
                label: "even clouds",
                variant: CLASSICAL,
                seed: 1,
                scene: l_shape_at,
                levels: 4,
            },
            Ladder {
                case: "l-shape",
                label: "clouds that adapt",
                variant: CLASSICAL,
                seed: 2,
                scene: |level| adapting(&l_shape_at(level)),
                levels: 4,
            },
        ],
        order: 1.6,
        saved: 4.0,
    },
    Diagram {
        case: "layer",
        name: "adaptive-layer",
        caption: "Error against nodes, a layer of width 0.02, order 6.",
        curves: [
            Ladder {
                case: "layer",
                label: "even clouds",
                variant: SHARP_6,
                seed: 1,
                scene: |level| adaptive::layer(WIDTH, 0.04 / f64::from(1_u32 << level), 1),
                levels: 4,
            },
            Ladder {
                case: "layer",
                label: "clouds that adapt",
                variant: SHARP_6,
                seed: 2,
                scene: |level| to_tolerance(&adaptive::layer(WIDTH, ANY, 1), 0.1_f64.powi(level as i32 + 1)),
                levels: 4,
            },
        ],
        order: 4.0,
        saved: 1.5,
    },
];

impl Diagram {
    fn figure(&self, runner: &Runner<'_>) -> Figure {
        let curve = |ladder: &Ladder| Curve { label: ladder.label.to_owned(), points: ladder.points(runner) };
        Figure {
            name: self.name.to_owned(),
            caption: self.caption.to_owned(),
            x: "nodes",
            y: "relative L2 error",
            curves: self.curves.iter().map(curve).collect(),
            slope: None,
        }
    }

    fn check(&self, runner: &Runner<'_>, claims: &mut Claims) {
        if runner.options.effort == Effort::Quick || !runner.options.wants_case(self.case) {
            return;
        }
        let [even, adapted] = self.curves.each_ref().map(|ladder| ladder.points(runner));
        let ends = |points: &[(f64, f64)]| Some((*points.first()?, *points.last()?));
        let observed = |points: &[(f64, f64)]| {
            let (first, last) = ends(points)?;
            order::between((first.0.powf(-0.5), first.1), (last.0.powf(-0.5), last.1))
        };
        let [of_even, of_adapted] = [observed(&even), observed(&adapted)];
        claims.at_least(self.case, "diagram: order in the nodes, clouds that adapt", of_adapted, self.order);
        // Nodes of an adapted cloud of the error of the finest even one, by the order between.
        let saved = ends(&even).zip(ends(&adapted)).zip(of_adapted).map(|((even, adapted), order)| {
            let nodes = adapted.1.0 * (adapted.1.1 / even.1.1).powf(2.0 / order);
            even.1.0 / nodes
        });
        let even = of_even.map_or_else(|| "?".to_owned(), short);
        claims.at_least(
            self.case,
            format!("diagram: nodes of the finest even cloud (order {even}) over those of an adapted one of the same error"),
            saved,
            self.saved,
        );
    }
}

fn section(runner: &Runner<'_>, case: &Case) -> Section {
    let row = |(number, run): (usize, &Run)| -> Option<Vec<String>> {
        let outcome: &Outcome = find(&runner.outcomes, &key(case, number, run))?;
        let report = &outcome.report;
        let judged = judge(case, run.parameter, report);
        let rungs = report.accuracy.iter().flat_map(|a| &a.rungs).map(|rung| rung.unknowns.to_string());
        let figure = |k: usize| judged.map_or_else(String::new, |j| short(j[k]));
        Some(vec![
            format!("{:e}", run.parameter),
            format!("{:e}", run.tolerance),
            format!("{}, order {}", report.method, report.order),
            rungs.collect::<Vec<_>>().join(", "),
            figure(1),
            figure(0),
            short(outcome.row.t_total),
        ])
    };
    let head =
        ["parameter", "tolerance", "method", "unknowns of the clouds", "estimate", "true error", "total (s)"];
    Section {
        case: case.case,
        title: case.title,
        about: case.about,
        figures: DIAGRAMS.iter().filter(|d| d.case == case.case).map(|d| d.figure(runner)).collect(),
        pictures: Vec::new(),
        tables: vec![Table {
            caption: "What was asked for, and what came out; seconds of one thread.".to_owned(),
            head: head.map(str::to_owned).to_vec(),
            rows: case.runs.iter().enumerate().filter_map(row).collect(),
        }],
    }
}
