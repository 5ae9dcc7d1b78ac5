//! Suite `hard`: what breaks methods that look good on the published cases.

mod problems;
mod unsteady;

use problems::{Rings, rings};

use super::claims::Claims;
use super::figure::{Curve, Figure};
use super::jobs::Job;
use super::options::{Effort, Options};
use super::order;
use super::runner::{Extra, Runner};
use super::study::{self, Key, Section, Study};
use super::variant::Variant;

const SUITE: &str = "hard";

pub(super) const ABOUT: &str = "Contrasts from 1e-10 to 1e12, clouds of several seeds, a gap as thin as the spacing, nodes on the interface, nested \
    floating rings, a re-entrant corner, heat in two materials; by the conservative hybrid, and by what the plan chooses.";

pub(super) const CASES: [&str; 7] =
    ["contrast", "seeds", "thin-gap", "on-interface", "nested-rings", "l-shape", unsteady::CASE];

/// The method whose order and insensitivity are claimed.
const HYBRID: Variant = Variant { support: None, ..Variant::plain("gfdm-hybrid") };

/// What a scene gets that names no method.
const AUTO: Variant = Variant { support: None, ..Variant::plain("auto") };

/// Orders that count as first order.
const FIRST_ORDER: f64 = 0.9;

/// How much the error may depend on the contrast or on the seed.
const INSENSITIVE: f64 = 2.0;

/// A family of runs that belong together: one ladder for each jump and seed.
struct Family {
    case: &'static str,
    title: &'static str,
    about: &'static str,
    scene: fn(f64, f64, u64) -> String,
    jumps: &'static [f64],
    seeds: &'static [u64],
    /// Nodes on a grid, so that some lie on the interface.
    grid: bool,
    /// Relative L2 error to reach at spacing 1/60.
    limit: f64,
}

const FAMILIES: [Family; 6] = [
    Family {
        case: "contrast",
        title: "Contrasts",
        about: "A disc and a ring around it, alternately stiff and soft. Where the contrast is below 1, the soft parts carry \
                values as large as its inverse.",
        scene: |contrast, spacing, seed| {
            rings(&Rings { radii: &[0.35, 0.6], ..Rings::plain(contrast) }, spacing, seed)
        },
        jumps: &[1e-10, 1e-6, 1e-2, 1e2, 1e6, 1e10, 1e12],
        seeds: &[1],
        grid: false,
        limit: 2e-2,
    },
    Family {
        case: "seeds",
        title: "Seeds",
        about: "The interior interface on clouds of several seeds.",
        scene: |jump, spacing, seed| meshless_tests::kraus::interior(jump, 3.0 * spacing, seed),
        jumps: &[1e10],
        seeds: &[1, 2, 3, 4, 5],
        grid: false,
        limit: 3e-3,
    },
    Family {
        case: "thin-gap",
        title: "Thin gap",
        about: "Two stiff rings with a soft gap of 0.04 between them: about one spacing on the coarsest cloud.",
        scene: |contrast, spacing, seed| {
            rings(&Rings { radii: &[0.2, 0.4, 0.44, 0.7], ..Rings::plain(contrast) }, spacing, seed)
        },
        jumps: &[1e2, 1e6, 1e10],
        seeds: &[1],
        grid: false,
        limit: 1e-2,
    },
    Family {
        case: "on-interface",
        title: "Nodes on the interface",
        about: "Two strips on a grid with a column of nodes on the interface: they belong to the region that matches first.",
        scene: |jump, spacing, seed| meshless_tests::kraus::two_strip(jump, 3.0 * spacing, seed),
        jumps: &[1e-10, 1e-4, 1e4, 1e10],
        seeds: &[1],
        grid: true,
        limit: 1e-2,
    },
    Family {
        case: "nested-rings",
        title: "Nested floating rings",
        about: "Three stiff rings, one within the other, none of which touches a boundary: their constants depend on each other.",
        scene: |contrast, spacing, seed| {
            rings(
                &Rings { radii: &[0.15, 0.3, 0.45, 0.6, 0.75, 0.9], ..Rings::plain(contrast) },
                spacing,
                seed,
            )
        },
        jumps: &[1e2, 1e6, 1e10, 1e12],
        seeds: &[1],
        grid: false,
        limit: 2e-2,
    },
    Family {
        case: "l-shape",
        title: "L-shaped domain",
        about: "The disc and the ring, cut by a re-entrant corner at their centre: interfaces meet the boundary.",
        scene: |contrast, spacing, seed| {
            rings(&Rings { radii: &[0.35, 0.6], corner: true, ..Rings::plain(contrast) }, spacing, seed)
        },
        jumps: &[1e-6, 1e6, 1e10],
        seeds: &[1],
        grid: false,
        limit: 1e-2,
    },
];

/// Spacing of a rung.
fn spacing(level: usize) -> f64 {
    1.0 / 15.0 / 2.0_f64.powi(level as i32)
}

