//! What the constrained approximation reproduces, and what it may not depend on.

use meshless_geometry::{Cloud, Layout, Shape};
use meshless_interfaces::particle_difference::{ParticleDifference, ParticleDifferenceParams};
use meshless_interfaces::{Condition, Discretization, Field, InterfaceLaw, Method, RowKind};
use proptest::prelude::*;

use crate::support::{Setup, dot, max_difference, unit};

/// Rounding in gradients, relative to the largest: fits over one-sided supports have conditions of some hundreds, and
/// the values that they are applied to are some times as large as their differences.
const GRADIENT: f64 = 1e-9;

/// A quadratic function of position: `c + b.x + x.A x`.
#[derive(Debug, Clone, Copy)]
struct Quadratic<const D: usize> {
    c: f64,
    b: [f64; D],
    a: [[f64; D]; D],
}

impl<const D: usize> Quadratic<D> {
    /// From numbers in [-1, 1], of which there are enough.
    fn from(numbers: &[f64]) -> Self {
        let b = std::array::from_fn(|k| numbers[1 + k]);
        Self { c: numbers[0], b, a: std::array::from_fn(|k| std::array::from_fn(|l| numbers[4 + 3 * k + l])) }
    }

    fn at(&self, x: &[f64; D]) -> f64 {
        self.c + dot(&self.b, x) + (0..D).map(|k| x[k] * dot(&self.a[k], x)).sum::<f64>()
    }

    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|k| self.b[k] + (0..D).map(|l| (self.a[k][l] + self.a[l][k]) * x[l]).sum::<f64>())
    }

    fn laplacian(&self) -> f64 {
        (0..D).map(|k| 2.0 * self.a[k][k]).sum()
    }
}

fn normal<const D: usize>(direction: &[f64]) -> [f64; D] {
    let d: [f64; D] = std::array::from_fn(|k| direction[k] + if k == 0 { 1.5 } else { 0.0 });
    d.map(|x| x / dot(&d, &d).sqrt())
}

