//! Immersed interfaces: what is reproduced, what is conserved, what may not matter.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::dcpse::{Ghosts, ImmersedInterface, ImmersedParams, Interpolation};
use meshless_interfaces::{
    Condition, Discretization, Field, InterfaceLaw, Method, PseudoTimeParams, RowKind, pseudo_time,
};
use proptest::prelude::*;

use crate::support::{Setup, box_normal, condition_of_kind, dot, max_difference, unit};

/// A polynomial of third degree: all terms up to the second, and cubes.
#[derive(Debug, Clone, Copy)]
struct Cubic<const D: usize> {
    c: f64,
    b: [f64; D],
    a: [[f64; D]; D],
    t: [f64; D],
}

impl<const D: usize> Cubic<D> {
    /// From 16 numbers in [-1, 1]; cubes only where the degree is three.
    fn from(numbers: &[f64], degree: usize) -> Self {
        Self {
            c: numbers[0],
            b: std::array::from_fn(|k| numbers[1 + k]),
            a: std::array::from_fn(|k| std::array::from_fn(|l| numbers[4 + 3 * k + l])),
            t: std::array::from_fn(|k| if degree > 2 { numbers[13 + k] } else { 0.0 }),
        }
    }

    fn at(&self, x: &[f64; D]) -> f64 {
        let terms = |k: usize| x[k] * (dot(&self.a[k], x) + self.t[k] * x[k] * x[k]);
        self.c + dot(&self.b, x) + (0..D).map(terms).sum::<f64>()
    }

    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|k| {
            let second: f64 = (0..D).map(|l| (self.a[k][l] + self.a[l][k]) * x[l]).sum();
            self.b[k] + second + 3.0 * self.t[k] * x[k] * x[k]
        })
    }

    fn laplacian(&self, x: &[f64; D]) -> f64 {
        (0..D).map(|k| 2.0 * self.a[k][k] + 6.0 * self.t[k] * x[k]).sum()
    }
}

/// How far the rows are from zero for values at the nodes, relative to what is added up in them.
fn defect<const D: usize>(rows: &Discretization, u: &[f64]) -> f64 {
    (0..u.len()).filter(|&i| rows.kinds[i] != RowKind::Dirichlet).fold(0.0, |worst, i| {
        let (columns, values) = rows.rows.row(i);
        let (mut sum, mut total) = (rows.rows.row_sum(i) * u[i], 0.0);
        for (&j, a) in columns.iter().zip(values) {
            sum += a * (u[j as usize] - u[i]);
            total += a.abs() * (u[j as usize].abs() + u[i].abs());
        }
        worst.max((sum - rows.rhs[i]).abs() / (total + rows.rhs[i].abs()))
    })
}

/// Two polynomials with a plane between them and any conditions at the faces: everything that can jump does.
fn piecewise<const D: usize>(
    degree: usize,
    numbers: [&[f64]; 2],
    direction: &[f64],
    eta: [f64; 2],
    kinds: [u8; 6],
    seed: u64,
) -> f64 {
    let d: [f64; D] = std::array::from_fn(|k| direction[k] + if k == 0 { 1.5 } else { 0.0 });
    let n = d.map(|x| x / dot(&d, &d).sqrt());
    let q = numbers.map(|numbers| Cubic::<D>::from(numbers, degree));
    let flux = move |x: &[f64; D]| eta[1] * dot(&q[1].gradient(x), &n) - eta[0] * dot(&q[0].gradient(x), &n);
    let value = move |x: &[f64; D]| q[1].at(x) - q[0].at(x);
    let (through, layout) = ([0.47; D], Layout::Scattered);
    let side = move |x: &[f64; D]| {
        let level: f64 = (0..D).map(|k| (x[k] - through[k]) * n[k]).sum();
        usize::from(level > 0.0)
    };
    let mut setup = Setup::<D>::generated(unit(), layout, [0.02, 0.06, 0.13][D - 1], seed)
        .with_support([4.1, 3.4 + 0.5 * (degree - 2) as f64, 2.9 + 0.4 * (degree - 2) as f64][D - 1])
        .regions(vec![Some(Shape::half_space(through, n).unwrap()), None], &eta)
        .sources((0..2).map(|k| Field::from_fn(move |x: &[f64; D]| -eta[k] * q[k].laplacian(x))).collect())
        .conditions(move |face, x| {
            let k = side(x);
            let slope = dot(&q[k].gradient(x), &box_normal(face));
            condition_of_kind(kinds[face.0 as usize], q[k].at(x), slope, eta[k])
        });
    let (value, flux) = (Some(Field::from_fn(value)), Some(Field::from_fn(flux)));
    setup.laws = vec![InterfaceLaw { value, flux, ..InterfaceLaw::new([0, 1]) }];
    let u = setup.nodal(|label, x| q[label as usize].at(x));
    let params = ImmersedParams { ghosts: Ghosts::Constrained { degree }, ..Default::default() };
    let rows = ImmersedInterface { params }.discretize(&setup.problem()).unwrap();
    assert!(rows.counts.constrained > 0);
    defect::<D>(&rows, &u)
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0, 16)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Ghosts and boundary rows are exact for every field of the fitting space.
    #[test]
    fn polynomials_on_each_side_are_reproduced(
        inside in numbers(), outside in numbers(), direction in numbers(),
        exponents in proptest::array::uniform2(-3.0..3.0), kinds in proptest::array::uniform6(0..4_u8),
        seed in 0..1000_u64, degree in 2..4_usize,
    ) {
        let eta = exponents.map(|e| 10_f64.powf(e));
        let numbers = [&inside[..], &outside[..]];
        let found = [
            piecewise::<1>(degree, numbers, &direction, eta, kinds, seed),
            piecewise::<2>(degree, numbers, &direction, eta, kinds, seed),
            piecewise::<3>(2, numbers, &direction, eta, kinds, seed),
        ];
        // Second differences of the jump of the value lose four digits.
        prop_assert!(found.iter().all(|&d| d < 1e-9), "{found:?}");
    }
}

