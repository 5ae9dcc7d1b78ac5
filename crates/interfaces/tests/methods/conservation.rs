//! Signs, symmetry and sums of conservative rows.

use meshless_geometry::{CloudParams, Domain, Layout, Shape, Spacing, generate};
use meshless_interfaces::gfdm::GfdmParams;
use meshless_interfaces::{Condition, Discretization, RowKind};
use proptest::prelude::*;

use crate::support::{Setup, unit};

fn inclusion<const D: usize>(layout: Layout, spacing: f64, seed: u64, eta: f64, radius: f64) -> Setup<D> {
    let ball = Shape::ball([0.5; D], radius).unwrap();
    Setup::generated(unit(), layout, spacing, seed).regions(vec![Some(ball), None], &[eta, 1.0])
}

/// Entries between conservative nodes agree up to the round-off of a face: that of an area, not of its size.
fn check_symmetry<const D: usize>(setup: &Setup<D>, rows: &Discretization) {
    let (points, spacing) = (setup.cloud.points(), setup.cloud.spacing());
    let entry = |i: usize, j: usize| {
        let (columns, values) = rows.rows.row(i);
        columns.iter().position(|&c| c as usize == j).map_or(0.0, |k| values[k])
    };
    for i in (0..points.len()).filter(|&i| rows.kinds[i] == RowKind::Conservative) {
        for &j in rows.rows.row(i).0 {
            let j = j as usize;
            if rows.kinds[j] == RowKind::Conservative {
                let distance = (0..D).map(|k| (points[i][k] - points[j][k]).powi(2)).sum::<f64>().sqrt();
                let harmonic = 2.0 / (1.0 / setup.eta[i] + 1.0 / setup.eta[j]);
                let size = harmonic * spacing[i].powi(D as i32 - 1) / distance;
                let difference = (entry(i, j) - entry(j, i)).abs();
                assert!(difference <= 1e-12 * size, "{i} {j}: {difference:e} of {size:e}");
            }
        }
    }
}

