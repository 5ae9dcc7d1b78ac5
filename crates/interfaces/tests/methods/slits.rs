//! Stencils near slits: what they reproduce, and who sees whom.

use meshless_geometry::{Layout, Slit};
use meshless_interfaces::gfdm::{Gfdm, GfdmParams};
use meshless_interfaces::particle_difference::{ParticleDifference, ParticleDifferenceParams};
use meshless_interfaces::{Field, Method, MethodError, SlitCondition, SlitInterface};
use proptest::prelude::*;

use crate::particle_difference::defects;
use crate::support::{Setup, unit};

/// Rounding: fits over one side of a slit have conditions of some thousands, more with singular functions that look
/// like polynomials far from the tip.
const EXACT: f64 = 1e-8;

/// A straight slit, and coordinates from its last vertex: ahead of it, and to its left.
#[derive(Debug, Clone, Copy)]
struct Line {
    tip: [f64; 2],
    tangent: [f64; 2],
}

impl Line {
    fn new(numbers: &[f64]) -> Self {
        let angle = std::f64::consts::PI * numbers[0];
        Self { tip: [0.5 + 0.15 * numbers[1], 0.5 + 0.15 * numbers[2]], tangent: [angle.cos(), angle.sin()] }
    }

    fn local(&self, x: &[f64; 2]) -> [f64; 2] {
        let d = [x[0] - self.tip[0], x[1] - self.tip[1]];
        let [c, s] = self.tangent;
        [d[0] * c + d[1] * s, d[1] * c - d[0] * s]
    }

    fn turned(&self, [ahead, left]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.tangent;
        [ahead * c - left * s, ahead * s + left * c]
    }

    /// How far the box reaches along a direction of this sign.
    fn reach(&self, sign: f64) -> f64 {
        let along = |k: usize| {
            let t = sign * self.tangent[k];
            match t {
                t if t > 0.0 => (1.0 - self.tip[k]) / t,
                t if t < 0.0 => self.tip[k] / -t,
                _ => f64::INFINITY,
            }
        };
        along(0).min(along(1))
    }

    /// From the boundary to the tip, or through to the other boundary.
    fn slit(&self, through: bool) -> Slit<2> {
        let at = |t: f64| [0, 1].map(|k| (self.tip[k] + t * self.tangent[k]).clamp(0.0, 1.0));
        let last = if through { at(self.reach(1.0)) } else { self.tip };
        Slit::new(vec![at(-self.reach(-1.0)), last], [false, !through]).unwrap()
    }
}

/// `sqrt(r) sin(theta/2)` or `sqrt(r) cos(theta/2)`, with the gradient.
fn singular(line: &Line, sine: bool, x: &[f64; 2]) -> (f64, [f64; 2]) {
    let [a, b] = line.local(x);
    let (r, half) = (a.hypot(b), 0.5 * b.atan2(a));
    let (s, c) = half.sin_cos();
    let slope = 0.5 / r.sqrt();
    let (value, gradient) = if sine { (s, [-s, c]) } else { (c, [c, s]) };
    (r.sqrt() * value, line.turned(gradient.map(|g| slope * g)))
}

fn setup(line: &Line, seed: u64, condition: SlitCondition<2>, through: bool) -> Setup<2> {
    let mut setup = Setup::<2>::generated(unit(), Layout::Irregular, 0.06, seed);
    // Within a third of the tip: everything between here and there is enriched, or the slit has no tip.
    setup.slits = vec![SlitInterface { slit: line.slit(through), condition, enrichment: 0.2 }];
    setup
}

