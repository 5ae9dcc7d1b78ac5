//! Tables A.1 (which nodes are conservative) and B.1 (iterations of the linear solver) of the paper.

use meshless::Solution;
use meshless::interfaces::RowKind;
use meshless_neighbors::{Distance, NeighborLists, Radius, within_radius};

use super::cases::{case, power_of_ten};
use super::sweep::{CLAIMED, SEED};
use super::view::{View, spread};
use super::{HYBRID, STRONG, Variant, radius};
use crate::verify::claims::{Claims, short};
use crate::verify::options::Effort;
use crate::verify::runner::{Extra, Runner};
use crate::verify::study::{Key, Table};

/// Distance from the boundary, in interaction radii, that no row selected there reaches: it lies within a spacing, and
/// its neighbours within a radius of it.
const CLEAR_OF_BOUNDARY: f64 = 1.5;

/// Strong Neumann rows, so that every conservative row is one that was selected.
const SELECTING: Variant = HYBRID.with_strong_neumann();

/// Rungs of table A.1: h = 0.05 and h = 0.0125.
const COARSE: usize = 2;
const FINE: usize = 4;

/// Why more nodes far from the interface are selected here.
const CUT_OFF: &str = "Rows beside the boundary, whose supports are cut off, fail the criterion with or without a jump: four in five \
    of the nodes within a spacing of it, none in the interior (2 % of all at h = 0.05, half of that at half of h). The paper's \
    clouds have 0.28 %. Away from the boundary the share is as in the paper: see the next line.";

/// Residual where the solution itself does not matter.
const ROUGH: f64 = 1e-3;

/// Residual of table B.1; the paper does not state its own.
const TABLE_TOLERANCE: f64 = 1e-4;

/// Table A.1 of the paper in percent: jump, then |I_σ0|/|I|, |I_c|/|I|, |I_c ∩ I_Γ|/|I_c|, |I_c ∩ I_Γ⁺|/|I_c| for both h.
const PAPER: [(f64, [f64; 4], [f64; 4]); 6] = [
    (1e0, [0.28, 2.21, 0.0, 0.0], [0.13, 1.57, 0.0, 0.0]),
    (1e2, [5.13, 15.72, 51.58, 85.96], [1.35, 4.96, 41.27, 69.19]),
    (1e4, [7.00, 17.43, 46.52, 87.34], [1.87, 5.43, 37.64, 71.89]),
    (1e6, [7.78, 18.15, 44.68, 87.84], [2.04, 5.59, 36.56, 72.70]),
    (1e8, [8.11, 18.53, 43.75, 88.10], [2.12, 5.67, 36.08, 73.06]),
    (1e10, [8.33, 18.70, 43.36, 88.20], [2.16, 5.69, 35.93, 73.17]),
];

/// A line of table A.1, in percent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fractions {
    level: usize,
    jump: f64,
    /// As `paper`; then the third share once more, among nodes that no selection at the boundary reaches.
    measured: [f64; 5],
    paper: [f64; 4],
}

pub(super) fn fractions(runner: &mut Runner<'_>) -> Vec<Fractions> {
    let levels: &[usize] = if runner.options.effort == Effort::Quick { &[COARSE] } else { &[COARSE, FINE] };
    let mut lines = Vec::new();
    for &level in levels {
        for (jump, coarse, fine) in PAPER {
            let key = Key { case: "two-strip", variant: SELECTING, jump, level, seed: SEED };
            let mut measured = None;
            let text = (case(key.case).scene)(jump, radius(level), SEED);
            // Only the selection counts here: on the fine cloud the system need not be solved well.
            let krylov = (level == FINE).then_some(ROUGH);
            let extra = Extra { krylov, ..Extra::default() };
            runner.run_with(&text, key, extra, |solution| measured = selected(solution));
            let paper = if level == COARSE { coarse } else { fine };
            lines.extend(measured.map(|measured| Fractions { level, jump, measured, paper }));
        }
    }
    lines
}

