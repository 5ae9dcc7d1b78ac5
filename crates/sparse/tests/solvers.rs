//! What solvers say when they cannot, and what they do at the edges.

mod common;

use common::{distance, grid, point, solve_without_subtraction};
use meshless_sparse::{
    Csr, DifferenceMatrix, MatrixError, PreconditionerKind, SolveError, SolverKind, SolverParams, Split,
    ilu0, ilut, pure_neumann, solve,
};

fn with(kind: SolverKind) -> SolverParams {
    SolverParams { kind, ..SolverParams::default() }
}

const KINDS: [SolverKind; 5] = [
    SolverKind::Direct,
    SolverKind::BiCgStab { l: 2 },
    SolverKind::Gmres { restart: 30 },
    SolverKind::Idr { s: 4 },
    SolverKind::Cg,
];

#[test]
fn a_singular_matrix_is_named_not_solved() {
    // The Laplacian of a path without anything fixed.
    let n = 500;
    let path = DifferenceMatrix::from_rows(n, |i, row| {
        [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n).for_each(|j| row.push(j, -1.0));
    });
    let error = solve(&path.unwrap().to_csr(), &vec![1.0; n], &with(SolverKind::Direct)).unwrap_err();
    assert!(matches!(error, SolveError::Singular { condition, .. } if condition > 1e14), "{error}");
    let structural = Csr::from_triplets(3, 3, &[(0, 0, 1.0), (1, 0, 1.0), (2, 2, 1.0)]).unwrap();
    let error = solve(&structural, &[1.0; 3], &with(SolverKind::Direct)).unwrap_err();
    assert!(matches!(error, SolveError::Singular { .. }), "{error}");
    // Column 1 vanishes numerically, not in its pattern.
    let zero = Csr::from_triplets(2, 2, &[(0, 0, 1.0), (0, 1, 2.0), (1, 0, 1.0), (1, 1, 2.0)]).unwrap();
    let error = solve(&zero, &[1.0, 0.0], &with(SolverKind::Direct)).unwrap_err();
    assert!(matches!(error, SolveError::Singular { .. }), "{error}");
}

#[test]
fn iterative_methods_report_what_they_reached_on_an_inconsistent_system() {
    let a = Csr::from_triplets(2, 2, &[(0, 0, 1.0), (0, 1, 1.0), (1, 0, 1.0), (1, 1, 1.0)]).unwrap();
    for kind in &KINDS[1..] {
        let params = SolverParams { preconditioner: PreconditionerKind::None, ..with(*kind) };
        match solve(&a, &[1.0, 0.0], &params).unwrap_err() {
            SolveError::NoConvergence { residual, best, .. }
            | SolveError::BreakDown { residual, best, .. } => {
                // The least-squares residual is 1/sqrt(2) of the right-hand side.
                assert!(residual > 0.7 && residual <= 1.0, "{kind:?}: {residual}");
                assert!(best.iter().all(|x| x.is_finite()));
            }
            other => panic!("{other}"),
        }
    }
}

#[test]
fn the_limit_of_products_is_kept_and_the_best_solution_returned() {
    let grid = grid(40, |_| 1.0, 1.0, |_| 0.0);
    let a = grid.reduced.matrix.to_csr();
    for kind in &KINDS[1..] {
        let params =
            SolverParams { max_iterations: 12, preconditioner: PreconditionerKind::Jacobi, ..with(*kind) };
        let Err(SolveError::NoConvergence { iterations, residual, best, .. }) =
            solve(&a, &grid.reduced.rhs, &params)
        else {
            panic!("{kind:?} converged in 12 products");
        };
        assert!((12..=15).contains(&iterations), "{kind:?}: {iterations}");
        let mut r = vec![0.0; best.len()];
        a.residual(&best, &grid.reduced.rhs, &mut r);
        let size = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        assert!((size(&r) / size(&grid.reduced.rhs) / residual - 1.0).abs() < 1e-10, "{kind:?}");
    }
}

#[test]
fn a_rotation_defeats_plain_bicgstab_but_not_the_others() {
    // Skew-symmetric: the first search direction of BiCGStab is orthogonal to the shadow residual.
    let a = Csr::from_triplets(2, 2, &[(0, 1, 1.0), (1, 0, -1.0)]).unwrap();
    let none = |kind| SolverParams { preconditioner: PreconditionerKind::None, ..with(kind) };
    let error = solve(&a, &[1.0, 0.0], &none(SolverKind::BiCgStab { l: 1 })).unwrap_err();
    assert!(matches!(error, SolveError::BreakDown { .. }), "{error}");
    for kind in [SolverKind::Gmres { restart: 5 }, SolverKind::Idr { s: 2 }, SolverKind::Direct] {
        let (x, _) = solve(&a, &[1.0, 0.0], &none(kind)).unwrap();
        assert!(distance(&x, &[0.0, 1.0]) < 1e-15, "{kind:?}: {x:?}");
    }
}

