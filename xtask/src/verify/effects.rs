//! Suite `effects`: films and partition coefficients, velocities, reactions, capacities – alone, together, and in problems with closed forms.

use meshless::report::Report;
use meshless_tests::effects::{
    ARRAY_WITH_CONTACT, Effects, NAFEMS_T3, array_with_contact, chip_behind_a_film, chosen, disc_with_film,
    nafems_t3, stream,
};

use super::claims::{Claims, short};
use super::figure::{Curve, Figure};
use super::jobs::Job;
use super::options::{Effort, Options};
use super::order;
use super::runner::{Extra, Runner};
use super::study::{Key, Section, Study, Table, find, ladder};
use super::variant::Variant;

const SUITE: &str = "effects";

pub(super) const ABOUT: &str = "Effects beside diffusion: interfaces with a resistance or partition coefficients, a velocity, a reaction, capacities. Chosen \
    solutions prove orders, closed forms and series that answers are right.";

pub(super) const CASES: [&str; 10] = [
    "contact",
    "partition",
    "advection",
    "reaction",
    "together",
    "together-line",
    "together-space",
    "capacity",
    "closed-forms",
    "stream",
];

/// A method at an order, on its own radius of interaction.
const fn method(name: &'static str, order: Option<usize>) -> Variant {
    Variant { order, support: None, ..Variant::plain(name) }
}

const SHARP_4: Variant = method("sharp", Some(4));
const SHARP_6: Variant = method("sharp", Some(6));
const CONSERVATIVE: Variant = method("gfdm-conservative", None);
const HYBRID: Variant = method("gfdm-hybrid", None);
const AUTO: Variant = method("auto", None);

/// A chosen solution, and what is asked of every method: the least order, and the error of the last cloud.
struct Chosen {
    case: &'static str,
    title: &'static str,
    about: &'static str,
    dimension: usize,
    effects: Effects,
    coarsest: f64,
    /// Rungs of the default sweep.
    rungs: usize,
    /// Method, least order, largest error on the last rung.
    asked: &'static [(Variant, f64, f64)],
}

const ASKED: &[(Variant, f64, f64)] =
    &[(SHARP_4, 3.5, 1e-6), (SHARP_6, 5.5, 1e-9), (CONSERVATIVE, 0.8, 2e-2), (HYBRID, 0.8, 2e-2)];

const PLANE: Chosen = Chosen {
    case: "",
    title: "",
    about: "",
    dimension: 2,
    effects: Effects::NONE,
    coarsest: 0.1,
    rungs: 3,
    asked: ASKED,
};

const CHOSEN: [Chosen; 8] = [
    Chosen {
        case: "contact",
        title: "An interface that resists",
        about: "A disc of diffusivity 10 behind a film of resistance 0.2.",
        effects: Effects { resistance: 0.2, ..Effects::NONE },
        ..PLANE
    },
    Chosen {
        case: "partition",
        title: "Partition coefficients",
        about: "u / K goes on, with K = 1 in the disc and 2.5 outside.",
        effects: Effects { partition: [1.0, 2.5], ..Effects::NONE },
        ..PLANE
    },
    Chosen {
        case: "advection",
        title: "A velocity",
        about: "Without sources, another one in the disc than outside; fluxes through the interface go with it.",
        effects: Effects { velocity: true, ..Effects::NONE },
        ..PLANE
    },
    Chosen {
        case: "reaction",
        title: "A reaction",
        about: "A factor of u that varies in the disc.",
        effects: Effects { reaction: true, ..Effects::NONE },
        ..PLANE
    },
    Chosen {
        case: "together",
        title: "All of them",
        about: "Film, partition coefficients, velocity and reaction.",
        effects: Effects::ALL,
        ..PLANE
    },
    Chosen {
        case: "together-line",
        title: "All of them on the line",
        about: "Film, partition coefficients, velocity and reaction. Errors of balances are those of one node here.",
        dimension: 1,
        effects: Effects::ALL,
        asked: &[(SHARP_4, 3.5, 1e-5), (CONSERVATIVE, 0.0, 3e-2)],
        ..PLANE
    },
    Chosen {
        case: "together-space",
        title: "All of them in space",
        about: "Film, partition coefficients, velocity and reaction.",
        dimension: 3,
        effects: Effects::ALL,
        coarsest: 0.3,
        rungs: 2,
        asked: &[(SHARP_4, 2.5, 2e-3), (CONSERVATIVE, 0.5, 1e-1)],
    },
    Chosen {
        case: "capacity",
        title: "Capacities in time",
        about: "One that varies in the disc, one beside it, and a film in between.",
        effects: Effects { time: true, resistance: 0.2, ..Effects::NONE },
        coarsest: 0.2,
        rungs: 2,
        asked: &[(SHARP_4, 2.5, 1e-3), (CONSERVATIVE, 0.8, 6e-2)],
        ..PLANE
    },
];

