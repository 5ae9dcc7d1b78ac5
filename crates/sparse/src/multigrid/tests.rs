//! What the levels must be whatever the matrix.

use super::strength::Bonds;
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

fn marked(a: &DifferenceMatrix) -> marks::Marks<'_> {
    marks::symmetric(a, &smoother::reciprocals(a), None, 0.25)
}

fn levels(a: &DifferenceMatrix) -> (marks::Marks<'_>, Interpolation, Interpolation, Vec<f64>) {
    let graph = marked(a);
    let aggregates = aggregation::standard(a, None, &graph);
    let p = prolongation::smoothed(a, None, &graph, &aggregates, Step::LONG);
    let p = Interpolation::new(p);
    let r = p.transposed();
    (graph, p, r, galerkin::row_sums(a, None, &[]))
}

/// So many cases of a property, or `PROPTEST_CASES`, which `ProptestConfig::with_cases` does not look at.
fn cases(count: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(count))
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn constants_are_reproduced_and_the_coarse_matrix_is_the_galerkin_product(
        bonds in prop::collection::vec((0usize..7, -3.0..3.0, -3.0..3.0), 300..500),
        symmetric: bool,
    ) {
        let a = m_matrix(150, &bonds, symmetric);
        let (graph, p, r, sums) = levels(&a);
        for i in 0..a.n() {
            let sum: f64 = p.row(i).map(|(_, w)| w).sum();
            prop_assert!(sum == 1.0 || (graph.is_settled(i) && p.is_empty(i)));
        }
        let coarse = galerkin::product(&a, sums, [None, None], &p, &r);
        let (p, r) = (p.to_csr(), r.to_csr());
        let (a, coarse_sums, coarse) = (a.to_csr(), coarse.row_sums().to_vec(), coarse.to_csr());
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
    fn minimised_prolongation_has_less_energy_and_the_same_sums(
        bonds in prop::collection::vec((0usize..7, -1.0..1.0, -1.0..1.0), 300..500),
        symmetric: bool,
    ) {
        let rows = m_matrix(150, &bonds, symmetric);
        let graph = marked(&rows);
        let aggregates = aggregation::standard(&rows, None, &graph);
        let jacobi = prolongation::smoothed(&rows, None, &graph, &aggregates, Step::LONG);
        let a = rows.to_csr();
        let p = energy::minimized(&a, &graph, &aggregates).unwrap();
        prop_assert_eq!((p.offsets(), p.indices()), (jacobi.offsets(), jacobi.indices()));
        for i in 0..a.nrows() {
            let (sum, before): (f64, f64) = (p.row(i).1.iter().sum(), jacobi.row(i).1.iter().sum());
            prop_assert!((sum - before).abs() < 1e-13);
        }
        if symmetric {
            let energy = |p: &Csr| {
                let coarse = p.transpose().multiply(&a.multiply(p).unwrap()).unwrap();
                coarse.diagonal().iter().sum::<f64>()
            };
            prop_assert!(energy(&p) <= energy(&jacobi) * (1.0 + 1e-12), "{} {}", energy(&p), energy(&jacobi));
        }
    }

    #[test]
    fn founded_aggregates_are_neighbourhoods_that_do_not_overlap_and_leave_no_room_for_more(
        bonds in prop::collection::vec((0usize..7, -3.0..3.0, -3.0..3.0), 200..400),
    ) {
        let a = m_matrix(100, &bonds, false);
        let graph = marked(&a);
        let (of, count) = aggregation::founded(&graph);
        let mut founders = vec![0; count as usize];
        for i in 0..100 {
            let whole = graph.neighbors(i).all(|j| of[j] == of[i]);
            let size = of.iter().filter(|&&k| k == of[i]).count();
            if of[i] != aggregation::NONE && whole && size == 1 + graph.neighbors(i).count() {
                founders[of[i] as usize] += 1;
            }
            let room = graph.neighbors(i).all(|j| of[j] == aggregation::NONE);
            prop_assert!(of[i] != aggregation::NONE || graph.is_alone(i) || !room);
        }
        prop_assert!(founders.iter().all(|&n| n > 0));
    }

    #[test]
    fn every_node_is_in_an_aggregate_or_settled(
        bonds in prop::collection::vec((0usize..7, -3.0..3.0, -3.0..3.0), 200..400),
    ) {
        let a = m_matrix(100, &bonds, false);
        let graph = marked(&a);
        let aggregates = aggregation::standard(&a, None, &graph);
        let mut members = vec![0; aggregates.count];
        for (i, &k) in aggregates.of.iter().enumerate() {
            prop_assert!(k != aggregation::NONE || graph.is_settled(i) );
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
    let (_, p, r, _) = levels(&rows);
    let coarse = galerkin::product(&rows, rows.row_sums().to_vec(), [None, None], &p, &r);
    assert_eq!(coarse.row_sums().iter().sum::<f64>(), 1.0);
    let coarse = coarse.to_csr();
    // The rows of the second half add up to what ties it to the first.
    let half = coarse.nrows() / 2;
    let tie: f64 = (half..coarse.nrows())
        .flat_map(|i| (0..half).map(move |j| (i, j)))
        .map(|(i, j)| coarse.get(i, j))
        .sum();
    assert!((tie + 1.0).abs() < 1e-12, "{tie}");
}

/// The five-point formula on a square of `m` by `m` nodes, with a stiff disc in it.
fn disc(m: usize, contrast: f64) -> (DifferenceMatrix, Vec<f64>) {
    let inside = |i: usize| (i % m).abs_diff(m / 2).pow(2) + (i / m).abs_diff(m / 2).pow(2) < (m / 4).pow(2);
    let eta = |i: usize| if inside(i) { contrast } else { 1.0 };
    let rows = DifferenceMatrix::from_rows(m * m, |i, row| {
        for (k, stride) in [(i % m, 1), (i / m, m)] {
            for other in [(k > 0).then(|| i - stride), (k + 1 < m).then(|| i + stride)] {
                match other {
                    Some(j) => row.push(j, -2.0 * eta(i) * eta(j) / (eta(i) + eta(j))),
                    None => row.add_to_row_sum(2.0 * eta(i)),
                }
            }
        }
    });
    let indicator = (0..m * m).map(|i| f64::from(u8::from(inside(i)))).collect();
    (rows.expect("entries are in range"), indicator)
}

#[test]
fn at_a_high_contrast_the_constant_of_every_region_is_reproduced() {
    let (a, indicator) = disc(40, 1e4);
    let graph = marked(&a);
    let aggregates = aggregation::standard(&a, None, &graph);
    let jacobi = prolongation::smoothed(&a, None, &graph, &aggregates, Step::LONG);
    for p in [jacobi, energy::minimized(&a.to_csr(), &graph, &aggregates).unwrap()] {
        let mut coarse = vec![0.0; aggregates.count];
        (0..a.n()).for_each(|i| coarse[aggregates.of[i] as usize] = indicator[i]);
        let mut fine = vec![0.0; a.n()];
        p.mul_vec(&coarse, &mut fine);
        assert!(fine.iter().zip(&indicator).all(|(f, i)| (f - i).abs() < 1e-13));
    }
}

#[test]
fn a_numbering_is_found_where_there_was_none() {
    let (small, _) = disc(30, 10.0);
    assert!(numbering::found(small.off_diagonal()).is_some(), "small ones are always renumbered");
    let (a, _) = disc(70, 10.0);
    assert!(numbering::found(a.off_diagonal()).is_none(), "rows of a grid are an order");
    let (n, a) = (a.n(), a.to_csr());
    let shuffle: Vec<u32> = (0..n).map(|k| (k * 367 % n) as u32).collect();
    let shuffled = a.permuted(&shuffle).unwrap();
    let order = numbering::found(&shuffled).expect("a grid has an order");
    let again = shuffled.permuted(&order).unwrap();
    let widest = |a: &Csr| {
        let far = |i: usize| a.row(i).0.iter().map(move |&j| (j as usize).abs_diff(i)).max();
        (0..n).filter_map(far).max()
    };
    assert!(widest(&again) <= Some(105), "{:?}", widest(&again));
    // Everybody knows somebody far away.
    let random = Csr::from_rows(n, n, |i, row| {
        row.push(i, 10.0);
        (1..8).for_each(|k| row.push((i * i * 7 + k * 131 * (i + k)) % n, -1.0));
    });
    assert!(numbering::found(&random.unwrap()).is_none());
}
