//! Pure Neumann problems: multigrid on the singular matrix, whatever floats in it and whatever its rows are multiplied by.

mod common;

use common::{distance, grid, point};
use meshless_sparse::{
    ComponentInfo, DEFAULT_THRESHOLD, DifferenceMatrix, PreparedBordered, SolverKind, SolverParams, Split,
    clusters, solve,
};

const NODES: usize = 60;

/// What is not balanced, in the test problems.
const LAMBDA: f64 = 0.125;

fn is_stiff(p: [f64; 2]) -> bool {
    (p[0] - 0.5).hypot(p[1] - 0.5) < 0.25
}

/// Rows multiplied by factors between `1 / spread` and `spread`: sums of equations say nothing about the balance then.
fn weighted(matrix: &DifferenceMatrix, spread: f64) -> DifferenceMatrix {
    DifferenceMatrix::from_rows(matrix.n(), |i, row| {
        let factor = spread.powf((i * 7919 % 101) as f64 / 50.0 - 1.0);
        let (columns, values) = matrix.row(i);
        columns.iter().zip(values).for_each(|(&j, a)| row.push(j as usize, factor * a));
    })
    .expect("finite rows")
}

/// Iterations, products for responses, the error and that of the incompatibility.
fn solved(contrast: f64, spread: f64, kind: SolverKind) -> (usize, usize, f64, f64) {
    let grid = grid(NODES, |p| if is_stiff(p) { contrast } else { 1.0 }, 0.0, |_| 0.0);
    let n = NODES * NODES;
    let matrix = weighted(&grid.matrix, spread);
    let component: Vec<u32> = (0..n).map(|i| u32::from(is_stiff(point(NODES, i)))).collect();
    let info = |eta: f64, touches_fixed| ComponentInfo { eta_min: eta, eta_max: eta, touches_fixed };
    let infos = [info(1.0, true), info(contrast, false)];
    let found = clusters(&infos, &[vec![1], vec![0]], DEFAULT_THRESHOLD);
    let split = Split::from_clusters(&matrix, &component, 2, &found).expect("every cluster has nodes");

    // Constant where it is stiff, so that the right-hand side has no digits of the contrast.
    let exact: Vec<f64> =
        (0..n).map(|i| point(NODES, i)).map(|p| if is_stiff(p) { 2.0 } else { p[0] + p[1] * p[1] }).collect();
    let column = vec![1.0; n];
    let mut rhs = vec![0.0; n];
    matrix.mul_vec(&exact, &mut rhs);
    rhs.iter_mut().for_each(|b| *b += LAMBDA);
    let pin = 3;
    let system = split.apply_neumann(&matrix, &rhs, &column, pin).expect("a system");
    let params = SolverParams { kind, tolerance: 1e-12, ..SolverParams::default() };
    let prepared = PreparedBordered::new(system, &params).expect("levels");
    let solution = prepared.solve(&rhs).expect("a solution");
    let u = split.recover(&solution.values, &solution.extra).expect("lengths fit");
    let shifted: Vec<f64> = exact.iter().map(|v| v - exact[pin]).collect();
    let lambda = solution.extra[split.extra()];
    (solution.info.iterations, prepared.products(), distance(&u, &shifted), (lambda - LAMBDA).abs())
}

/// Iterations where u is prescribed on one side, for one material.
fn held(spread: f64) -> usize {
    let matrix = weighted(&grid(NODES, |_| 1.0, 0.0, |_| 0.0).matrix, spread);
    let known: Vec<Option<f64>> = (0..matrix.n()).map(|i| (i % NODES == 0).then_some(1.0)).collect();
    let rhs: Vec<f64> = (0..matrix.n()).map(|i| point(NODES, i)[0] - 0.3).collect();
    let reduced = matrix.eliminate(&known, &rhs).expect("lengths fit");
    let params = SolverParams { kind: SolverKind::Multigrid, tolerance: 1e-12, ..SolverParams::default() };
    solve(&reduced.matrix.to_csr(), &reduced.rhs, &params).expect("a solution").1.iterations
}

#[test]
fn what_nothing_holds_takes_hardly_more_iterations_than_what_is_held() {
    for spread in [1.0, 2.0] {
        let most = held(spread) + 4;
        for contrast in [1.0, 1e2, 1e6, 1e10] {
            let (iterations, products, error, lambda) = solved(contrast, spread, SolverKind::Multigrid);
            assert!(iterations <= most && products == 0, "{contrast:e}, {spread}: {iterations}, {most}");
            assert!(error < 1e-8 && lambda < 1e-8, "{contrast:e}, {spread}: {error:e}, {lambda:e}");
            let (.., error, lambda) = solved(contrast, spread, SolverKind::Direct);
            assert!(error < 1e-8 && lambda < 1e-8, "direct, {contrast:e}, {spread}: {error:e}, {lambda:e}");
        }
    }
}