impl Chosen {
    fn rungs(&self, effort: Effort) -> usize {
        match effort {
            // One case stands for all of them.
            Effort::Quick => {
                if self.case == "together" {
                    2
                } else {
                    0
                }
            }
            Effort::Default => self.rungs,
            Effort::Full => self.rungs + 1,
        }
    }

    fn key(&self, variant: Variant, level: usize) -> Key {
        Key { case: self.case, variant, jump: self.effects.contrast, level, seed: 1 }
    }

    fn jobs(&self, effort: Effort) -> impl Iterator<Item = Job> + '_ {
        self.asked.iter().flat_map(move |(variant, _, _)| {
            (0..self.rungs(effort)).map(move |level| Job {
                problem: chosen(self.dimension, &self.effects, self.coarsest / 2.0_f64.powi(level as i32), 1),
                key: self.key(*variant, level),
                extra: Extra::default(),
            })
        })
    }

    fn check(&self, runner: &Runner<'_>, claims: &mut Claims) {
        let rungs = self.rungs(runner.options.effort);
        if rungs < 2 {
            return;
        }
        for (variant, least, largest) in self.asked {
            let points = ladder(&runner.outcomes, &self.key(*variant, 0));
            let label = variant.label();
            claims.at_least(self.case, format!("{label}: observed order"), order::fit(&points), *least);
            if rungs >= self.rungs {
                let last = points.get(self.rungs - 1).map(|p| p.1);
                claims.at_most(
                    self.case,
                    format!("{label}: relative L2 error, rung {}", self.rungs),
                    last,
                    *largest,
                );
            }
        }
    }

    fn section(&self, runner: &Runner<'_>) -> Section {
        let curve = |(variant, _, _): &(Variant, f64, f64)| Curve {
            label: variant.label(),
            points: ladder(&runner.outcomes, &self.key(*variant, 0)),
        };
        Section {
            case: self.case,
            title: self.title,
            about: self.about,
            figures: vec![Figure {
                name: format!("effects-{}", self.case),
                caption: "Relative L2 error. Dashed: fourth order.".to_owned(),
                x: "spacing of nodes",
                y: "relative L2 error",
                curves: self.asked.iter().map(curve).filter(|c| !c.points.is_empty()).collect(),
                slope: Some(4.0),
            }],
            pictures: Vec::new(),
            tables: Vec::new(),
        }
    }
}

/// Resistances of the film round the disc.
const FILMS: [f64; 5] = [0.0, 0.1, 10.0, 1e6, 1e12];
/// The same round a chip with corners.
const CHIP_FILMS: [f64; 3] = [1e-3, 0.1, 10.0];
/// Péclet numbers of a cell.
const CELLS: [f64; 4] = [0.1, 1.0, 10.0, 1000.0];
const STREAM_SPACING: f64 = 0.05;

fn key(case: &'static str, variant: Variant, jump: f64, level: usize) -> Key {
    Key { case, variant, jump, level, seed: 1 }
}