/// How far the rows are from the exact values, relative to what the values in them are multiplied by; and the gradient, relative to its size.
pub(crate) fn defects<const D: usize>(
    setup: &Setup<D>,
    params: ParticleDifferenceParams,
    u: &[f64],
    gradient: impl Fn(u16, &[f64; D]) -> [f64; D],
) -> [f64; 2] {
    let (method, problem) = (ParticleDifference { params }, setup.problem());
    let rows = method.discretize(&problem).unwrap();
    assert!(rows.counts.constrained > 0);
    let found = method.gradient(&problem, u).unwrap();
    let (mut worst, mut slope, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in 0..u.len() {
        let (columns, values) = rows.rows.row(i);
        let constant = rows.rows.row_sum(i) * u[i];
        let (mut sum, mut total) = (constant, constant.abs());
        for (&j, a) in columns.iter().zip(values) {
            sum += a * (u[j as usize] - u[i]);
            total += a.abs() * (u[j as usize].abs() + u[i].abs());
        }
        if rows.kinds[i] != RowKind::Dirichlet {
            worst = worst.max((sum - rows.rhs[i]).abs() / (total + rows.rhs[i].abs()));
        }
        let exact = gradient(setup.labels[i], &setup.cloud.points()[i]);
        slope = slope.max((0..D).map(|k| (found[i][k] - exact[k]).abs()).fold(0.0, f64::max));
        size = size.max(dot(&exact, &exact).sqrt());
    }
    [worst, slope / size]
}

/// Wedges `q + (1/2) W |d|` with one W: continuous, the flux jumps by what follows from them (Yoon & Song, (26)).
fn wedge_defects<const D: usize>(
    params: ParticleDifferenceParams,
    numbers: &[f64],
    direction: &[f64],
    eta: [f64; 2],
    seed: u64,
    linear: bool,
) -> [f64; 2] {
    let n = normal::<D>(direction);
    let mut q = Quadratic::<D>::from(numbers);
    if linear {
        q.a = [[0.0; D]; D];
    }
    let through = [0.5 + 0.1 * numbers[13]; D];
    let half = 0.5 * (1.0 + numbers[14]);
    let distance = move |x: &[f64; D]| (0..D).map(|k| (x[k] - through[k]) * n[k]).sum::<f64>();
    let side = |label: u16| if label == 0 { -half } else { half };
    let flux = move |x: &[f64; D]| {
        let slope = dot(&q.gradient(x), &n);
        eta[1] * (slope + half) - eta[0] * (slope - half)
    };
    let mut setup = Setup::<D>::generated(unit(), Layout::Irregular, [0.02, 0.07, 0.19][D - 1], seed)
        .regions(vec![Some(Shape::half_space(through, n).unwrap()), None], &eta)
        .sources(eta.map(|eta| Field::Constant(-eta * q.laplacian())).to_vec());
    setup.laws =
        vec![InterfaceLaw { value: None, flux: Some(Field::from_fn(flux)), ..InterfaceLaw::new([0, 1]) }];
    let u = setup.nodal(|label, x| q.at(x) + side(label) * distance(x));
    defects(&setup, params, &u, |label, x| {
        let g = q.gradient(x);
        std::array::from_fn(|k| g[k] + side(label) * n[k])
    })
}

/// Any two quadratic functions: value, flux and second derivative jump.
fn piecewise_defects<const D: usize>(
    params: ParticleDifferenceParams,
    numbers: [&[f64]; 2],
    direction: &[f64],
    eta: [f64; 2],
    seed: u64,
    reversed: bool,
) -> [f64; 2] {
    let n = normal::<D>(direction);
    let q = numbers.map(Quadratic::<D>::from);
    let flux = move |x: &[f64; D]| eta[1] * dot(&q[1].gradient(x), &n) - eta[0] * dot(&q[0].gradient(x), &n);
    let sign = if reversed { -1.0 } else { 1.0 };
    let value = move |x: &[f64; D]| sign * (q[1].at(x) - q[0].at(x));
    let mut setup = Setup::<D>::generated(unit(), Layout::Irregular, [0.02, 0.07, 0.19][D - 1], seed)
        .regions(vec![Some(Shape::half_space([0.47; D], n).unwrap()), None], &eta)
        .sources((0..2).map(|k| Field::Constant(-eta[k] * q[k].laplacian())).collect());
    let between = if reversed { [1, 0] } else { [0, 1] };
    let (value, flux) = (Some(Field::from_fn(value)), Some(Field::from_fn(flux)));
    setup.laws = vec![InterfaceLaw { value, flux, ..InterfaceLaw::new(between) }];
    let u = setup.nodal(|label, x| q[label as usize].at(x));
    defects(&setup, params, &u, |label, x| q[label as usize].gradient(x))
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0, 15)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn linear_and_quadratic_wedges_are_reproduced(
        numbers in numbers(), direction in numbers(), exponents in proptest::array::uniform2(-1.0..1.0),
        seed in 0..1000_u64, linear in any::<bool>(), degree in 2..4_usize,
    ) {
        // Without weights in units of the flux rounding grows with the contrast.
        for (params, range) in [(ParticleDifferenceParams::paper(), 1.0), (ParticleDifferenceParams::default(), 3.0)] {
            let eta = exponents.map(|e| 10_f64.powf(range * e));
            let params = ParticleDifferenceParams { degree, ..params };
            let found = [
                wedge_defects::<1>(params, &numbers, &direction, eta, seed, linear),
                wedge_defects::<2>(ParticleDifferenceParams { degree: 2, ..params }, &numbers, &direction, eta, seed, linear),
                wedge_defects::<3>(ParticleDifferenceParams { degree: 2, ..params }, &numbers, &direction, eta, seed, linear),
            ];
            prop_assert!(found.iter().all(|d| d[0] < 1e-12 && d[1] < GRADIENT), "{params:?}: {found:?}");
        }
    }

    #[test]
    fn all_piecewise_quadratic_functions_are_reproduced(
        inside in numbers(), outside in numbers(), direction in numbers(),
        exponents in proptest::array::uniform2(-3.0..3.0), seed in 0..1000_u64, reversed in any::<bool>(),
    ) {
        let eta = exponents.map(|e| 10_f64.powf(e));
        let (params, numbers) = (ParticleDifferenceParams::default(), [&inside[..], &outside[..]]);
        let found = [
            piecewise_defects::<1>(params, numbers, &direction, eta, seed, reversed),
            piecewise_defects::<2>(params, numbers, &direction, eta, seed, reversed),
            piecewise_defects::<3>(params, numbers, &direction, eta, seed, reversed),
        ];
        // Second differences of the jump of the value lose four digits.
        prop_assert!(found.as_flattened().iter().all(|&d| d < 1e-9), "{found:?}");
    }
}

