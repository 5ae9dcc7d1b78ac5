//! Floating clusters of random graphs, and chains whose solution is a sum of resistances.

use meshless_sparse::{
    Bordered, Cluster, ComponentInfo, DEFAULT_THRESHOLD, DifferenceMatrix, MatrixError, SolverKind,
    SolverParams, Split, clusters,
};
use proptest::prelude::*;

fn info(eta: f64, touches_fixed: bool) -> ComponentInfo {
    ComponentInfo { eta_min: eta, eta_max: eta, touches_fixed }
}

/// Clusters of a path of components, of which the first is fixed.
fn path(etas: &[f64]) -> Vec<Cluster> {
    let infos: Vec<_> = etas.iter().enumerate().map(|(k, &eta)| info(eta, k == 0)).collect();
    let adjacency: Vec<Vec<u32>> = (0..etas.len() as u32)
        .map(|k| if (k as usize) + 1 < etas.len() { vec![k + 1] } else { vec![] })
        .collect();
    clusters(&infos, &adjacency, DEFAULT_THRESHOLD)
}

fn members(found: &[Cluster]) -> Vec<(Vec<u32>, Option<u32>)> {
    found.iter().map(|c| (c.members.clone(), c.parent)).collect()
}

#[test]
fn rings_of_growing_stiffness_are_nested() {
    let found = path(&[1.0, 1e5, 1e10]);
    assert_eq!(members(&found), [(vec![1, 2], None), (vec![2], Some(0))]);
    assert_eq!((found[0].factor, found[0].own.as_slice(), found[0].scales[0]), (1.0, &[1][..], 1e-5));
    assert_eq!((found[1].factor, found[1].own.as_slice()), (1e-5, &[2][..]));
    assert!((found[1].scales[0] / 1e-10 - 1.0).abs() < 1e-15);
}

#[test]
fn a_soft_ring_sets_its_core_afloat() {
    let found = path(&[1.0, 1e-10, 1.0]);
    assert_eq!(members(&found), [(vec![2], None)]);
    assert_eq!((found[0].factor, found[0].scales[0]), (1.0, 1e-10));
}

#[test]
fn a_stiff_ring_takes_a_softer_core_with_it() {
    // The core is stiffer than the outside, but not than the ring.
    assert_eq!(members(&path(&[1.0, 1e10, 1e5])), [(vec![1, 2], None), (vec![1], Some(0))]);
    // A core as soft as the outside has its level from the ring.
    assert_eq!(members(&path(&[1.0, 1e10, 1.0])), [(vec![1], None)]);
}

#[test]
fn what_is_fixed_soft_or_alone_does_not_float() {
    assert!(path(&[1e10, 1.0]).is_empty());
    assert!(path(&[1.0, 9.0]).is_empty());
    assert!(clusters(&[info(1.0, false)], &[vec![]], DEFAULT_THRESHOLD).is_empty());
    let fixed = [info(1.0, true), info(1e6, true)];
    assert!(clusters(&fixed, &[vec![1], vec![0]], DEFAULT_THRESHOLD).is_empty());
    // Without anything fixed, the softest level is where constants meet.
    let free = [info(1.0, false), info(1e6, false)];
    assert_eq!(members(&clusters(&free, &[vec![1], vec![]], DEFAULT_THRESHOLD)), [(vec![1], None)]);
}

#[test]
fn small_steps_that_add_up_are_split_too() {
    let etas: Vec<f64> = (0..12).map(|k| 5.0_f64.powi(k)).collect();
    let found = path(&etas);
    // One cluster for each factor of more than ten, which is every other step.
    assert_eq!(found.len(), 5);
    assert!(found.windows(2).all(|w| w[1].members.len() == w[0].members.len() - 2));
}

#[test]
fn coefficients_that_are_no_numbers_float_nowhere() {
    for eta in [f64::NAN, -1.0, 0.0, f64::INFINITY] {
        let infos = [info(1.0, true), info(eta, false)];
        assert!(clusters(&infos, &[vec![1], vec![7]], DEFAULT_THRESHOLD).is_empty(), "{eta}");
    }
}

