//! A scene as users have them: does the whole take as long as its parts add up to?

use meshless::Silent;
use meshless::plan::{Plan, Stage};
use meshless::scene::Scene;

use super::Outcome;
use super::measure::median;
use super::table::Table;

/// Spacing of about 1e5 nodes on `[-1, 1]^2`.
const SPACING: f64 = 0.0064;
const CONTRAST: f64 = 1e6;
const REPETITIONS: usize = 3;

pub(super) fn run() -> Outcome {
    let mut tables = Vec::new();
    for threads in [1, 2] {
        tables.push(meshless::on_threads(threads, || split(threads))??);
    }
    Ok(tables)
}

fn split(threads: usize) -> Result<Table, meshless::Error> {
    let text = meshless_tests::kraus::interior(CONTRAST, meshless_tests::kraus::SUPPORT * SPACING, 1);
    let scene = Scene::parse(&text, "interior")?;
    let mut plan = Plan::new(&scene)?;
    plan.stages.retain(|s| *s != Stage::Estimate);
    let solutions: Vec<_> =
        (0..REPETITIONS).map(|_| meshless::execute(&scene, &plan, &mut Silent)).collect::<Result<_, _>>()?;
    let report = &solutions[0].report;
    let of = |part: fn(&meshless::report::Seconds) -> f64| {
        median(solutions.iter().map(|s| part(&s.report.seconds)).collect())
    };
    let parts = [
        ("points", of(|s| s.points)),
        ("neighbours", of(|s| s.neighbors)),
        ("stencils and cells", of(|s| s.stencils)),
        ("assembly", of(|s| s.assembly)),
        ("solve", of(|s| s.solve)),
        ("gradient and errors", of(|s| s.post)),
    ];
    let (sum, total) = (parts.iter().map(|p| p.1).sum::<f64>(), of(|s| s.total));
    let title = format!("{threads} thread{}", if threads == 1 { "" } else { "s" });
    let mut table = Table::new(&[&title, "seconds", "µs/node", "of total"]);
    let mut row = |name: &str, seconds: f64| {
        let per_node = 1e6 * seconds / report.unknowns as f64;
        table.row(
            name,
            vec![format!("{seconds:.3}"), format!("{per_node:.2}"), format!("{:.2}", seconds / total)],
        );
    };
    parts.iter().for_each(|(name, seconds)| row(name, *seconds));
    row("sum of the parts", sum);
    row("total", total);
    let error = report.errors.as_ref().map_or(f64::NAN, |e| e.l2);
    table
        .row(&format!("{} unknowns, {}, error {error:.1e}", report.unknowns, report.solver.name), Vec::new());
    Ok(table)
}
