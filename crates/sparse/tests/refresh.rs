//! Other values in the same pattern: levels stay as long as they fit.

mod common;

use common::{direct, disc, distance, iterations, multigrid, with};
use meshless_sparse::{
    Candidate, Csr, DifferenceMatrix, MultigridParams, PreconditionerKind, Prepared, SolverKind,
    SolverParams, solve,
};

#[test]
fn refreshed_levels_serve_a_matrix_with_other_values() {
    let (before, after) = (disc(60, 1e-2), disc(60, 1e-3));
    let (a, b) = (before.reduced.matrix.to_csr(), &after.reduced.rhs);
    let changed = after.reduced.matrix.to_csr();
    let exact = solve(&changed, b, &direct()).unwrap().0;
    let chain = SolverParams { kind: SolverKind::Multigrid, ..multigrid() };
    let constant =
        with(MultigridParams { coarsest: 40, candidate: Candidate::Constant, ..Default::default() });
    let jacobi = SolverParams { preconditioner: PreconditionerKind::Jacobi, ..multigrid() };
    for params in [multigrid(), constant, chain, jacobi, direct()] {
        let mut prepared = Prepared::new(&a, &params).unwrap();
        prepared.refresh(&changed).unwrap();
        let solved = prepared.solve_all(&[b.clone(), vec![0.0; b.len()]]).unwrap();
        assert!(distance(&solved[0].0, &exact) < 1e-7, "{}", solved[0].1.name);
        assert!(solved[1].0.iter().all(|&x| x == 0.0));
        if params.kind != SolverKind::Direct && params != jacobi {
            let fresh = iterations(&changed, b, &multigrid()).iterations;
            assert!(solved[0].1.iterations <= fresh + 3, "{} {fresh}", solved[0].1.iterations);
        }
        assert!(prepared.refresh(&disc(20, 1.0).reduced.matrix.to_csr()).is_err());
    }
}

/// A square of `m` by `m` nodes whose diffusivities in both directions depend on the place.
fn anisotropic(m: usize, eta: impl Fn(f64, f64) -> [f64; 2] + Sync) -> Csr {
    let rows = DifferenceMatrix::from_rows(m * m, |i, row| {
        let at = |k: usize| (k as f64 + 0.5) / m as f64;
        let eta = |i: usize, direction: usize| eta(at(i % m), at(i / m))[direction];
        for (direction, (k, stride)) in [(i % m, 1), (i / m, m)].into_iter().enumerate() {
            let own = eta(i, direction);
            for other in [(k > 0).then(|| i - stride), (k + 1 < m).then(|| i + stride)] {
                match other {
                    Some(j) => row.push(j, -2.0 * own * eta(j, direction) / (own + eta(j, direction))),
                    None => row.add_to_row_sum(2.0 * own),
                }
            }
        }
    });
    rows.expect("entries are in range").to_csr()
}

#[test]
fn levels_that_no_longer_fit_are_made_anew() {
    let m = 70;
    let disc = |x: f64, y: f64, center: f64| if (x - center).hypot(y - 0.5) < 0.25 { 1e4 } else { 1.0 };
    let waves = |x: f64, y: f64| (3.0 * ((17.0 * x).sin() + (19.0 * y).cos())).exp();
    let pairs = [
        (anisotropic(m, |x, y| [disc(x, y, 0.4); 2]), anisotropic(m, |x, y| [disc(x, y, 0.45); 2])),
        (anisotropic(m, |_, _| [1.0; 2]), anisotropic(m, |_, _| [1.0, 100.0])),
        (anisotropic(m, |_, _| [1.0; 2]), anisotropic(m, |x, y| [waves(x, y); 2])),
    ];
    let chain = SolverParams { kind: SolverKind::Multigrid, ..multigrid() };
    for (k, (before, after)) in pairs.iter().enumerate() {
        for params in [chain, multigrid()] {
            let b = vec![1.0; m * m];
            let fresh = iterations(after, &b, &params);
            let mut prepared = Prepared::new(before, &params).unwrap();
            prepared.refresh(after).unwrap();
            let (_, info) = prepared.solve(&b).unwrap();
            assert_eq!((info.iterations, info.name), (fresh.iterations, fresh.name), "{k}");
        }
    }
    // By small steps to the same end.
    let mut prepared = Prepared::new(&pairs[1].0, &chain).unwrap();
    (1..=20).for_each(|k| {
        let ratio = 100.0_f64.powf(f64::from(k) / 20.0);
        prepared.refresh(&anisotropic(m, |_, _| [1.0, ratio])).unwrap();
    });
    let (_, info) = prepared.solve(&vec![1.0; m * m]).unwrap();
    assert!(info.iterations <= 14 && info.name.ends_with("multigrid"), "{} {}", info.name, info.iterations);
}
