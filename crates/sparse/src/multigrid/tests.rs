//! What the levels must be whatever the matrix.

use super::*;
use crate::difference::DifferenceMatrix;
use proptest::prelude::*;

/// A random M-matrix on `n` nodes in a ring with chords: off-diagonal entries by six orders of magnitude, not symmetric
/// unless asked for, row sums that are zero but for a few rows.
fn m_matrix(n: usize, bonds: &[(usize, f64, f64)], symmetric: bool) -> DifferenceMatrix {
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
    for (k, &(chord, there, back)) in bonds.iter().enumerate() {
        let (i, j) = (k % n, (k + 1 + chord % 7) % n);
        if i != j {
            rows[i].push((j, -(10.0_f64.powf(there))));
            rows[j].push((i, -(10.0_f64.powf(if symmetric { there } else { back }))));
        }
    }
    DifferenceMatrix::from_rows(n, |i, row| {
        rows[i].iter().for_each(|&(j, v)| row.push(j, v));
        if i % 50 == 0 {
            row.add_to_row_sum(1.0);
        }
    })
    .expect("entries are finite and in range")
}

fn levels(a: &Csr) -> (strength::Graph, Csr, Csr, Vec<f64>) {
    let graph = strength::symmetric(a, 0.25);
    let aggregates = aggregation::standard(a, &graph);
    let p = prolongation::smoothed(a, &graph, &aggregates);
    (graph, p.clone(), restriction(&p, None), galerkin::row_sums(a))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn constants_are_reproduced_and_the_coarse_matrix_is_the_galerkin_product(
        bonds in prop::collection::vec((0usize..7, -3.0..3.0, -3.0..3.0), 300..500),
        symmetric: bool,
    ) {
        let a = m_matrix(150, &bonds, symmetric).to_csr();
        let (graph, p, r, sums) = levels(&a);
        for i in 0..a.nrows() {
            let sum: f64 = p.row(i).1.iter().sum();
            prop_assert!((sum - 1.0).abs() < 1e-14 || (graph.settled[i] && p.row(i).0.is_empty()));
        }
        let (coarse, coarse_sums) = galerkin::product(&a, &sums, &p, &r);
        let reference = r.multiply(&a).unwrap().multiply(&p).unwrap();
        let size = |m: &Csr, i: usize| m.row(i).1.iter().map(|v| v.abs()).sum::<f64>();
        for i in 0..coarse.nrows() {
            // What rounding allows: entries of A up to the largest of its rows enter the sums.
            let room = 1e-13 * r.row(i).0.iter().map(|&k| size(&a, k as usize)).sum::<f64>();
            for &j in reference.row(i).0.iter().chain(coarse.row(i).0) {
                let difference = coarse.get(i, j as usize) - reference.get(i, j as usize);
                prop_assert!(difference.abs() <= room, "{difference} {room}");
            }
            let sum: f64 = coarse.row(i).1.iter().sum();
            prop_assert!((sum - coarse_sums[i]).abs() <= room);
        }
    }

    #[test]
    fn every_node_is_in_an_aggregate_or_settled(
        bonds in prop::collection::vec((0usize..7, -3.0..3.0, -3.0..3.0), 200..400),
    ) {
        let a = m_matrix(100, &bonds, false).to_csr();
        let graph = strength::symmetric(&a, 0.25);
        let aggregates = aggregation::standard(&a, &graph);
        let mut members = vec![0; aggregates.count];
        for (i, &k) in aggregates.of.iter().enumerate() {
            prop_assert!(k != aggregation::NONE || graph.settled[i] );
            if k != aggregation::NONE {
                members[k as usize] += 1;
            }
        }
        prop_assert!(members.iter().all(|&m| m > 0));
    }
}

#[test]
fn a_weak_bond_survives_on_the_coarse_level() {
    // Two stiff halves of a chain, 1e12, that a bond of 1 ties together; only the first is held, by 1.
    let n = 60;
    let rows = DifferenceMatrix::from_rows(n, |i, row| {
        let bond = |k: usize| if k == n / 2 - 1 { -1.0 } else { -1e12 };
        if i > 0 {
            row.push(i - 1, bond(i - 1));
        }
        if i + 1 < n {
            row.push(i + 1, bond(i));
        }
        if i == 0 {
            row.add_to_row_sum(1.0);
        }
    })
    .unwrap();
    let a = rows.to_csr();
    let (_, p, r, _) = levels(&a);
    let sums: Vec<f64> = (0..n).map(|i| rows.row_sum(i)).collect();
    let (coarse, sums) = galerkin::product(&a, &sums, &p, &r);
    assert_eq!(sums.iter().sum::<f64>(), 1.0);
    // The rows of the second half add up to what ties it to the first.
    let half = coarse.nrows() / 2;
    let tie: f64 = (half..coarse.nrows())
        .flat_map(|i| (0..half).map(move |j| (i, j)))
        .map(|(i, j)| coarse.get(i, j))
        .sum();
    assert!((tie + 1.0).abs() < 1e-12, "{tie}");
}
