//! The former particle difference method: jumps of the slope as unknowns.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::particle_difference::{ParticleDifferenceExtended, ParticleDifferenceParams, Wedge};
use meshless_interfaces::{Condition, Field, InterfaceLaw, Method, solve};

use crate::support::{Setup, dot, max_difference, unit};

/// Two linear functions that meet at a plane, with a jump of the value and of the flux.
fn kinked<const D: usize>(eta: [f64; 2], wedge: Wedge, decaying: bool, seed: u64) -> [f64; 2] {
    let mut normal: [f64; D] = std::array::from_fn(|k| 1.0 - 0.4 * k as f64);
    let length = dot(&normal, &normal).sqrt();
    normal = normal.map(|n| n / length);
    let slope: [f64; D] = std::array::from_fn(|k| 0.7 - 0.5 * k as f64);
    let (kink, value) = (1.3, 0.2);
    let distance = move |x: &[f64; D]| (0..D).map(|k| (x[k] - 0.47) * normal[k]).sum::<f64>();
    let u = move |x: &[f64; D]| {
        let beyond = distance(x) > 0.0;
        dot(&slope, x) + if beyond { value + kink * distance(x) } else { 0.0 }
    };
    let flux = eta[1] * (dot(&slope, &normal) + kink) - eta[0] * dot(&slope, &normal);
    let mut setup = Setup::<D>::generated(unit(), Layout::Irregular, [0.02, 0.07, 0.19][D - 1], seed)
        .regions(vec![Some(Shape::half_space([0.47; D], normal).unwrap()), None], &eta)
        .conditions(move |_, x| Condition::Dirichlet(u(x)));
    let (value, flux) = (Some(Field::Constant(value)), Some(Field::Constant(flux)));
    setup.laws = vec![InterfaceLaw { value, flux, ..InterfaceLaw::new([0, 1]) }];
    let params = ParticleDifferenceParams { wedge, decaying, ..ParticleDifferenceParams::default() };
    let (method, problem) = (ParticleDifferenceExtended { params }, setup.problem());
    let rows = method.discretize(&problem).unwrap();
    let found = solve(&problem, &rows, &Default::default()).unwrap();
    assert_eq!(found.extra.len(), rows.interface_points.len());
    assert!(!found.extra.is_empty() && rows.counts.constrained > 0);
    let jumps = found.extra.iter().map(|j| (j - kink).abs()).fold(0.0, f64::max);
    [max_difference(&found.u, &setup.nodal(|_, x| u(x))), jumps]
}

/// Piecewise linear functions are solved for exactly, and the unknowns are the jumps of their slopes.
#[test]
fn kinks_are_found() {
    for eta in [[1.0, 1.0], [1.0, 30.0], [20.0, 1.0]] {
        for wedge in [Wedge::Plane, Wedge::Varying] {
            for decaying in [false, true] {
                let found = [
                    kinked::<1>(eta, wedge, decaying, 1),
                    kinked::<2>(eta, wedge, decaying, 2),
                    kinked::<3>(eta, wedge, decaying, 3),
                ];
                // Rounding times the condition of the system.
                assert!(found.as_flattened().iter().all(|&d| d < 1e-9), "{eta:?}, {wedge:?}: {found:?}");
            }
        }
    }
}
