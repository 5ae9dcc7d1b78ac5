//! The slit of section 3.4 and a crack: what visibility, a graded cloud and the singular functions bring.

use meshless_tests::particle_difference::{SlitSetup, crack, slit};

use super::cases::regularity;
use super::checks::{Error, rungs};
use super::{GRID, OURS, SEEDS};
use crate::verify::claims::{Claims, short};
use crate::verify::figure::{Curve, Figure};
use crate::verify::jobs::Job;
use crate::verify::order;
use crate::verify::runner::{self, Extra, Runner};
use crate::verify::study::{Key, Picture, Section, Table, find};
use crate::verify::variant::Variant;

/// One way to treat the slit; its place in the list is the `jump` of the key.
struct Way {
    name: &'static str,
    scene: fn(usize, u64) -> String,
    sees_through: bool,
    /// Whether it makes sense on the regular cloud, too.
    regular: bool,
}

const fn setup(dirichlet: bool, enriched: bool, graded: bool) -> SlitSetup {
    SlitSetup { dirichlet, enriched, graded }
}

const WAYS: [Way; 10] = [
    Way {
        name: "flux jump, as in the paper: no visibility",
        scene: |n, seed| slit(n, regularity(seed), setup(false, false, false)),
        sees_through: true,
        regular: true,
    },
    Way {
        name: "flux jump, visibility",
        scene: |n, seed| slit(n, regularity(seed), setup(false, false, false)),
        sees_through: false,
        regular: true,
    },
    Way {
        name: "flux jump, visibility, graded",
        scene: |n, seed| slit(n, regularity(seed), setup(false, false, true)),
        sees_through: false,
        regular: false,
    },
    Way {
        name: "flux jump, visibility, singular functions",
        scene: |n, seed| slit(n, regularity(seed), setup(false, true, false)),
        sees_through: false,
        regular: true,
    },
    Way {
        name: "flux jump, all three",
        scene: |n, seed| slit(n, regularity(seed), setup(false, true, true)),
        sees_through: false,
        regular: false,
    },
    Way {
        name: "u = 0 on the slit, visibility",
        scene: |n, seed| slit(n, regularity(seed), setup(true, false, false)),
        sees_through: false,
        regular: true,
    },
    Way {
        name: "u = 0, visibility, graded",
        scene: |n, seed| slit(n, regularity(seed), setup(true, false, true)),
        sees_through: false,
        regular: false,
    },
    Way {
        name: "u = 0, visibility, singular functions",
        scene: |n, seed| slit(n, regularity(seed), setup(true, true, false)),
        sees_through: false,
        regular: true,
    },
    Way {
        name: "crack, visibility",
        scene: |n, seed| crack(n, regularity(seed), false),
        sees_through: false,
        regular: true,
    },
    Way {
        name: "crack, visibility, singular functions",
        scene: |n, seed| crack(n, regularity(seed), true),
        sees_through: false,
        regular: true,
    },
];

const PAPER: usize = 0;
const SEEN: usize = 1;
const SINGULAR: usize = 3;
const PRESCRIBED: usize = 5;
const PRESCRIBED_SINGULAR: usize = 7;
const CRACK: usize = 8;
const CRACK_SINGULAR: usize = 9;

/// Largest errors of the prototype that the paper's formulas were first tried with, 400 to 6400 nodes.
const PROTOTYPE: [f64; 2] = [7.4e-2, 5.4e-2];

const L2: Error = |r| r.err_l2;
const MAX: Error = |r| r.err_linf;

fn key(way: usize, seed: u64) -> Key {
    let visibility = WAYS[way].sees_through.then_some(false);
    let variant = Variant { visibility, ..OURS };
    Key { case: "slit", variant, jump: way as f64, level: 0, seed }
}

pub(super) fn jobs(rungs: usize) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (number, way) in WAYS.iter().enumerate() {
        for seed in SEEDS.into_iter().filter(|&s| s != GRID || way.regular) {
            jobs.extend((0..rungs).map(|level| Job {
                problem: (way.scene)(20 << level, seed),
                key: Key { level, ..key(number, seed) },
                extra: Extra::default(),
            }));
        }
    }
    jobs
}