/// Rows and gradients over the nodes that the test function is reproduced at.
fn worst(setup: &Setup<2>, u: &[f64], gradient: impl Fn(u16, &[f64; 2]) -> [f64; 2]) -> [f64; 2] {
    defects(setup, ParticleDifferenceParams::default(), u, gradient)
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-0.95..0.95, 9)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// A slit from boundary to boundary is an interface: two quadratic functions with the same Laplacian.
    #[test]
    fn jumps_across_a_slit_are_reproduced(n in numbers(), seed in 0..1000_u64) {
        let line = Line::new(&n);
        let n: [f64; 9] = std::array::from_fn(|k| n[k]);
        let quadratic = move |k: [f64; 4], x: &[f64; 2]| {
            let [a, b] = line.local(x);
            let value = k[0] + k[1] * a + k[2] * b + 0.5 * a * a - 0.3 * b * b + k[3] * (a * b + a * a - b * b);
            let slope = [k[1] + a + k[3] * (b + 2.0 * a), k[2] - 0.6 * b + k[3] * (a - 2.0 * b)];
            (value, line.turned(slope))
        };
        let (left, right) = ([n[3], n[4], n[5], n[6]], [n[7], n[8], n[3], n[4]]);
        let normal = line.turned([0.0, 1.0]);
        let condition = SlitCondition::Jump {
            value: Some(Field::from_fn(move |x: &[f64; 2]| quadratic(left, x).0 - quadratic(right, x).0)),
            flux: Some(Field::from_fn(move |x: &[f64; 2]| {
                let (l, r) = (quadratic(left, x).1, quadratic(right, x).1);
                (l[0] - r[0]) * normal[0] + (l[1] - r[1]) * normal[1]
            })),
        };
        let setup = setup(&line, seed, condition, true).source(|_, _| -0.4);
        let side = move |x: &[f64; 2]| if line.local(x)[1] >= 0.0 { left } else { right };
        let u = setup.nodal(|_, x| quadratic(side(x), x).0);
        let found = worst(&setup, &u, |_, x| quadratic(side(x), x).1);
        prop_assert!(found.iter().all(|&d| d < EXACT), "{found:?}");
    }

    /// The flux jumps as that of `sqrt(r) cos(theta/2)`, without bound at the tip.
    #[test]
    fn a_singular_function_and_its_flux_are_reproduced(n in numbers(), seed in 0..1000_u64) {
        let line = Line::new(&n);
        let n: [f64; 9] = std::array::from_fn(|k| n[k]);
        let flux = move |x: &[f64; 2]| n[3] / line.local(x)[0].abs().sqrt();
        let condition = SlitCondition::Jump { value: None, flux: Some(Field::from_fn(flux)) };
        let mut setup = setup(&line, seed, condition, false).source(|_, _| -1.0);
        setup.slits[0].enrichment = 2.0;
        let slope = [n[4], n[5]];
        let strength = n[3];
        let function = move |x: &[f64; 2]| {
            let (value, gradient) = singular(&line, false, x);
            let [a, b] = line.local(x);
            let smooth = line.turned([slope[0] + a, slope[1]]);
            (
                strength * value + slope[0] * a + slope[1] * b + 0.5 * a * a,
                [0, 1].map(|k| strength * gradient[k] + smooth[k]),
            )
        };
        let u = setup.nodal(|_, x| function(x).0);
        let found = worst(&setup, &u, |_, x| function(x).1);
        prop_assert!(found.iter().all(|&d| d < EXACT), "{found:?}");
    }

    /// Each side by itself: u prescribed with a cosine, the flux with a sine.
    #[test]
    fn conditions_on_each_side_are_satisfied(n in numbers(), seed in 0..1000_u64, sine in any::<bool>()) {
        let line = Line::new(&n);
        let n: [f64; 9] = std::array::from_fn(|k| n[k]);
        // The smooth part has no slope across the slit.
        let smooth = move |x: &[f64; 2]| {
            let [a, b] = line.local(x);
            (n[4] * a + n[5] * a * a + n[6] * b * b, line.turned([n[4] + 2.0 * n[5] * a, 2.0 * n[6] * b]))
        };
        let condition = if sine {
            SlitCondition::Flux(Field::Constant(0.0))
        } else {
            SlitCondition::Dirichlet(Field::from_fn(move |x: &[f64; 2]| smooth(x).0))
        };
        let laplacian = 2.0 * (n[5] + n[6]);
        let mut setup = setup(&line, seed, condition, false).source(|_, _| -laplacian);
        setup.slits[0].enrichment = 2.0;
        let strength = n[3];
        let function = move |x: &[f64; 2]| {
            let ((value, slope), (regular, gradient)) = (singular(&line, sine, x), smooth(x));
            (strength * value + regular, [0, 1].map(|k| strength * slope[k] + gradient[k]))
        };
        let u = setup.nodal(|_, x| function(x).0);
        let found = worst(&setup, &u, |_, x| function(x).1);
        prop_assert!(found.iter().all(|&d| d < EXACT), "{found:?}");
    }
}

/// No row of a node before the slit has a neighbour behind it, and a slit at which nothing jumps changes no row.
#[test]
fn nobody_sees_through_a_slit() {
    let line = Line { tip: [0.5, 0.5], tangent: [0.0, 1.0] };
    let blind = setup(&line, 3, SlitCondition::Flux(Field::Constant(0.0)), false);
    let problem = blind.problem();
    let rows = ParticleDifference::default().discretize(&problem).unwrap();
    let points = blind.cloud.points();
    let hidden = |i: usize, j: usize| problem.is_hidden(&points[i], &points[j]);
    let mut met = false;
    for i in 0..points.len() {
        met |= problem.supports.lists.of(i).iter().any(|&j| hidden(i, j as usize));
        assert!(rows.rows.row(i).0.iter().all(|&j| !hidden(i, j as usize)), "row {i}");
    }
    assert!(met && rows.counts.constrained > 0);

    let mut nothing = setup(&line, 3, SlitCondition::Jump { value: None, flux: None }, false);
    nothing.slits[0].enrichment = 0.0;
    let with = ParticleDifference::default().discretize(&nothing.problem()).unwrap();
    nothing.slits.clear();
    let without = ParticleDifference::default().discretize(&nothing.problem()).unwrap();
    let u = nothing.nodal(|_, x| (3.0 * x[0]).sin() + x[1]);
    for i in 0..u.len() {
        let apply = |rows: &meshless_interfaces::Discretization| {
            let (columns, values) = rows.rows.row(i);
            columns.iter().zip(values).map(|(&j, a)| a * (u[j as usize] - u[i])).sum::<f64>()
        };
        assert!((apply(&with) - apply(&without)).abs() < 1e-12);
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let line = Line { tip: [0.5, 0.5], tangent: [0.0, 1.0] };
    let blind = setup(&line, 3, SlitCondition::Flux(Field::Constant(0.0)), false);
    let classical = Gfdm { params: GfdmParams::classical() }.discretize(&blind.problem());
    assert!(matches!(classical, Err(MethodError::Unsupported { .. })), "{classical:?}");
    let not_a_number = Field::from_fn(|_: &[f64; 2]| f64::NAN);
    let bad = setup(&line, 3, SlitCondition::Dirichlet(not_a_number), false);
    let found = ParticleDifference::default().discretize(&bad.problem());
    assert!(matches!(found, Err(MethodError::InvalidProblem { .. })), "{found:?}");
}
