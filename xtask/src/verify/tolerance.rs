//! Case `tolerance` of suite `cost`: scenes that give an error to reach instead of a method and a spacing.

use meshless::plan::Plan;
use meshless::scene::Scene;
use meshless::{Overrides, Silent, Solution};
use meshless_tests::{kraus, sharp};

use super::claims::{Claims, short};
use super::figure::{Curve, Figure};
use super::options::Effort;
use super::runner::{self, Extra, Runner};
use super::study::{self, Key, Outcome, Section, Table};
use super::variant::Variant;

pub(super) const CASE: &str = "tolerance";

/// The plan chooses everything.
const VARIANT: Variant = Variant { support: None, ..Variant::plain("auto") };

const TOLERANCES: [f64; 5] = [3e-2, 1e-3, 1e-5, 1e-7, 1e-9];

/// Spacing of the first cloud.
const SPACING: f64 = 0.15;

/// A problem, and the last of the tolerances that it is solved to.
struct Problem {
    name: &'static str,
    scene: fn() -> String,
    tightest: f64,
}

const PROBLEMS: [Problem; 5] = [
    Problem {
        name: "interior interface, 1e10",
        scene: || kraus::interior(1e10, kraus::SUPPORT * SPACING, 1),
        tightest: 1e-9,
    },
    Problem {
        name: "circle of mode 3, 1e10",
        scene: || sharp::circle_mode(1e10, SPACING, 1),
        tightest: 1e-9,
    },
    Problem {
        name: "circle of mode 3, 1e-10",
        scene: || sharp::circle_mode(1e-10, SPACING, 1),
        tightest: 1e-9,
    },
    Problem {
        name: "curved interface to the boundary, 1e4",
        scene: || kraus::curved(1.0, 1e4, kraus::SUPPORT * SPACING, 1),
        tightest: 1e-7,
    },
    Problem { name: "ball of mode 3, 1e4", scene: || sharp::ball_mode(1e4, 0.25, 1), tightest: 1e-3 },
];

/// Solves to a tolerance.
fn solve(text: &str, tolerance: f64) -> Result<Solution, Box<dyn std::error::Error>> {
    let mut scene = Scene::parse(text, CASE)?;
    Overrides { tolerance: Some(tolerance), ..Overrides::default() }.apply(&mut scene)?;
    Ok(meshless::execute(&scene, &Plan::new(&scene)?, &mut Silent)?)
}

pub(super) fn run(runner: &mut Runner<'_>, claims: &mut Claims) {
    if !runner.options.wants(CASE, VARIANT.method) {
        return;
    }
    let limit = if runner.options.effort == Effort::Quick { 1e-5 } else { 0.0 };
    for (number, problem) in (0..).zip(&PROBLEMS) {
        let wanted = |t: &&f64| **t >= problem.tightest.max(limit);
        for (level, &tolerance) in TOLERANCES.iter().filter(wanted).enumerate() {
            // The problem stands in the place of the seed, the tolerance in that of the jump.
            let key = Key { case: CASE, variant: VARIANT, jump: tolerance, level, seed: number };
            runner::announce(runner.suite, &key);
            match solve(&(problem.scene)(), tolerance) {
                Ok(solution) => {
                    let mut row = runner::row(runner.suite, &key, Extra::default(), &solution);
                    row.params = format!("{}; tolerance={tolerance:e}", problem.name);
                    row.seed = 1;
                    study::push(&mut runner.outcomes, Outcome { key, row, report: solution.report });
                }
                Err(error) => runner.fail(&key, &error.to_string()),
            }
        }
        let ratios = of(runner, number).map(|o| o.l2() / o.key.jump);
        let name = problem.name;
        claims.at_most(CASE, format!("{name}: error over the tolerance, largest"), worst(ratios), 1.0);
        let estimates = of(runner, number).filter_map(|o| {
            let ratio = o.report.estimate.l2? / o.l2();
            // Next to round-off neither means anything.
            (o.l2() > 1e-12).then_some(ratio.max(1.0 / ratio))
        });
        let claim = format!("{name}: factor between estimate and error, largest");
        claims.at_most(CASE, claim, worst(estimates), 5.0);
    }
}

/// The runs of a problem.
fn of<'a>(runner: &'a Runner<'_>, number: u64) -> impl Iterator<Item = &'a Outcome> {
    runner.outcomes.iter().filter(move |o| o.key.case == CASE && o.key.seed == number)
}

fn worst(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.reduce(f64::max)
}

pub(super) fn section(runner: &Runner<'_>) -> Section {
    let all = || (0..).zip(&PROBLEMS);
    let curves = all()
        .map(|(number, problem)| Curve {
            label: problem.name.to_owned(),
            points: of(runner, number).map(|o| (o.row.t_total, o.l2())).collect(),
        })
        .collect();
    let row = |name: &str, o: &Outcome| {
        let report = &o.report;
        let clouds: Vec<String> =
            report.accuracy.iter().flat_map(|a| &a.rungs).map(|r| r.unknowns.to_string()).collect();
        vec![
            name.to_owned(),
            format!("{:.0e}", o.key.jump),
            format!("{}, order {}", report.method, report.order),
            clouds.join(", "),
            report.estimate.l2.map_or_else(String::new, short),
            short(o.l2()),
            short(o.row.t_total),
        ]
    };
    let rows = all().flat_map(|(number, p)| of(runner, number).map(|o| row(p.name, o)).collect::<Vec<_>>());
    let head = ["problem", "tolerance", "method", "unknowns of the clouds", "estimate", "error", "total (s)"];
    Section {
        case: CASE,
        title: "To a tolerance",
        about: "The scene gives an error to reach; method, order and spacing are the plan's. Times include all clouds that were tried, and the estimates.",
        figures: vec![Figure {
            name: "cost-tolerance".to_owned(),
            caption: "Error reached against seconds, all clouds and estimates included.".to_owned(),
            x: "seconds",
            y: "relative L2 error",
            curves,
            slope: None,
        }],
        pictures: Vec::new(),
        tables: vec![Table {
            caption: "What was asked for, and what came out.".to_owned(),
            head: head.map(str::to_owned).to_vec(),
            rows: rows.collect(),
        }],
    }
}