pub(super) fn claims(runner: &Runner<'_>, claims: &mut Claims) {
    let first = |way, seed, error| {
        let rungs = rungs(runner, &key(way, seed), error);
        (rungs.len() > 2).then(|| [rungs[0], rungs[1], rungs[2]])
    };
    let order_of = |way, seed, error| order::fit(&first(way, seed, error)?);
    let at = |way, seed, level: usize| Some(first(way, seed, MAX)?[level].1);
    let ratio = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a / b);
    let named = |way: usize, seed: u64, what: &str| {
        format!("{}, {} cloud: {what}", WAYS[way].name, if seed == GRID { "regular" } else { "scattered" })
    };
    for (level, (error, nodes)) in [0, 2].into_iter().zip(PROTOTYPE.into_iter().zip([400, 6400])) {
        let measured = ratio(at(PAPER, GRID, level), Some(error));
        let claim = named(PAPER, GRID, &format!("largest error over the prototype's, {nodes} nodes"));
        claims.within("slit", claim, measured, [0.9, 1.1]);
    }
    claims.at_most(
        "slit",
        named(PAPER, GRID, "order of the largest error, of which the prototype had 0.23"),
        order_of(PAPER, GRID, MAX),
        0.4,
    );
    // Visibility alone does not help where the sides are coupled: the jump that it carries over is singular.
    claims.within(
        "slit",
        named(SEEN, GRID, "largest error over that without visibility, 6400 nodes"),
        ratio(at(SEEN, GRID, 2), at(PAPER, GRID, 2)),
        [0.7, 1.7],
    );
    for way in [PRESCRIBED, CRACK] {
        claims.at_least("slit", named(way, GRID, "order in L2"), order_of(way, GRID, L2), 0.9);
    }
    for way in [SINGULAR, PRESCRIBED_SINGULAR, CRACK_SINGULAR] {
        for seed in SEEDS {
            claims.at_least("slit", named(way, seed, "order in L2"), order_of(way, seed, L2), 1.8);
            claims.at_least(
                "slit",
                named(way, seed, "order of the largest error"),
                order_of(way, seed, MAX),
                1.3,
            );
        }
    }
    for (level, error, nodes) in [(0, PROTOTYPE[0], 400), (2, PROTOTYPE[1], 6400)] {
        for (seed, limit) in SEEDS.into_iter().zip([0.02, 0.4]) {
            let claim = named(SINGULAR, seed, &format!("largest error over the prototype's, {nodes} nodes"));
            claims.at_most("slit", claim, ratio(at(SINGULAR, seed, level), Some(error)), limit);
        }
    }
    for (with, without, gain) in
        [(SINGULAR, SEEN, 300.0), (PRESCRIBED_SINGULAR, PRESCRIBED, 300.0), (CRACK_SINGULAR, CRACK, 25.0)]
    {
        let claim = named(with, GRID, "largest error without singular functions over that with, 6400 nodes");
        claims.at_least("slit", claim, ratio(at(without, GRID, 2), at(with, GRID, 2)), gain);
    }
}

pub(super) fn section(runner: &Runner<'_>) -> Section {
    let seed = SEEDS[1];
    let curves = |error: Error| {
        (WAYS.iter().enumerate())
            .map(|(k, way)| Curve { label: way.name.to_owned(), points: rungs(runner, &key(k, seed), error) })
            .filter(|c| !c.points.is_empty())
            .collect()
    };
    let figure = |kind: &str, caption: &str, y, error| Figure {
        name: format!("particle-difference-slit-{kind}"),
        caption: caption.to_owned(),
        x: "smallest spacing",
        y,
        curves: curves(error),
        slope: Some(2.0),
    };
    let text = (WAYS[CRACK_SINGULAR].scene)(40, seed);
    let drawn = runner::solve(&text, &key(CRACK_SINGULAR, seed), Extra { picture: true, ..Extra::default() });
    let picture = drawn.ok().and_then(|solution| solution.picture).map(|picture| Picture {
        name: "particle-difference-crack-solution".to_owned(),
        caption: "The crack, 1600 scattered nodes.".to_owned(),
        svg: picture.svg,
    });
    Section {
        case: "slit",
        title: "Slit and crack",
        about: "Section 3.4: Im sqrt(z^2 + 1), whose gradient is infinite at the tip of a slit that ends in the middle of \
                the square, by the jump of the flux or with u = 0 on the slit; and heat past an insulating crack with two \
                tips.",
        figures: vec![
            figure("l2", "Scattered clouds. Dashed: second order.", "relative L2 error of u", L2),
            figure("max", "Scattered clouds. Dashed: second order.", "relative maximum error of u", MAX),
        ],
        pictures: picture.into_iter().collect(),
        tables: vec![table(runner)],
    }
}

fn table(runner: &Runner<'_>) -> Table {
    let mut rows = Vec::new();
    for (number, way) in WAYS.iter().enumerate() {
        for seed in SEEDS {
            let ladder =
                (0..3).filter_map(|level| find(&runner.outcomes, &Key { level, ..key(number, seed) }));
            let errors: Vec<[f64; 2]> =
                ladder.filter_map(|o| Some([o.row.err_l2?, o.row.err_linf?])).collect();
            if errors.is_empty() {
                continue;
            }
            let cloud = if seed == GRID { "regular" } else { "scattered" };
            let list = |which: usize| errors.iter().map(|e| short(e[which])).collect::<Vec<_>>().join(", ");
            rows.push(vec![way.name.to_owned(), cloud.to_owned(), list(0), list(1)]);
        }
    }
    Table {
        caption: "What each means brings: 20, 40 and 80 nodes an edge.".to_owned(),
        head: ["treatment", "cloud", "L2 errors", "largest errors"].map(str::to_owned).to_vec(),
        rows,
    }
}
