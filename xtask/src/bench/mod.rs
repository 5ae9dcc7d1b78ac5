//! `cargo xtask bench`: how long the building blocks take, and what each effect of a scene costs.

mod by_hand;
mod effects;
mod measure;
mod micro;
mod scene;
mod sharp;
mod sharp_solver;
mod solvers;
mod table;

use std::error::Error;
use std::process::ExitCode;

use table::Table;

pub(crate) use solvers::systems;

type Outcome = Result<Vec<Table>, Box<dyn Error + Send + Sync>>;

/// A benchmark: its name, what it measures, and what runs it.
type Bench = (&'static str, &'static str, fn() -> Outcome);

const BENCHES: &[Bench] = &[
    ("neighbors", "radius lists of 1e6 nodes", micro::neighbors::run),
    ("stencils", "least-squares stencils of second order", micro::stencils::run),
    ("cells", "Voronoi cells", micro::cells::run),
    (
        "sparse",
        "matrix-vector product against the bandwidth of the memory, incomplete factorisation",
        micro::sparse::run,
    ),
    ("freespace", "convolution in free space against the bare transforms", micro::freespace::run),
    (
        "sharp",
        "the sharp method: stencils against their targets, and whole scenes to a given error",
        sharp::run,
    ),
    ("sharp-solver", "multigrid on the matrices of the sharp method: products of a solve", sharp_solver::run),
    ("solvers", "multigrid against its targets: a ball in a box, six kinds of discretisation", solvers::run),
    ("effects", "what each effect of a scene costs, and what the facade does", effects::run),
    ("scene", "a scene of 1e5 nodes and contrast 1e6, from points to solution", scene::run),
];

/// What `micro` stands for.
const MICRO: &[&str] = &["neighbors", "stencils", "cells", "sparse", "freespace"];

pub(crate) fn run(arguments: &[String]) -> ExitCode {
    let chosen = match choose(arguments) {
        Ok(chosen) => chosen,
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(crate::USAGE_ERROR);
        }
    };
    say!("{} threads; medians of several runs", rayon::current_num_threads());
    for (name, about, bench) in chosen {
        say!("\n{name}: {about}");
        match bench() {
            Ok(tables) => tables.iter().for_each(|t| say!("\n{t}")),
            Err(error) => {
                eprintln!("error: {name}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

fn choose(arguments: &[String]) -> Result<Vec<&'static Bench>, String> {
    if arguments.is_empty() {
        return Ok(BENCHES.iter().collect());
    }
    let mut names: Vec<&str> = Vec::new();
    for argument in arguments {
        match argument.as_str() {
            "micro" => names.extend(MICRO),
            name if BENCHES.iter().any(|(n, ..)| *n == name) => names.push(name),
            unknown => {
                let known: Vec<&str> = BENCHES.iter().map(|b| b.0).collect();
                return Err(format!("unknown benchmark `{unknown}`; there are micro, {}", known.join(", ")));
            }
        }
    }
    Ok(BENCHES.iter().filter(|(name, ..)| names.contains(name)).collect())
}

#[cfg(test)]
mod tests {
    use super::{BENCHES, MICRO, choose};

    fn names(line: &str) -> Result<Vec<&'static str>, String> {
        let arguments: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        Ok(choose(&arguments)?.iter().map(|b| b.0).collect())
    }

    #[test]
    fn names_choose_benchmarks() {
        assert_eq!(names("").map(|n| n.len()), Ok(BENCHES.len()));
        assert_eq!(names("micro"), Ok(MICRO.to_vec()));
        assert_eq!(names("scene stencils"), Ok(vec!["stencils", "scene"]));
        assert!(names("stencil").is_err_and(|e| e.contains("stencils")));
    }
}
