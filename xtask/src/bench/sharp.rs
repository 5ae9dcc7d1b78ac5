//! The sharp method: stencils away from interfaces and across them, and whole scenes to a given error, on one core.

use meshless::plan::{Plan, Stage};
use meshless::report::Report;
use meshless::scene::{MethodName, Scene};
use meshless::{Silent, execute};
use meshless_tests::kraus;
use meshless_tests::particle_difference::{Regularity, circle};
use meshless_tests::sharp::{ball_mode, circle_mode};

use super::measure::median;
use super::table::Table;

const REPETITIONS: usize = 5;

type Failure = Box<dyn std::error::Error + Send + Sync>;

pub(super) fn run() -> super::Outcome {
    Ok(vec![stencils()?, scenes()?])
}

/// Solves on one thread, without the estimate; the reports of several runs.
fn reports(text: &str, order: usize) -> Result<Vec<Report>, Failure> {
    let mut scene = Scene::parse(text, "bench.toml")?;
    scene.method.name = MethodName::Sharp;
    scene.method.order = Some(order);
    let mut plan = Plan::new(&scene)?;
    plan.stages.retain(|stage| *stage != Stage::Estimate);
    let solve = || execute(&scene, &plan, &mut Silent).map(|solution| solution.report);
    let runs = meshless::on_threads(1, || (0..REPETITIONS).map(|_| solve()).collect::<Result<Vec<_>, _>>())?;
    Ok(runs?)
}

/// Median of a time over the runs.
fn time(reports: &[Report], of: fn(&Report) -> f64) -> f64 {
    median(reports.iter().map(of).collect())
}

/// Microseconds a stencil: those of a scene of one material for the plain ones, and what remains of the same scene
/// with a disc of another one for those that cross its rim.
fn stencils() -> Result<Table, Failure> {
    let mut table = Table::new(&["stencils", "plain, µs", "target", "crossing, µs", "target"]);
    let plane = |contrast| circle_mode(contrast, 0.025, 1);
    let space = |contrast| ball_mode(contrast, 0.15, 1);
    for (dimension, order, targets) in [(2, 4, [40.0, 250.0]), (2, 8, [60.0, 250.0]), (3, 4, [400.0, 3000.0])]
    {
        let scene = |contrast| if dimension == 2 { plane(contrast) } else { space(contrast) };
        let one = reports(&one_material(&scene(1.0)), order)?;
        let two = reports(&scene(1e3), order)?;
        let all = |r: &Report| (r.unknowns - r.nodes.dirichlet) as f64;
        let plain = time(&one, |r| r.seconds.stencils) / all(&one[0]);
        let crossing = two[0].nodes.constrained as f64;
        let rest = (all(&two[0]) - crossing) * plain;
        let across = (time(&two, |r| r.seconds.stencils) - rest) / crossing;
        let cells = [1e6 * plain, targets[0], 1e6 * across, targets[1]];
        table.row(&format!("{dimension}-D, order {order}"), cells.map(|x| format!("{x:.1}")).to_vec());
    }
    Ok(table)
}

/// The same problem with its first region left out: the field outside of a disc of the same material is smooth.
fn one_material(text: &str) -> String {
    let (first, second) = (text.find("[[regions]]"), text.rfind("[[regions]]"));
    match (first, second) {
        (Some(first), Some(second)) => format!("{}{}", &text[..first], &text[second..]),
        _ => text.to_owned(),
    }
}

/// Seconds from points to solution, with the gradients at the nodes, which come with the rows; and the error. Targets are what a
/// finite-element code of curved elements of order 4 needs where that converges, and less where it does not.
fn scenes() -> Result<Table, Failure> {
    let mut table = Table::new(&["scene", "nodes", "error", "seconds", "target: error", "target: seconds"]);
    let interior = |contrast, spacing| kraus::interior(contrast, kraus::SUPPORT * spacing, 1);
    for contrast in [1e2, 1e10] {
        for (order, spacing, target) in [(8, 0.14, [1e-8, 0.03]), (8, 0.07, [1e-11, 0.1])] {
            let name = format!("interior, {contrast:e}, order {order}");
            row(&mut table, &name, &reports(&interior(contrast, spacing), order)?, target);
        }
    }
    let disc = |nodes| circle(1e2, 0.1, nodes, Regularity::Irregular(1));
    for (order, nodes, target) in [(6, 30, [2e-8, 0.12]), (8, 41, [4e-10, 0.43])] {
        let name = format!("disc of variable diffusivity, order {order}");
        row(&mut table, &name, &reports(&disc(nodes), order)?, target);
    }
    Ok(table)
}

fn row(table: &mut Table, name: &str, found: &[Report], target: [f64; 2]) {
    let solved = |r: &Report| {
        let s = &r.seconds;
        s.points + s.neighbors + s.stencils + s.assembly + s.solve
    };
    let error = found[0].errors.as_ref().map_or(f64::NAN, |e| e.l2);
    let cells = [
        found[0].unknowns.to_string(),
        format!("{error:.1e}"),
        format!("{:.3}", time(found, solved)),
        format!("{:.0e}", target[0]),
        format!("{}", target[1]),
    ];
    table.row(name, cells.to_vec());
}