/// Components with coefficients from 1e-12 to 1e12, some varying within, some fixed; and who touches whom.
#[test]
fn a_split_of_all_nodes_serves_those_that_are_left() {
    // A line of which the first node is prescribed and the last four are stiff.
    let eta = |i: usize| if i < 6 { 1.0 } else { 1e10 };
    let rows = DifferenceMatrix::from_rows(10, |i, row| {
        for j in [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < 10) {
            row.push(j, -2.0 / (1.0 / eta(i) + 1.0 / eta(j)));
        }
    })
    .unwrap();
    let component: Vec<u32> = (0..10).map(|i| u32::from(i >= 6)).collect();
    let found = path(&[1.0, 1e10]);
    let whole = Split::from_clusters(&rows, &component, 2, &found).unwrap();
    let mut known = vec![None; 10];
    known[0] = Some(0.0);
    let reduced = rows.eliminate(&known, &[1.0; 10]).unwrap();
    let split = whole.restricted(&reduced.map).unwrap();
    assert_eq!(split, Split::from_clusters(&reduced.matrix, &component[1..], 2, &found).unwrap());
    // Rows over w and C that say how they are split are the same system.
    let applied = split.apply(&reduced.matrix, &reduced.rhs).unwrap();
    let (columns, pinned) = (applied.columns().to_vec(), applied.pinned().to_vec());
    let given = |pinned| {
        Bordered::new(applied.matrix().clone(), columns.clone(), pinned, reduced.rhs.clone()).unwrap()
    };
    assert_eq!(given(pinned).with_split(split.clone()), Ok(applied.clone()));
    assert!(matches!(given(vec![0]).with_split(split), Err(MatrixError::NoPin { cluster: 0, .. })));
    assert!(matches!(whole.restricted(&[0, 1]), Err(MatrixError::NoPin { cluster: 0, .. })));
    assert!(matches!(whole.restricted(&[10]), Err(MatrixError::RowOutOfRange { row: 10, nrows: 10 })));
}

fn graph() -> impl Strategy<Value = (Vec<ComponentInfo>, Vec<Vec<u32>>)> {
    (2usize..9).prop_flat_map(|n| {
        let component = (-12.0..12.0f64, 0.0..1.5f64, prop::bool::weighted(0.25));
        let touching = prop::collection::vec((0..n, 0..n), n..2 * n);
        (prop::collection::vec(component, n), touching).prop_map(move |(components, touching)| {
            let infos = components.iter().map(|&(level, spread, touches_fixed)| ComponentInfo {
                eta_min: 10f64.powf(level),
                eta_max: 10f64.powf(level + (spread - 1.0).max(0.0)),
                touches_fixed,
            });
            let mut adjacency = vec![Vec::new(); n];
            touching.iter().for_each(|&(a, b)| adjacency[a].push(b as u32));
            (infos.collect(), adjacency)
        })
    })
}

fn touches(adjacency: &[Vec<u32>], a: usize, b: usize) -> bool {
    adjacency[a].contains(&(b as u32)) || adjacency[b].contains(&(a as u32))
}

/// Whether a set, given by the bits of `set`, is connected, has neighbours, touches nothing fixed, and exceeds all
/// neighbours by the factor.
fn floats(infos: &[ComponentInfo], adjacency: &[Vec<u32>], set: u32, factor: f64) -> bool {
    let inside = |k: usize| set >> k & 1 == 1;
    let n = infos.len();
    let mut reached = 1u32 << set.trailing_zeros();
    for _ in 0..n {
        for k in (0..n).filter(|&k| inside(k)) {
            if (0..n).any(|j| reached >> j & 1 == 1 && touches(adjacency, j, k)) {
                reached |= 1 << k;
            }
        }
    }
    let lowest = (0..n).filter(|&k| inside(k)).map(|k| infos[k].eta_min).fold(f64::INFINITY, f64::min);
    let outside = (0..n).filter(|&j| !inside(j) && (0..n).any(|k| inside(k) && touches(adjacency, j, k)));
    let highest = outside.map(|j| infos[j].eta_max).fold(0.0, f64::max);
    reached == set
        && (0..n).all(|k| !inside(k) || !infos[k].touches_fixed)
        && highest > 0.0
        && lowest > factor * highest
}

