//! Housekeeping of the workspace: verification sweeps, benchmarks, and the invariants that the documents promise.

/// A line on the terminal; whoever stops reading it does not stop the work.
macro_rules! say {
    ($($arg:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout(), $($arg)*);
    }};
}

mod bench;
mod tidy;
mod verify;
mod workspace;

use std::process::ExitCode;

const USAGE: &str = "\
cargo xtask COMMAND

  verify [SUITE...] [--case C] [--method M] [--quick | --full] [--threads N] [--out DIR]
         run the published benchmarks and check every claim about them
  bench  [NAME...]
         measure the building blocks and what each effect of a scene costs
  tidy   check the invariants of the workspace
";

/// Exit status of a command line that makes no sense.
const USAGE_ERROR: u8 = 2;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (command, rest) = arguments.split_first().map_or(("", &[][..]), |(c, rest)| (c.as_str(), rest));
    if rest.iter().any(|option| option == "--help" || option == "-h") {
        say!("{}", USAGE.trim_end());
        return ExitCode::SUCCESS;
    }
    match command {
        "verify" => verify::run(rest),
        "bench" => bench::run(rest),
        "tidy" => tidy::run(rest),
        "" | "help" | "-h" | "--help" => {
            say!("{}", USAGE.trim_end());
            ExitCode::SUCCESS
        }
        unknown => {
            eprintln!("error: there is no command `{unknown}`\n\n{USAGE}");
            ExitCode::from(USAGE_ERROR)
        }
    }
}
