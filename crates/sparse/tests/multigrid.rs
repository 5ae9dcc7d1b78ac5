//! Multigrid: few iterations at any size and contrast, the same on any number of threads.

mod common;

use common::{direct, disc, distance, grid, inside, iterations, multigrid, with};
use meshless_sparse::{
    Candidate, ChainLink, Coarsening, Csr, CycleKind, DifferenceMatrix, GroupUnknowns, MultigridParams,
    Prepared, ProlongationKind, Restriction, SmootherKind, SolveError, SolverKind, SolverParams, Split,
    StrengthKind, solve,
};

#[test]
fn iterations_hardly_grow_with_nodes_or_contrast() {
    let mut counts = Vec::new();
    for contrast in [1e-10, 1e-4, 1.0] {
        for m in [30, 60, 120] {
            let grid = disc(m, contrast);
            let info = iterations(&grid.reduced.matrix.to_csr(), &grid.reduced.rhs, &multigrid());
            assert!(info.residual <= 1e-10);
            counts.push(info.iterations);
        }
    }
    assert!(counts.iter().all(|&n| n <= 18), "{counts:?}");
    assert!(counts.chunks(3).all(|c| c[2] <= c[0] + 4), "{counts:?}");
}

#[test]
fn a_stiff_disc_with_its_constant_split_off_is_as_accurate_as_by_the_direct_method() {
    // At moderate contrasts aggregates reach across the interface.
    for contrast in [12.0, 50.0, 200.0, 1e4, 1e10, 1e12, 1e14] {
        let grid = disc(60, contrast);
        let map = &grid.reduced.map;
        let group: Vec<u32> =
            map.iter().map(|&i| u32::from(inside(common::point(grid.m, i as usize)))).collect();
        let pin = (0..map.len())
            .filter(|&k| group[k] == 1)
            .nth(group.iter().filter(|&&g| g == 1).count() / 2)
            .expect("the disc has nodes");
        let stiff =
            GroupUnknowns { scale: 1.0 / contrast, chain: vec![ChainLink { cluster: 0, factor: 1.0 }] };
        let groups = vec![GroupUnknowns { scale: 1.0, chain: Vec::new() }, stiff];
        let split = Split::new(group, groups, vec![pin as u32]).unwrap();
        let values = |params: &SolverParams| {
            let system = split.apply(&grid.reduced.matrix, &grid.reduced.rhs).unwrap();
            let solved = system.solve(params).unwrap();
            assert!(
                params.kind != SolverKind::Multigrid
                    || solved.info.iterations <= if contrast > 1e12 { 24 } else { 15 },
                "{contrast:e}: {:?}",
                solved.info
            );
            split.recover(&solved.values, &solved.extra).unwrap()
        };
        // By elimination, and all equations at once.
        let tight = SolverParams { tolerance: 1e-12, ..multigrid() };
        // Block elimination does not know the scales, see `Bordered::with_scales`.
        let by_elimination = (contrast >= 1e4).then_some(tight);
        for params in
            by_elimination.into_iter().chain([SolverParams { kind: SolverKind::Multigrid, ..tight }])
        {
            let difference = distance(&values(&params), &values(&direct()));
            // The condition of what is left after the split is about the number of nodes.
            assert!(difference < 1e-8, "{contrast:e}: {difference:e}");
        }
    }
}

