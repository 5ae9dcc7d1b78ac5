//! The flux through a closed surface about an interface is that of the sources inside, to the method's order.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::dcpse::ImmersedInterface;
use meshless_interfaces::sharp::Sharp;
use meshless_interfaces::{Condition, Field, Method, Sampler, solve};

use crate::support::{Setup, dot, unit};

/// Radius of the ball of another diffusivity, and of the surface about it; their center.
const BALL: f64 = 0.27;
const SURFACE: f64 = 0.36;
const CENTER: [f64; 3] = [0.45, 0.52, 0.48];

/// Points of Gauss and Legendre on (-1, 1) and their weights, exact for the degree 11.
const GAUSS: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170_4),
    (-0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (-0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_4),
];

/// Unit normals of a circle or a sphere, and shares of its surface.
fn normals<const D: usize>() -> Vec<([f64; D], f64)> {
    let angles = if D == 2 { 400 } else { 14 };
    let rings: &[(f64, f64)] = if D == 2 { &[(0.0, 2.0)] } else { &GAUSS };
    let at = |&(z, weight): &(f64, f64), k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(angles);
        let wide = (1.0 - z * z).sqrt();
        let n = [wide * angle.cos(), wide * angle.sin(), z];
        (std::array::from_fn(|axis| n[axis]), 0.5 * weight / f64::from(angles))
    };
    rings.iter().flat_map(|ring| (0..angles).map(move |k| at(ring, k))).collect()
}

/// The flux through the surface against the sources inside, relative to these.
fn imbalance<const D: usize>(method: &impl Method<D>, spacing: f64, seed: u64, eta: f64) -> f64 {
    let center: [f64; D] = std::array::from_fn(|k| CENTER[k]);
    let setup = Setup::<D>::generated(unit(), Layout::Scattered, spacing, seed)
        .with_support(2.9)
        .regions(vec![Some(Shape::ball(center, BALL).unwrap()), None], &[eta, 1.0])
        .sources(vec![Field::Constant(3.0), Field::from_fn(|x: &[f64; D]| x[0])])
        .conditions(|_, x| Condition::Dirichlet(1.0 + x[0] * x[1]));
    let problem = setup.problem();
    let solution = solve(&problem, &method.discretize(&problem).unwrap(), &Default::default()).unwrap();
    let normals = normals::<D>();
    let points: Vec<[f64; D]> =
        normals.iter().map(|(n, _)| std::array::from_fn(|k| center[k] + SURFACE * n[k])).collect();
    // Those of the method where it has its own between nodes.
    let slopes: Vec<[f64; D]> = match method.samples(&problem, &solution, &points).unwrap() {
        Some(samples) => samples.into_iter().map(|sample| sample.unwrap().gradient).collect(),
        None => {
            let sampler = Sampler::new(&problem, &solution.u).unwrap();
            let mut scratch = sampler.scratch();
            points.iter().map(|x| sampler.at(x, &mut scratch).unwrap().gradient).collect()
        }
    };
    let (area, volume) = if D == 2 {
        (std::f64::consts::TAU * SURFACE, [BALL, SURFACE].map(|r| std::f64::consts::PI * r * r))
    } else {
        let ball = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
        (4.0 * std::f64::consts::PI * SURFACE.powi(2), [BALL, SURFACE].map(ball))
    };
    let flux: f64 = normals.iter().zip(&slopes).map(|((n, share), slope)| area * share * dot(slope, n)).sum();
    // Constant inside of the ball, x outside: the mean of x over what is between is that of the center.
    let sources = 3.0 * volume[0] + center[0] * (volume[1] - volume[0]);
    ((flux + sources) / sources).abs()
}

/// Checks the order over the spacings from the first to the last, less two deviations: the root mean square of n normal errors has a
/// relative deviation of `1/sqrt(2 n)`.
fn check<const D: usize>(name: &str, method: &impl Method<D>, spacings: &[f64], clouds: u32, order: f64) {
    let halvings = (spacings[0] / spacings[spacings.len() - 1]).log2();
    let deviation = 1.0 / (f64::from(clouds).sqrt() * std::f64::consts::LN_2 * halvings);
    for eta in [1e-2, 50.0] {
        let error = |&h: &f64| {
            let squares = (0..clouds).map(|seed| imbalance(method, h, u64::from(seed), eta).powi(2));
            (squares.sum::<f64>() / f64::from(clouds)).sqrt()
        };
        let errors: Vec<f64> = spacings.iter().map(error).collect();
        let found = (errors[0] / errors[errors.len() - 1]).log2() / halvings;
        assert!(
            found > order - 2.0 * deviation,
            "{name}, {D}-D, {eta}: order {found} ± {deviation}, {errors:?}"
        );
    }
}

#[test]
fn immersed_interfaces_are_of_second_order() {
    check::<2>("ghosts", &ImmersedInterface::default(), &[0.1, 0.05, 0.025], 16, 2.0);
    check::<3>("ghosts", &ImmersedInterface::default(), &[0.16, 0.08], 16, 2.0);
}

/// Order p = 4 in u, and one less in the gradient.
#[test]
fn sharp_is_of_third_order() {
    check::<2>("sharp", &Sharp::default(), &[0.1, 0.05, 0.025], 16, 3.0);
    check::<3>("sharp", &Sharp::default(), &[0.16, 0.08], 8, 3.0);
}
