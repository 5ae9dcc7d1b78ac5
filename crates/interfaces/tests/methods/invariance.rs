//! What the solution may not depend on.

use meshless_geometry::{BoundaryNode, Cloud, Domain, FaceId, Layout, Shape, Touch};
use meshless_interfaces::Condition;
use meshless_interfaces::gfdm::GfdmParams;
use proptest::prelude::*;

use crate::support::{Setup, max_difference, unit};

const CENTER: [f64; 2] = [0.4, 0.55];
const RADIUS: f64 = 0.25;

fn methods() -> [GfdmParams; 3] {
    [GfdmParams::classical(), GfdmParams::hybrid(), GfdmParams::conservative()]
}

/// Conditions of all kinds, by face of the unit box and position in it.
fn condition(face: FaceId, x: &[f64; 2], length: f64) -> Condition {
    match face.0 {
        0 => Condition::Dirichlet(1.0 + x[1] * x[1]),
        1 => Condition::Robin { a: 0.5 / length, b: 1.0, g: 0.2 / length },
        2 => Condition::Flux(0.3 * x[0] / length),
        _ => Condition::Neumann(-0.4 / length),
    }
}

fn original(seed: u64, eta: f64) -> Setup<2> {
    let disc = Shape::ball(CENTER, RADIUS).unwrap();
    Setup::generated(unit(), Layout::Irregular, 0.1, seed)
        .regions(vec![Some(disc), None], &[eta, 1.0])
        .source(|label, x| f64::from(label) + x[0])
        .conditions(|face, x| condition(face, x, 1.0))
}

/// The same problem turned by a right angle (which takes x to y and y to -x), scaled, then moved.
fn moved(setup: &Setup<2>, turned: bool, scale: f64, shift: [f64; 2], eta: f64) -> Setup<2> {
    let turn = move |v: &[f64; 2]| if turned { [-v[1], v[0]] } else { *v };
    let to = move |x: &[f64; 2]| {
        let t = turn(x);
        [scale * t[0] + shift[0], scale * t[1] + shift[1]]
    };
    let back = move |y: &[f64; 2]| {
        let t = [(y[0] - shift[0]) / scale, (y[1] - shift[1]) / scale];
        if turned { [t[1], -t[0]] } else { t }
    };
    let new_face = move |face: FaceId| if turned { FaceId([2, 3, 1, 0][face.0 as usize]) } else { face };
    let old_face = move |face: FaceId| if turned { FaceId([3, 2, 0, 1][face.0 as usize]) } else { face };
    let (a, b) = (to(&[0.0, 0.0]), to(&[1.0, 1.0]));
    let domain =
        Domain::boxed(std::array::from_fn(|k| a[k].min(b[k])), std::array::from_fn(|k| a[k].max(b[k])))
            .unwrap();
    let touch = |t: &Touch<2>| Touch { face: new_face(t.face), normal: turn(&t.normal) };
    let boundary = (setup.cloud.boundary().iter())
        .map(|b| BoundaryNode { node: b.node, touches: b.touches.iter().map(touch).collect() })
        .collect();
    let spacing = setup.cloud.spacing().iter().map(|s| s * scale).collect();
    let cloud = Cloud::from_parts(setup.cloud.points().iter().map(to).collect(), boundary, spacing).unwrap();
    let disc = Shape::ball(to(&CENTER), scale * RADIUS).unwrap();
    Setup::new(domain, cloud)
        .regions(vec![Some(disc), None], &[eta, 1.0])
        .source(move |label, y| (f64::from(label) + back(y)[0]) / (scale * scale))
        .conditions(move |face, y| condition(old_face(face), &back(y), scale))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// With `u` the same, sources go with the inverse square of the length, fluxes with its inverse.
    #[test]
    fn motions_and_scaling_do_not_change_the_solution(
        seed in 0..1000_u64, turned in any::<bool>(), scale in 0.01..100.0, shift in proptest::array::uniform2(-3.0..3.0),
        exponent in -6.0..6.0,
    ) {
        let eta = 10_f64.powf(exponent);
        let setup = original(seed, eta);
        let other = moved(&setup, turned, scale, shift.map(|s| s * scale), eta);
        prop_assert_eq!(&setup.labels, &other.labels);
        for params in methods() {
            let (u, v) = (setup.solve(params), other.solve(params));
            let size = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            let difference = max_difference(&u, &v);
            prop_assert!(difference < 1e-9 * size, "{difference:e} of {size:e}");
        }
    }

    #[test]
    fn the_numbering_of_nodes_does_not_matter(seed in 0..1000_u64, step in 1..500_usize, exponent in -6.0..6.0) {
        let eta = 10_f64.powf(exponent);
        let setup = original(seed, eta);
        let n = setup.cloud.len();
        let gcd = |mut a: usize, mut b: usize| { while b > 0 { (a, b) = (b, a % b); } a };
        let step = (step..).find(|&s| gcd(s, n) == 1).unwrap();
        let order: Vec<u32> = (0..n).map(|k| ((k * step + 7) % n) as u32).collect();
        let disc = Shape::ball(CENTER, RADIUS).unwrap();
        let other = Setup::new(unit(), setup.cloud.permuted(&order).unwrap())
            .regions(vec![Some(disc), None], &[eta, 1.0])
            .source(|label, x| f64::from(label) + x[0])
            .conditions(|face, x| condition(face, x, 1.0));
        for params in methods() {
            let (u, v) = (setup.solve(params), other.solve(params));
            let expected: Vec<f64> = order.iter().map(|&old| u[old as usize]).collect();
            let size = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            prop_assert!(max_difference(&expected, &v) < 1e-9 * size);
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let setup = original(1, 1e6);
    for params in methods() {
        let [one, two] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| (setup.discretize(params), setup.solve(params)))
        });
        assert_eq!(one.0.rows, two.0.rows);
        assert_eq!((&one.0.rhs, &one.0.kinds, &one.0.volumes), (&two.0.rhs, &two.0.kinds, &two.0.volumes));
        assert_eq!(one.1, two.1);
    }
}
