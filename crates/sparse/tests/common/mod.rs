//! Independent references: dense matrices, elimination without subtraction, five-point grids, and how they are solved.
#![allow(dead_code)] // each test program uses its own part

use meshless_sparse::{
    Csr, DifferenceMatrix, MultigridParams, PreconditionerKind, Reduced, SolveInfo, SolverKind, SolverParams,
    solve,
};
use proptest::prelude::ProptestConfig;

/// So many cases of a property, or `PROPTEST_CASES`, which `ProptestConfig::with_cases` does not look at.
pub(crate) fn cases(count: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(count))
}

pub(crate) fn dense(matrix: &Csr) -> Vec<Vec<f64>> {
    (0..matrix.nrows()).map(|i| (0..matrix.ncols()).map(|j| matrix.get(i, j)).collect()).collect()
}

pub(crate) fn dense_product(a: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    a.iter().map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
}

/// Largest difference relative to the largest value.
pub(crate) fn distance(x: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(x.len(), reference.len());
    let size = reference.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let worst = x.iter().zip(reference).map(|(x, r)| (x - r).abs());
    worst.fold(0.0, |m, d| if d > m || d.is_nan() { d } else { m }) / size.max(f64::MIN_POSITIVE)
}

/// Elimination of an M-matrix on off-diagonal entries and row sums, for a right-hand side without negative entries: it
/// adds, multiplies and divides positive numbers only, so that every entry of the solution is accurate whatever the
/// condition number (Alfa, Xue, Ye, Math. Comp. 71, 2002). `band` bounds `|i - j|`.
pub(crate) fn solve_without_subtraction(matrix: &DifferenceMatrix, rhs: &[f64], band: usize) -> Vec<f64> {
    let n = matrix.n();
    let width = 2 * band + 1;
    let mut p = vec![0.0; n * width];
    let at = |i: usize, j: usize| i * width + (j + band - i);
    let mut r: Vec<f64> = (0..n).map(|i| matrix.row_sum(i)).collect();
    let mut b = rhs.to_vec();
    for i in 0..n {
        let (columns, values) = matrix.row(i);
        for (&j, &a) in columns.iter().zip(values) {
            assert!(
                a <= 0.0 && r[i] >= 0.0 && b[i] >= 0.0,
                "not an M-matrix with a positive right-hand side"
            );
            p[at(i, j as usize)] = -a;
        }
    }
    let mut pivot = vec![0.0; n];
    for k in 0..n {
        let end = n.min(k + band + 1);
        pivot[k] = r[k] + (k + 1..end).map(|j| p[at(k, j)]).sum::<f64>();
        for i in k + 1..end {
            let f = p[at(i, k)] / pivot[k];
            if f > 0.0 {
                for j in (k + 1..end).filter(|&j| j != i) {
                    p[at(i, j)] += f * p[at(k, j)];
                }
                r[i] += f * r[k];
                b[i] += f * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let end = n.min(k + band + 1);
        b[k] = (b[k] + (k + 1..end).map(|j| p[at(k, j)] * b[j]).sum::<f64>()) / pivot[k];
    }
    b
}

/// A square of `m` by `m` nodes, five-point fluxes with harmonic means, Dirichlet data on the boundary.
pub(crate) struct Grid {
    pub(crate) m: usize,
    /// Equations of all nodes, with the right-hand sides `h^2 f`.
    pub(crate) matrix: DifferenceMatrix,
    pub(crate) rhs: Vec<f64>,
    pub(crate) known: Vec<Option<f64>>,
    pub(crate) reduced: Reduced,
}

pub(crate) fn point(m: usize, i: usize) -> [f64; 2] {
    [(i % m) as f64 / (m - 1) as f64, (i / m) as f64 / (m - 1) as f64]
}

pub(crate) fn grid(
    m: usize,
    eta: impl Fn([f64; 2]) -> f64 + Sync,
    f: f64,
    g: impl Fn([f64; 2]) -> f64,
) -> Grid {
    let matrix = DifferenceMatrix::from_rows(m * m, |i, row| {
        let own = eta(point(m, i));
        let mut flux = |j: usize| {
            let other = eta(point(m, j));
            row.push(j, -2.0 * own * other / (own + other));
        };
        if i % m > 0 {
            flux(i - 1);
        }
        if i % m + 1 < m {
            flux(i + 1);
        }
        if i >= m {
            flux(i - m);
        }
        if i + m < m * m {
            flux(i + m);
        }
    })
    .expect("five-point rows are in range");
    let on_edge = |i: usize| i.is_multiple_of(m) || i % m + 1 == m || i < m || i + m >= m * m;
    let known: Vec<_> = (0..m * m).map(|i| on_edge(i).then(|| g(point(m, i)))).collect();
    let h = 1.0 / (m - 1) as f64;
    let rhs = vec![h * h * f; m * m];
    let reduced = matrix.eliminate(&known, &rhs).expect("lengths fit");
    Grid { m, matrix, rhs, known, reduced }
}

/// Whether a point is in the disc of [`disc`].
pub(crate) fn inside(x: [f64; 2]) -> bool {
    (x[0] - 0.5).hypot(x[1] - 0.5) < 0.3
}

/// A disc of another diffusivity in the middle of a square.
pub(crate) fn disc(m: usize, contrast: f64) -> Grid {
    grid(m, |x| if inside(x) { contrast } else { 1.0 }, 1.0, |x| x[0])
}

/// GMRES with these levels, to 1e-10.
pub(crate) fn with(levels: MultigridParams) -> SolverParams {
    SolverParams {
        kind: SolverKind::Gmres { restart: 60 },
        preconditioner: PreconditionerKind::Multigrid(levels),
        tolerance: 1e-10,
        ..SolverParams::default()
    }
}

/// With several levels on small grids, too.
pub(crate) fn multigrid() -> SolverParams {
    with(MultigridParams { coarsest: 40, ..MultigridParams::default() })
}

pub(crate) fn direct() -> SolverParams {
    SolverParams { kind: SolverKind::Direct, ..SolverParams::default() }
}

pub(crate) fn iterations(matrix: &Csr, rhs: &[f64], params: &SolverParams) -> SolveInfo {
    solve(matrix, rhs, params).expect("converges").1
}
