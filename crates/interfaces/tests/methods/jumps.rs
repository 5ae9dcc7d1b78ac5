//! Prescribed jumps of the value and of the flux.

use meshless_geometry::{Domain, FaceId, Layout, Shape};
use meshless_interfaces::gfdm::GfdmParams;
use meshless_interfaces::{Condition, Field, InterfaceLaw};
use proptest::prelude::*;

use crate::support::{Setup, condition_of_kind, dot, grid, max_difference, relative_l2, unit};

/// A jump given from A to B, or the same one from B to A.
fn jump<const D: usize>(reversed: bool, value: Field<D>, flux: Field<D>) -> InterfaceLaw<D> {
    let between = if reversed { [1, 0] } else { [0, 1] };
    InterfaceLaw { value: Some(value), flux: Some(flux), ..InterfaceLaw::new(between) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Piecewise linear with slopes p and q; the interface lies midway between two columns of nodes.
    #[test]
    fn piecewise_linear_solutions_with_jumps_are_exact(
        n in 4..7_usize, p in -2.0..2.0, q in -2.0..2.0, offset in -3.0..3.0, exponent in -4.0..4.0,
        reversed in any::<bool>(), first in prop_oneof![Just(0_u8), Just(3)], rest in 0..4_u8,
    ) {
        jumps_are_exact::<1>(n, [p, q], offset, exponent, reversed, [first, rest]);
        jumps_are_exact::<2>(n, [p, q], offset, exponent, reversed, [first, rest]);
        jumps_are_exact::<3>(n, [p, q], offset, exponent, reversed, [first, rest]);
    }
}

fn jumps_are_exact<const D: usize>(
    n: usize,
    slopes: [f64; 2],
    offset: f64,
    exponent: f64,
    reversed: bool,
    kinds: [u8; 2],
) {
    let eta = [10_f64.powf(exponent), 1.0];
    let at = 1.5 / n as f64;
    let axis = |length: f64| std::array::from_fn(|k| if k == 0 { length } else { 0.0 });
    let u = move |x: f64| if x < at { slopes[0] * x } else { offset + slopes[1] * x };
    // Going from A to B or back, "B less A" in the fixed direction of x changes its sign, and so does n, once more for
    // the flux: (eta du/dn)_B - (eta du/dn)_A is the same either way.
    let sign = if reversed { -1.0 } else { 1.0 };
    let value = sign * (offset + (slopes[1] - slopes[0]) * at);
    let flux = eta[1] * slopes[1] - eta[0] * slopes[0];
    let mut setup = Setup::<D>::new(unit(), grid(n, |_| true))
        .regions(vec![Some(Shape::half_space(axis(at), axis(1.0)).unwrap()), None], &eta)
        .conditions(move |face, x| match face.0 {
            0 => condition_of_kind(kinds[0], u(x[0]), -slopes[0], eta[0]),
            1 => condition_of_kind(kinds[1], u(x[0]), slopes[1], eta[1]),
            _ => Condition::Flux(0.0),
        });
    setup.laws = vec![jump(reversed, Field::Constant(value), Field::Constant(flux))];
    let exact = setup.nodal(|_, x| u(x[0]));
    let size = 1.0 + exact.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    for params in [
        GfdmParams::conservative(),
        GfdmParams::hybrid(),
        GfdmParams { conservative_neumann: false, ..GfdmParams::conservative() },
        GfdmParams { conservative_neumann: false, ..GfdmParams::positive() },
    ] {
        let error = max_difference(&setup.solve(params), &exact);
        assert!(error < 1e-9 * size, "{D}-D, {params:?}: {error:e} of {size:e}");
    }
}

/// `u = r^2 + x_0 x_1` in the ball, `3 + 2 x_0 - x_0^2` outside of it.
fn ball_error<const D: usize>(spacing: f64, seed: u64, reversed: bool, params: GfdmParams) -> f64 {
    const RADIUS: f64 = 0.53;
    const ETA: [f64; 2] = [10.0, 0.5];
    let inside = |x: &[f64; D]| dot(x, x) + x[0] * x[1];
    let outside = |x: &[f64; D]| 3.0 + 2.0 * x[0] - x[0] * x[0];
    let value = move |x: &[f64; D]| outside(x) - inside(x);
    // The normal is x / r; gradients times x.
    let flux = move |x: &[f64; D]| {
        let inner = 2.0 * dot(x, x) + 2.0 * x[0] * x[1];
        let outer = 2.0 * x[0] - 2.0 * x[0] * x[0];
        (ETA[1] * outer - ETA[0] * inner) / dot(x, x).sqrt()
    };
    let sign = if reversed { -1.0 } else { 1.0 };
    let domain = Domain::boxed([-1.0; D], [1.0; D]).unwrap();
    let mut setup = Setup::<D>::generated(domain, Layout::Irregular, spacing, seed)
        .regions(vec![Some(Shape::ball([0.0; D], RADIUS).unwrap()), None], &ETA)
        .source(|label, _| if label == 0 { -ETA[0] * 2.0 * D as f64 } else { 2.0 * ETA[1] })
        .conditions(move |_: FaceId, x| Condition::Dirichlet(outside(x)));
    setup.laws = vec![jump(reversed, Field::from_fn(move |x| sign * value(x)), Field::from_fn(flux))];
    let exact = setup.nodal(|label, x| if label == 0 { inside(x) } else { outside(x) });
    relative_l2(&setup.solve(params), &exact)
}

/// Root mean square over several clouds: where the staircase of faces runs is a matter of chance.
fn mean_error<const D: usize>(spacing: f64, clouds: u64, reversed: bool, params: GfdmParams) -> f64 {
    let squares: f64 =
        (1..=clouds).map(|seed| ball_error::<D>(spacing, seed, reversed, params).powi(2)).sum();
    (squares / clouds as f64).sqrt()
}

#[test]
fn jumps_on_a_circle_converge() {
    for (params, reversed) in [(GfdmParams::conservative(), false), (GfdmParams::hybrid(), true)] {
        let [coarse, fine] = [0.1, 0.025].map(|h| mean_error::<2>(h, 6, reversed, params));
        let order = (coarse / fine).log2() / 2.0;
        assert!(order >= 0.8 && fine < 1e-2, "{coarse:e}, {fine:e}: order {order}");
    }
}

#[test]
fn jumps_on_a_sphere_converge() {
    let [coarse, fine] = [0.25, 0.125].map(|h| mean_error::<3>(h, 4, false, GfdmParams::conservative()));
    let order = (coarse / fine).log2();
    assert!(order >= 0.8 && fine < 5e-2, "{coarse:e}, {fine:e}: order {order}");
}

#[test]
fn the_direction_in_which_a_jump_is_given_does_not_matter() {
    let [a, b] = [false, true].map(|reversed| ball_error::<2>(0.1, 9, reversed, GfdmParams::conservative()));
    assert!((a - b).abs() < 1e-10 * a, "{a:e} {b:e}");
}

#[test]
fn the_classical_method_refuses_jumps() {
    let mut setup = Setup::<1>::new(unit(), grid(8, |_| true));
    setup.laws = vec![jump(false, Field::Constant(1.0), Field::Constant(0.0))];
    let error = setup.try_solve(GfdmParams::classical()).unwrap_err().to_string();
    assert!(error.contains("jump") && error.contains("gfdm-hybrid"), "{error}");
}
