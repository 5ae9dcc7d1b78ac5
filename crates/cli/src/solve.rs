//! `meshless solve`.

use std::path::Path;
use std::time::Duration;

use meshless::plan::Plan;
use meshless::{Checkpoint, execute_from, write_outputs};

use crate::Failure;
use crate::args::SolveArgs;
use crate::progress::Bar;
use crate::summary;

/// Least time between two writes of a checkpoint.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(10);

/// Threads at most: more than this are a slip of the keyboard, and take minutes to start.
const MAX_THREADS: usize = 1024;

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
        summary::print(&solution.report);
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
        Some(n) if n > MAX_THREADS => {
            Err(Failure::input(format!("error: --threads must be at most {MAX_THREADS}, not {n}")))
        }
        Some(n) => meshless::on_threads(n, work).map_err(|e| Failure::failed(format!("error: {e}"))),
    }
}