fn discretize(setup: &Setup<2>, params: ParticleDifferenceParams) -> Discretization {
    ParticleDifference { params }.discretize(&setup.problem()).unwrap()
}

fn disc(setup: Setup<2>, eta: f64) -> Setup<2> {
    let shape = Shape::ball([0.45, 0.52], 0.27).unwrap();
    setup
        .regions(vec![Some(shape), None], &[eta, 1.0])
        .sources(vec![Field::Constant(1.0), Field::from_fn(|x: &[f64; 2]| x[0])])
}

#[test]
fn an_interface_at_which_nothing_jumps_leaves_the_plain_stencils_bit_for_bit() {
    let plain = Setup::<2>::generated(unit(), Layout::Irregular, 0.05, 7);
    let with = plain.clone().regions(vec![Some(Shape::ball([0.45, 0.52], 0.27).unwrap()), None], &[1.0, 1.0]);
    let mut zero = with.clone();
    let nothing = Some(Field::from_fn(|_: &[f64; 2]| 0.0));
    zero.laws = vec![InterfaceLaw { value: None, flux: nothing, ..InterfaceLaw::new([0, 1]) }];
    let mut varying = with.clone();
    varying.set_diffusivities(vec![Field::from_fn(|_: &[f64; 2]| 1.0), Field::Constant(1.0)]);
    for params in [ParticleDifferenceParams::paper(), ParticleDifferenceParams::default()] {
        let expected = discretize(&plain, params);
        for setup in [&with, &zero, &varying] {
            let found = discretize(setup, params);
            assert_eq!((found.rows, found.rhs), (expected.rows.clone(), expected.rhs.clone()));
            assert_eq!(found.counts.constrained, 0);
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let setup = disc(Setup::generated(unit(), Layout::Irregular, 0.05, 3), 1e4);
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| discretize(&setup, ParticleDifferenceParams::default()))
    });
    assert_eq!((one.rows, one.rhs, one.kinds), (two.rows, two.rhs, two.kinds));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Rotated by any angle, scaled and moved: with u the same, sources go with the inverse square of the length.
    #[test]
    fn motions_and_scaling_do_not_change_the_solution(
        seed in 0..1000_u64, angle in 0.0..6.3, scale in 0.01..100.0, shift in proptest::array::uniform2(-3.0..3.0),
        exponent in -6.0..6.0,
    ) {
        let eta = 10_f64.powf(exponent);
        let (sin, cos) = f64::sin_cos(angle);
        let to = move |x: &[f64; 2]| {
            [scale * (cos * x[0] - sin * x[1] + shift[0]), scale * (sin * x[0] + cos * x[1] + shift[1])]
        };
        let back = move |y: &[f64; 2]| {
            let t = [y[0] / scale - shift[0], y[1] / scale - shift[1]];
            [cos * t[0] + sin * t[1], cos * t[1] - sin * t[0]]
        };
        let setup = disc(Setup::generated(unit(), Layout::Irregular, 0.08, seed), eta)
            .conditions(|_, x| Condition::Dirichlet(1.0 + x[0] * x[1]));
        let points = setup.cloud.points().iter().map(to).collect();
        let spacing = setup.cloud.spacing().iter().map(|s| s * scale).collect();
        let cloud = Cloud::from_parts(points, setup.cloud.boundary().to_vec(), spacing).unwrap();
        let shape = Shape::ball(to(&[0.45, 0.52]), scale * 0.27).unwrap();
        let per_area = 1.0 / (scale * scale);
        let moved = Setup::new(unit(), cloud)
            .regions(vec![Some(shape), None], &[eta, 1.0])
            .sources(vec![Field::Constant(per_area), Field::from_fn(move |y: &[f64; 2]| per_area * back(y)[0])])
            .conditions(move |_, y| Condition::Dirichlet(1.0 + back(y)[0] * back(y)[1]));
        prop_assert_eq!(&setup.labels, &moved.labels);
        for params in [ParticleDifferenceParams::paper(), ParticleDifferenceParams::default()] {
            let [u, v] = [&setup, &moved].map(|s| s.solve_by(&ParticleDifference { params }));
            let size = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            let difference = max_difference(&u, &v);
            prop_assert!(difference < 1e-9 * size, "{difference:e} of {size:e}");
        }
    }
}
