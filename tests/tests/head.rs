//! The dipole in a head of four layers, against the closed solution for concentric layers.

use meshless::scene::MethodName;
use meshless_tests::head::{head, potential};
use meshless_tests::solve::solve_with;

/// Electrodes on the scalp.
const AT: [[f64; 3]; 9] = [
    [0.0, 0.0, 9.0],
    [7.2, -5.4, 0.0],
    [-5.4, 0.0, 7.2],
    [0.0, -9.0, 0.0],
    [0.0, 0.0, -9.0],
    [5.4, 0.0, 7.2],
    [0.0, -5.4, 7.2],
    [-7.2, -5.4, 0.0],
    [4.32, -5.76, 5.4],
];

/// Two nodes across each of the thin layers; coarser in the brain.
const SPACING: &str = "0.4 + 0.2*abs(sqrt(x^2 + y^2 + z^2) - 7.7)";

#[test]
fn potentials_at_the_electrodes_are_those_of_the_closed_solution() {
    let report = solve_with(&head(SPACING, &AT), MethodName::ImmersedInterface).expect("a solution").report;
    // The scene fixes no constant, so both are compared without their mean.
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let exact: Vec<f64> = AT.iter().map(potential).collect();
    let found: Vec<f64> =
        report.probes.iter().map(|p| p.value.expect("a value at every electrode")).collect();
    let (shift, center) = (mean(&found) - mean(&exact), mean(&exact));
    let (error, size) = found.iter().zip(&exact).fold((0.0, 0.0), |(error, size), (u, v)| {
        (error + (u - v - shift).powi(2), size + (v - center).powi(2))
    });
    let relative = (error / size).sqrt();
    // As many nodes across the layers as an operator of second order can do with; docs/dcpse.md has finer clouds.
    assert!(relative < 0.1, "{relative}");
}