/// The films are level 0 of the closed forms, the array is level 1, the bar level 2, the chip level 3.
fn closed(effort: Effort) -> Vec<Job> {
    let estimate = Extra { estimate: true, ..Extra::default() };
    let job = |problem, key, extra| Job { problem, key, extra };
    let films = if effort == Effort::Quick { &FILMS[1..2] } else { &FILMS[..] };
    let films =
        films.iter().map(|&r| job(disc_with_film(r, 0.05, 1), key("closed-forms", AUTO, r, 0), estimate));
    let mut all: Vec<Job> = films.collect();
    if effort > Effort::Quick {
        for (h, _) in ARRAY_WITH_CONTACT {
            all.push(job(array_with_contact(h, 0.025, 1), key("closed-forms", AUTO, h, 1), estimate));
        }
        for variant in [AUTO, SHARP_4] {
            for film in CHIP_FILMS {
                let key = key("closed-forms", variant, film, 3);
                all.push(job(chip_behind_a_film(film, 0.025, 1), key, estimate));
            }
        }
        for variant in [SHARP_4, CONSERVATIVE] {
            all.push(job(nafems_t3(0.002), key("closed-forms", variant, 1.0, 2), Extra::default()));
        }
        for cell in CELLS {
            let text = stream(2, cell / STREAM_SPACING, STREAM_SPACING, 1);
            all.push(job(text, key("stream", CONSERVATIVE, cell, 0), Extra::default()));
        }
        let resolved = stream(2, 10.0, STREAM_SPACING, 1);
        all.push(job(resolved, key("stream", SHARP_6, 0.5, 0), Extra::default()));
    }
    all
}

/// The larger error of what flows in and out, and its estimate.
fn conductivity(report: &Report, effective: f64) -> Option<[f64; 2]> {
    let fluxes = &report.fluxes.as_ref()?.boundaries;
    let error = |face: &str| {
        let flux = fluxes.iter().find(|flux| flux.face == face)?;
        Some([(flux.flux.abs() - effective).abs() / effective, flux.estimate? / effective])
    };
    let (left, right) = (error("left")?, error("right")?);
    Some(if left[0] > right[0] { left } else { right })
}

