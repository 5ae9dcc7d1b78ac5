//! The suites that there are.

use super::options::Options;
use super::study::Study;
use super::{
    adaptive, cost, dcpse, effects, freespace, gfdm, hard, natural, particle_difference, sharp, solvers,
};

/// A group of benchmarks with the claims about them.
#[derive(Debug)]
pub(crate) struct Suite {
    pub(crate) name: &'static str,
    /// One sentence for the report.
    pub(crate) about: &'static str,
    pub(crate) cases: &'static [&'static str],
    run: fn(&Options) -> Study,
}

static SUITES: [Suite; 11] = [
    Suite { name: "gfdm", about: gfdm::ABOUT, cases: &gfdm::CASES, run: gfdm::run },
    Suite {
        name: "particle-difference",
        about: particle_difference::ABOUT,
        cases: &particle_difference::CASES,
        run: particle_difference::run,
    },
    Suite { name: "dcpse", about: dcpse::ABOUT, cases: &dcpse::CASES, run: dcpse::run },
    Suite { name: "freespace", about: freespace::ABOUT, cases: &freespace::CASES, run: freespace::run },
    Suite { name: "sharp", about: sharp::ABOUT, cases: &sharp::CASES, run: sharp::run },
    Suite { name: "hard", about: hard::ABOUT, cases: &hard::CASES, run: hard::run },
    Suite { name: "natural", about: natural::ABOUT, cases: &natural::CASES, run: natural::run },
    Suite { name: "adaptive", about: adaptive::ABOUT, cases: &adaptive::CASES, run: adaptive::run_suite },
    Suite { name: "effects", about: effects::ABOUT, cases: &effects::CASES, run: effects::run },
    Suite { name: "solvers", about: solvers::ABOUT, cases: &solvers::CASES, run: solvers::run },
    Suite { name: "cost", about: cost::ABOUT, cases: &cost::CASES, run: cost::run },
];

impl Suite {
    /// Runs it.
    pub(crate) fn run(&self, options: &Options) -> Study {
        (self.run)(options)
    }
}

/// The suites that can be run.
pub(crate) fn built() -> impl Iterator<Item = &'static Suite> {
    SUITES.iter()
}

/// A suite by its name.
pub(crate) fn find(name: &str) -> Result<&'static Suite, String> {
    match SUITES.iter().find(|s| s.name == name) {
        Some(suite) => Ok(suite),
        None => {
            let names: Vec<&str> = SUITES.iter().map(|s| s.name).collect();
            Err(format!("unknown suite `{name}`; there are {}", names.join(", ")))
        }
    }
}
