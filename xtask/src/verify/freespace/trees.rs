//! Patches chosen by the estimate of the error: a source with two scales to a tolerance.

use meshless_freespace::{Centring, Mesh, RefineParams, TreeParams, suggest_tree};

use super::patches::{solve, two_scales};
use super::problems;
use super::runs::Run;

/// Names and tolerances: largest error of the velocity over its largest magnitude.
pub(super) const TREES: [(&str, f64); 2] = [("tree to 1e-3", 1e-3), ("tree to 1e-4", 1e-4)];

/// Cells of the base mesh in each direction: sixteen on the radius of the narrow bump, which resolves it.
const BASE: usize = 512;

/// The source with two scales on a base mesh with as many levels as the estimate asks for.
pub(super) fn run(order: usize, (variant, tolerance): (&'static str, f64)) -> Result<Run, String> {
    let said = |e: meshless_freespace::FreeSpaceError| format!("{variant}: {e}");
    let bumps = two_scales();
    let base = Mesh::of_box([-1.0; 2], [1.0; 2], [BASE; 2], Centring::Cell).map_err(said)?;
    let params = TreeParams { tolerance, gradient: true, ..TreeParams::default() };
    let refine = RefineParams { order, ..params.refine };
    let start = std::time::Instant::now();
    let tree = suggest_tree(&base, |p| problems::vorticity(&bumps, p), TreeParams { refine, ..params })
        .map_err(said)?;
    let choice = start.elapsed().as_secs_f64();
    let solved = solve(&base, &tree, refine, &bumps)?;
    let run = solved.of_two_scales(variant, order);
    Ok(Run { plan_seconds: choice + run.plan_seconds, ..run })
}

/// Levels that were chosen.
pub(super) fn levels(run: &Run) -> f64 {
    (run.n as f64 / BASE as f64).log2()
}
