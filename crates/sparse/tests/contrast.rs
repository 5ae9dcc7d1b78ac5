//! The solution, not the residual, keeps its digits at any contrast.

mod common;

use common::{Grid, distance, grid, point, solve_without_subtraction};
use meshless_sparse::{
    ComponentInfo, DEFAULT_THRESHOLD, MultigridParams, PreconditionerKind, SolveError, SolverKind,
    SolverParams, Split, clusters, solve,
};

const NODES: usize = 60;

/// What splitting must keep of the solution, whatever the contrast.
const ACCURATE: f64 = 1e-12;

fn radius(p: [f64; 2], center: [f64; 2]) -> f64 {
    (p[0] - center[0]).hypot(p[1] - center[1])
}

/// A picture of components: which one a point is in, their coefficients, and who touches whom. Component 0 holds the
/// Dirichlet data.
struct Scene {
    component: fn([f64; 2]) -> usize,
    eta: Vec<f64>,
    adjacency: Vec<Vec<u32>>,
    source: f64,
}

impl Scene {
    fn discretise(&self) -> Grid {
        grid(NODES, |p| self.eta[(self.component)(p)], self.source, |p| 1.0 + p[0] + 2.0 * p[1] * p[1])
    }

    fn split(&self, grid: &Grid) -> Split {
        let infos: Vec<ComponentInfo> = (self.eta.iter().enumerate())
            .map(|(k, &eta)| ComponentInfo { eta_min: eta, eta_max: eta, touches_fixed: k == 0 })
            .collect();
        let found = clusters(&infos, &self.adjacency, DEFAULT_THRESHOLD);
        let map = &grid.reduced.map;
        let component: Vec<u32> =
            map.iter().map(|&i| (self.component)(point(NODES, i as usize)) as u32).collect();
        Split::from_clusters(&grid.reduced.matrix, &component, infos.len(), &found)
            .expect("every cluster has nodes")
    }

    /// Errors of the plain and of the split solution.
    fn errors(&self, params: &SolverParams) -> (Result<f64, SolveError>, f64) {
        let grid = self.discretise();
        let (matrix, rhs) = (&grid.reduced.matrix, &grid.reduced.rhs);
        let exact = solve_without_subtraction(matrix, rhs, NODES - 2);
        let plain = solve(&matrix.to_csr(), rhs, params).map(|(u, _)| distance(&u, &exact));
        let split = self.split(&grid);
        let bordered = split.apply(matrix, rhs).expect("the split fits");
        let solution = bordered.solve(params).expect("the split system is well determined");
        let u = split.recover(&solution.values, &solution.extra).expect("lengths fit");
        (plain, distance(&u, &exact))
    }
}

fn disc(eta: f64) -> Scene {
    Scene {
        component: |p| usize::from(radius(p, [0.5, 0.45]) < 0.25),
        eta: vec![1.0, eta],
        adjacency: vec![vec![1], vec![0]],
        source: 1.0,
    }
}

fn rings(etas: [f64; 3], source: f64) -> Scene {
    Scene {
        component: |p| match radius(p, [0.5, 0.5]) {
            r if r < 0.17 => 2,
            r if r < 0.33 => 1,
            _ => 0,
        },
        eta: etas.to_vec(),
        adjacency: vec![vec![1], vec![2], vec![]],
        source,
    }
}

fn three_discs(etas: [f64; 3]) -> Scene {
    Scene {
        component: |p| {
            let centers = [[0.25, 0.25], [0.7, 0.3], [0.45, 0.75]];
            centers.iter().position(|&c| radius(p, c) < 0.15).map_or(0, |k| k + 1)
        },
        eta: [vec![1.0], etas.to_vec()].concat(),
        adjacency: vec![vec![1, 2, 3], vec![], vec![], vec![]],
        source: 1.0,
    }
}

fn direct() -> SolverParams {
    SolverParams { kind: SolverKind::Direct, ..SolverParams::default() }
}

#[test]
fn a_floating_disc_is_as_accurate_at_1e12_as_at_1e2() {
    for contrast in [1e2, 1e6, 1e10, 1e12] {
        let (_, split) = disc(contrast).errors(&direct());
        assert!(split < ACCURATE, "contrast {contrast:e}: {split:e}");
    }
}

#[test]
fn without_the_split_digits_are_lost() {
    // The same scenes: otherwise the tests above would show nothing.
    for contrast in [1e10, 1e12] {
        match disc(contrast).errors(&direct()).0 {
            Ok(error) => assert!(error > 1e3 * ACCURATE, "contrast {contrast:e}: {error:e}"),
            Err(SolveError::Singular { condition, .. }) => assert!(condition > 0.01 * contrast),
            Err(other) => panic!("{other}"),
        }
    }
}

#[test]
fn nested_clusters_are_accurate() {
    for (etas, source) in [
        ([1.0, 1e5, 1e10], 1.0),
        ([1.0, 1e10, 1e5], 1.0),
        ([1.0, 1e-10, 1.0], 0.0),
        ([1.0, 1e-10, 1.0], 1.0),
        ([1.0, 1e-10, 1e10], 0.0),
        ([1e10, 1.0, 1e10], 1.0),
    ] {
        let (_, split) = rings(etas, source).errors(&direct());
        assert!(split < ACCURATE, "{etas:?}, source {source}: {split:e}");
    }
}

#[test]
fn several_discs_are_accurate() {
    for etas in [[1e10, 1e10, 1e10], [1e12, 1e4, 1e8], [1e-10, 1e10, 1e3]] {
        let (_, split) = three_discs(etas).errors(&direct());
        assert!(split < ACCURATE, "{etas:?}: {split:e}");
    }
}

#[test]
fn iterative_methods_reach_the_same_solution() {
    let ilut = PreconditionerKind::Ilut { fill: 5, drop: 1e-3 };
    let levels = MultigridParams { coarsest: 40, ..MultigridParams::default() };
    for (kind, preconditioner) in [
        (SolverKind::BiCgStab { l: 2 }, PreconditionerKind::Ilu0),
        (SolverKind::Gmres { restart: 80 }, ilut),
        (SolverKind::Multigrid, PreconditionerKind::Multigrid(levels)),
    ] {
        let params = SolverParams { kind, preconditioner, tolerance: 1e-13, ..SolverParams::default() };
        for scene in [disc(1e10), rings([1.0, 1e5, 1e10], 1.0), rings([1.0, 1e-10, 1.0], 0.0)] {
            let (_, split) = scene.errors(&params);
            assert!(split < 1e-10, "{kind:?}: {split:e}");
        }
    }
}

#[test]
fn constants_have_no_part_in_rows_inside_their_cluster() {
    let scene = rings([1.0, 1e5, 1e10], 1.0);
    let grid = scene.discretise();
    let bordered = scene.split(&grid).apply(&grid.reduced.matrix, &grid.reduced.rhs).unwrap();
    let map = &grid.reduced.map;
    let place = |i: u32| (scene.component)(point(NODES, map[i as usize] as usize));
    for (k, column) in bordered.columns().iter().enumerate() {
        assert!(!column.is_empty());
        for &(row, _) in column {
            let here = place(row) > k;
            let all_alike = grid.reduced.matrix.row(row as usize).0.iter().all(|&j| (place(j) > k) == here);
            assert!(!all_alike, "row {row} does not leave cluster {k}, but has a coefficient");
        }
    }
}
