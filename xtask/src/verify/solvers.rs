//! Suite `solvers`: multigrid on every kind of matrix, in iterations rather than seconds.

use meshless::sparse::{PreparedBordered, SolverParams};

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

/// Iterations at most, at any size and contrast.
const ITERATIONS: f64 = 15.0;

/// By how many iterations the largest cloud may exceed the smallest.
const GROWTH: f64 = 3.0;

/// By what factor the highest contrast may exceed none.
const CONTRAST_FACTOR: f64 = 2.0;

const COMPLEXITY: f64 = 1.6;

/// What was measured of a matrix.
struct Figures {
    case: &'static str,
    kind: Kind,
    unknowns: usize,
    contrast: f64,
    /// Products for the responses to extra unknowns, once for a matrix.
    responses: usize,
    iterations: usize,
    by_multigrid: bool,
    residual: f64,
    complexity: f64,
}

impl Figures {
    /// Iterations, if it is multigrid that reached the tolerance, and not what steps in for it.
    fn multigrid_iterations(&self) -> f64 {
        if self.by_multigrid && self.residual <= TOLERANCE { self.iterations as f64 } else { f64::INFINITY }
    }
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
        for contrast in CONTRASTS {
            for &n in &sizes {
                runner::progress(&format!("{SUITE} {case} {contrast:e} {n}"));
                all.extend(measure(case, kind, n, contrast));
            }
            check(&all, case, contrast, sizes.len(), &mut claims);
        }
        let at = |contrast| last(&all, case, contrast).map(Figures::multigrid_iterations);
        let ratio = at(CONTRASTS[2]).zip(at(1.0)).map(|(high, low)| high / low);
        let claim = "iterations at contrast 1e10 over those at 1, largest cloud";
        claims.at_most(case, claim, ratio, CONTRAST_FACTOR);
    }
    let sections = CASES.into_iter().zip(Kind::ALL).map(|(case, kind)| section(&all, case, kind)).collect();
    Study { suite: SUITE, outcomes: Vec::new(), claims: claims.by_case(&CASES), sections }
}

fn check(all: &[Figures], case: &'static str, contrast: f64, sizes: usize, claims: &mut Claims) {
    let mut of: Vec<&Figures> = all.iter().filter(|f| f.case == case && f.contrast == contrast).collect();
    if of.len() < sizes {
        // What could not be measured is no claim that holds.
        of.clear();
    }
    let largest = of.last().map(|f| f.multigrid_iterations());
    let growth = of.first().zip(of.last()).map(|(a, b)| b.multigrid_iterations() - a.multigrid_iterations());
    let claim = |what: &str| format!("contrast {contrast:e}: {what}");
    claims.at_most(case, claim("iterations, largest cloud"), largest, ITERATIONS);
    let grows = claim("more iterations on the largest cloud than on the smallest");
    claims.at_most(case, grows, growth, GROWTH);
    let complexity = of.iter().map(|f| f.complexity).reduce(f64::max);
    claims.at_most(case, claim("operator complexity"), complexity, COMPLEXITY);
}

fn last<'a>(all: &'a [Figures], case: &str, contrast: f64) -> Option<&'a Figures> {
    all.iter().rfind(|f| f.case == case && f.contrast == contrast)
}

/// `None` where the system cannot be made or solved.
fn measure(case: &'static str, kind: Kind, unknowns: usize, contrast: f64) -> Option<Figures> {
    let (system, params) = system(kind, unknowns, contrast).ok()?;
    let (system, params) = (system.bordered, SolverParams { tolerance: TOLERANCE, ..params });
    let unknowns = system.n();
    let rhs = system.rhs().to_vec();
    let prepared = PreparedBordered::new(system, &params).ok()?;
    let info = prepared.solve(&rhs).ok()?.info;
    let complexity = prepared.hierarchy()?.operator_complexity();
    Some(Figures {
        case,
        kind,
        unknowns,
        contrast,
        responses: prepared.products(),
        iterations: info.iterations,
        by_multigrid: info.name.ends_with("multigrid"),
        residual: info.residual,
        complexity,
    })
}

fn section(all: &[Figures], case: &'static str, kind: Kind) -> Section {
    let rows = all.iter().filter(|f| f.kind == kind).map(|f| {
        vec![
            f.unknowns.to_string(),
            format!("{:e}", f.contrast),
            f.responses.to_string(),
            f.iterations.to_string(),
            short(f.residual),
            short(f.complexity),
        ]
    });
    let table = Table {
        caption: "Smoothed aggregation, W cycle, two sweeps of Gauss-Seidel.".to_owned(),
        head: ["unknowns", "contrast", "responses", "iterations", "residual", "operator complexity"]
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
