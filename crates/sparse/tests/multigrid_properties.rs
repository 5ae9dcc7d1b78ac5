//! Multigrid on random matrices.

mod common;

use common::{cases, dense, dense_product, distance};
use meshless_sparse::{
    Criterion, Csr, DifferenceMatrix, MultigridParams, PreconditionerKind, Prepared, SolveError, SolverKind,
    SolverParams, solve,
};
use proptest::prelude::*;

fn multigrid(tolerance: f64) -> SolverParams {
    let levels = MultigridParams { coarsest: 8, ..MultigridParams::default() };
    SolverParams {
        kind: SolverKind::Gmres { restart: 60 },
        preconditioner: PreconditionerKind::Multigrid(levels),
        tolerance,
        ..SolverParams::default()
    }
}

/// A nonsymmetric matrix with entries of both signs, its diagonals larger than the sums of the rest, and a solution.
fn dominant() -> impl Strategy<Value = (Csr, Vec<f64>)> {
    (50usize..150).prop_flat_map(|n| {
        let entries = prop::collection::vec((0..n, 0..n, -1.0..0.3f64), 3 * n..6 * n);
        let rows = prop::collection::vec(0.01..1.0f64, n);
        (entries, rows, prop::collection::vec(-1.0..1.0f64, n)).prop_map(move |(entries, rows, x)| {
            let off: Vec<_> = entries.into_iter().filter(|e| e.0 != e.1).collect();
            let mut diagonal = rows;
            off.iter().for_each(|e| diagonal[e.0] += e.2.abs());
            let all: Vec<_> = off.into_iter().chain((0..).zip(diagonal).map(|(i, d)| (i, i, d))).collect();
            (Csr::from_triplets(n, n, &all).expect("entries are in range"), x)
        })
    })
}

/// Conductances between the nodes of a ring with chords, and a field.
fn network() -> impl Strategy<Value = (DifferenceMatrix, Vec<f64>)> {
    (60usize..160).prop_flat_map(|n| {
        let bonds = prop::collection::vec((0..n, 1..n, -2.0..2.0f64), 2 * n..4 * n);
        (bonds, prop::collection::vec(-1.0..1.0f64, n)).prop_map(move |(bonds, u)| {
            let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
            let ring = (0..n).map(|i| (i, 1, 0.0));
            for (i, step, level) in bonds.into_iter().chain(ring) {
                let (j, a) = ((i + step) % n, -(10.0_f64.powf(level)));
                rows[i].push((j, a));
                rows[j].push((i, a));
            }
            let matrix =
                DifferenceMatrix::from_rows(n, |i, row| rows[i].iter().for_each(|&(j, a)| row.push(j, a)));
            (matrix.expect("entries are in range"), u)
        })
    })
}

/// A square grid with a random diffusivity in every cell, held at its boundary, and an order of its unknowns.
fn field() -> impl Strategy<Value = (usize, Vec<f64>, Vec<u32>)> {
    (14usize..22).prop_flat_map(|m| {
        let order = Just((0..(m * m) as u32).collect::<Vec<u32>>()).prop_shuffle();
        (Just(m), prop::collection::vec(-1.0..1.0f64, m * m), order)
    })
}

