//! Suite `gfdm`: the benchmarks of Kraus et al. (2022), section 3 and appendices A and B.

mod cases;
mod checks;
mod curved;
mod interior;
mod sections;
mod strips;
mod sweep;
mod tables;
mod view;

use super::claims::Claims;
use super::options::Options;
use super::runner::Runner;
use super::study::Study;
use super::variant::Variant;

const SUITE: &str = "gfdm";

/// Off-diagonal entries of the wrong sign, over the diagonal, that count as round-off: the tolerance by which rows are selected.
const WRONG_SIGN: f64 = 1e-12;

pub(super) const ABOUT: &str = "Generalised finite differences in strong form, conservative, and the two hybrids of Kraus, Kuhnert, Meister and \
    Suchde (2022), on irregular clouds that know nothing of the interface. The interaction radius h is three spacings.";

pub(super) const CASES: [&str; 4] = ["two-strip", "curved", "interior", "three-strip"];

/// Conservative rows where the strong row is not diagonally dominant.
const POSITIVE: Variant = Variant::plain("gfdm-positive").directly();
/// Conservative rows there and at the neighbours.
const HYBRID: Variant = Variant::plain("gfdm-hybrid").directly();
/// Conservative rows everywhere.
const CONSERVATIVE: Variant = Variant::plain("gfdm-conservative").directly();
/// The same, and regions tell where interfaces are: what a plan falls back on.
const BY_REGION: Variant =
    Variant { select_by_region: Some(true), ..Variant::plain("gfdm-hybrid") }.directly();
/// The strong form that the paper compares with.
const STRONG: Variant = Variant::strong(2, true);

/// The interaction radius of a rung: `h = 0.2 / 2^level`.
fn radius(level: usize) -> f64 {
    0.2 / 2.0_f64.powi(level as i32)
}

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    // The tables look at fields, which are dropped after a run: they come first.
    let fractions = tables::fractions(&mut runner);
    let iterations = tables::iterations(&mut runner);
    sweep::sweep(&mut runner);
    checks::check(&mut runner, &mut claims);
    strips::two_strip(&runner, &mut claims);
    strips::three_strip(&mut runner, &mut claims);
    curved::check(&runner, &mut claims);
    interior::check(&runner, &mut claims);
    tables::check(&runner, &fractions, &mut claims);
    let sections = sections::sections(&runner, &fractions, &iterations);
    checks::no_failures(&runner, &mut claims);
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}
