//! Many runs at once: one on every core, each of them on one thread.
//!
//! Runs are single-threaded so that their times can be compared: with each other, and between machines.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use meshless::Error;
use meshless::report::Report;

use super::row::Row;
use super::runner::{self, Extra, Runner};
use super::study::{self, Key, Outcome};

/// What is kept of a run.
type Ended = (Row, Report);

/// A run to be done.
#[derive(Debug, Clone)]
pub(crate) struct Job {
    /// Text of a scene without `[method]`.
    pub(crate) problem: String,
    pub(crate) key: Key,
    pub(crate) extra: Extra,
}

impl Runner<'_> {
    /// Does the runs that the command line does not leave out and that were not done before; what came out is kept in
    /// the order of the jobs, whichever ended first.
    pub(crate) fn run_all(&mut self, jobs: Vec<Job>) {
        let mut wanted: Vec<Job> = Vec::new();
        for job in jobs {
            let again = wanted.iter().any(|w| w.key == job.key);
            if self.options.wants(job.key.case, job.key.variant.method)
                && study::find(&self.outcomes, &job.key).is_none()
                && !again
            {
                wanted.push(job);
            }
        }
        let suite = self.suite;
        let next = AtomicUsize::new(0);
        let results: Vec<OnceLock<Result<Ended, String>>> = wanted.iter().map(|_| OnceLock::new()).collect();
        let work = || {
            while let Some((job, result)) = {
                let index = next.fetch_add(1, Ordering::Relaxed);
                wanted.get(index).zip(results.get(index))
            } {
                runner::announce(suite, &job.key);
                let _ = result.set(job.run(suite));
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..rayon::current_num_threads().min(wanted.len()) {
                scope.spawn(work);
            }
        });
        for (job, result) in wanted.iter().zip(results) {
            match result.into_inner() {
                Some(Ok((row, report))) => {
                    study::push(&mut self.outcomes, Outcome { key: job.key, row, report });
                }
                Some(Err(error)) => self.fail(&job.key, &error),
                None => self.fail(&job.key, "it was not run"),
            }
        }
    }
}

impl Job {
    /// Solves on this thread alone.
    fn run(&self, suite: &'static str) -> Result<Ended, String> {
        let solve = || {
            let solution = runner::solve(&self.problem, &self.key, self.extra)?;
            Ok((runner::row(suite, &self.key, self.extra, &solution), solution.report))
        };
        match meshless::on_threads(1, solve) {
            Ok(ended) => ended.map_err(|e: Error| e.to_string()),
            Err(error) => Err(error.to_string()),
        }
    }
}
