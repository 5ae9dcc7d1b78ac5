//! Multigrid on every kind of matrix: iterations, complexity, set-up, memory.

pub(crate) mod systems;

use std::time::Instant;

use meshless::sparse::{AUTO_RESTART, BorderedSolution, PreparedBordered, SolveError, SolverParams};

use super::Outcome;
use super::table::Table;
use systems::{Kind, system};

const CONTRASTS: [f64; 3] = [1.0, 1e4, 1e10];

const UNKNOWNS: [usize; 3] = [10_000, 100_000, 1_000_000];

/// Unknowns up to which the dearest rows, 65 entries each, are set up; so many at the highest contrast only.
const GHOSTS_MAX: usize = 400_000;

/// The residual at which the targets count.
const TOLERANCE: f64 = 1e-10;

/// Vectors of a solve besides those that GMRES keeps: right-hand side with scaled rows, direction, its product, and two of the cycle.
const VECTORS: usize = 5;

/// GMRES keeps in single precision what comes after a residual of this many tolerances.
const SINGLE_BELOW: f64 = 1e5;

/// Minutes of work: every row is reported as soon as it is there.
pub(super) fn run() -> Outcome {
    let head = [
        "",
        "unknowns",
        "contrast",
        "entries/row",
        "responses",
        "iterations",
        "residual",
        "complexity",
        "set-up (s)",
        "solve (s)",
        "set-up (iterations)",
        "us/unknown",
        "bytes/unknown",
    ];
    let mut table = Table::new(&head);
    for kind in Kind::ALL {
        for unknowns in UNKNOWNS.map(|n| if kind == Kind::Ghosts { n.min(GHOSTS_MAX) } else { n }) {
            for contrast in CONTRASTS {
                if kind != Kind::Ghosts || unknowns < GHOSTS_MAX || contrast == CONTRASTS[2] {
                    let figures = figures(kind, unknowns, contrast)?;
                    eprintln!("{}: {}", kind.name(), figures.join(", "));
                    table.row(kind.name(), figures);
                }
            }
        }
    }
    Ok(vec![table])
}

fn figures(
    kind: Kind,
    unknowns: usize,
    contrast: f64,
) -> Result<Vec<String>, Box<dyn std::error::Error + Send + Sync>> {
    let (system, params) = system(kind, unknowns, contrast)?;
    let (system, params) = (system.bordered, SolverParams { tolerance: TOLERANCE, ..params });
    let n = system.n() as f64;
    let start = Instant::now();
    let prepared = PreparedBordered::new(system.clone(), &params)?;
    let setup = start.elapsed().as_secs_f64();
    let responses = prepared.products();
    let start = Instant::now();
    let solved = prepared.solve(system.rhs());
    let solve = start.elapsed().as_secs_f64();
    let mut single = 0;
    let (iterations, residual, by_multigrid) = match &solved {
        Ok(BorderedSolution { info, .. }) => {
            let steps = info.history.iter().take(info.iterations.saturating_sub(1));
            single = steps.filter(|r| **r <= SINGLE_BELOW * TOLERANCE).count();
            (info.iterations, info.residual, info.name.ends_with("multigrid"))
        }
        Err(
            SolveError::NoConvergence { iterations, residual, .. }
            | SolveError::BreakDown { iterations, residual, .. },
        ) => (*iterations, *residual, false),
        Err(error) => return Err(error.clone().into()),
    };
    let (complexity, levels) =
        prepared.hierarchy().map_or((f64::NAN, 0), |h| (h.operator_complexity(), h.bytes));
    // The rows in difference form with their sums, right-hand side and factors, scales and groups where there are any; the levels,
    // which share the rows; and the vectors of GMRES: for an iteration one, and half of one where it is flexible.
    let split = if system.extra() > 0 { 12 } else { 0 };
    let rows = system.matrix().off_diagonal().bytes() + (24 + split) * system.n();
    let kept = iterations.min(AUTO_RESTART) * if split > 0 { 12 } else { 8 };
    let bytes = rows + levels + (kept + 8 * VECTORS - 4 * single) * system.n();
    Ok(vec![
        format!("{n}"),
        format!("{contrast:.0e}"),
        format!("{:.1}", 1.0 + system.matrix().nnz() as f64 / n),
        format!("{responses}"),
        if by_multigrid { format!("{iterations}") } else { format!("> {iterations}") },
        format!("{residual:.0e}"),
        format!("{complexity:.2}"),
        format!("{setup:.2}"),
        format!("{solve:.2}"),
        format!("{:.1}", setup * iterations as f64 / solve),
        format!("{:.2}", 1e6 * (setup + solve) / n),
        format!("{:.0}", bytes as f64 / n),
    ])
}
