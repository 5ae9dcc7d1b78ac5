//! Suite `dcpse`: the operators themselves, and the problems of Fiétier et al., sections 3 and 5.

mod cases;
mod checks;
mod operators;
mod pseudo;
mod sections;

use meshless_tests::fietier::REFERENCE;

use super::claims::Claims;
use super::options::Options;
use super::runner::Runner;
use super::study::{Outcome, Study};
use super::variant::Variant;
use cases::jobs;

const SUITE: &str = "dcpse";

pub(super) const ABOUT: &str = "DC-PSE operators after Fiétier, Demirel and Sbalzarini: orders of the operators; immersed interfaces with ghosts \
    from constrained fits (ours) and from image points (the paper's); the continuum surface reaction, as in the paper \
    and corrected; against the conservative hybrid on the same clouds. Seed 0 is the lattice, 1 is moved by up to a \
    quarter of the spacing, 2 by up to half.";

pub(super) const CASES: [&str; 4] = ["operators", "dipole", "shells", "inclusions"];

/// As the plan chooses it.
const CONSTRAINED: Variant = Variant { support: None, ..Variant::plain("immersed-interface") };
/// The paper's ghosts: interpolation at the image point from as many nodes as unknowns.
const TRILINEAR: Variant = Variant { ghosts: Some("trilinear"), ..CONSTRAINED };
/// The same with a least-squares fit of second degree.
const QUADRATIC: Variant = Variant { ghosts: Some("quadratic"), ..CONSTRAINED };
/// Surface reaction, corrected.
const REACTION: Variant = Variant { support: None, ..Variant::plain("surface-reaction") };
/// As in the paper, but for the sign.
const PAPER_REACTION: Variant = Variant { smeared: Some(("sharp", "smoothed")), ..REACTION };
/// What it is compared with.
const HYBRID: Variant = Variant { support: None, ..Variant::plain("gfdm-hybrid") };

const VARIANTS: [Variant; 6] = [CONSTRAINED, TRILINEAR, QUADRATIC, REACTION, PAPER_REACTION, HYBRID];

/// Layouts, as seeds.
const LATTICE: u64 = 0;
const JITTERED: u64 = 1;
const SCATTERED: u64 = 2;
const LAYOUTS: [(u64, &str); 3] = [(LATTICE, "lattice"), (JITTERED, "±h/4"), (SCATTERED, "±h/2")];

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    runner.run_all(jobs(options.effort));
    // The inclusions have no closed form: their error is that at the points of the reference.
    for outcome in runner.outcomes.iter_mut().filter(|o| o.key.case == "inclusions") {
        outcome.row.err_l2 = at_reference(outcome);
    }
    if options.wants_case("operators") && options.methods.is_empty() {
        operators::check(&mut claims);
    }
    let mut stepped = Vec::new();
    if options.wants("dipole", CONSTRAINED.method) {
        match pseudo::measure(options.effort) {
            Ok(costs) => stepped = costs,
            Err(error) => runner.failures.push(format!("pseudo-time: {error}")),
        }
    }
    pseudo::check(&stepped, &mut claims);
    checks::dipole(&runner, &mut claims);
    checks::shells(&runner, &mut claims);
    checks::inclusions(&runner, &mut claims);
    runner.failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
    let mut sections = sections::sections(&runner);
    if let (Some(section), false) = (sections.iter_mut().find(|s| s.case == "dipole"), stepped.is_empty()) {
        section.figures.push(pseudo::figure(&stepped));
    }
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}

/// Relative error over the points of the reference.
pub(super) fn at_reference(outcome: &Outcome) -> Option<f64> {
    let probes = &outcome.report.probes;
    let values: Option<Vec<f64>> = probes.iter().map(|p| p.value).collect();
    let values = values.filter(|v| v.len() == REFERENCE.len())?;
    let (error, size) = values
        .iter()
        .zip(REFERENCE)
        .fold((0.0, 0.0), |(error, size), (value, (_, u))| (error + (value - u).powi(2), size + u * u));
    Some((error / size).sqrt())
}
