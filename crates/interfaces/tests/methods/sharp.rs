//! Values between the nodes from the fits of the sharp method.

use meshless_geometry::{Domain, Layout, Shape};
use meshless_interfaces::sharp::{Sharp, SharpParams};
use meshless_interfaces::{Condition, Field, Method, Sample, Sampler, solve};

use crate::support::Setup;

const RADIUS: f64 = 0.5;

/// A disc of diffusivity `inside` in a field of mode 2, and a source on both sides so that there is a particular part: value
/// and gradient by the distance from the center.
fn exact(inside: f64, disc: bool, [x, y]: &[f64; 2]) -> (f64, [f64; 2]) {
    let b = (1.0 - inside) / (1.0 + inside);
    let (mode, slope, square) = (x * x - y * y, [2.0 * x, -2.0 * y], x * x + y * y);
    // -cos(3 x) / 9 has the Laplacian cos(3 x).
    let wave = |eta: f64| (-(3.0 * x).cos() / 9.0 / eta.max(1.0), (3.0 * x).sin() / 3.0 / eta.max(1.0));
    if disc {
        let (value, derivative) = wave(inside);
        return ((1.0 + b) * mode + value, [(1.0 + b) * slope[0] + derivative, (1.0 + b) * slope[1]]);
    }
    let (value, derivative) = wave(1.0);
    let beyond = b * RADIUS.powi(4) / (square * square);
    let factor = -4.0 * beyond * mode / square;
    let gradient = [0, 1].map(|k| slope[k] * (1.0 + beyond) + factor * [*x, *y][k]);
    (mode * (1.0 + beyond) + value, [gradient[0] + derivative, gradient[1]])
}

fn setup(inside: f64) -> Setup<2> {
    let domain = Domain::boxed([-1.0; 2], [1.0; 2]).unwrap();
    let disc = Shape::ball([0.0; 2], RADIUS).unwrap();
    let mut setup = Setup::generated(domain, Layout::Irregular, 0.05, 1)
        .regions(vec![Some(disc), None], &[inside, 1.0])
        .sources(
            [inside.min(1.0), 1.0]
                .map(|f| Field::from_fn(move |x: &[f64; 2]| -f * (3.0 * x[0]).cos()))
                .to_vec(),
        )
        .conditions(move |_, x| Condition::Dirichlet(exact(inside, false, x).0));
    // The waves differ by a factor on both sides: u jumps, or its flux does.
    let jump = Field::from_fn(move |x: &[f64; 2]| {
        let wave = -(3.0 * x[0]).cos() / 9.0;
        wave - wave / inside.max(1.0)
    });
    let flux = Field::from_fn(move |x: &[f64; 2]| {
        (1.0 - inside.min(1.0)) * (3.0 * x[0]).sin() / 3.0 * x[0] / RADIUS
    });
    setup.laws.push(meshless_interfaces::InterfaceLaw {
        value: Some(jump),
        flux: Some(flux),
        ..meshless_interfaces::InterfaceLaw::new([0, 1])
    });
    setup
}

fn compare(inside: f64, samples: &[Option<Sample<2>>], points: &[[f64; 2]]) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for (sample, x) in samples.iter().zip(points) {
        let sample = sample.unwrap();
        assert_eq!(sample.region, u16::from(x[0].hypot(x[1]) > RADIUS));
        let (value, gradient) = exact(inside, sample.region == 0, x);
        worst[0] = worst[0].max((sample.value - value).abs());
        worst[1] = worst[1].max((sample.gradient[0] - gradient[0]).hypot(sample.gradient[1] - gradient[1]));
    }
    worst
}

#[test]
fn many_points_by_the_fits_of_the_nodes_are_as_accurate_as_few_by_their_own() {
    for inside in [1e-6, 3.0, 1e6] {
        let setup = setup(inside);
        let problem = setup.problem();
        let sharp = Sharp { params: SharpParams { order: 6, ..SharpParams::default() } };
        let solution = solve(&problem, &sharp.discretize(&problem).unwrap(), &Default::default()).unwrap();
        // Also close to the interface, on both sides of it.
        let along = |k: i32| -0.99 + 0.0495 * f64::from(k);
        let mut many: Vec<[f64; 2]> = (0..1600).map(|k| [along(k % 40), along(k / 40)]).collect();
        many.extend((0..100).map(|k| {
            let (sin, cos) = (0.0628 * f64::from(k)).sin_cos();
            let r = if k % 2 == 0 { RADIUS * 0.9999 } else { RADIUS * 1.0001 };
            [r * cos, r * sin]
        }));
        assert!(many.len() > problem.cloud.len());
        let few: Vec<[f64; 2]> = many.iter().copied().step_by(7).collect();
        assert!(few.len() < problem.cloud.len());
        let at = |points: &[[f64; 2]]| sharp.samples(&problem, &solution, points).unwrap().unwrap();
        let (by_nodes, by_points) = (at(&many), at(&few));
        let [value, gradient] = compare(inside, &by_nodes, &many);
        let [own_value, own_gradient] = compare(inside, &by_points, &few);
        assert!(value < 1e-4 && gradient < 1e-2, "{inside:e}: {value:e} {gradient:e}");
        assert!(value < 10.0 * own_value, "{inside:e}: {value:e} {own_value:e}");
        assert!(gradient < 10.0 * own_gradient, "{inside:e}: {gradient:e} {own_gradient:e}");
        // The general sampler knows nodal values only and is of second degree.
        let sampler = Sampler::new(&problem, &solution.u).unwrap();
        let mut scratch = sampler.scratch();
        let general: Vec<Option<Sample<2>>> = many.iter().map(|x| sampler.at(x, &mut scratch)).collect();
        assert!(compare(inside, &general, &many)[0] > 10.0 * value);
    }
}
