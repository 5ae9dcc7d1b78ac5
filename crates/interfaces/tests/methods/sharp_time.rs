//! The mass of sharp rows: `M du/dt + A u = 0` lets nothing grow, and steady fields stay.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::sharp::{Sharp, SharpParams};
use meshless_interfaces::{
    Condition, Discretization, Mass, Method, PreparedSystem, RowKind, SystemParams, residual,
};

use crate::support::{Setup, unit};

fn sharp(order: usize) -> Sharp {
    Sharp { params: SharpParams { order, unsteady: true, ..SharpParams::default() } }
}

/// Growth in the root mean square by the last of many implicit steps of one size.
fn growth(setup: &Setup<2>, rows: &Discretization, c: f64) -> f64 {
    let mass = Mass::of(rows).unwrap();
    let (shifted, constants) = mass.shifted(rows, c).unwrap();
    let known: Vec<bool> = rows.kinds.iter().map(|&k| k == RowKind::Dirichlet).collect();
    let params = SystemParams { split_floating: false, ..SystemParams::default() };
    let system = match &constants {
        Some(constants) => PreparedSystem::with_constants(shifted, constants, &known, &params),
        None => PreparedSystem::new(&setup.problem(), shifted, &known, &params),
    }
    .unwrap();
    let size = |u: &[f64]| u.iter().map(|u| u * u).sum::<f64>().sqrt();
    let mut u: Vec<f64> =
        (0..known.len()).map(|i| if known[i] { 0.0 } else { (i as f64 * 0.618).fract() - 0.5 }).collect();
    let mut last = 0.0;
    for _ in 0..20 {
        let before = size(&u);
        u.iter_mut().for_each(|u| *u /= before);
        let rhs: Vec<f64> = mass.times(&u).iter().map(|m| m / c).collect();
        u = system.solve(&rhs).unwrap().0;
        last = size(&u);
    }
    last
}

/// A mode that grows with a rate r is doubled at least by implicit steps between `0.5 / r` and `1.5 / r`; no rate is missed by
/// steps of which each is three times as long as the one before.
#[test]
fn nothing_grows() {
    for order in [2, 4, 6] {
        for contrast in [1e-6, 1e-2, 0.3, 10.0, 1e2, 1e6] {
            for (kind, seed) in [("wall", 1), ("disc", 2)] {
                let shape = match kind {
                    "wall" => Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap(),
                    _ => Shape::ball([0.47, 0.52], 0.27).unwrap(),
                };
                let h = 0.09;
                let setup = Setup::<2>::generated(unit(), Layout::Irregular, h, seed)
                    .regions(vec![Some(shape), None], &[1.0, contrast])
                    .conditions(|_, x| match x[0] > 1e-9 && x[0] < 1.0 - 1e-9 {
                        true => Condition::Neumann(0.0),
                        false => Condition::Dirichlet(0.0),
                    });
                let rows = sharp(order).discretize(&setup.problem()).unwrap();
                let least = 0.02 * h * h / contrast.max(1.0);
                for k in 0..24 {
                    let c = least * 3_f64.powi(k);
                    let growth = growth(&setup, &rows, c);
                    let what = format!("order {order}, contrast {contrast:e}, {kind}, steps of {c:e}");
                    assert!(growth < 1.5, "{what}: {growth}");
                }
            }
        }
    }
}

/// Fields that are linear on both sides of a contact solve the rows in time as they do the steady ones.
#[test]
fn steady_fields_stay() {
    for contrast in [1e-6, 0.1, 10.0, 1e6] {
        let value = move |side: u16, x: &[f64; 2]| {
            let slope = if side == 0 { 1.0 } else { 1.0 / contrast };
            2.0 + slope * (x[0] - 0.4) + 0.3 * x[1]
        };
        let setup = Setup::<2>::generated(unit(), Layout::Irregular, 0.08, 3)
            .regions(vec![Some(Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap()), None], &[1.0, contrast])
            .conditions(move |_, x| Condition::Dirichlet(value(u16::from(x[0] > 0.4), x)));
        let rows = sharp(4).discretize(&setup.problem()).unwrap();
        let u = setup.nodal(value);
        let left = residual(&rows, &u).unwrap();
        let size = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (i, r) in left.iter().enumerate() {
            let row: f64 = rows.rows.row(i).1.iter().map(|a| a.abs()).sum();
            assert!(
                rows.kinds[i] == RowKind::Dirichlet || r.abs() < 1e-10 * row * size,
                "{contrast:e}: {r:e}"
            );
        }
    }
}

/// Rows without du/dt hold after the values of their nodes have been solved for; no other value changes.
#[test]
fn initial_values_are_made_consistent() {
    let mut all = 0;
    for (contrast, shape) in [
        (1e6, Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap()),
        (1e-6, Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap()),
        (1e-6, Shape::ball([0.47, 0.52], 0.27).unwrap()),
    ] {
        let setup = Setup::<2>::generated(unit(), Layout::Irregular, 0.09, 1)
            .regions(vec![Some(shape), None], &[1.0, contrast])
            .conditions(|_, x| Condition::Dirichlet(x[0]));
        let problem = setup.problem();
        let rows = sharp(4).discretize(&problem).unwrap();
        let mass = Mass::of(&rows).unwrap();
        let given = |i: usize, x: &[f64; 2]| match rows.kinds[i] {
            RowKind::Dirichlet => x[0],
            _ => (i as f64 * 0.618).fract(),
        };
        let u: Vec<f64> = setup.cloud.points().iter().enumerate().map(|(i, x)| given(i, x)).collect();
        let found = mass.consistent(&problem, &rows, &u, &SystemParams::default().solver).unwrap();
        let left = residual(&rows, &found).unwrap();
        let algebraic: Vec<usize> = mass.algebraic().collect();
        all += algebraic.len();
        for i in 0..u.len() {
            if algebraic.contains(&i) {
                let row: f64 = rows.rows.row(i).1.iter().map(|a| a.abs()).sum();
                assert!(left[i].abs() < 1e-9 * row, "{contrast:e}: {:e}", left[i]);
            } else {
                assert!((found[i] - u[i]).abs() < 1e-9, "{contrast:e}: {} and {}", found[i], u[i]);
            }
        }
    }
    assert!(all > 0, "no row is without du/dt");
}