fn check_conservation<const D: usize>(setup: Setup<D>, flux: [f64; 6], source: f64) {
    let setup = setup.source(|_, _| source).conditions(move |face, _| Condition::Flux(flux[face.0 as usize]));
    let rows = setup.discretize(GfdmParams::conservative());
    assert!(rows.kinds.iter().all(|&k| k == RowKind::Conservative));
    check_symmetry(&setup, &rows);
    let report = rows.report();
    assert_eq!(report.wrong_sign, 0.0);
    assert!(report.row_sum < 1e-12 && report.column_sum < 1e-12, "{report:?}");
    assert!((0..setup.cloud.len()).all(|i| rows.rows.row_sum(i) == 0.0));
    // The cells fill the box, and the sum of all balances is what flows in and is produced.
    let volume: f64 = rows.volumes.iter().sum();
    assert!((volume - 1.0).abs() < 1e-12, "volume {volume}");
    let total: f64 = rows.rhs.iter().sum();
    let expected = source + flux[..2 * D].iter().sum::<f64>();
    let size = source.abs() + flux[..2 * D].iter().map(|g| g.abs()).sum::<f64>();
    assert!((total - expected).abs() < 1e-12 * size, "{total} instead of {expected}");
    // The sum of all rows is zero for any field.
    let field = setup.nodal(|_, x| (7.0 * x[0]).sin() + (5.0 * x[D - 1]).cos());
    let mut flows = vec![0.0; field.len()];
    rows.rows.mul_vec(&field, &mut flows);
    let (sum, size) = flows.iter().fold((0.0, 0.0), |(s, a): (f64, f64), f| (s + f, a + f.abs()));
    assert!(sum.abs() < 1e-12 * size, "{sum:e} of {size:e}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn the_discrete_divergence_theorem_holds(
        seed in 0..1000_u64, exponent in -10.0..10.0, flux in proptest::array::uniform6(-2.0..2.0), source in -3.0..3.0,
        radius in 0.15..0.4, irregular in any::<bool>(),
    ) {
        let eta = 10_f64.powf(exponent);
        let layout = if irregular { Layout::Irregular } else { Layout::Jittered };
        check_conservation(inclusion::<1>(layout, 0.04, seed, eta, radius), flux, source);
        check_conservation(inclusion::<2>(layout, 0.08, seed, eta, radius), flux, source);
        check_conservation(inclusion::<3>(layout, 0.2, seed, eta, radius), flux, source);
    }

    /// Supports are of very different sizes, so that cells meet nodes which are not in their lists.
    #[test]
    fn the_discrete_divergence_theorem_holds_on_graded_clouds(
        seed in 0..1000_u64, ratio in 2.0..8.0_f64, flux in proptest::array::uniform6(-2.0..2.0),
    ) {
        let domain = Domain::<2>::boxed([0.0; 2], [1.0; 2]).unwrap();
        let fine = 0.1 / ratio;
        let spacing = std::sync::Arc::new(move |x: &[f64; 2]| 0.1_f64.min(fine + 0.45 * (x[0] - 0.5).abs()));
        let params = CloudParams { spacing: Spacing::Graded(spacing), layout: Layout::Irregular, seed, max_nodes: 20_000 };
        let cloud = generate(&domain, &params).unwrap();
        check_conservation(Setup::new(domain, cloud), flux, 1.0);
    }

    #[test]
    fn hybrid_solutions_obey_the_maximum_principle(
        seed in 0..1000_u64,
        discs in proptest::collection::vec((0.0..1.0, 0.0..1.0, 0.05..0.3, -10.0..10.0), 1..4),
        faces in proptest::array::uniform4(0.0..1.0),
        insulated in proptest::array::uniform3(any::<bool>()),
    ) {
        let shape = |&(x, y, r, _): &(f64, f64, f64, f64)| Some(Shape::ball([x, y], r).unwrap());
        let shapes = discs.iter().map(shape).chain([None]).collect();
        let eta: Vec<f64> = discs.iter().map(|d| 10_f64.powf(d.3)).chain([1.0]).collect();
        let setup = Setup::<2>::generated(unit(), Layout::Irregular, 0.08, seed).regions(shapes, &eta).conditions(
            move |face, _| match face.0 {
                k if k > 0 && insulated[k as usize - 1] => Condition::Neumann(0.0),
                k => Condition::Dirichlet(faces[k as usize]),
            },
        );
        for params in [GfdmParams::hybrid(), GfdmParams::positive(), GfdmParams::conservative()] {
            let rows = setup.discretize(params);
            prop_assert!(rows.report().wrong_sign < 1e-12);
            let u = setup.solve(params);
            let used = (0..4).filter(|&k| k == 0 || !insulated[k - 1]).map(|k| faces[k]);
            let (low, high) = used.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), g| (l.min(g), h.max(g)));
            for &value in &u {
                prop_assert!(value >= low - 1e-10 && value <= high + 1e-10, "{value} outside of {low}..{high}");
            }
        }
    }
}

/// Where the strong form is replaced is near the interface.
#[test]
fn flagged_nodes_lie_near_the_interface() {
    let setup = inclusion::<2>(Layout::Irregular, 0.04, 3, 1e6, 0.3);
    for (params, reach) in [(GfdmParams::positive(), 1.0), (GfdmParams::hybrid(), 2.0)] {
        let rows = setup.discretize(params);
        assert!(rows.counts.flagged > 0 && rows.counts.cells > 0);
        for (i, x) in setup.cloud.points().iter().enumerate() {
            let distance = ((x[0] - 0.5).hypot(x[1] - 0.5) - 0.3).abs();
            let near_the_boundary =
                x.iter().any(|&c| c.min(1.0 - c) < (reach + 1.0) * crate::support::SUPPORT * 0.04);
            if rows.kinds[i] == RowKind::Conservative && !near_the_boundary {
                assert!(distance < reach * crate::support::SUPPORT * 0.04, "node {i} at {distance}");
            }
        }
    }
    // Every node whose support crosses the interface has a face, or a neighbour with a face, at it.
    let rows = setup.discretize(GfdmParams { select_by_region: true, ..GfdmParams::hybrid() });
    for (i, &label) in setup.labels.iter().enumerate() {
        let crosses = setup.problem().supports.lists.of(i).iter().any(|&j| setup.labels[j as usize] != label);
        assert!(!crosses || rows.kinds[i] != RowKind::Strong, "node {i}");
    }
}