/// The four fractions of the table in percent, and the last one away from the boundary.
fn selected(solution: &Solution) -> Option<[f64; 5]> {
    let field = &solution.field;
    let points: Vec<[f64; 2]> = field.points.iter().map(|p| [p[0], p[1]]).collect();
    let reach = vec![meshless_tests::kraus::SUPPORT * solution.report.spacing; points.len()];
    let lists = within_radius(&points, Radius::PerPoint(&reach), Distance::D2).ok()?;
    let eta = &field.eta;
    let near: Vec<bool> =
        (0..points.len()).map(|i| lists.of(i).iter().any(|&j| eta[j as usize] != eta[i])).collect();
    let near_plus = widened(&near, &lists);
    let interior = |kind: &RowKind| matches!(kind, RowKind::Strong | RowKind::Conservative);
    let inner = field.kind.iter().filter(|k| interior(k)).count() as f64;
    let chosen: Vec<usize> = (0..points.len()).filter(|&i| field.kind[i] == RowKind::Conservative).collect();
    let part =
        |set: &[bool]| 100.0 * chosen.iter().filter(|&&i| set[i]).count() as f64 / chosen.len().max(1) as f64;
    let flagged = solution.report.nodes.flagged as f64;
    let inset = to_boundary(&points);
    let away: Vec<usize> =
        chosen.iter().copied().filter(|&i| inset[i] > CLEAR_OF_BOUNDARY * reach[i]).collect();
    let inside = 100.0 * away.iter().filter(|&&i| near_plus[i]).count() as f64 / away.len().max(1) as f64;
    Some([
        100.0 * flagged / inner,
        100.0 * chosen.len() as f64 / inner,
        part(&near),
        part(&near_plus),
        inside,
    ])
}

/// Distances of the nodes from the boundary of the square, which is given by its own nodes.
fn to_boundary(points: &[[f64; 2]]) -> Vec<f64> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for x in points {
        for k in 0..2 {
            low[k] = low[k].min(x[k]);
            high[k] = high[k].max(x[k]);
        }
    }
    let along = |x: &[f64; 2], k: usize| (x[k] - low[k]).min(high[k] - x[k]);
    points.iter().map(|x| along(x, 0).min(along(x, 1))).collect()
}

/// The set with the supports of its nodes.
fn widened(set: &[bool], lists: &NeighborLists) -> Vec<bool> {
    let mut wide = set.to_vec();
    for i in (0..set.len()).filter(|&i| set[i]) {
        lists.of(i).iter().for_each(|&j| wide[j as usize] = true);
    }
    wide
}

/// The linear system of table B.1: BiCGStab(2) with an incomplete factorisation, whatever the size.
fn krylov(variant: Variant) -> Variant {
    Variant { solver: Some("bicgstab"), ..variant }
}

/// Iterations of strong form and hybrid on one rung; `None` where it was not run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Iterations {
    level: usize,
    strong: Option<(usize, f64)>,
    hybrid: Option<(usize, f64)>,
}

/// Table B.1 of the paper: iterations of strong form and hybrid for h = 0.2, 0.1, …
const PAPER_ITERATIONS: [(usize, usize); 7] = [(1, 2), (2, 3), (3, 2), (4, 3), (9, 6), (18, 11), (33, 21)];

pub(super) fn iterations(runner: &mut Runner<'_>) -> Vec<Iterations> {
    let rungs = match runner.options.effort {
        Effort::Quick => CLAIMED,
        Effort::Default => CLAIMED + 1,
        Effort::Full => PAPER_ITERATIONS.len(),
    };
    let mut run = |variant: Variant, level: usize| {
        let key =
            Key { case: "interior", variant: krylov(variant), jump: power_of_ten(10), level, seed: SEED };
        let text = (case(key.case).scene)(key.jump, radius(level), SEED);
        let extra = Extra { krylov: Some(TABLE_TOLERANCE), ..Extra::default() };
        runner.run_with(&text, key, extra, |_| {}).map(|o| (o.row.iterations, o.row.t_total))
    };
    (0..rungs)
        .map(|level| Iterations { level, strong: run(STRONG, level), hybrid: run(HYBRID, level) })
        .collect()
}

