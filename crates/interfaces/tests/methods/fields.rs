//! Values and gradients of nodal fields.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::gfdm::{Gfdm, GfdmParams};
use meshless_interfaces::{Method, Sampler};
use proptest::prelude::*;

use crate::support::{Setup, unit};

/// A quadratic of its own in each region, so far apart that any mixture shows.
fn quadratic<const D: usize>(label: u16, x: &[f64; D]) -> (f64, [f64; D]) {
    let sign = if label == 0 { 1.0 } else { -1.0 };
    let squares: f64 = (0..D).map(|k| (1.0 + k as f64) * x[k] * x[k]).sum();
    let value = 1e4 * sign + sign * squares + x[0] * x[D - 1];
    let mut gradient: [f64; D] = std::array::from_fn(|k| 2.0 * sign * (1.0 + k as f64) * x[k]);
    gradient[0] += x[D - 1];
    gradient[D - 1] += x[0];
    (value, gradient)
}

fn two_regions<const D: usize>(spacing: f64, seed: u64) -> Setup<D> {
    let ball = Shape::ball([0.45; D], 0.3).unwrap();
    Setup::generated(unit(), Layout::Irregular, spacing, seed).regions(vec![Some(ball), None], &[1e3, 1.0])
}

fn check_gradients<const D: usize>(setup: &Setup<D>) {
    let u = setup.nodal(|label, x| quadratic(label, x).0);
    let method = Gfdm { params: GfdmParams::hybrid() };
    let gradients = Method::gradient(&method, &setup.problem(), &u).unwrap();
    for (i, gradient) in gradients.iter().enumerate() {
        let exact = quadratic(setup.labels[i], &setup.cloud.points()[i]).1;
        for k in 0..D {
            assert!((gradient[k] - exact[k]).abs() < 1e-7, "node {i}: {gradient:?} instead of {exact:?}");
        }
    }
}

fn check_samples<const D: usize>(setup: &Setup<D>, positions: &[[f64; 3]]) {
    let u = setup.nodal(|label, x| quadratic(label, x).0);
    let problem = setup.problem();
    let sampler = Sampler::new(&problem, &u).unwrap();
    let mut scratch = sampler.scratch();
    for position in positions {
        let x: [f64; D] = std::array::from_fn(|k| position[k]);
        let sample = sampler.at(&x, &mut scratch).unwrap();
        let inside = (0..D).map(|k| (x[k] - 0.45).powi(2)).sum::<f64>() <= 0.09;
        assert_eq!(sample.region, u16::from(!inside), "{x:?}");
        let exact = quadratic(sample.region, &x);
        assert!((sample.value - exact.0).abs() < 1e-6, "{x:?}: {} instead of {}", sample.value, exact.0);
        for k in 0..D {
            assert!((sample.gradient[k] - exact.1[k]).abs() < 1e-5, "{x:?}: {:?}", sample.gradient);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn gradients_of_quadratics_are_exact_in_each_region(seed in 0..1000_u64) {
        check_gradients(&two_regions::<1>(0.04, seed));
        check_gradients(&two_regions::<2>(0.06, seed));
        check_gradients(&two_regions::<3>(0.14, seed));
    }

    #[test]
    fn samples_of_quadratics_are_exact_in_each_region(
        seed in 0..1000_u64,
        positions in proptest::collection::vec(proptest::array::uniform3(0.0..1.0), 40),
    ) {
        check_samples(&two_regions::<1>(0.04, seed), &positions);
        check_samples(&two_regions::<2>(0.06, seed), &positions);
        check_samples(&two_regions::<3>(0.14, seed), &positions);
    }
}