#[test]
fn extra_unknowns_cost_a_rough_solve_each() {
    // Four discs, each with its constant, in a box that nothing holds: five extra unknowns, one with a dense column.
    let centers = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]];
    let disc_of = |x: [f64; 2]| centers.iter().position(|c| (x[0] - c[0]).hypot(x[1] - c[1]) < 0.15);
    let contrast = 1e8;
    let grid = grid(81, |x| if disc_of(x).is_some() { contrast } else { 1.0 }, 1.0, |_| 0.0);
    let n = grid.matrix.n();
    let group: Vec<u32> =
        (0..n).map(|i| disc_of(common::point(grid.m, i)).map_or(0, |k| k as u32 + 1)).collect();
    let mut groups = vec![GroupUnknowns { scale: 1.0, chain: Vec::new() }];
    let chain = |cluster| vec![ChainLink { cluster, factor: 1.0 }];
    groups.extend((0..4).map(|k| GroupUnknowns { scale: 1.0 / contrast, chain: chain(k) }));
    let pin = |k: u32| {
        let own: Vec<usize> = (0..n).filter(|&i| group[i] == k).collect();
        own[own.len() / 2] as u32
    };
    let split = Split::new(group.clone(), groups, (1..=4).map(pin).collect()).unwrap();
    let rhs: Vec<f64> = (0..n).map(|i| common::point(grid.m, i)[0] - 0.4).collect();
    let free = (0..n).find(|&i| group[i] == 0).expect("nodes between the discs");
    let system = split.apply_neumann(&grid.matrix, &rhs, &vec![1.0; n], free).unwrap();
    let base = MultigridParams { coarsest: 40, ..MultigridParams::default() };
    let factors =
        MultigridParams { smoother: SmootherKind::Ilu0, restriction: Restriction::Own, sweeps: 1, ..base };
    let solve = |kind, levels| {
        let solved = system.solve(&SolverParams { kind, tolerance: 1e-12, ..with(levels) }).unwrap();
        (split.recover(&solved.values, &solved.extra).unwrap(), solved)
    };
    let (exact, reference) = solve(SolverKind::Direct, base);
    for levels in [base, factors] {
        let (u, solved) = solve(SolverKind::Multigrid, levels);
        assert!(distance(&u, &exact) < 1e-8, "{:e}", distance(&u, &exact));
        let lambda = (solved.extra[4] - reference.extra[4]).abs();
        assert!(lambda < 1e-9 * reference.extra[4].abs(), "{lambda:e}");
        // About 16 for the right-hand side, and up to 4 for each response; by elimination 16 for each, too.
        assert!(solved.info.iterations <= 40, "{}", solved.info.iterations);
    }
}

#[test]
fn a_short_time_step_needs_no_levels() {
    let grid = disc(120, 1e-2);
    let steps = DifferenceMatrix::from_rows(grid.matrix.n(), |i, row| {
        let (columns, values) = grid.matrix.row(i);
        columns.iter().zip(values).for_each(|(&j, &v)| row.push(j as usize, v));
        row.add_to_row_sum(100.0);
    });
    let a = steps.unwrap().to_csr();
    let exact: Vec<f64> = (0..a.nrows()).map(|i| common::point(grid.m, i)[1].sin()).collect();
    let mut b = vec![0.0; a.nrows()];
    a.mul_vec(&exact, &mut b);
    let prepared = Prepared::new(&a, &multigrid()).unwrap();
    assert_eq!(prepared.hierarchy().unwrap().levels.len(), 1);
    let (x, info) = prepared.solve(&b).unwrap();
    assert!(info.iterations <= 5, "{}", info.iterations);
    assert!(distance(&x, &exact) < 1e-9);
}

#[test]
fn every_cycle_and_smoother_converges() {
    let grid = disc(50, 1e-4);
    let (a, b) = (grid.reduced.matrix.to_csr(), &grid.reduced.rhs);
    let exact = solve(&a, b, &direct()).unwrap().0;
    for cycle in [CycleKind::V, CycleKind::W, CycleKind::K] {
        for smoother in [SmootherKind::Jacobi, SmootherKind::GaussSeidel, SmootherKind::Ilu0] {
            for sweeps in [1, 2] {
                let levels = MultigridParams { cycle, smoother, sweeps, coarsest: 40, ..Default::default() };
                let (x, info) = solve(&a, b, &with(levels)).unwrap();
                assert!(info.iterations <= 30, "{levels:?}: {}", info.iterations);
                assert!(distance(&x, &exact) < 1e-7, "{levels:?}");
            }
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let grid = disc(110, 1e-6);
    let (a, b) = (grid.reduced.matrix.to_csr(), &grid.reduced.rhs);
    for smoother in [SmootherKind::GaussSeidel, SmootherKind::Ilu0] {
        let levels = MultigridParams { smoother, ..Default::default() };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| solve(&a, b, &with(levels)).unwrap())
        };
        let (one, three) = (on(1), on(3));
        assert_eq!(one.0, three.0);
        assert_eq!(one.1.iterations, three.1.iterations);
    }
}

