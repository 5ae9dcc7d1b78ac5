//! The `meshless` command: scenes in, fields with their errors out.

/// Prints a line; a reader that has gone away, as after `| head`, is no error.
macro_rules! say {
    ($($arg:tt)*) => {{
        use std::io::Write;
        let _ = writeln!(std::io::stdout(), $($arg)*);
    }};
}

mod args;
mod cost;
mod methods;
mod plan;
mod progress;
mod solve;
mod summary;

use std::process::ExitCode;

use clap::Parser;

use args::{Args, Command};

/// The scene or the command line is wrong.
const EXIT_INPUT: u8 = 2;
/// The solve failed.
const EXIT_FAILED: u8 = 1;

fn main() -> ExitCode {
    let args = Args::parse();
    let outcome = match &args.command {
        Command::Solve(options) => solve::run(options),
        Command::Plan(options) => plan::run(options),
        Command::Cost(options) => cost::run(options),
        Command::Methods => methods::run(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{}", failure.message);
            ExitCode::from(failure.status)
        }
    }
}

/// Why the command ends with a status other than 0.
pub(crate) struct Failure {
    message: String,
    status: u8,
}

impl Failure {
    pub(crate) fn input(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: EXIT_INPUT }
    }

    pub(crate) fn failed(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: EXIT_FAILED }
    }
}

impl From<meshless::Error> for Failure {
    fn from(error: meshless::Error) -> Self {
        if error.is_input() {
            Self::input(error.to_string())
        } else {
            Self::failed(format!("error: {error}"))
        }
    }
}
