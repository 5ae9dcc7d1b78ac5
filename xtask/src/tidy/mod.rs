//! `cargo xtask tidy`: keeps the invariants that `docs/architecture.md` promises. Every check is a function from the
//! workspace to the list of what is wrong.

mod arrows;
mod documents;
mod manifest;
mod sources;

use std::io;
use std::path::Path;
use std::process::ExitCode;

use crate::workspace;

/// A check: its name, and what finds what is wrong.
type Check = (&'static str, fn(&Path) -> io::Result<Vec<String>>);

const CHECKS: &[Check] = &[
    ("arrows between crates point one way", arrows::between_crates),
    ("outside libraries are named by one crate each", arrows::to_the_outside),
    ("a library that may be replaced is named in one file", sources::named_in_one_file),
    ("every crate has a README and the lints of the workspace", documents::crates_are_complete),
    ("every document is linked", documents::documents_are_linked),
    ("every example is mentioned", documents::examples_are_mentioned),
    ("nothing is left undone", sources::nothing_left_undone),
    ("every exception from a lint has its reason", sources::exceptions_have_reasons),
];

pub(crate) fn run(arguments: &[String]) -> ExitCode {
    if let Some(argument) = arguments.first() {
        eprintln!("error: `cargo xtask tidy` takes no arguments, but got `{argument}`");
        return ExitCode::from(crate::USAGE_ERROR);
    }
    let root = workspace::root();
    let mut wrong = 0;
    for (name, check) in CHECKS {
        match check(&root) {
            Ok(found) => {
                say!("{} {name}", if found.is_empty() { "ok  " } else { "FAIL" });
                found.iter().for_each(|what| say!("       {what}"));
                wrong += found.len();
            }
            Err(error) => {
                say!("FAIL {name}\n       cannot read the workspace: {error}");
                wrong += 1;
            }
        }
    }
    match sources::summary(&root) {
        Ok(summary) => say!("\n{summary}"),
        Err(error) => say!("\nno summary: {error}"),
    }
    if wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// A path as it is written in messages: relative to the root.
fn shown(root: &Path, path: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).display().to_string()
}