fn disc(spacing: f64, seed: u64, eta: f64) -> Setup<2> {
    Setup::<2>::generated(unit(), Layout::Scattered, spacing, seed)
        .with_support(2.9)
        .regions(vec![Some(Shape::ball([0.45, 0.52], 0.27).unwrap()), None], &[eta, 1.0])
        .sources(vec![Field::Constant(3.0), Field::from_fn(|x: &[f64; 2]| x[0])])
        .conditions(|_, x| Condition::Dirichlet(1.0 + x[0] * x[1]))
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let setup = disc(0.05, 3, 1e4);
    for ghosts in [Ghosts::Constrained { degree: 2 }, Ghosts::Image(Interpolation::Trilinear)] {
        let method = ImmersedInterface { params: ImmersedParams { ghosts, ..Default::default() } };
        let [one, two] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| method.discretize(&setup.problem()).unwrap())
        });
        assert_eq!((one.rows, one.rhs, one.kinds), (two.rows, two.rhs, two.kinds));
    }
}

/// Linear functions and ghosts by image points: interpolation and Taylor expansion are exact for them.
#[test]
fn ghosts_by_images_are_exact_for_linear_functions() {
    let slope = [0.7, -0.4];
    let eta = [3.0, 0.5];
    let n = [0.6, 0.8];
    // Equal along the plane; across it the flux jumps by 0.9, the value by 0.2.
    let other = (eta[0] * dot(&slope, &n) + 0.9) / eta[1] - dot(&slope, &n);
    let distance = move |x: &[f64; 2]| (x[0] - 0.5) * n[0] + (x[1] - 0.48) * n[1];
    let value = move |x: &[f64; 2]| {
        let beyond = distance(x);
        dot(&slope, x) + if beyond > 0.0 { 0.2 + other * beyond } else { 0.0 }
    };
    for interpolation in [
        Interpolation::Trilinear,
        Interpolation::Complete { degree: 1 },
        Interpolation::Complete { degree: 2 },
        Interpolation::Complete { degree: 3 },
    ] {
        let mut setup = Setup::<2>::generated(unit(), Layout::Scattered, 0.06, 5)
            .with_support(2.9)
            .regions(vec![Some(Shape::half_space([0.5, 0.48], n).unwrap()), None], &eta)
            .conditions(move |_, x| Condition::Dirichlet(value(x)));
        let (jump, flux) = (Some(Field::Constant(0.2)), Some(Field::Constant(0.9)));
        setup.laws = vec![InterfaceLaw { value: jump, flux, ..InterfaceLaw::new([0, 1]) }];
        let params = ImmersedParams { ghosts: Ghosts::Image(interpolation), ..Default::default() };
        let rows = ImmersedInterface { params }.discretize(&setup.problem()).unwrap();
        let found = defect::<2>(&rows, &setup.nodal(|_, x| value(x)));
        assert!(found < 1e-11, "{interpolation:?}: {found:e}");
    }
}

#[test]
fn pseudo_time_leads_to_the_same_solution_and_needs_many_steps() {
    let setup = disc(0.05, 3, 5.0);
    let method = ImmersedInterface::default();
    let problem = setup.problem();
    let rows = method.discretize(&problem).unwrap();
    let stepped =
        pseudo_time(&problem, &rows, &PseudoTimeParams { tolerance: 1e-10, max_steps: 100_000 }).unwrap();
    let direct = setup.solve_by(&method);
    assert!(max_difference(&stepped.u, &direct) < 1e-7, "{:e}", max_difference(&stepped.u, &direct));
    assert!(stepped.residual <= 1e-10 && stepped.steps > 500, "{} steps", stepped.steps);
    let short = pseudo_time(&problem, &rows, &PseudoTimeParams { tolerance: 1e-10, max_steps: 10 }).unwrap();
    assert!(short.steps == 10 && short.residual > 1e-3);
}