/// Solves that elimination takes where one constant is split off: for the response, the right-hand side, and refinement.
const SOLVES: f64 = 3.0;

const ONE_SOLVE: &str = "the constant of the disc is split off from the hybrid, which makes three solves, and each takes fewer products; the rows of the strong form hold it themselves, which leaves one solve";

pub(super) fn check(runner: &Runner<'_>, fractions: &[Fractions], claims: &mut Claims) {
    selection(fractions, runner.options.effort, claims);
    scaling_matters(runner, claims);
    tolerance_does_not_matter(runner, claims);
    let view = View::new(runner, "interior");
    let finest = if runner.options.effort == Effort::Quick { CLAIMED - 1 } else { CLAIMED };
    let count = |variant| view.at(krylov(variant), 1e10, finest).map(|o| o.row.iterations as f64);
    let fewer = count(HYBRID).zip(count(STRONG)).map(|(hybrid, strong)| hybrid / strong);
    claims.explained(
        "interior",
        "table B.1: iterations of the hybrid over those of the strong form, finest cloud",
        fewer,
        [0.0, 1.0],
        [1.0, SOLVES],
        ONE_SOLVE,
    );
    let before = view.at(krylov(HYBRID), 1e10, finest - 1).map(|o| o.row.iterations as f64);
    let growth = count(HYBRID).zip(before).map(|(fine, coarse)| fine / coarse);
    claims.at_most(
        "interior",
        "table B.1: iterations of the hybrid at most double when h is halved (2.5 with rounding)",
        growth,
        2.5,
    );
}

fn selection(fractions: &[Fractions], effort: Effort, claims: &mut Claims) {
    let at = |level: usize, jump: f64| {
        fractions.iter().find(|f| f.level == level && f.jump == jump).map(|f| f.measured)
    };
    let levels: &[usize] = if effort == Effort::Quick { &[COARSE] } else { &[COARSE, FINE] };
    for &level in levels {
        let h = radius(level);
        let column = |k: usize| -> Option<Vec<f64>> {
            PAPER.iter().map(|(jump, ..)| at(level, *jump).map(|m| m[k])).collect()
        };
        let rising = column(0).map(|c| c[1..].windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min));
        claims.at_least(
            "two-strip",
            format!(
                "table A.1: flagged nodes do not become fewer as the jump grows, h = {h}: least growth in %"
            ),
            rising,
            0.0,
        );
        let bounded = at(level, 1e10).zip(at(level, 1e8)).map(|(last, before)| last[0] / before[0]);
        claims.at_most(
            "two-strip",
            format!("table A.1: their number is bounded, h = {h}: 1e10 over 1e8"),
            bounded,
            1.1,
        );
        let outside = at(level, 1e0).map(|m| m[0]);
        claims.at_least(
            "two-strip",
            format!("table A.1: some nodes are flagged without a jump, h = {h}: %"),
            outside,
            0.01,
        );
        let extended = at(level, 1e10).map(|m| m[3]);
        let paper = if level == COARSE { [80.0, 100.0] } else { [60.0, 100.0] };
        let claim =
            format!("table A.1: most conservative nodes are near the interface, jump 1e10, h = {h}: %");
        claims.explained("two-strip", claim, extended, paper, [20.0, paper[0]], CUT_OFF);
        let claim = format!("table A.1: the same away from the boundary, h = {h}: %");
        claims.within("two-strip", claim, at(level, 1e10).map(|m| m[4]), paper);
    }
    if effort > Effort::Quick {
        let fewer = at(COARSE, 1e10).zip(at(FINE, 1e10)).map(|(c, f)| c[0] / f[0]);
        claims.within(
            "two-strip",
            "table A.1: flagged nodes become fewer with h: fraction at h = 0.05 over that at 0.0125",
            fewer,
            [3.0, 5.0],
        );
    }
}

