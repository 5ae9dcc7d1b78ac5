//! `cargo xtask verify`: runs the benchmarks, checks every claim about them, and shows what accuracy costs.

mod adaptive;
mod claims;
mod cost;
mod csv;
mod dcpse;
mod effects;
mod figure;
mod freespace;
mod gfdm;
mod hard;
mod html;
mod jobs;
mod ladder;
mod natural;
mod options;
mod order;
mod particle_difference;
mod row;
mod runner;
mod sharp;
mod solvers;
mod study;
mod suite;
mod tolerance;
mod variant;

use std::fs;
use std::io;
use std::process::ExitCode;
use std::time::Instant;

use claims::{Claim, Verdict};
use options::{Effort, Options};
use study::Study;

pub(crate) fn run(arguments: &[String]) -> ExitCode {
    let options = match Options::parse(arguments) {
        Ok(options) => options,
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(crate::USAGE_ERROR);
        }
    };
    // Before hours of work: can the results be written at all?
    if let Err(error) = fs::create_dir_all(&options.out) {
        eprintln!("error: cannot create {}: {error}", options.out.display());
        return ExitCode::from(crate::USAGE_ERROR);
    }
    if let Some(threads) = options.threads
        && let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()
    {
        eprintln!("error: cannot start {threads} threads: {error}");
        return ExitCode::FAILURE;
    }
    let start = Instant::now();
    let studies: Vec<Study> = options.suites.iter().map(|suite| suite.run(&options)).collect();
    runner::progress("");
    if studies.iter().all(Study::is_empty) {
        let quick = if options.effort == Effort::Quick { ", or the case is not part of --quick" } else { "" };
        eprintln!("error: nothing was run: the method does not take part in the case{quick}");
        return ExitCode::from(crate::USAGE_ERROR);
    }
    let claims: Vec<&Claim> = studies.iter().flat_map(|s| &s.claims).collect();
    let written = write(&options, &studies);
    print_table(&claims);
    match written {
        Ok(()) => say!("\nreport: {}", options.out.join("report.html").display()),
        Err(error) => {
            eprintln!("error: cannot write to {}: {error}", options.out.display());
            return ExitCode::FAILURE;
        }
    }
    let runs: usize = studies.iter().map(|s| s.outcomes.len()).sum();
    say!("{runs} runs in {:.1} s on {} threads", start.elapsed().as_secs_f64(), rayon::current_num_threads());
    let failed = claims.iter().filter(|c| c.verdict == Verdict::Fails).count();
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        eprintln!("{failed} of {} claims do not hold", claims.len());
        ExitCode::FAILURE
    }
}

fn print_table(claims: &[&Claim]) {
    let mut case = ("", "");
    for claim in claims {
        if case != (claim.suite, claim.case) {
            case = (claim.suite, claim.case);
            say!("\n{} / {}", claim.suite, claim.case);
        }
        let mark = match claim.verdict {
            Verdict::Holds => "ok       ",
            Verdict::Explained(_) => "explained",
            Verdict::Fails => "FAILS    ",
        };
        say!("  {mark} {}: {} (expected {})", claim.claim, claim.measured, claim.expected);
        if let Verdict::Explained(why) = claim.verdict {
            say!("            {why}");
        }
    }
}

fn write(options: &Options, studies: &[Study]) -> io::Result<()> {
    let file = |name: &str, text: &str| fs::write(options.out.join(name), text);
    file("results.csv", &row::file(studies.iter().flat_map(|s| &s.outcomes).map(|o| &o.row)))?;
    file("claims.csv", &claims::file(studies.iter().flat_map(|s| &s.claims)))?;
    let page = html::page(studies).map_err(io::Error::other)?;
    for (name, svg) in &page.pictures {
        file(&format!("{name}.svg"), svg)?;
    }
    file("report.html", &page.html)
}
