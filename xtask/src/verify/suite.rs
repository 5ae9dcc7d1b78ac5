//! The suites that there are.

use super::options::Options;
use super::study::Study;
use super::{cost, freespace, gfdm, hard, particle_difference, sharp, solvers};

/// A group of benchmarks with the claims about them.
#[derive(Debug)]
pub(crate) struct Suite {
    pub(crate) name: &'static str,
    /// One sentence for the report.
    pub(crate) about: &'static str,
    pub(crate) cases: &'static [&'static str],
    /// Runs it; `None` where the suite belongs to a method that is not built yet.
    run: Option<fn(&Options) -> Study>,
}

const fn later(name: &'static str) -> Suite {
    Suite { name, about: "", cases: &[], run: None }
}

static SUITES: [Suite; 8] = [
    Suite { name: "gfdm", about: gfdm::ABOUT, cases: &gfdm::CASES, run: Some(gfdm::run) },
    Suite {
        name: "particle-difference",
        about: particle_difference::ABOUT,
        cases: &particle_difference::CASES,
        run: Some(particle_difference::run),
    },
    later("dcpse"),
    Suite { name: "freespace", about: freespace::ABOUT, cases: &freespace::CASES, run: Some(freespace::run) },
    Suite { name: "sharp", about: sharp::ABOUT, cases: &sharp::CASES, run: Some(sharp::run) },
    Suite { name: "hard", about: hard::ABOUT, cases: &hard::CASES, run: Some(hard::run) },
    Suite { name: "solvers", about: solvers::ABOUT, cases: &solvers::CASES, run: Some(solvers::run) },
    Suite { name: "cost", about: cost::ABOUT, cases: &cost::CASES, run: Some(cost::run) },
];

impl Suite {
    /// Runs it.
    pub(crate) fn run(&self, options: &Options) -> Study {
        self.run.map_or_else(|| Study::new(self.name), |run| run(options))
    }
}

/// The suites that can be run.
pub(crate) fn built() -> impl Iterator<Item = &'static Suite> {
    SUITES.iter().filter(|s| s.run.is_some())
}

/// A suite by its name.
pub(crate) fn find(name: &str) -> Result<&'static Suite, String> {
    match SUITES.iter().find(|s| s.name == name) {
        Some(suite) if suite.run.is_none() => Err(format!("suite `{name}` is not built yet")),
        Some(suite) => Ok(suite),
        None => {
            let names: Vec<&str> = SUITES.iter().map(|s| s.name).collect();
            Err(format!("unknown suite `{name}`; there are {}", names.join(", ")))
        }
    }
}
