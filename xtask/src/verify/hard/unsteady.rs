//! Case `unsteady` of suite `hard`: heat in two materials, by every method that steps through time.
//!
//! Slabs of two and of three layers whose ends are kept at 0 decay by a mode that is known up to the root of a transcendental equation
//! ([`meshless_tests::unsteady`]). Errors are at the time when u has fallen to 1/e. What the steps add is told from what the rows
//! do by a run on the same cloud with steps that are far shorter.

use meshless::Solution;
use meshless_tests::order::over_clouds;
use meshless_tests::unsteady::{composite, sandwich};
use rayon::prelude::*;

use super::super::claims::{Claims, short};
use super::super::figure::{Curve, Figure};
use super::super::jobs::Job;
use super::super::options::Effort;
use super::super::order;
use super::super::runner::{self, Extra, Runner};
use super::super::study::{self, Key, Outcome, Section, Table};
use super::super::variant::Variant;
use super::{FIRST_ORDER, HYBRID, INSENSITIVE};

pub(super) const CASE: &str = "unsteady";

/// A method and what theory gives it at a contact.
struct Stepped {
    variant: Variant,
    /// Least order in space.
    order: f64,
    /// Clouds a spacing.
    seeds: u64,
}

const fn stepped(method: &'static str, order: f64) -> Stepped {
    Stepped { variant: Variant { support: None, ..Variant::plain(method) }, order, seeds: 1 }
}

/// The hybrid that the plan chooses: diagonal dominance, which the paper selects nodes by, does not see a contrast of 10.
const BY_REGION: Variant = Variant { select_by_region: Some(true), ..HYBRID };

const SHARP: Stepped = stepped("sharp", 2.0);

/// Every method that has an order where materials meet.
const METHODS: [Stepped; 8] = [
    Stepped { variant: BY_REGION, ..stepped(HYBRID.method, FIRST_ORDER) },
    stepped("gfdm-conservative", FIRST_ORDER),
    stepped("gfdm-positive", FIRST_ORDER),
    stepped("particle-difference", FIRST_ORDER),
    // Its errors scatter from cloud to cloud.
    Stepped { seeds: 3, ..stepped("particle-difference-extended", FIRST_ORDER) },
    stepped("surface-reaction", FIRST_ORDER),
    // Second order, less what three clouds of different nodes scatter.
    stepped("immersed-interface", 1.8),
    SHARP,
];

/// Contrast of the ladders.
const LADDER: f64 = 10.0;

/// Contrasts in pairs whose solutions differ by less than 1e-5: the errors of either must be alike.
const EXTREMES: [[f64; 2]; 2] = [[1e-10, 1e-6], [1e6, 1e10]];

/// Deviation of an order over several clouds, beyond which it says nothing.
const DEVIATION: f64 = 0.25;

/// Relative L2 error to reach at [`CLAIMED`], any method and contrast.
const LIMIT: f64 = 3e-2;

/// The rung at which claims about errors are checked: a spacing of 1/40.
const CLAIMED: usize = 2;

/// Tolerances of the steps, and that of a run beside which the steps count for nothing.
const TOLERANCES: [f64; 3] = [1e-3, 1e-4, 1e-5];
const EXACT_STEPS: f64 = 1e-7;

/// Least order in the number of steps, of a method of second order.
const STEPS_ORDER: f64 = 1.8;

fn spacing(level: usize) -> f64 {
    0.1 / 2.0_f64.powi(level as i32)
}

fn key(variant: Variant, jump: f64, level: usize) -> Key {
    Key { case: CASE, variant, jump, level, seed: 1 }
}

/// A stiff core floats between two layers where it can; a soft one would be two slabs.
fn problem(key: &Key) -> String {
    let seed = format!("seed = {}", key.seed);
    // Sharp rows are far better than steps of 1e-4.
    let tolerance = if key.variant == SHARP.variant { 1e-5 } else { 1e-4 };
    let scene = if key.jump > LADDER { sandwich } else { composite };
    scene(2, spacing(key.level), key.jump, tolerance).replace("seed = 1", &seed)
}

fn jobs(effort: Effort) -> Vec<Job> {
    let rungs = if effort == Effort::Quick { CLAIMED } else { CLAIMED + 1 };
    let ladders = METHODS.iter().flat_map(|m| {
        let seeds = if effort == Effort::Quick { 1 } else { m.seeds };
        let clouds = move |level| (1..=seeds).map(move |seed| Key { seed, ..key(m.variant, LADDER, level) });
        (0..rungs).flat_map(clouds)
    });
    let extremes = [HYBRID, SHARP.variant].into_iter().flat_map(|variant| {
        EXTREMES.into_iter().flatten().map(move |contrast| key(variant, contrast, rungs - 1))
    });
    let keys = ladders.chain(extremes);
    keys.map(|key| Job { problem: problem(&key), key, extra: Extra::default() }).collect()
}

