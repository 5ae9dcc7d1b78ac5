//! The mass of sharp rows: `M du/dt + A u = 0` lets nothing grow, and steady fields stay.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::sharp::{Sharp, SharpParams};
use meshless_interfaces::{Condition, Mass, Method, RowKind, SystemParams, residual};
use meshless_sparse::DifferenceMatrix;

use crate::growth::{contact, largest_growth};
use crate::support::{Setup, unit};

fn sharp(order: usize) -> Sharp {
    Sharp { params: SharpParams { order, unsteady: true, ..SharpParams::default() } }
}

#[test]
fn nothing_grows() {
    for order in [2, 4, 6] {
        for contrast in [1e-6, 1e-2, 0.3, 10.0, 1e2, 1e6] {
            for (kind, seed) in [("wall", 1), ("disc", 2)] {
                let shape = match kind {
                    "wall" => Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap(),
                    _ => Shape::ball([0.47, 0.52], 0.27).unwrap(),
                };
                let setup = contact::<2>(shape, Layout::Irregular, 0.09, seed, contrast);
                let rows = sharp(order).discretize(&setup.problem()).unwrap();
                let growth = largest_growth(&setup, &rows, 0.09, contrast);
                assert!(growth < 1.5, "order {order}, contrast {contrast:e}, {kind}: {growth}");
            }
        }
    }
}

/// Nodes that almost lie on the contact, or between it and a prescribed value: on the line most clouds have one. All rows have a
/// du/dt.
#[test]
fn nothing_grows_at_a_contact_of_any_contrast() {
    let mut found = Vec::new();
    let mut look = |growth: f64, algebraic: usize, what: String| {
        if growth > 1.5 || algebraic > 0 {
            found.push((what, growth, algebraic));
        }
    };
    for contrast in [1e-10, 1e-6, 1e-2, 1e2, 1e6, 1e10] {
        let wall = Shape::half_space([0.4], [1.0]).unwrap();
        for (layout, order, h) in [
            (Layout::Irregular, 4, 0.1),
            (Layout::Irregular, 6, 0.05),
            (Layout::Jittered, 4, 0.1),
            (Layout::Scattered, 4, 0.05),
            (Layout::Scattered, 6, 0.05),
        ] {
            for seed in 1..=12 {
                let setup = contact::<1>(wall.clone(), layout, h, seed, contrast);
                let rows = sharp(order).discretize(&setup.problem()).unwrap();
                let algebraic = Mass::of(&setup.problem(), &rows).unwrap().algebraic().count();
                let what = format!("1-D, order {order}, {contrast:e}, {layout:?}, spacing {h}, seed {seed}");
                look(largest_growth(&setup, &rows, h, contrast), algebraic, what);
            }
        }
    }
    let wall = Shape::half_space([0.4, 0.5], [1.0, 0.0]).unwrap();
    let disc = Shape::ball([0.47, 0.52], 0.27).unwrap();
    for contrast in [1e-10, 1e-6, 1e-2, 1e2, 1e6, 1e10] {
        for layout in [Layout::Irregular, Layout::Jittered, Layout::Scattered] {
            for (kind, shape, seed) in [("wall", &wall, 1), ("wall", &wall, 6), ("disc", &disc, 1)] {
                let setup = contact::<2>(shape.clone(), layout, 0.11, seed, contrast);
                let rows = sharp(4).discretize(&setup.problem()).unwrap();
                let algebraic = Mass::of(&setup.problem(), &rows).unwrap().algebraic().count();
                let what = format!("2-D, {kind}, order 4, {contrast:e}, {layout:?}, seed {seed}");
                look(largest_growth(&setup, &rows, 0.11, contrast), algebraic, what);
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
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
        let mut rows = sharp(4).discretize(&problem).unwrap();
        // Every ninth row, though all have one.
        let full = rows.mass.take().unwrap();
        let kept = DifferenceMatrix::from_rows(full.n(), |i, out| {
            if i % 9 > 0 {
                let (columns, values) = full.row(i);
                columns.iter().zip(values).for_each(|(&j, &m)| out.push(j as usize, m));
                out.add_to_row_sum(full.row_sum(i));
            }
        });
        rows.mass = Some(kept.unwrap());
        let mass = Mass::of(&setup.problem(), &rows).unwrap();
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