fn check_closed(runner: &Runner<'_>, claims: &mut Claims) {
    let report = |key: &Key| find(&runner.outcomes, key).map(|run| &run.report);
    let l2 = |report: &Report| report.errors.as_ref().map(|errors| errors.l2);
    let quick = runner.options.effort == Effort::Quick;
    for film in if quick { &FILMS[1..2] } else { &FILMS[..] } {
        let found = report(&key("closed-forms", AUTO, *film, 0));
        let what = format!(
            "disc behind a film of resistance {film:e}, the plan's choice, 1,600 nodes: relative L2 error"
        );
        claims.at_most("closed-forms", what, found.and_then(l2), 2e-4);
    }
    if quick {
        return;
    }
    for (h, effective) in ARRAY_WITH_CONTACT {
        let found =
            report(&key("closed-forms", AUTO, h, 1)).and_then(|report| conductivity(report, effective));
        let what = format!(
            "square array of cylinders, contact conductance h a = {h}: effective conductivity, relative error"
        );
        claims.at_most("closed-forms", what, found.map(|f| f[0]), 5e-4);
        let what = format!("the same, h a = {h}: true error over its estimate");
        claims.at_most("closed-forms", what, found.map(|f| f[0] / f[1]), 10.0);
    }
    for film in CHIP_FILMS {
        let [balances, fits] = [AUTO, SHARP_4].map(|variant| report(&key("closed-forms", variant, film, 3)));
        for (name, found) in [("the plan's choice", balances), ("sharp", fits)] {
            let what = format!(
                "heated chip behind a film of {film:e}, {name}, h = 0.025: heat that leaves, off 3.6"
            );
            let leaves = |report: &Report| {
                let entering = &report.balance.as_ref()?.into;
                Some((entering.iter().map(|part| part.flux).sum::<f64>() + 3.6).abs() / 3.6)
            };
            claims.at_most("closed-forms", what, found.and_then(leaves), 1e-3);
        }
        let apart = balances.zip(fits).and_then(|(a, b)| {
            let over = a
                .probes
                .iter()
                .zip(&b.probes)
                .map(|(p, q)| Some((p.value? - q.value?).abs() / (p.estimate? + q.estimate?)));
            over.collect::<Option<Vec<f64>>>().map(|all| all.into_iter().fold(0.0, f64::max))
        });
        let what = format!(
            "the same, {film:e}: how far values of the two are apart, over the sum of their estimates"
        );
        claims.at_most("closed-forms", what, apart, 1.0);
    }
    for (variant, bound) in [(SHARP_4, 1e-4), (CONSERVATIVE, 0.05)] {
        let found = report(&key("closed-forms", variant, 1.0, 2)).and_then(|r| r.probes.first()?.value);
        let what = format!("NAFEMS T3 by {}, 50 intervals: error in K", variant.label());
        claims.at_most("closed-forms", what, found.map(|value| (value - NAFEMS_T3).abs()), bound);
    }
    for cell in CELLS {
        let found = report(&key("stream", CONSERVATIVE, cell, 0));
        let beyond = found.map(|report| (-report.extrema.min).max(report.extrema.max - 1.0).max(0.0));
        claims.at_most(
            "stream",
            format!("cell Péclet number {cell}: values beyond those on the boundary"),
            beyond,
            1e-12,
        );
    }
    let found = report(&key("stream", CONSERVATIVE, CELLS[0], 0)).and_then(l2);
    claims.at_most("stream", "cell Péclet number 0.1, balances: relative L2 error", found, 1e-2);
    let found = report(&key("stream", SHARP_6, 0.5, 0)).and_then(l2);
    claims.at_most("stream", "cell Péclet number 0.5, sharp of order 6: relative L2 error", found, 1e-4);
}

fn table_of(runner: &Runner<'_>, case: &'static str, title: &'static str, about: &'static str) -> Section {
    let row = |run: &super::study::Outcome| {
        let figure = |x: Option<f64>| x.map_or_else(String::new, short);
        vec![
            format!("{:e}", run.key.jump),
            format!("{} ({})", run.key.variant.label(), run.report.method),
            run.row.unknowns.to_string(),
            figure(run.row.err_l2),
            figure(run.report.estimate.l2),
            short(run.row.t_total),
        ]
    };
    let rows = runner.outcomes.iter().filter(|run| run.key.case == case).map(row).collect();
    let head = ["parameter", "method", "unknowns", "relative L2 error", "estimate", "total (s)"];
    let table = Table { caption: "Every run.".to_owned(), head: head.map(str::to_owned).to_vec(), rows };
    Section { case, title, about, figures: Vec::new(), pictures: Vec::new(), tables: vec![table] }
}

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let jobs = CHOSEN.iter().flat_map(|case| case.jobs(options.effort)).chain(closed(options.effort));
    runner.run_all(jobs.collect());
    let mut sections = Vec::new();
    for case in CHOSEN.iter().filter(|case| options.wants_case(case.case) && case.rungs(options.effort) > 0) {
        case.check(&runner, &mut claims);
        sections.push(case.section(&runner));
    }
    check_closed(&runner, &mut claims);
    for (case, title, about) in [
        (
            "closed-forms",
            "Closed forms",
            "A disc and a chip behind a film, an array of cylinders with contact resistance, a bar whose end swings.",
        ),
        (
            "stream",
            "A stream and its layer",
            "u is 0 at the inlet and 1 at the outlet, and all of the change is in a layer there.",
        ),
    ] {
        if options.wants_case(case) && runner.outcomes.iter().any(|run| run.key.case == case) {
            sections.push(table_of(&runner, case, title, about));
        }
    }
    runner.failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}