/// Without the logarithmic scaling the criterion does not see the jump.
fn scaling_matters(runner: &Runner<'_>, claims: &mut Claims) {
    if !runner.options.wants("two-strip", HYBRID.method) {
        return;
    }
    let flagged = |log: bool| -> Option<Vec<f64>> {
        let variant = Variant { log_scaling: Some(log), ..SELECTING };
        [1e2, 1e4, 1e10].iter().map(|&jump| single(variant, jump)).collect()
    };
    let plain = flagged(false).and_then(|f| spread(&f));
    let claim = "without scaling the flagged nodes do not depend on the jump (ours): most over fewest";
    claims.within("two-strip", claim, plain, [1.0, 1.01]);
    let scaled = flagged(true).and_then(|f| spread(&f));
    claims.at_least("two-strip", "with scaling they do: most over fewest", scaled, 1.25);
}

/// Appendix A: tolerances from 1e-12 to 1e-4 select nearly the same nodes.
fn tolerance_does_not_matter(runner: &Runner<'_>, claims: &mut Claims) {
    if !runner.options.wants("two-strip", HYBRID.method) {
        return;
    }
    let flagged: Option<Vec<f64>> = [1e-12, 1e-8, 1e-4]
        .iter()
        .map(|&t| single(Variant { selection_tolerance: Some(t), ..SELECTING }, 1e4))
        .collect();
    let change = flagged.and_then(|f| spread(&f));
    claims.within(
        "two-strip",
        "the tolerance of the criterion does not matter from 1e-12 to 1e-4: most flagged nodes over fewest",
        change,
        [1.0, 1.05],
    );
}

/// Flagged nodes of the two-strip problem at h = 0.05.
fn single(variant: Variant, jump: f64) -> Option<f64> {
    let key = Key { case: "two-strip", variant, jump, level: COARSE, seed: SEED };
    let text = (case(key.case).scene)(jump, radius(COARSE), SEED);
    crate::verify::runner::solve(&text, &key, Extra::default()).ok().map(|s| s.report.nodes.flagged as f64)
}

pub(super) fn show_fractions(fractions: &[Fractions]) -> Table {
    let head = ["h", "jump", "|I_σ0|/|I|", "|I_c|/|I|", "|I_c ∩ I_Γ|/|I_c|", "|I_c ∩ I_Γ⁺|/|I_c|"];
    let cell = |measured: f64, paper: f64| format!("{measured:.2} ({paper:.2})");
    Table {
        caption: "Table A.1: nodes that fail the criterion, nodes with conservative rows, and how many of these are near the \
                  interface; in percent, with the paper's figures in brackets."
            .to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: fractions
            .iter()
            .map(|f| {
                let mut row = vec![format!("{}", radius(f.level)), format!("{:e}", f.jump)];
                row.extend(f.measured.iter().zip(f.paper).map(|(&m, p)| cell(m, p)));
                row
            })
            .collect(),
    }
}

pub(super) fn show_iterations(iterations: &[Iterations]) -> Table {
    let count = |run: Option<(usize, f64)>, paper: usize| {
        run.map_or_else(|| "–".to_owned(), |(n, _)| format!("{n} ({paper})"))
    };
    let time = |run: Option<(usize, f64)>| run.map_or_else(|| "–".to_owned(), |(_, t)| short(t));
    Table {
        caption: "Table B.1: iterations of BiCGStab(2) with an incomplete factorisation, and seconds from points to solution; in \
                  brackets the paper's iterations, counted with a stopping criterion that it does not state. Ours is a \
                  relative true residual of 1e-4 (the strong form, whose matrix is all but singular, does not get far below), and we count products with the matrix, of which an iteration of BiCGStab(2) \
                  has four."
            .to_owned(),
        head: ["h", "strong form: iterations", "seconds", "hybrid: iterations", "seconds"].map(str::to_owned).to_vec(),
        rows: iterations
            .iter()
            .map(|i| {
                let (strong, hybrid) = PAPER_ITERATIONS[i.level];
                vec![format!("{}", radius(i.level)), count(i.strong, strong), time(i.strong), count(i.hybrid, hybrid), time(i.hybrid)]
            })
            .collect(),
    }
}