#[test]
fn scaling_and_numbering_change_at_most_one_iteration() {
    let grid = disc(50, 1e-3);
    let (a, b) = (grid.reduced.matrix.to_csr(), grid.reduced.rhs.clone());
    let reference = iterations(&a, &b, &multigrid()).iterations;
    let all = vec![1e-7; a.nrows()];
    let scaled_b: Vec<f64> = b.iter().map(|b| b * 1e-7).collect();
    let scaled = iterations(&a.row_scaled(&all).unwrap(), &scaled_b, &multigrid()).iterations;
    assert!(scaled.abs_diff(reference) <= 1, "{scaled} {reference}");
    // Columns before rows: aggregates come out otherwise, and Gauss-Seidel runs in another direction.
    let inner = grid.m - 2;
    let order: Vec<u32> = (0..a.nrows()).map(|k| (k % inner * inner + k / inner) as u32).collect();
    let permuted_b: Vec<f64> = order.iter().map(|&i| b[i as usize]).collect();
    let permuted = iterations(&a.permuted(&order).unwrap(), &permuted_b, &multigrid()).iterations;
    assert!(permuted.abs_diff(reference) <= 1, "{permuted} {reference}");
    // By lot: no order for aggregates and sweeps, until one is found.
    let shuffled: Vec<u32> = (0..a.nrows()).map(|k| (k * 1009 % a.nrows()) as u32).collect();
    let shuffled_b: Vec<f64> = shuffled.iter().map(|&i| b[i as usize]).collect();
    let shuffled = iterations(&a.permuted(&shuffled).unwrap(), &shuffled_b, &multigrid()).iterations;
    assert!(shuffled.abs_diff(reference) <= 1, "{shuffled} {reference}");
}

#[test]
fn a_pure_neumann_problem_is_solved_as_far_as_its_data_allow() {
    let grid = disc(40, 1.0);
    let a = grid.matrix.to_csr();
    let b: Vec<f64> = (0..a.nrows()).map(|i| common::point(grid.m, i)[0] - 0.5).collect();
    let (x, info) = solve(&a, &b, &multigrid()).unwrap();
    assert!(info.iterations <= 20, "{}", info.iterations);
    let mut r = vec![0.0; x.len()];
    a.residual(&x, &b, &mut r);
    assert!(r.iter().all(|r| r.abs() < 1e-8));
    // With a constant added, nothing can solve it; what is left is that constant.
    let wrong: Vec<f64> = b.iter().map(|b| b + 1.0).collect();
    let Err(SolveError::NoConvergence { residual, reason, .. }) = solve(&a, &wrong, &multigrid()) else {
        panic!("sources without a sink")
    };
    assert!(reason.contains("add up to nothing"), "{reason}");
    let unit = wrong.iter().map(|b| b * b).sum::<f64>().sqrt();
    assert!((residual * unit / (a.nrows() as f64).sqrt() - 1.0).abs() < 0.1, "{residual}");
}

/// Upwind differences for a flow in circles, with that cell Péclet number at the sides, on a square of `m` by `m` nodes.
fn convection(m: usize, peclet: f64) -> Csr {
    let rows = Csr::from_rows(m * m, m * m, |i, row| {
        let at = |k: usize| 2.0 * k as f64 / m as f64 - 1.0;
        let wind = [(i % m, 1, at(i / m) * peclet), (i / m, m, -at(i % m) * peclet)];
        for (k, stride, speed) in wind {
            if k > 0 {
                row.push(i - stride, -1.0 - speed.max(0.0));
            }
            if k + 1 < m {
                row.push(i + stride, -1.0 + speed.min(0.0));
            }
            row.push(i, 2.0 + speed.abs());
        }
    });
    rows.expect("entries are in range")
}

