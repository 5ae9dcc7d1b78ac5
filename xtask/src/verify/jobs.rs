//! Many runs at once: one on every core, each of them on one thread.
//!
//! Runs are single-threaded so that their times can be compared: with each other, and between machines. Large ones wait until their
//! memory fits.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, OnceLock, PoisonError};

use meshless::Error;
use meshless::report::Report;

use super::row::Row;
use super::runner::{self, Extra, Runner};
use super::study::{self, Key, Outcome};

/// What is kept of a run.
type Ended = (Row, Report);

/// Memory that the runs side by side may take, in GB; a larger one runs alone.
const MEMORY: f64 = 8.0;

/// Lets runs begin while their memory fits.
#[derive(Default)]
struct Gate {
    taken: Mutex<f64>,
    freed: Condvar,
}

impl Gate {
    fn within<T>(&self, memory: f64, work: impl FnOnce() -> T) -> T {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        while *taken > 0.0 && memory > 0.0 && *taken + memory > MEMORY {
            taken = self.freed.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
        *taken += memory;
        drop(taken);
        let result = work();
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        // Exactly nothing where nothing runs: what is taken was added and comes off in another order.
        *taken = if *taken - memory > 1e-6 { *taken - memory } else { 0.0 };
        self.freed.notify_all();
        result
    }
}

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
        let (next, gate) = (AtomicUsize::new(0), Gate::default());
        let results: Vec<OnceLock<Result<Ended, String>>> = wanted.iter().map(|_| OnceLock::new()).collect();
        let work = || {
            while let Some((job, result)) = {
                let index = next.fetch_add(1, Ordering::Relaxed);
                wanted.get(index).zip(results.get(index))
            } {
                gate.within(job.extra.memory, || {
                    runner::announce(suite, &job.key);
                    let _ = result.set(job.run(suite));
                });
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