#[test]
fn symmetric_and_other_methods_agree_and_choose_as_they_say() {
    let grid = grid(30, |p| 1.0 + 100.0 * p[0], 1.0, |p| p[1]);
    let (a, b) = (grid.reduced.matrix.to_csr(), &grid.reduced.rhs);
    let exact = solve_without_subtraction(&grid.reduced.matrix, b, 28);
    for kind in KINDS {
        let (u, info) = solve(&a, b, &with(kind)).unwrap();
        assert!(distance(&u, &exact) < 1e-11, "{}: {:e}", info.name, distance(&u, &exact));
        assert!(info.residual <= 1e-12 && info.history.len() >= info.iterations.min(2), "{}", info.name);
    }
    assert_eq!(solve(&a, b, &with(SolverKind::Direct)).unwrap().1.name, "sparse LL^T");
    let mut lopsided: Vec<f64> = vec![1.0; b.len()];
    lopsided[3] = 2.0;
    let lopsided = a.row_scaled(&lopsided).unwrap();
    assert_eq!(solve(&lopsided, b, &with(SolverKind::Direct)).unwrap().1.name, "sparse LU");
    let negative = a.row_scaled(&vec![-1.0; b.len()]).unwrap();
    let error = solve(&negative, b, &with(SolverKind::Cg)).unwrap_err();
    assert!(matches!(error, SolveError::BadParameter { .. }), "{error}");
    // Indefinite but with a positive diagonal: Cholesky fails, LU does not.
    let indefinite = Csr::from_triplets(2, 2, &[(0, 0, 1.0), (0, 1, 2.0), (1, 0, 2.0), (1, 1, 1.0)]).unwrap();
    let (x, info) = solve(&indefinite, &[3.0, 3.0], &with(SolverKind::Direct)).unwrap();
    assert!(info.name == "sparse LU" && distance(&x, &[1.0, 1.0]) < 1e-15);
}

#[test]
fn input_that_cannot_be_solved_is_refused() {
    let a = Csr::identity(3);
    for kind in KINDS {
        let params = with(kind);
        assert_eq!(solve(&a, &[0.0; 3], &params).unwrap().0, [0.0; 3]);
        let error = solve(&a, &[1.0, f64::NAN, 0.0], &params).unwrap_err();
        assert!(matches!(error, SolveError::Matrix(MatrixError::BadNumber { node: 1, .. })), "{error}");
        let error = solve(&a, &[1.0; 2], &params).unwrap_err();
        assert!(matches!(error, SolveError::Matrix(MatrixError::Length { found: 2, .. })), "{error}");
        let wide = Csr::from_triplets(2, 3, &[(0, 0, 1.0), (1, 1, 1.0)]).unwrap();
        let error = solve(&wide, &[1.0; 2], &params).unwrap_err();
        assert!(matches!(error, SolveError::Matrix(MatrixError::NotSquare { .. })), "{error}");
        let nothing = Csr::from_triplets(0, 0, &[]).unwrap();
        assert!(solve(&nothing, &[], &params).unwrap().0.is_empty());
    }
    let hole = Csr::from_triplets(3, 3, &[(0, 0, 1.0), (2, 2, 1.0)]).unwrap();
    assert_eq!(
        solve(&hole, &[1.0; 3], &with(SolverKind::Direct)).unwrap_err(),
        SolveError::EmptyRow { row: 1 }
    );
    for params in [
        SolverParams { tolerance: 0.0, ..with(SolverKind::Direct) },
        SolverParams { tolerance: f64::NAN, ..with(SolverKind::Direct) },
        SolverParams { backward_error: Some(2.0), ..with(SolverKind::Direct) },
        with(SolverKind::BiCgStab { l: 0 }),
        with(SolverKind::Gmres { restart: 0 }),
        with(SolverKind::Idr { s: 0 }),
        SolverParams {
            preconditioner: PreconditionerKind::Ilut { fill: 1, drop: -1.0 },
            ..with(SolverKind::Cg)
        },
    ] {
        assert!(matches!(solve(&a, &[1.0; 3], &params), Err(SolveError::BadParameter { .. })), "{params:?}");
    }
}

#[test]
fn a_componentwise_error_is_reached_where_it_is_asked_for() {
    // The solution decays by eight orders of magnitude, which the norm does not see.
    let n = 200;
    let matrix = DifferenceMatrix::from_rows(n, |i, row| {
        [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n).for_each(|j| row.push(j, -1.0));
        row.add_to_row_sum(0.01);
    });
    let a = matrix.unwrap().to_csr();
    let b: Vec<f64> = (0..n).map(|i| if i < 20 { 1.0 } else { 0.0 }).collect();
    for kind in [SolverKind::BiCgStab { l: 2 }, SolverKind::Gmres { restart: 30 }, SolverKind::Idr { s: 4 }] {
        let jacobi =
            SolverParams { preconditioner: PreconditionerKind::Jacobi, tolerance: 1e-6, ..with(kind) };
        let loose = solve(&a, &b, &jacobi).unwrap().1;
        let tight = solve(&a, &b, &SolverParams { backward_error: Some(1e-9), ..jacobi }).unwrap().1;
        assert!(loose.backward_error > 1e-6, "{kind:?}: {:e}", loose.backward_error);
        assert!(tight.backward_error <= 1e-9, "{kind:?}: {:e}", tight.backward_error);
    }
}