fn five_point(m: usize, levels: &[f64]) -> (Csr, Vec<f64>) {
    let eta: Vec<f64> = levels.iter().map(|l| 10.0_f64.powf(*l)).collect();
    let rows = DifferenceMatrix::from_rows(m * m, |i, row| {
        for (k, stride) in [(i % m, 1), (i / m, m)] {
            for other in [(k > 0).then(|| i - stride), (k + 1 < m).then(|| i + stride)] {
                match other {
                    Some(j) => row.push(j, -2.0 * eta[i] * eta[j] / (eta[i] + eta[j])),
                    None => row.add_to_row_sum(2.0 * eta[i]),
                }
            }
        }
    });
    (rows.expect("entries are in range").to_csr(), vec![1.0; m * m])
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn dominant_matrices_of_any_signs_are_solved((a, x) in dominant()) {
        let b = dense_product(&dense(&a), &x);
        let (u, info) = solve(&a, &b, &multigrid(1e-12)).unwrap();
        // Dominance by 0.01 bounds the inverse.
        prop_assert!(distance(&u, &x) < 1e-8, "{:e} after {}", distance(&u, &x), info.iterations);
        prop_assert!(info.iterations <= 40, "{}", info.iterations);
    }

    #[test]
    fn sizes_and_numbering_hardly_change_the_iterations((m, levels, order) in field(), power in -60i32..60, factor in 0.1..10.0f64) {
        let (a, b) = five_point(m, &levels);
        let count = |a: &Csr, b: &[f64]| solve(a, b, &multigrid(1e-10)).map(|s| s.1.iterations);
        let reference = count(&a, &b).unwrap();
        let all = vec![f64::from(power).exp2() * factor; a.nrows()];
        let scaled = count(&a.row_scaled(&all).unwrap(), &b).unwrap();
        prop_assert!(scaled.abs_diff(reference) <= 1, "scaled: {scaled} {reference}");
        let permuted = count(&a.permuted(&order).unwrap(), &b).unwrap();
        prop_assert!(permuted.abs_diff(reference) <= 1, "permuted: {permuted} {reference}");
    }

    #[test]
    fn what_has_no_solution_is_said_to_have_none((network, u) in network(), excess in 0.1..10.0f64) {
        let a = network.to_csr();
        let n = a.nrows();
        let mut b = vec![0.0; n];
        network.mul_vec(&u, &mut b);
        let prepared = Prepared::new(&a, &multigrid(1e-10)).unwrap();
        let (x, info) = prepared.solve(&b).unwrap();
        prop_assert!(info.residual <= 1e-10 || info.criterion == Criterion::RoundOff);
        // One constant is open.
        let mean = |v: &[f64]| v.iter().sum::<f64>() / n as f64;
        let (mx, mu) = (mean(&x), mean(&u));
        let apart = x.iter().zip(&u).map(|(x, u)| (x - mx - u + mu).abs()).fold(0.0, f64::max);
        prop_assert!(apart < 1e-6, "{apart:e}");
        // Sources without a sink: the best any method can do leaves the constant part of them, in equations of equal weight.
        let wrong: Vec<f64> = b.iter().map(|b| b + excess * norm(&a.diagonal()) / (n as f64).sqrt()).collect();
        match prepared.solve(&wrong) {
            Err(SolveError::NoConvergence { residual, best, .. } | SolveError::BreakDown { residual, best, .. }) => {
                prop_assert!(residual > 1e-3, "{residual:e}");
                prop_assert!(best.iter().all(|x| x.is_finite()));
            }
            Err(other) => prop_assert!(false, "{other}"),
            Ok((_, info)) => prop_assert!(false, "solved by {}, {:e}", info.name, info.residual),
        }
    }
}

#[test]
fn any_two_shuffles_of_a_large_matrix_take_as_many_iterations() {
    // More than what is always renumbered, so that the order it comes in is kept.
    let m = 68;
    for seed in 0..4u64 {
        // The finaliser of splitmix64.
        let bits = |k: usize| {
            let mut z = (seed * 1_000_003 + k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            (z ^ (z >> 31)) >> 40
        };
        let levels: Vec<f64> = (0..m * m).map(|k| bits(k) as f64 / f64::from(1 << 23) - 1.0).collect();
        let (a, b) = five_point(m, &levels);
        let count = |a: &Csr| solve(a, &b, &multigrid(1e-10)).unwrap().1.iterations;
        let natural = count(&a);
        let shuffled = [1, 2, 3].map(|k| {
            let mut order: Vec<u32> = (0..(m * m) as u32).collect();
            order.sort_by_key(|&i| bits(k * 100_000 + i as usize));
            count(&a.permuted(&order).unwrap())
        });
        assert!(shuffled.iter().all(|s| s.abs_diff(shuffled[0]) <= 1), "{shuffled:?}");
        assert!(shuffled[0].abs_diff(natural) <= 2, "{natural} {shuffled:?}");
    }
}

#[test]
fn a_graph_in_which_everything_is_near_everything_does_not_fill_in() {
    // Six chords to anywhere from each of 4,000 nodes: a few steps lead from one to any other.
    let n = 4000;
    let rows = DifferenceMatrix::from_rows(n, |i, row| {
        for k in 1..=6 {
            let step = k * k * 97 + 13 * k;
            row.push((i * (2 * k + 1) + step) % n, -1.0);
        }
        row.add_to_row_sum(1e-3);
    });
    let a = rows.unwrap().to_csr();
    let x: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let mut b = vec![0.0; n];
    a.mul_vec(&x, &mut b);
    let prepared = Prepared::new(&a, &multigrid(1e-10)).unwrap();
    let complexity = prepared.hierarchy().unwrap().operator_complexity();
    assert!(complexity < 2.5, "{complexity}");
    let (u, info) = prepared.solve(&b).unwrap();
    assert!(distance(&u, &x) < 1e-6 && info.iterations <= 40, "{:e} {}", distance(&u, &x), info.iterations);
}
