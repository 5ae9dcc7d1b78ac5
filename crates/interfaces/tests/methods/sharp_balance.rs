//! Balances over cells by region: what they conserve, and what they make of problems that are given by their data alone.

use std::f64::consts::{PI, TAU};

use meshless_geometry::{Domain, Layout, Shape};
use meshless_interfaces::sharp::{Conservation, Sharp, SharpParams};
use meshless_interfaces::{Condition, Field, Method, RowKind, solve};

use crate::support::Setup;

fn sharp(order: usize, conservation: Conservation) -> Sharp {
    Sharp { params: SharpParams { order, conservation, ..SharpParams::default() } }
}

#[test]
fn an_insulated_body_keeps_its_heat_to_round_off() {
    let domain = Domain::boxed([-1.0; 2], [1.0; 2]).unwrap();
    let disc = Shape::ball([0.1, 0.0], 0.5).unwrap();
    let setup = Setup::generated(domain, Layout::Irregular, 0.1, 1)
        .regions(vec![Some(disc), None], &[3.0, 1.0])
        .sources(vec![Field::Constant(2.0), Field::from_fn(|x: &[f64; 2]| x[0] * x[0])])
        .conditions(|_, x| Condition::Flux(x[1]));
    let problem = setup.problem();
    for order in [4, 6] {
        let made = sharp(order, Conservation::All).discretize(&problem).unwrap();
        assert!(made.kinds.iter().all(|&kind| kind == RowKind::Conservative));
        // The sum of all rows: whatever leaves a cell enters another.
        let n = made.kinds.len();
        let (mut columns, mut largest) = (vec![0.0; n], 0.0_f64);
        for i in 0..n {
            let (neighbors, values) = made.rows.row(i);
            neighbors.iter().zip(values).for_each(|(&j, a)| columns[j as usize] += a);
            columns[i] += made.rows.diagonal(i);
            largest = largest.max(made.rows.diagonal(i).abs());
        }
        let worst = columns.iter().fold(0.0_f64, |w, c| w.max(c.abs()));
        assert!(worst < 1e-12 * largest, "{worst}");
        // int f over both regions; the given fluxes cancel.
        let [inside, quartic] = [PI * 0.25, PI * 0.25 * (0.01 + 0.0625)];
        let expected = 2.0 * inside + 4.0 / 3.0 - quartic;
        let total: f64 = made.rhs.iter().sum();
        assert!((total - expected).abs() < 1e-9, "{total} {expected}");
    }
}

/// A square with a source in a plate that is held at 0: what leaves is what is made, 3.6.
fn flux_of_heated_square(eta: f64, conservation: Conservation) -> f64 {
    let domain = Domain::boxed([-1.0; 2], [1.0; 2]).unwrap();
    let square = Shape::cuboid([-0.3; 2], [0.3; 2]).unwrap();
    let setup = Setup::generated(domain, Layout::Irregular, 0.05, 1)
        .regions(vec![Some(square), None], &[eta, 1.0])
        .sources(vec![Field::Constant(10.0), Field::Constant(0.0)])
        .conditions(|_, _| Condition::Dirichlet(0.0));
    let problem = setup.problem();
    let sharp = sharp(4, conservation);
    let solution = solve(&problem, &sharp.discretize(&problem).unwrap(), &Default::default()).unwrap();
    // Round a circle the rule of trapezoids converges as fast as any.
    let (count, radius) = (200, 0.75);
    let around = |k: i32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
        [radius * cos, radius * sin]
    };
    let points: Vec<[f64; 2]> = (0..count).map(around).collect();
    let samples = sharp.samples(&problem, &solution, &points).unwrap().unwrap();
    let outward = samples.iter().zip(&points).map(|(sample, x)| {
        let gradient = sample.as_ref().unwrap().gradient;
        -(gradient[0] * x[0] + gradient[1] * x[1]) / radius
    });
    outward.sum::<f64>() * TAU * radius / f64::from(count)
}

#[test]
fn what_a_heated_square_makes_leaves_it() {
    for eta in [1e-4, 10.0, 1e4] {
        let flux = flux_of_heated_square(eta, Conservation::Crossing);
        assert!((flux - 3.6).abs() < 3.6e-3, "{eta}: {flux}");
    }
}
