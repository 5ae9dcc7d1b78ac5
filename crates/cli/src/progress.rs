//! A progress bar on standard error, where that is a terminal.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressStyle};
use meshless::Progress;
use meshless::plan::{Plan, Stage};

/// Shows the stage that runs.
pub(crate) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    pub(crate) fn new(plan: &Plan) -> Self {
        let bar = if std::io::stderr().is_terminal() {
            ProgressBar::new(plan.stages.len() as u64)
        } else {
            ProgressBar::hidden()
        };
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} {elapsed}") {
            bar.set_style(style);
        }
        Self { bar }
    }
}

impl Progress for Bar {
    fn stage(&mut self, stage: Stage) {
        self.bar.inc(1);
        self.bar.set_message(stage.name());
    }

    fn proceed(&mut self, t: f64, end: f64) -> bool {
        self.bar.set_message(format!("t = {t:.4e} of {end:e}"));
        true
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