fn bits(members: &[u32]) -> u32 {
    members.iter().map(|&k| 1 << k).sum()
}

/// Cells of a chain in groups: coefficient of a group, number of its cells.
fn chain() -> impl Strategy<Value = Vec<(f64, usize)>> {
    let group = (-12.0..12.0f64, 1usize..6).prop_map(|(level, cells)| (10f64.powf(level), cells));
    prop::collection::vec(group, 2..10)
}

proptest! {
    #[test]
    fn clusters_are_what_they_are_defined_to_be((infos, adjacency) in graph()) {
        let found = clusters(&infos, &adjacency, DEFAULT_THRESHOLD);
        let sets: Vec<u32> = found.iter().map(|c| bits(&c.members)).collect();
        for (k, cluster) in found.iter().enumerate() {
            prop_assert!(floats(&infos, &adjacency, sets[k], 1.0), "{cluster:?}");
            // The parent is the smallest one around, and comes before.
            let around = (0..found.len()).filter(|&j| j != k && sets[j] & sets[k] == sets[k]);
            let smallest = around.min_by_key(|&j| sets[j].count_ones());
            prop_assert_eq!(cluster.parent.map(|p| p as usize), smallest);
            prop_assert!(smallest.is_none_or(|p| p < k));
            prop_assert!(!cluster.own.is_empty() && cluster.own.len() == cluster.scales.len());
            for j in 0..k {
                let common = sets[j] & sets[k];
                prop_assert!(common == 0 || common == sets[k], "neither nested nor disjoint");
            }
        }
        // Nothing that exceeds all its neighbours by the threshold is missed.
        for set in 1..1u32 << infos.len() {
            if floats(&infos, &adjacency, set, DEFAULT_THRESHOLD) {
                prop_assert!(sets.contains(&set), "missed {set:b} of {infos:?}");
            }
        }
    }

    #[test]
    fn chains_are_sums_of_resistances(groups in chain(), right in prop::bool::ANY) {
        // Cells of width 1 with half-cell resistances 1/(2 eta); u = 1 at the left end, 0 or an insulated wall at the right.
        let etas: Vec<f64> = groups.iter().flat_map(|&(eta, cells)| vec![eta; cells]).collect();
        let n = etas.len();
        let conductance = |i: usize, j: usize| 2.0 * etas[i] / (1.0 + etas[i] / etas[j]);
        let matrix = DifferenceMatrix::from_rows(n, |i, row| {
            [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n).for_each(|j| row.push(j, -conductance(i, j)));
            if i == 0 || (right && i + 1 == n) {
                row.add_to_row_sum(2.0 * etas[i]);
            }
        }).unwrap();
        let mut rhs = vec![0.0; n];
        rhs[0] = 2.0 * etas[0];
        let half: Vec<f64> = etas.iter().map(|eta| 0.5 / eta).collect();
        let total: f64 = 2.0 * half.iter().sum::<f64>();
        let exact: Vec<f64> = (0..n)
            .map(|i| if right { (half[i] + 2.0 * half[i + 1..].iter().sum::<f64>()) / total } else { 1.0 })
            .collect();

        let infos: Vec<_> = (groups.iter().enumerate())
            .map(|(k, g)| info(g.0, k == 0 || (right && k + 1 == groups.len())))
            .collect();
        let adjacency: Vec<Vec<u32>> = (1..=groups.len() as u32)
            .map(|k| if (k as usize) < groups.len() { vec![k] } else { vec![] })
            .collect();
        let found = clusters(&infos, &adjacency, DEFAULT_THRESHOLD);
        let component: Vec<u32> = (0u32..).zip(&groups).flat_map(|(k, g)| vec![k; g.1]).collect();
        let split = Split::from_clusters(&matrix, &component, groups.len(), &found).unwrap();
        let params = SolverParams { kind: SolverKind::Direct, ..SolverParams::default() };
        let solution = split.apply(&matrix, &rhs).unwrap().solve(&params).unwrap();
        let u = split.recover(&solution.values, &solution.extra).unwrap();
        for i in 0..n {
            prop_assert!((u[i] - exact[i]).abs() <= 1e-10, "{i}: {} {}, {found:?}", u[i], exact[i]);
        }
    }
}
