//! The dipole in a head of four layers, against the closed solution for concentric layers.

use meshless::scene::MethodName;
use meshless_tests::head::{correction, head};
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

/// Three nodes across each of the thin layers; coarser in the brain.
const SPACING: &str = "0.25 + 0.2*abs(sqrt(x^2 + y^2 + z^2) - 7.7)";

#[test]
fn potentials_at_the_electrodes_are_those_of_the_closed_solution() {
    let probes = solve_with(&head(SPACING, &AT), MethodName::Auto).expect("a solution").report.probes;
    // The scene fixes no constant, so both are compared without their mean.
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let exact: Vec<f64> = AT.iter().map(correction).collect();
    let found: Vec<f64> = probes.iter().map(|p| p.value.expect("a value at every point")).collect();
    let (shift, center) = (mean(&found) - mean(&exact), mean(&exact));
    let (error, size) = found.iter().zip(&exact).fold((0.0, 0.0), |(error, size), (u, v)| {
        (error + (u - v - shift).powi(2), size + (v - center).powi(2))
    });
    let relative = (error / size).sqrt();
    // The method is of first order: 0.21 at a spacing of 0.3 in the layers, 0.16 at 0.2, over the electrodes alone.
    assert!(relative < 0.2, "{relative}");
}
