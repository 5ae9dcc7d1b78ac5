//! `meshless solve`.

use std::path::Path;
use std::time::Duration;

use meshless::plan::Plan;
use meshless::report::Report;
use meshless::{Checkpoint, Solution, execute_from, write_outputs};

use crate::Failure;
use crate::args::SolveArgs;
use crate::progress::Bar;

/// Least time between two writes of a checkpoint.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(10);

pub(crate) fn run(args: &SolveArgs) -> Result<(), Failure> {
    let scene = args.instead.read(&args.scene)?;
    let plan = Plan::new(&scene)?;
    let writes = scene.output.vtu || scene.output.plot || scene.output.csv;
    if writes {
        prepare(&args.out)?;
    }
    if args.checkpoint.is_some() && scene.time.is_none() {
        return Err(Failure::input("error: --checkpoint: the scene is steady; it needs a [time] section"));
    }
    let checkpoint =
        args.checkpoint.as_ref().map(|path| Checkpoint { path: path.clone(), every: CHECKPOINT_INTERVAL });
    let run = || execute_from(&scene, &plan, checkpoint.as_ref(), &mut Bar::new(&plan));
    let solution = on_threads(args.threads, run)??;
    let stem = args.scene.file_stem().map_or_else(|| "scene".into(), |s| s.to_string_lossy());
    let files = write_outputs(&plan, &solution, &args.out, &stem)?;
    if args.json {
        let json = serde_json::to_string(&solution.report).map_err(|e| Failure::failed(e.to_string()))?;
        say!("{json}");
    } else {
        print(&solution.report, &solution);
        files.iter().for_each(|file| say!("wrote       {}", file.display()));
    }
    Ok(())
}

/// Makes the output folder and finds out whether it can be written, before anything is computed.
pub(crate) fn prepare(out: &Path) -> Result<(), Failure> {
    let refuse = |e: std::io::Error| {
        Failure::input(format!("error: --out {}: {e}; name a folder that can be written", out.display()))
    };
    std::fs::create_dir_all(out).map_err(refuse)?;
    let probe = out.join(".meshless-write-test");
    std::fs::write(&probe, b"").map_err(refuse)?;
    std::fs::remove_file(&probe).map_err(refuse)
}

pub(crate) fn on_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> T + Send,
) -> Result<T, Failure> {
    match threads {
        None => Ok(work()),
        Some(0) => Err(Failure::input("error: --threads must be at least 1")),
        Some(n) => meshless::on_threads(n, work).map_err(|e| Failure::failed(format!("error: {e}"))),
    }
}

fn print(report: &Report, solution: &Solution) {
    say!("{}", report.title);
    say!(
        "method      {} (order {}), {} unknowns, spacing {:.4}",
        report.method,
        report.order,
        report.unknowns,
        report.spacing
    );
    if let Some(why) = &report.fallback {
        say!("fallback    {why}");
    }
    if let Some(layer) = &report.thin_layer {
        say!(
            "thin layer  \"{}\" is {:.2e} thin near {:?}: less accurate there; a spacing of {:.2e} resolves it",
            layer.region,
            layer.thickness,
            layer.at,
            layer.resolving_spacing
        );
    }
    let nodes = &report.nodes;
    say!(
        "rows        {} stencils, {} cells, {} boundary stencils, {} prescribed",
        nodes.strong,
        nodes.conservative,
        nodes.strong_boundary,
        nodes.dirichlet
    );
    say!("contrast    {:.3e}", report.contrast);
    say!("u           {:.6e} .. {:.6e}", report.extrema.min, report.extrema.max);
    if let Some(speed) = &report.speed {
        say!("speed       {:.6e} .. {:.6e}", speed.min, speed.max);
    }
    let solver = &report.solver;
    say!("solver      {}, {} iterations, residual {:.1e}", solver.name, solver.iterations, solver.residual);
    if let Some(time) = &report.time {
        say!(
            "time        {} in {} steps ({} rejected), {} matrices",
            time.end,
            time.steps,
            time.rejected,
            time.matrices
        );
    }
    if let Some(errors) = &report.errors {
        say!(
            "error       l2 {:.3e}, linf {:.3e}, gradient linf {:.3e}",
            errors.l2,
            errors.linf,
            errors.gradient_linf
        );
        if errors.regions.len() > 1 {
            for (name, region) in &errors.regions {
                say!("  {name:<10} l2 {:.3e}, linf {:.3e}", region.l2, region.linf);
            }
        }
    }
    match (report.estimate.l2, &report.estimate.why_not) {
        (Some(l2), _) => say!("estimate    l2 {l2:.3e}"),
        (None, Some(why)) => say!("estimate    none: {why}"),
        (None, None) => {}
    }
    for rung in report.accuracy.iter().flat_map(|accuracy| &accuracy.rungs) {
        match (&rung.why, rung.estimate) {
            (None, Some(estimate)) => say!(
                "  spacing {:.3e}: {} unknowns, estimate {estimate:.1e}, {:.3} s",
                rung.spacing,
                rung.unknowns,
                rung.seconds
            ),
            (why, _) => {
                say!("  spacing {:.3e}: {}", rung.spacing, why.as_deref().unwrap_or("no estimate"));
            }
        }
    }
    let s = &report.seconds;
    say!(
        "seconds     {:.3}: points {:.3}, neighbors {:.3}, stencils {:.3}, assembly {:.3}, solve {:.3}, post {:.3}, estimate {:.3}",
        s.total,
        s.points,
        s.neighbors,
        s.stencils,
        s.assembly,
        s.solve,
        s.post,
        s.estimate
    );
    for probe in &solution.report.probes {
        match probe.value {
            Some(value) => say!("probe       {:?}: {value:.8e}", probe.at),
            None => say!("probe       {:?}: outside of the domain", probe.at),
        }
    }
}
