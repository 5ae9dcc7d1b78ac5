//! The dipole in a head of four layers, against the closed solution for concentric layers.

use meshless::scene::MethodName;
use meshless_tests::head::{correction, head};
use meshless_tests::order::observed;
use meshless_tests::solve::solve_with;

/// Electrodes on the scalp and points in the brain.
const AT: [[f64; 3]; 7] = [
    [0.0, 0.0, 9.0],
    [7.2, -5.4, 0.0],
    [-5.4, 0.0, 7.2],
    [0.0, -9.0, 0.0],
    [0.0, 0.0, -9.0],
    [0.0, -6.0, 0.0],
    [3.6, -4.8, 0.0],
];

/// l2 error over the points relative to the closed solution, both without their mean: the scene fixes no constant.
fn error(spacing: f64) -> f64 {
    let text = head(&format!("{spacing:?}*(1 + 0.3*abs(sqrt(x^2 + y^2 + z^2) - 7.7))"), &AT);
    let probes = solve_with(&text, MethodName::Auto).expect("the scene can be solved").report.probes;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let exact: Vec<f64> = AT.iter().map(correction).collect();
    let found: Vec<f64> = probes.iter().map(|p| p.value.expect("a value at every point")).collect();
    let (shift, center) = (mean(&found) - mean(&exact), mean(&exact));
    let (error, size) = found.iter().zip(&exact).fold((0.0, 0.0), |(error, size), (u, v)| {
        (error + (u - v - shift).powi(2), size + (v - center).powi(2))
    });
    (error / size).sqrt()
}

#[test]
fn potentials_at_the_electrodes_converge_to_the_closed_solution() {
    let ladder = [0.5, 0.4, 0.32, 0.25].map(|h| (h, error(h)));
    println!("{ladder:?} {}", observed(&ladder));
    assert!(observed(&ladder) >= 0.8, "{ladder:?}");
}
