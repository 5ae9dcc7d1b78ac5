//! Suite `solvers`: multigrid on every kind of matrix, in iterations rather than seconds.

use meshless::sparse::{MultigridParams, PreconditionerKind, Prepared, SolveError, SolverKind, SolverParams};

use super::claims::{Claims, short};
use super::options::{Effort, Options};
use super::runner;
use super::study::{Section, Study, Table};
use crate::bench::systems::{Kind, system};

const SUITE: &str = "solvers";

pub(super) const ABOUT: &str = "Multigrid: a ball of another diffusivity in a box, by six kinds of discretisation; iterations of GMRES to a residual of 1e-10.";

pub(super) const CASES: [&str; 6] =
    ["conservative", "hybrid", "classical", "particle", "ghosts", "seven-point"];

const CONTRASTS: [f64; 3] = [1.0, 1e4, 1e10];

const TOLERANCE: f64 = 1e-10;

/// Vectors that GMRES keeps.
const RESTART: usize = 60;

/// Iterations at most, at any size and contrast.
const ITERATIONS: f64 = 15.0;

/// By how many iterations the largest cloud may exceed the smallest.
const GROWTH: f64 = 3.0;

/// The same in space where a node of a floating region is pinned, at 1e6 unknowns.
const GROWTH_WITH_PIN: f64 = 5.0;

const POINT_SOURCE: &str = "a pinned node in space is a point at which the error behaves like 1/r, which coarse levels resolve the less the finer the cloud: a box of pure Neumann conditions with one pinned node grows likewise, from 11 iterations at 1e4 unknowns to 14 at 5e5";

/// By what factor the highest contrast may exceed none.
const CONTRAST_FACTOR: f64 = 2.0;

const COMPLEXITY: f64 = 1.6;

/// What was measured of a matrix.
struct Figures {
    case: &'static str,
    kind: Kind,
    unknowns: usize,
    contrast: f64,
    iterations: usize,
    residual: f64,
    complexity: f64,
}

pub(super) fn run(options: &Options) -> Study {
    let sizes: &[usize] = match options.effort {
        Effort::Quick => &[2_500, 10_000],
        Effort::Default => &[10_000, 40_000],
        Effort::Full => &[10_000, 100_000, 1_000_000],
    };
    let mut claims = Claims::new(SUITE, options.is_filtered());
    let mut all = Vec::new();
    for (case, kind) in CASES.into_iter().zip(Kind::ALL) {
        if !options.wants(case, "multigrid") {
            continue;
        }
        // Rows of 65 entries: larger clouds take minutes to make.
        let largest = if kind == Kind::Ghosts { 20_000 } else { usize::MAX };
        let sizes: Vec<usize> = sizes.iter().copied().filter(|&n| n <= largest).collect();
        let contrasts = if outpaced(kind) { &CONTRASTS[..1] } else { &CONTRASTS };
        for &contrast in contrasts {
            for &n in &sizes {
                runner::progress(&format!("{SUITE} {case} {contrast:e} {n}"));
                all.extend(measure(case, kind, n, contrast, false));
            }
            check(&all, case, contrast, &mut claims);
        }
        let at = |contrast| last(&all, case, contrast).map(|f| f.iterations as f64);
        if outpaced(kind) {
            runner::progress(&format!("{SUITE} {case} 1e4 {}", sizes[0]));
            let stepped_in = measure(case, kind, sizes[0], CONTRASTS[1], true);
            let claim = "contrast 1e4: residual of `multigrid` with what steps in for it";
            claims.at_most(case, claim, stepped_in.as_ref().map(|f| f.residual), TOLERANCE);
            all.extend(stepped_in);
        } else {
            let ratio = at(CONTRASTS[2]).zip(at(1.0)).map(|(high, low)| high / low);
            claims.at_most(
                case,
                "iterations at contrast 1e10 over those at 1, largest cloud",
                ratio,
                CONTRAST_FACTOR,
            );
        }
    }
    let sections = CASES.into_iter().zip(Kind::ALL).map(|(case, kind)| section(&all, case, kind)).collect();
    Study { suite: SUITE, outcomes: Vec::new(), claims: claims.by_case(&CASES), sections }
}