pub(super) fn run(runner: &mut Runner<'_>, claims: &mut Claims) {
    if !runner.options.wants_case(CASE) {
        return;
    }
    runner.run_all(jobs(runner.options.effort));
    in_space(runner, claims);
    contrasts(runner, claims);
    in_time(runner, claims);
    growth(runner, claims);
    threads(runner, claims);
}

fn finest(effort: Effort) -> usize {
    if effort == Effort::Quick { CLAIMED - 1 } else { CLAIMED }
}

fn error(runner: &Runner<'_>, key: &Key) -> Option<f64> {
    study::find(&runner.outcomes, key).map(Outcome::l2)
}

fn in_space(runner: &Runner<'_>, claims: &mut Claims) {
    if runner.options.effort == Effort::Quick {
        return;
    }
    for Stepped { variant, order, seeds } in &METHODS {
        let rung = |level: usize| -> Option<(f64, Vec<f64>)> {
            let keys = (1..=*seeds).map(|seed| Key { seed, ..key(*variant, LADDER, level) });
            Some((spacing(level), keys.map(|key| error(runner, &key)).collect::<Option<_>>()?))
        };
        let ladder: Option<Vec<(f64, Vec<f64>)>> = (0..=CLAIMED).map(rung).collect();
        let name = format!("{}: order in space, contrast 10", variant.label());
        match (ladder, *seeds) {
            (Some(ladder), 1) => {
                let points: Vec<(f64, f64)> = ladder.iter().map(|(h, errors)| (*h, errors[0])).collect();
                claims.at_least(CASE, name, order::fit(&points), *order);
            }
            (ladder, seeds) => {
                let found = ladder.map(|ladder| over_clouds(&ladder));
                let name = format!("{name}, {seeds} clouds, plus twice its deviation");
                claims.at_least(CASE, name, found.map(|(order, deviation)| order + 2.0 * deviation), *order);
                claims.at_most(
                    CASE,
                    format!("{}: deviation of that order", variant.label()),
                    found.map(|(_, deviation)| deviation),
                    DEVIATION,
                );
            }
        }
    }
}

fn contrasts(runner: &Runner<'_>, claims: &mut Claims) {
    let level = finest(runner.options.effort);
    for variant in [HYBRID, SHARP.variant] {
        for pair in EXTREMES {
            let errors = pair.map(|contrast| error(runner, &key(variant, contrast, level)));
            let errors = errors[0].zip(errors[1]);
            let name = format!("{}, contrasts {:e} and {:e}", variant.label(), pair[0], pair[1]);
            let largest = errors.map(|(a, b)| a.max(b));
            claims.at_most(
                CASE,
                format!("{name}: largest error, spacing 1/{:.0}", 1.0 / spacing(level)),
                largest,
                LIMIT,
            );
            let spread = errors.map(|(a, b)| (a / b).max(b / a));
            claims.at_most(CASE, format!("{name}: largest error over smallest"), spread, INSENSITIVE);
        }
    }
}

/// Solves on one thread.
fn solve(text: &str, key: &Key) -> Result<Solution, String> {
    let solved = meshless::on_threads(1, || runner::solve(text, key, Extra::default()));
    solved.map_err(|e| e.to_string())?.map_err(|e| e.to_string())
}

/// What the steps of a method add to u, relative to the largest u in l2, and one over their number, tolerance by tolerance.
fn steps(variant: Variant) -> Result<Vec<(f64, f64)>, String> {
    let key = key(variant, LADDER, 0);
    let at = |tolerance: f64| solve(&composite(2, spacing(0), LADDER, tolerance), &key);
    let exact = at(EXACT_STEPS)?.field.u;
    // The mode has fallen to 1/e.
    let scale = norm(exact.iter().copied()) * std::f64::consts::E;
    let rung = |&tolerance: &f64| {
        let solution = at(tolerance)?;
        let taken = solution.report.time.as_ref().map_or(0, |time| time.steps);
        let off = norm(solution.field.u.iter().zip(&exact).map(|(a, b)| a - b));
        Ok((1.0 / taken as f64, off / scale))
    };
    TOLERANCES.iter().map(rung).collect()
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|x| x * x).sum::<f64>().sqrt()
}

fn in_time(runner: &mut Runner<'_>, claims: &mut Claims) {
    let wanted = || METHODS.iter().map(|m| m.variant).filter(|v| runner.options.wants(CASE, v.method));
    let variants: Vec<Variant> = wanted().collect();
    let ladders: Vec<Result<Vec<(f64, f64)>, String>> = variants.par_iter().map(|&v| steps(v)).collect();
    for (variant, ladder) in variants.into_iter().zip(ladders) {
        let name = variant.label();
        let ladder = match ladder {
            Ok(ladder) => Some(ladder),
            Err(message) => {
                runner.fail(&key(variant, LADDER, 0), &message);
                None
            }
        };
        let found = ladder.as_deref().and_then(order::fit);
        claims.at_least(CASE, format!("{name}: order in the number of steps"), found, STEPS_ORDER);
        let worst = ladder
            .map(|ladder| ladder.iter().zip(TOLERANCES).map(|((_, error), t)| error / t).fold(0.0, f64::max));
        claims.at_most(CASE, format!("{name}: error of the steps over their tolerance, largest"), worst, 1.0);
    }
}

