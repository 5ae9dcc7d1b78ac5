//! `meshless cost`.

use meshless::cost::{CostParams, CostReport, CostRun, chart, cost, table};
use meshless::output::write_text_atomically;
use meshless::scene::MethodName;

use crate::Failure;
use crate::args::CostArgs;
use crate::solve::{on_threads, prepare};

pub(crate) fn run(args: &CostArgs) -> Result<(), Failure> {
    let scene = args.read()?;
    let methods = args
        .method
        .iter()
        .map(|name| {
            MethodName::parse(name)
                .map_err(|e| Failure::input(format!("error: --method {name}: {e}; {}", e.help())))
        })
        .collect::<Result<Vec<MethodName>, Failure>>()?;
    if !(args.seconds > 0.0 && args.seconds.is_finite()) {
        return Err(Failure::input("error: --seconds must be a positive number"));
    }
    prepare(&args.out)?;
    let params = CostParams { methods, seconds: args.seconds };
    if !args.json {
        say!("{}", scene.title);
        say!("{:<28} {:>10} {:>9} {:>10} {:>10}", "method", "spacing", "unknowns", "error", "seconds");
    }
    let mut each = |run: &CostRun| {
        if !args.json {
            line(run);
        }
    };
    let report = on_threads(args.threads, || cost(&scene, &params, &mut each))??;
    let stem = args.scene.file_stem().map_or_else(|| "scene".into(), |s| s.to_string_lossy());
    let (svg, csv) = (args.out.join(format!("{stem}-cost.svg")), args.out.join(format!("{stem}-cost.csv")));
    write_text_atomically(&csv, &table(&report)).map_err(meshless::Error::from)?;
    let drawing = chart(&report).map_err(meshless::Error::from)?;
    write_text_atomically(&svg, &drawing).map_err(meshless::Error::from)?;
    if args.json {
        say!("{}", serde_json::to_string(&report).map_err(|e| Failure::failed(e.to_string()))?);
    } else {
        summary(&report);
        say!("wrote       {}", csv.display());
        say!("wrote       {}", svg.display());
    }
    Ok(())
}

fn line(run: &CostRun) {
    let label = run.label();
    match (run.error, &run.why) {
        (Some(error), _) => {
            say!(
                "{label:<28} {:>10.3e} {:>9} {error:>10.2e} {:>10.4}",
                run.spacing,
                run.unknowns,
                run.seconds
            );
        }
        (None, why) => {
            say!("{label:<28} {:>10.3e} {}", run.spacing, why.as_deref().unwrap_or("no error known"));
        }
    }
}

/// What errors mean, and what to buy.
fn summary(report: &CostReport) {
    match report.reference_error {
        Some(error) => say!("errors against {}, itself known to about {error:.1e}", report.reference),
        None => say!("errors against {}", report.reference),
    }
    say!("best buys: no other run is more accurate in less time");
    let mut best: Vec<&CostRun> = report.runs.iter().filter(|r| r.best_buy).collect();
    best.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    best.into_iter().for_each(line);
}
