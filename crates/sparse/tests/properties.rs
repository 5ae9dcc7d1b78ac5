//! Invariants of matrices, elimination and solvers, on random systems.

mod common;

use common::{dense, dense_product, distance};
use meshless_sparse::{Csr, DifferenceMatrix, PreconditionerKind, Prepared, SolverKind, SolverParams, solve};
use proptest::prelude::*;

type Triplets = Vec<(usize, usize, f64)>;

/// A size, triplets within it, and a vector.
fn triplets() -> impl Strategy<Value = (usize, usize, Triplets, Vec<f64>)> {
    (1usize..30, 1usize..30).prop_flat_map(|(n, m)| {
        let entry = (0..n, 0..m, -4.0..4.0f64);
        (Just(n), Just(m), prop::collection::vec(entry, 0..120), prop::collection::vec(-1.0..1.0f64, m))
    })
}

/// A strictly diagonally dominant nonsymmetric matrix with rows of very different size, and a solution.
fn dominant() -> impl Strategy<Value = (Csr, Vec<f64>)> {
    (2usize..40).prop_flat_map(|n| {
        let entry = (0..n, 0..n, -1.0..1.0f64);
        let entries = prop::collection::vec(entry, n..6 * n);
        let row = prop::collection::vec((-20i32..20, 0.05..1.0f64, any::<bool>()), n);
        (entries, row, prop::collection::vec(-1.0..1.0f64, n)).prop_map(move |(entries, rows, x)| {
            let mut dominance = vec![0.0; n];
            entries.iter().filter(|e| e.0 != e.1).for_each(|e| dominance[e.0] += e.2.abs());
            let off = entries
                .iter()
                .filter(|e| e.0 != e.1)
                .map(|&(i, j, a)| (i, j, a * f64::from(rows[i].0).exp2()));
            let diagonal = (0..n).map(|i| {
                let (power, extra, negative) = rows[i];
                let d = (dominance[i] + extra) * f64::from(power).exp2();
                (i, i, if negative { -d } else { d })
            });
            let all: Triplets = off.chain(diagonal).collect();
            (Csr::from_triplets(n, n, &all).expect("entries are in range"), x)
        })
    })
}

/// Rows of a difference matrix: columns with coefficients, and row sums; with some nodes known.
fn differences() -> impl Strategy<Value = (DifferenceMatrix, Vec<Option<f64>>, Vec<f64>)> {
    (2usize..25).prop_flat_map(|n| {
        let row = (prop::collection::vec((0..n, -2.0..1.0f64), 0..8), 0.0..1.0f64);
        let rows = prop::collection::vec(row, n);
        let known = prop::collection::vec(prop::option::of(-1.0..1.0f64), n);
        (rows, known, prop::collection::vec(-1.0..1.0f64, n)).prop_map(move |(rows, known, u)| {
            let matrix = DifferenceMatrix::from_rows(n, |i, row| {
                rows[i].0.iter().for_each(|&(j, a)| row.push(j, a));
                row.add_to_row_sum(rows[i].1);
            });
            (matrix.expect("entries are in range"), known, u)
        })
    })
}

fn every_solver() -> Vec<SolverParams> {
    let ilut = PreconditionerKind::Ilut { fill: 10, drop: 1e-4 };
    let kinds = [1, 2, 4].map(|l| SolverKind::BiCgStab { l });
    let mut all = vec![SolverParams { kind: SolverKind::Direct, ..SolverParams::default() }];
    let others = [SolverKind::Gmres { restart: 50 }, SolverKind::Idr { s: 1 }, SolverKind::Idr { s: 4 }];
    for kind in kinds.into_iter().chain(others) {
        for preconditioner in [PreconditionerKind::Jacobi, PreconditionerKind::Ilu0, ilut] {
            all.push(SolverParams { kind, preconditioner, tolerance: 1e-13, ..SolverParams::default() });
        }
    }
    all
}