/// The rung at which the claims about errors are checked.
const CLAIMED: usize = 2;

pub(super) fn run(options: &Options) -> Study {
    let mut runner = Runner::new(SUITE, options);
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let rungs = match options.effort {
        Effort::Quick => CLAIMED + 1,
        Effort::Default => CLAIMED + 2,
        Effort::Full => CLAIMED + 3,
    };
    let mut sections = Vec::new();
    runner.run_all(FAMILIES.iter().flat_map(|family| family.jobs(rungs)).collect());
    for family in FAMILIES.iter().filter(|f| options.wants(f.case, HYBRID.method)) {
        family.check(&runner, &mut claims);
        sections.push(family.section(&runner));
    }
    unsteady::run(&mut runner, &mut claims);
    if options.wants_case(unsteady::CASE) {
        sections.push(unsteady::section(&runner));
    }
    runner.failures.iter().for_each(|f| eprintln!("run failed: {f}"));
    claims.at_most("all", "runs that ended with an error", Some(runner.failures.len() as f64), 0.0);
    Study { suite: SUITE, outcomes: runner.outcomes, claims: claims.by_case(&CASES), sections }
}

impl Family {
    fn members(&self) -> impl Iterator<Item = (f64, u64)> {
        self.jumps.iter().flat_map(|&jump| self.seeds.iter().map(move |&seed| (jump, seed)))
    }

    fn jobs(&self, rungs: usize) -> impl Iterator<Item = Job> {
        self.members().flat_map(move |(jump, seed)| {
            let chosen = Key { variant: AUTO, ..self.key(jump, CLAIMED, seed) };
            (0..rungs).map(move |level| self.key(jump, level, seed)).chain([chosen]).map(|key| Job {
                problem: (self.scene)(key.jump, spacing(key.level), key.seed),
                key,
                extra: Extra { grid: self.grid, ..Extra::default() },
            })
        })
    }

    fn key(&self, jump: f64, level: usize, seed: u64) -> Key {
        Key { case: self.case, variant: HYBRID, jump, level, seed }
    }

    fn check(&self, runner: &Runner<'_>, claims: &mut Claims) {
        let error = |jump, seed| {
            study::find(&runner.outcomes, &self.key(jump, CLAIMED, seed)).map(study::Outcome::l2)
        };
        for (jump, seed) in self.members() {
            let name =
                if self.seeds.len() > 1 { format!("seed {seed}") } else { format!("contrast {jump:e}") };
            claims.at_most(
                self.case,
                format!("{name}: error at spacing 1/60"),
                error(jump, seed),
                self.limit,
            );
            let ladder = study::ladder(&runner.outcomes, &self.key(jump, 0, seed));
            let order = if ladder.len() > 2 { order::fit(&ladder) } else { None };
            claims.at_least(self.case, format!("{name}: order"), order, FIRST_ORDER);
        }
        let chosen = |(jump, seed)| {
            let key = Key { variant: AUTO, ..self.key(jump, CLAIMED, seed) };
            study::find(&runner.outcomes, &key).map(study::Outcome::l2)
        };
        let ratios: Option<Vec<f64>> =
            self.members().map(|(jump, seed)| Some(chosen((jump, seed))? / error(jump, seed)?)).collect();
        claims.at_most(
            self.case,
            "error of what the plan chooses over that of the conservative hybrid at spacing 1/60, largest",
            ratios.map(|r| r.into_iter().fold(0.0, f64::max)),
            1.0,
        );
        let stiff = |(jump, _): &(f64, u64)| *jump >= 1e4;
        let errors: Option<Vec<f64>> =
            self.members().filter(stiff).map(|(jump, seed)| error(jump, seed)).collect();
        let spread = errors
            .map(|e| e.iter().copied().fold(0.0, f64::max) / e.iter().copied().fold(f64::INFINITY, f64::min));
        claims.at_most(
            self.case,
            "largest error over smallest, contrasts of 1e4 and more, all seeds",
            spread,
            INSENSITIVE,
        );
    }

    fn section(&self, runner: &Runner<'_>) -> Section {
        let curve = |(jump, seed): (f64, u64)| Curve {
            label: if self.seeds.len() > 1 { format!("seed {seed}") } else { format!("contrast {jump:e}") },
            points: study::ladder(&runner.outcomes, &self.key(jump, 0, seed)),
        };
        let convergence = Figure {
            name: format!("hard-{}-convergence", self.case),
            caption: "Error against spacing. Dashed: first order.".to_owned(),
            x: "spacing of nodes",
            y: "relative L2 error",
            curves: self.members().map(curve).collect(),
            slope: Some(1.0),
        };
        Section {
            case: self.case,
            title: self.title,
            about: self.about,
            figures: vec![convergence],
            pictures: Vec::new(),
            tables: Vec::new(),
        }
    }
}