#[test]
fn zero_pivots_of_incomplete_factors_are_replaced_and_counted() {
    // The diagonal is missing: elimination without pivoting meets a zero at once.
    let a =
        Csr::from_triplets(3, 3, &[(0, 1, 1.0), (1, 0, 1.0), (1, 2, 1.0), (2, 1, 1.0), (2, 2, 3.0)]).unwrap();
    for preconditioner in [PreconditionerKind::Ilu0, PreconditionerKind::Ilut { fill: 2, drop: 0.0 }] {
        let params = SolverParams { preconditioner, ..with(SolverKind::Gmres { restart: 10 }) };
        let (x, info) = solve(&a, &[2.0, 4.0, 11.0], &params).unwrap();
        assert!(info.replaced_pivots > 0 && distance(&x, &[1.0, 2.0, 3.0]) < 1e-10, "{info:?}");
    }
}

#[test]
fn incomplete_factors_of_a_tridiagonal_matrix_are_complete() {
    let n = 50;
    let a = Csr::from_rows(n, n, |i, row| {
        row.push(i, 4.0 + (i % 3) as f64);
        [i.wrapping_sub(1), i + 1]
            .into_iter()
            .filter(|&j| j < n)
            .for_each(|j| row.push(j, -1.0 - (j % 2) as f64));
    })
    .unwrap();
    assert_eq!(ilu0(&a).unwrap().nnz(), a.nnz());
    assert_eq!(ilut(&a, 0, 0.0).unwrap().nnz(), a.nnz());
    for preconditioner in [PreconditionerKind::Ilu0, PreconditionerKind::Ilut { fill: 0, drop: 0.0 }] {
        let params = SolverParams { preconditioner, ..with(SolverKind::Gmres { restart: 10 }) };
        let (_, info) = solve(&a, &vec![1.0; n], &params).unwrap();
        assert!(info.iterations <= 2, "{info:?}");
    }
}

#[test]
fn more_fill_takes_fewer_products() {
    let grid = grid(50, |_| 1.0, 1.0, |_| 0.0);
    let a = grid.reduced.matrix.to_csr();
    let products = |preconditioner| {
        let params = SolverParams { preconditioner, ..with(SolverKind::Gmres { restart: 100 }) };
        solve(&a, &grid.reduced.rhs, &params).unwrap().1.iterations
    };
    let ilut = |fill, drop| products(PreconditionerKind::Ilut { fill, drop });
    let counts = [
        products(PreconditionerKind::Jacobi),
        products(PreconditionerKind::Ilu0),
        ilut(5, 1e-3),
        ilut(20, 1e-5),
    ];
    assert!(counts.windows(2).all(|w| 3 * w[1] < 2 * w[0]), "{counts:?}");
}

#[test]
fn a_pure_neumann_problem_gives_the_solution_and_the_incompatibility() {
    let m = 20;
    let grid = grid(m, |p| 1.0 + p[0], 0.0, |_| 0.0);
    let exact: Vec<f64> = (0..m * m).map(|i| point(m, i)[0] + 0.5 * point(m, i)[1]).collect();
    let mut rhs = vec![0.0; m * m];
    grid.matrix.mul_vec(&exact, &mut rhs);
    rhs.iter_mut().for_each(|b| *b += 0.125);
    let pin = 7 * m + 3;
    for kind in KINDS[..4].iter().copied() {
        let solution = pure_neumann(&grid.matrix, &rhs, &vec![1.0; m * m], pin, &with(kind)).unwrap();
        let shifted: Vec<f64> = exact.iter().map(|u| u - exact[pin]).collect();
        assert!((solution.lambda - 0.125).abs() < 1e-11, "{kind:?}: {}", solution.lambda);
        assert!(distance(&solution.values, &shifted) < 1e-9, "{kind:?}");
    }
    let error =
        pure_neumann(&grid.matrix, &rhs, &vec![0.0; m * m], pin, &with(SolverKind::Direct)).unwrap_err();
    assert_eq!(error, SolveError::Undetermined { extra: 0 });
}

#[test]
fn splits_that_do_not_fit_are_refused() {
    let grid = grid(6, |_| 1.0, 1.0, |_| 0.0);
    let n = grid.reduced.matrix.n();
    let short = Split::trivial(n - 1).apply(&grid.reduced.matrix, &grid.reduced.rhs);
    assert!(matches!(short, Err(MatrixError::Length { .. })));
    let no_group = Split::new(vec![1; n], Vec::new(), Vec::new());
    assert!(matches!(no_group, Err(MatrixError::NoSuchGroup { node: 0, group: 1, .. })));
}