proptest! {
    #![proptest_config(common::cases(64))]

    #[test]
    fn products_and_transposes_agree_with_dense_ones((n, m, entries, x) in triplets()) {
        let a = Csr::from_triplets(n, m, &entries).unwrap();
        let mut reference = vec![vec![0.0; m]; n];
        entries.iter().for_each(|&(i, j, v)| reference[i][j] += v);
        prop_assert_eq!(dense(&a), reference.clone());
        let mut y = vec![f64::NAN; n];
        a.mul_vec(&x, &mut y);
        for (y, z) in y.iter().zip(dense_product(&reference, &x)) {
            prop_assert!((y - z).abs() <= 1e-13);
        }
        let t = a.transpose();
        let again = Csr::try_from_parts(m, n, t.offsets().to_vec(), t.indices().to_vec(), t.values().to_vec());
        prop_assert_eq!(again.as_ref(), Ok(&t));
        prop_assert_eq!(t.transpose(), a);
    }

    #[test]
    fn sprs_sees_the_same_matrix((n, m, entries, _) in triplets()) {
        let a = Csr::from_triplets(n, m, &entries).unwrap();
        prop_assert_eq!(Csr::from_sprs(a.as_sprs()).unwrap(), a.clone());
        let columns_first = a.as_sprs().to_csc();
        prop_assert_eq!(Csr::from_sprs(columns_first.view()).unwrap(), a);
    }

    #[test]
    fn market_files_come_back((n, m, entries, _) in triplets()) {
        let a = Csr::from_triplets(n, m, &entries).unwrap();
        let mut file = Vec::new();
        meshless_sparse::write_matrix_market(&a, &mut file).unwrap();
        prop_assert_eq!(meshless_sparse::read_matrix_market(file.as_slice()).unwrap(), a);
    }

    #[test]
    fn every_solver_finds_the_solution((a, x) in dominant()) {
        // Dominance bounds the inverse of the scaled matrix, so that x solves up to some hundred roundings.
        let b = dense_product(&dense(&a), &x);
        for params in every_solver() {
            let (u, info) = solve(&a, &b, &params).unwrap();
            prop_assert!(distance(&u, &x) < 1e-11, "{}: {:e}", info.name, distance(&u, &x));
            prop_assert!(info.residual <= 1e-13, "{}: {:e}", info.name, info.residual);
            if params.kind == SolverKind::Direct {
                prop_assert!(info.backward_error <= 1e-15, "{:e}", info.backward_error);
            }
        }
    }

    #[test]
    fn scaling_rows_changes_nothing((a, x) in dominant(), powers in prop::collection::vec(-30i32..30, 40)) {
        let b = dense_product(&dense(&a), &x);
        let factors: Vec<f64> = powers[..b.len()].iter().map(|&p| f64::from(p).exp2()).collect();
        let scaled = a.row_scaled(&factors).unwrap();
        let c: Vec<f64> = b.iter().zip(&factors).map(|(b, f)| b * f).collect();
        for params in every_solver() {
            let (u, v) = (solve(&a, &b, &params).unwrap().0, solve(&scaled, &c, &params).unwrap().0);
            if a.is_symmetric() || scaled.is_symmetric() {
                // `L L^T` takes square roots.
                prop_assert!(distance(&v, &u) < 1e-13);
            } else {
                // Powers of two round nothing, and the solvers undo them: the same bits.
                prop_assert_eq!(u, v);
            }
        }
    }

    #[test]
    fn renumbering_renumbers_the_solution((a, x) in dominant(), keys in prop::collection::vec(any::<u32>(), 40)) {
        let b = dense_product(&dense(&a), &x);
        let mut order: Vec<u32> = (0..b.len() as u32).collect();
        order.sort_by_key(|&i| keys[i as usize]);
        let permuted = a.permuted(&order).unwrap();
        let c: Vec<f64> = order.iter().map(|&i| b[i as usize]).collect();
        for params in every_solver() {
            let u = solve(&a, &b, &params).unwrap().0;
            let v = solve(&permuted, &c, &params).unwrap().0;
            let renumbered: Vec<f64> = order.iter().map(|&i| u[i as usize]).collect();
            prop_assert!(distance(&v, &renumbered) < 1e-10);
        }
    }

    #[test]
    fn difference_form_and_matrix_agree((matrix, _, u) in differences()) {
        let mut by_differences = vec![0.0; u.len()];
        matrix.mul_vec(&u, &mut by_differences);
        let by_matrix = dense_product(&dense(&matrix.to_csr()), &u);
        for (a, b) in by_differences.iter().zip(&by_matrix) {
            prop_assert!((a - b).abs() < 1e-13);
        }
        // Constants see the row sums only, exactly.
        let mut sums = vec![0.0; u.len()];
        matrix.mul_vec(&vec![1.0; u.len()], &mut sums);
        prop_assert!((0..u.len()).all(|i| sums[i] == matrix.row_sum(i)));
    }

    #[test]
    fn elimination_keeps_the_equations((matrix, known, u) in differences()) {
        // For any u that takes the known values, the reduced residual is that of the unknown nodes.
        let rhs = vec![0.25; u.len()];
        let full: Vec<f64> = u.iter().zip(&known).map(|(u, g)| g.unwrap_or(*u)).collect();
        let reduced = matrix.eliminate(&known, &rhs).unwrap();
        let unknowns: Vec<f64> = reduced.map.iter().map(|&i| full[i as usize]).collect();
        prop_assert_eq!(&reduced.expand(&unknowns, &known).unwrap(), &full);
        let (mut r, mut s) = (vec![0.0; full.len()], vec![0.0; unknowns.len()]);
        matrix.residual(&full, &rhs, &mut r);
        reduced.matrix.residual(&unknowns, &reduced.rhs, &mut s);
        for (k, &i) in reduced.map.iter().enumerate() {
            prop_assert!((s[k] - r[i as usize]).abs() < 1e-13);
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    // Long enough for products and sums to be shared among threads.
    let n = 150_000;
    let work = || {
        let matrix = DifferenceMatrix::from_rows(n, |i, row| {
            let c = 1.0 + (i % 7) as f64 / 3.0;
            [i.wrapping_sub(1), i + 1, i + 300].into_iter().filter(|&j| j < n).for_each(|j| row.push(j, -c));
            row.add_to_row_sum(0.3 + (i % 11) as f64 / 7.0);
        })
        .unwrap();
        let b: Vec<f64> = (0..n).map(|i| ((i * 31) % 101) as f64 / 101.0).collect();
        let mut y = vec![0.0; n];
        matrix.mul_vec(&b, &mut y);
        let kinds = [SolverKind::BiCgStab { l: 2 }, SolverKind::Gmres { restart: 20 }];
        let solutions = kinds.map(|kind| {
            let params = SolverParams { kind, tolerance: 1e-10, ..SolverParams::default() };
            Prepared::new(&matrix.to_csr(), &params).unwrap().solve(&b).unwrap()
        });
        (y, solutions)
    };
    let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work);
    assert!(with(1) == with(2), "one and two threads give different bits");
}