/// Kinds that multigrid does not get along with where the diffusivity jumps, see `docs/multigrid.md`.
fn outpaced(kind: Kind) -> bool {
    matches!(kind, Kind::Classical | Kind::Ghosts)
}

fn check(all: &[Figures], case: &'static str, contrast: f64, claims: &mut Claims) {
    let of: Vec<&Figures> = all.iter().filter(|f| f.case == case && f.contrast == contrast).collect();
    let largest = of.last().map(|f| f.iterations as f64);
    let growth = of.first().zip(of.last()).map(|(a, b)| b.iterations as f64 - a.iterations as f64);
    let claim = |what: &str| format!("contrast {contrast:e}: {what}");
    claims.at_most(case, claim("iterations, largest cloud"), largest, ITERATIONS);
    let grows = claim("more iterations on the largest cloud than on the smallest");
    if case == "seven-point" && contrast > 1.0 {
        let (paper, ours) = ([f64::NEG_INFINITY, GROWTH], [GROWTH, GROWTH_WITH_PIN]);
        claims.explained(case, grows, growth, paper, ours, POINT_SOURCE);
    } else {
        claims.at_most(case, grows, growth, GROWTH);
    }
    let complexity = of.iter().map(|f| f.complexity).reduce(f64::max);
    claims.at_most(case, claim("operator complexity"), complexity, COMPLEXITY);
}

fn last<'a>(all: &'a [Figures], case: &str, contrast: f64) -> Option<&'a Figures> {
    all.iter().rfind(|f| f.case == case && f.contrast == contrast)
}

/// `None` where the system cannot be made or solved.
fn measure(
    case: &'static str,
    kind: Kind,
    unknowns: usize,
    contrast: f64,
    stepping_in: bool,
) -> Option<Figures> {
    let system = system(kind, unknowns, contrast).ok()?;
    let params = SolverParams {
        kind: if stepping_in { SolverKind::Multigrid } else { SolverKind::Gmres { restart: RESTART } },
        preconditioner: PreconditionerKind::Multigrid(MultigridParams::default()),
        tolerance: TOLERANCE,
        max_iterations: if stepping_in { SolverParams::default().max_iterations } else { RESTART },
        ..SolverParams::default()
    };
    let prepared = Prepared::new(&system.matrix, &params).ok()?;
    let (iterations, residual) = match prepared.solve(&system.rhs) {
        Ok((_, info)) => (info.iterations, info.residual),
        Err(SolveError::NoConvergence { iterations, residual, .. }) => (iterations, residual),
        Err(_) => return None,
    };
    let complexity = prepared.hierarchy()?.operator_complexity();
    let unknowns = system.matrix.nrows();
    Some(Figures { case, kind, unknowns, contrast, iterations, residual, complexity })
}

fn section(all: &[Figures], case: &'static str, kind: Kind) -> Section {
    let rows = all.iter().filter(|f| f.kind == kind).map(|f| {
        vec![
            f.unknowns.to_string(),
            format!("{:e}", f.contrast),
            f.iterations.to_string(),
            short(f.residual),
            short(f.complexity),
        ]
    });
    let table = Table {
        caption: "Smoothed aggregation, W cycle, two sweeps of Gauss-Seidel.".to_owned(),
        head: ["unknowns", "contrast", "iterations", "residual", "operator complexity"]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.collect(),
    };
    Section {
        case,
        title: kind.name(),
        about: "The constant of a floating stiff ball is split off first, as in every solve.",
        figures: Vec::new(),
        pictures: Vec::new(),
        tables: vec![table],
    }
}