#[test]
fn convection_by_upwind_differences_gets_levels_that_converge_without_being_asked() {
    let m = 80;
    for peclet in [1.0, 10.0, 1000.0] {
        let a = convection(m, peclet);
        let own = MultigridParams {
            smoother: SmootherKind::Ilu0,
            restriction: Restriction::Own,
            ..MultigridParams::default()
        };
        let chain = SolverParams { kind: SolverKind::Multigrid, tolerance: 1e-10, ..SolverParams::default() };
        for params in [with(own), chain] {
            let (_, info) = solve(&a, &vec![1.0; m * m], &params).unwrap();
            assert!(info.iterations <= 15, "{peclet}: {}", info.iterations);
            assert!(info.name.ends_with("multigrid"), "{peclet}: {}", info.name);
        }
    }
    // Asked for by name, the default levels are what they are.
    let named = SolverParams { kind: SolverKind::Multigrid, ..with(MultigridParams::default()) };
    let (_, info) = solve(&convection(m, 1000.0), &vec![1.0; m * m], &named).unwrap();
    assert!(info.name.contains("BiCGStab"), "{}", info.name);
}

#[test]
fn short_recurrences_refuse_what_changes_from_step_to_step() {
    let grid = disc(30, 1.0);
    let a = grid.reduced.matrix.to_csr();
    let levels = MultigridParams { cycle: CycleKind::K, coarsest: 40, ..Default::default() };
    let params = SolverParams { kind: SolverKind::BiCgStab { l: 2 }, ..with(levels) };
    let error = Prepared::new(&a, &params).expect_err("not linear");
    assert!(error.to_string().contains("GMRES"), "{error}");
    let bad = with(MultigridParams { threshold: 1.5, ..Default::default() });
    assert!(matches!(Prepared::new(&a, &bad), Err(SolveError::BadParameter { .. })));
}

#[test]
fn what_multigrid_does_not_get_along_with_is_solved_by_what_steps_in() {
    // A rotation in every pair of unknowns: no row has a neighbour with the right sign, so there are no levels.
    let n = 2000;
    let matrix = DifferenceMatrix::from_rows(n, |i, row| {
        let (partner, sign) = if i % 2 == 0 { (i + 1, 1.0) } else { (i - 1, -1.0) };
        row.push(partner, 3.0 * sign);
        row.push((i + 2) % n, 0.3);
        row.add_to_row_sum(0.5 + 3.0 * sign);
    })
    .unwrap();
    let a = matrix.to_csr();
    let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
    let mut b = vec![0.0; n];
    a.mul_vec(&exact, &mut b);
    let params = SolverParams { kind: SolverKind::Multigrid, tolerance: 1e-11, ..SolverParams::default() };
    let (x, info) = solve(&a, &b, &params).unwrap();
    assert!(distance(&x, &exact) < 1e-8, "{}", info.name);
}

#[test]
fn every_kind_of_coarsening_converges() {
    let grid = disc(60, 1e-4);
    let (a, b) = (grid.reduced.matrix.to_csr(), &grid.reduced.rhs);
    let exact = solve(&a, b, &direct()).unwrap().0;
    let base = MultigridParams { coarsest: 40, ..Default::default() };
    let others = [
        MultigridParams { coarsening: Coarsening::PairwiseAggregation, cycle: CycleKind::K, ..base },
        MultigridParams { coarsening: Coarsening::RugeStuebenDirect, ..base },
        MultigridParams { coarsening: Coarsening::RugeStuebenExtended, ..base },
        MultigridParams { strength: StrengthKind::Evolution, ..base },
        MultigridParams { restriction: Restriction::Own, ..base },
        MultigridParams { prolongation: ProlongationKind::EnergyMinimizing, ..base },
        MultigridParams {
            prolongation: ProlongationKind::EnergyMinimizing,
            restriction: Restriction::Own,
            ..base
        },
        MultigridParams { candidate: Candidate::Constant, ..base },
        MultigridParams { smoother: SmootherKind::ColoredGaussSeidel, ..base },
        MultigridParams { smoother: SmootherKind::Chebyshev, ..base },
    ];
    for levels in others {
        let prepared = Prepared::new(&a, &with(levels)).unwrap();
        let (x, info) = prepared.solve(b).unwrap();
        assert!(info.iterations <= 25, "{levels:?}: {}", info.iterations);
        assert!(distance(&x, &exact) < 1e-7, "{levels:?}");
        let info = prepared.hierarchy().unwrap();
        assert!(info.levels.len() > 1 && info.operator_complexity() < 3.0, "{levels:?}: {info:?}");
    }
}