/// A disc that is smeared over its rim by rows for which that is too stiff, and one by balances.
fn growth(runner: &mut Runner<'_>, claims: &mut Claims) {
    let level = "level_set = \"sqrt((x - 0.47)^2 + (y - 0.52)^2) - 0.27\"";
    let text = composite(2, 0.09, 1e-6, 1e-3).replace("level_set = \"x - 0.4\"", level);
    for (method, grows) in [("gfdm-classical", true), ("gfdm-conservative", false)] {
        if !runner.options.wants(CASE, method) {
            continue;
        }
        let variant = Variant { support: None, ..Variant::plain(method) };
        let ended = solve(&text, &key(variant, 1e-6, 0));
        let said = matches!(&ended, Err(message) if message.contains("grows by itself"));
        let (claim, right) = match grows {
            true => ("rows with a mode that grows end with an error", said),
            false => ("rows in which nothing grows end with a field", ended.is_ok()),
        };
        claims.at_least(CASE, format!("{}: {claim}", variant.label()), Some(f64::from(right)), 1.0);
    }
}

/// The same bits whatever the number of threads.
fn threads(runner: &Runner<'_>, claims: &mut Claims) {
    for variant in [HYBRID, SHARP.variant] {
        if !runner.options.wants(CASE, variant.method) {
            continue;
        }
        let key = key(variant, LADDER, 0);
        let text = problem(&key);
        let bits = |threads: usize| -> Option<Vec<u64>> {
            let solved = meshless::on_threads(threads, || runner::solve(&text, &key, Extra::default()));
            Some(solved.ok()?.ok()?.field.u.iter().map(|u| u.to_bits()).collect())
        };
        let different = bits(1).zip(bits(3)).map(|(one, three)| {
            let pairs = one.iter().zip(&three).filter(|(a, b)| a != b).count();
            (pairs + one.len().abs_diff(three.len())) as f64
        });
        let name = format!("{}: nodes whose value depends on the number of threads", variant.label());
        claims.at_most(CASE, name, different, 0.0);
    }
}

pub(super) fn section(runner: &Runner<'_>) -> Section {
    let rungs = |variant: Variant| -> Vec<&Outcome> {
        (0..=CLAIMED)
            .filter_map(|level| study::find(&runner.outcomes, &key(variant, LADDER, level)))
            .collect()
    };
    let curves = |x: fn(&Outcome) -> f64| -> Vec<Curve> {
        let points = |v: Variant| rungs(v).iter().map(|o| (x(o), o.l2())).collect();
        METHODS.iter().map(|m| Curve { label: m.variant.label(), points: points(m.variant) }).collect()
    };
    let y = "relative L2 error";
    let figures = vec![
        Figure {
            name: "hard-unsteady-convergence".to_owned(),
            caption: "Error against spacing, contrast 10. Dashed: first order.".to_owned(),
            x: "spacing of nodes",
            y,
            curves: curves(|o| o.row.spacing),
            slope: Some(1.0),
        },
        Figure {
            name: "hard-unsteady-cost".to_owned(),
            caption: "Error against seconds from points to the end of time on one thread, contrast 10."
                .to_owned(),
            x: "seconds",
            y,
            curves: curves(|o| o.row.t_total),
            slope: None,
        },
    ];
    let head = ["method", "unknowns", "error", "steps", "rejected", "matrices", "solve (s)", "total (s)"];
    let table = Table {
        caption: "What the steps take on the finest cloud.".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: METHODS.iter().filter_map(|m| line(rungs(m.variant).last()?)).collect(),
    };
    Section {
        case: CASE,
        title: "Heat in two materials",
        about: "A slab of two layers, contrast 10, whose ends are kept at 0, decays by its slowest mode; for the contrasts of the claims \
                a stiff core between two layers does, or a soft layer beside a stiff one.",
        figures,
        pictures: Vec::new(),
        tables: vec![table],
    }
}

fn line(outcome: &Outcome) -> Option<Vec<String>> {
    let (row, time) = (&outcome.row, outcome.report.time.as_ref()?);
    let counts = [time.steps, time.rejected, time.matrices].map(|n| n.to_string());
    let mut cells = vec![outcome.key.variant.label(), row.unknowns.to_string(), short(outcome.l2())];
    cells.extend(counts);
    cells.extend([row.t_solve, row.t_total].map(short));
    Some(cells)
}
