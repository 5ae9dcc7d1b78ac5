//! Multigrid on the matrices of the sharp method: products of a whole solve, those of the constants included.

use meshless::plan::{Plan, Stage};
use meshless::scene::{MethodName, Scene, SolverName};
use meshless::{Silent, execute};
use meshless_tests::kraus;
use meshless_tests::sharp::{ball_mode, circle_mode, rings};

use super::table::Table;

const CONTRASTS: [f64; 3] = [1e-10, 1.0, 1e10];

/// Spacings of about 1e4, 3e4 and 1e5 nodes in a square of edges of length 2.
const SPACINGS: [f64; 3] = [0.0198, 0.0115, 0.0063];

type Build = fn(f64, f64) -> String;

fn mode(contrast: f64, spacing: f64) -> String {
    circle_mode(contrast, spacing, 1)
}

fn interior(contrast: f64, spacing: f64) -> String {
    kraus::interior(contrast, kraus::SUPPORT * spacing, 1)
}

fn nested(contrast: f64, spacing: f64) -> String {
    rings([1.0, contrast, 1.0], spacing, 1)
}

fn ball(contrast: f64, spacing: f64) -> String {
    ball_mode(contrast, 6.0 * spacing, 1)
}

/// Case, scene, orders, and how many of the spacings.
const CASES: [(&str, Build, &[usize], usize); 4] = [
    ("circle of mode 3", mode, &[4, 6, 8], 3),
    ("interior", interior, &[4, 6, 8], 3),
    ("nested rings", nested, &[4, 6, 8], 3),
    ("ball of mode 3", ball, &[4, 6], 2),
];

/// Every row is reported as soon as it is there.
pub(super) fn run() -> super::Outcome {
    let head = ["", "order", "unknowns", "1e-10", "1", "1e10", "solve, s", "residual"];
    let mut table = Table::new(&head);
    for (name, scene, orders, sizes) in CASES {
        for &spacing in &SPACINGS[..sizes] {
            for &order in orders {
                let mut found = Vec::new();
                for contrast in CONTRASTS {
                    found.push(measure(&scene(contrast, spacing), order)?);
                }
                let mut cells = vec![order.to_string(), found[0].unknowns.to_string()];
                cells.extend(found.iter().map(|f| f.products.clone()));
                let seconds: Vec<String> = found.iter().map(|f| format!("{:.2}", f.seconds)).collect();
                cells.push(seconds.join(" / "));
                let worst = found.iter().fold(0.0_f64, |m, f| m.max(f.residual));
                cells.push(format!("{worst:.0e}"));
                eprintln!("{name}: {}", cells.join(", "));
                table.row(name, cells);
            }
        }
    }
    Ok(vec![table])
}

struct Figures {
    unknowns: usize,
    products: String,
    seconds: f64,
    residual: f64,
}

fn measure(text: &str, order: usize) -> Result<Figures, Box<dyn std::error::Error + Send + Sync>> {
    let mut scene = Scene::parse(text, "bench.toml")?;
    scene.method.name = MethodName::Sharp;
    scene.method.order = Some(order);
    scene.method.solver = SolverName::Multigrid;
    let mut plan = Plan::new(&scene)?;
    plan.stages.retain(|stage| !matches!(stage, Stage::Estimate | Stage::Gradient));
    let report = execute(&scene, &plan, &mut Silent)?.report;
    let solver = &report.solver;
    // Where something stepped in for multigrid, its name says so.
    let stepped_in = if solver.name.contains("BiCGStab") { " (BiCGStab)" } else { "" };
    Ok(Figures {
        unknowns: report.unknowns,
        products: format!("{}{stepped_in}", solver.iterations),
        seconds: report.seconds.solve,
        residual: solver.residual,
    })
}
