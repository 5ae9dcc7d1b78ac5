//! What each effect costs: the same cloud with one effect more.

use std::time::Instant;

use meshless::plan::{Plan, Stage};
use meshless::scene::Scene;
use meshless::{Silent, write_outputs};

use super::measure::median;
use super::table::Table;
use super::{Outcome, by_hand};

/// Spacing of about 1e5 nodes in the unit square.
pub(super) const SPACING: f64 = 0.0032;

const REPETITIONS: usize = 3;

/// How much more the facade may take than the crates by hand.
const FACADE_TARGET: f64 = 1.05;

/// Plain Laplace problem on the unit square.
const PLAIN: Effect = Effect {
    name: "plain Laplace",
    diffusivity: "1",
    disc: None,
    source: None,
    right: "dirichlet = \"1\"",
    vtu: false,
};

/// A scene with one effect.
#[derive(Debug, Clone, Copy)]
struct Effect {
    name: &'static str,
    diffusivity: &'static str,
    /// Diffusivity of a disc in the middle.
    disc: Option<&'static str>,
    source: Option<&'static str>,
    right: &'static str,
    vtu: bool,
}

const EFFECTS: [Effect; 7] = [
    PLAIN,
    Effect { name: "source", source: Some("sin(pi*x)*sin(pi*y)"), ..PLAIN },
    Effect { name: "variable diffusivity", diffusivity: "1 + x*y", ..PLAIN },
    Effect { name: "Robin boundary", right: "robin = { a = \"1\", b = \"1\", g = \"2\" }", ..PLAIN },
    Effect { name: "interface, contrast 1e2", disc: Some("1e2"), ..PLAIN },
    Effect { name: "interface, contrast 1e6", disc: Some("1e6"), ..PLAIN },
    Effect { name: "vtu output", vtu: true, ..PLAIN },
];

impl Effect {
    fn scene(&self) -> String {
        let mut text = format!(
            "title = \"{}\"\ndimension = 2\n[domain]\nbox = {{ min = [0.0, 0.0], max = [1.0, 1.0] }}\n\
             [points]\nspacing = {SPACING}\nlayout = \"irregular\"\nseed = 1\n",
            self.name
        );
        if let Some(eta) = self.disc {
            text += &format!(
                "[[regions]]\nname = \"disc\"\nsphere = {{ center = [0.5, 0.5], radius = 0.25 }}\ndiffusivity = \"{eta}\"\n"
            );
        }
        text += &format!("[[regions]]\nname = \"plate\"\ndiffusivity = \"{}\"\n", self.diffusivity);
        if let Some(source) = self.source {
            text += &format!("source = \"{source}\"\n");
        }
        text += &format!(
            "[[boundaries]]\nface = \"right\"\n{}\n[[boundaries]]\nface = \"all\"\ndirichlet = \"x\"\n",
            self.right
        );
        text + &format!("[output]\nvtu = {}\n", self.vtu)
    }
}

pub(super) fn run() -> Outcome {
    Ok(vec![effects()?, facade()?])
}

/// A solve through the facade, with its outputs; seconds of the whole, then of stencils and cells, solve, and output.
fn solve(text: &str) -> Result<[f64; 4], Box<dyn std::error::Error + Send + Sync>> {
    let start = Instant::now();
    let scene = Scene::parse(text, "effect.toml")?;
    let mut plan = Plan::new(&scene)?;
    plan.stages.retain(|s| *s != Stage::Estimate);
    let solution = meshless::execute(&scene, &plan, &mut Silent)?;
    let solved = start.elapsed().as_secs_f64();
    let folder = std::env::temp_dir().join(format!("meshless-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    write_outputs(&plan, &solution, &folder, "effect")?;
    std::fs::remove_dir_all(&folder)?;
    let seconds = &solution.report.seconds;
    let total = start.elapsed().as_secs_f64();
    Ok([total, seconds.stencils, seconds.solve, total - solved])
}

fn effects() -> Result<Table, Box<dyn std::error::Error + Send + Sync>> {
    let mut times: Vec<Vec<[f64; 4]>> = vec![Vec::new(); EFFECTS.len()];
    // In turns, so that a slow moment of the machine meets all of them.
    for _ in 0..REPETITIONS {
        for (effect, times) in EFFECTS.iter().zip(&mut times) {
            times.push(solve(&effect.scene())?);
        }
    }
    let medians: Vec<[f64; 4]> =
        times.iter().map(|t| std::array::from_fn(|k| median(t.iter().map(|x| x[k]).collect()))).collect();
    let mut table = Table::new(&["effect", "total (s)", "over plain", "stencils, cells", "solve", "output"]);
    for (effect, [total, stencils, solve, output]) in EFFECTS.iter().zip(&medians) {
        let figure = |x: &f64| format!("{x:.3}");
        let ratio = format!("{:.2}", total / medians[0][0]);
        table.row(effect.name, vec![figure(total), ratio, figure(stencils), figure(solve), figure(output)]);
    }
    Ok(table)
}

fn facade() -> Result<Table, Box<dyn std::error::Error + Send + Sync>> {
    let text = PLAIN.scene();
    let scene = Scene::parse(&text, "plain.toml")?;
    let plan = Plan::new(&scene)?;
    let (mut through, mut direct) = (Vec::new(), Vec::new());
    for _ in 0..REPETITIONS {
        through.push(solve(&text)?[0]);
        let start = Instant::now();
        by_hand::laplace(&plan)?;
        direct.push(start.elapsed().as_secs_f64());
    }
    let (through, direct) = (median(through), median(direct));
    let mut table = Table::new(&["plain Laplace", "total (s)", "over by hand", "target"]);
    table.row("crates wired by hand", vec![format!("{direct:.3}"), "1.00".to_owned(), String::new()]);
    table.row(
        "through the facade",
        vec![format!("{through:.3}"), format!("{:.3}", through / direct), format!("{FACADE_TARGET}")],
    );
    Ok(table)
}
