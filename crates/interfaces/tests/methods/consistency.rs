//! What is reproduced exactly.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::Condition;
use meshless_interfaces::gfdm::GfdmParams;
use proptest::prelude::*;

use crate::support::{Setup, box_normal, condition_of_kind, dot, grid, max_difference, unit};

/// Every face but the first has any condition; the first fixes the constant.
fn kinds() -> impl Strategy<Value = [u8; 6]> {
    (prop_oneof![Just(0_u8), Just(3)], proptest::array::uniform5(0..4_u8)).prop_map(|(first, rest)| {
        let mut kinds = [first; 6];
        kinds[1..].copy_from_slice(&rest);
        kinds
    })
}

fn linear_is_exact<const D: usize>(spacing: f64, seed: u64, kinds: [u8; 6], slope: [f64; 3], eta: f64) {
    let g: [f64; D] = std::array::from_fn(|k| slope[k]);
    let u = move |x: &[f64; D]| 0.7 + dot(&g, x);
    let setup = Setup::<D>::generated(unit(), Layout::Irregular, spacing, seed)
        .regions(vec![None], &[eta])
        .conditions(move |face, x| {
            condition_of_kind(kinds[face.0 as usize], u(x), dot(&g, &box_normal(face)), eta)
        });
    let exact = setup.nodal(|_, x| u(x));
    let error = max_difference(&setup.solve(GfdmParams::classical()), &exact);
    assert!(error < 1e-10, "{D}-D, conditions {kinds:?}: {error:e}");
}

/// `u = c + g.x + sum_k q_k x_k^2 + x_0 x_last`, with the conditions of every kind.
fn quadratic_is_exact<const D: usize>(spacing: f64, seed: u64, kinds: [u8; 6], q: [f64; 3]) {
    const ETA: f64 = 2.5;
    let u =
        move |x: &[f64; D]| 0.3 - x[0] + (0..D).map(|k| q[k] * x[k] * x[k]).sum::<f64>() + x[0] * x[D - 1];
    let gradient = move |x: &[f64; D]| -> [f64; D] {
        let mut g: [f64; D] = std::array::from_fn(|k| 2.0 * q[k] * x[k]);
        g[0] += x[D - 1] - 1.0;
        g[D - 1] += x[0];
        g
    };
    let laplacian = 2.0 * q[..D].iter().sum::<f64>() + if D == 1 { 2.0 } else { 0.0 };
    let setup = Setup::<D>::generated(unit(), Layout::Irregular, spacing, seed)
        .regions(vec![None], &[ETA])
        .source(|_, _| -ETA * laplacian)
        .conditions(move |face, x| {
            condition_of_kind(kinds[face.0 as usize], u(x), dot(&gradient(x), &box_normal(face)), ETA)
        });
    let exact = setup.nodal(|_, x| u(x));
    let error = max_difference(&setup.solve(GfdmParams::classical()), &exact);
    assert!(error < 1e-10, "{D}-D, conditions {kinds:?}: {error:e}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn classical_rows_reproduce_linear_solutions(
        seed in 0..1000_u64, kinds in kinds(), slope in proptest::array::uniform3(-2.0..2.0), exponent in -3.0..3.0,
    ) {
        let eta = 10_f64.powf(exponent);
        linear_is_exact::<1>(0.08, seed, kinds, slope, eta);
        linear_is_exact::<2>(0.1, seed, kinds, slope, eta);
        linear_is_exact::<3>(0.25, seed, kinds, slope, eta);
    }

    #[test]
    fn classical_rows_reproduce_quadratic_solutions(
        seed in 0..1000_u64, kinds in kinds(), q in proptest::array::uniform3(-1.0..1.0),
    ) {
        quadratic_is_exact::<1>(0.08, seed, kinds, q);
        quadratic_is_exact::<2>(0.1, seed, kinds, q);
        quadratic_is_exact::<3>(0.25, seed, kinds, q);
    }

    #[test]
    fn every_method_keeps_constants_at_any_contrast(
        seed in 0..1000_u64, exponent in -10.0..10.0, kinds in kinds(), constant in -5.0..5.0,
    ) {
        let disc = Shape::ball([0.45, 0.55], 0.25).unwrap();
        let setup = Setup::<2>::generated(unit(), Layout::Irregular, 0.1, seed)
            .regions(vec![Some(disc), None], &[10_f64.powf(exponent), 1.0])
            .conditions(move |face, _| condition_of_kind(kinds[face.0 as usize], constant, 0.0, 1.0));
        let exact = vec![constant; setup.cloud.len()];
        let methods = [
            ("classical", GfdmParams::classical()), ("positive", GfdmParams::positive()),
            ("hybrid", GfdmParams::hybrid()), ("conservative", GfdmParams::conservative()),
        ];
        for (name, params) in methods {
            let error = max_difference(&setup.solve(params), &exact);
            prop_assert!(error < 1e-9, "{name}: {error:e}");
        }
    }

    /// The interface lies midway between two columns of a grid, so that the flux is exact.
    #[test]
    fn conservative_rows_reproduce_layers(
        n in 4..9_usize, column in 0..3_usize, exponent in -10.0..10.0, sides in 0..3_u8,
    ) {
        layers_are_exact::<1>(n, column, exponent, sides);
        layers_are_exact::<2>(n, column, exponent, sides);
        layers_are_exact::<3>(n.min(6), column, exponent, sides);
    }

    /// Nodes are missing on the first face, so that cells of inner nodes end at it.
    #[test]
    fn conservative_rows_reproduce_linear_solutions_where_boundary_nodes_are_missing(
        n in 4..8_usize, first in prop_oneof![Just(0_u8), Just(3)], rest in 0..3_u8, slope in proptest::array::uniform3(-2.0..2.0),
    ) {
        missing_face_is_exact::<1>(n, first, rest, slope);
        missing_face_is_exact::<2>(n, first, rest, slope);
        missing_face_is_exact::<3>(n, first, rest, slope);
    }
}

fn layers_are_exact<const D: usize>(n: usize, column: usize, exponent: f64, sides: u8) {
    let at = (column as f64 + 0.5) / n as f64;
    let eta = [10_f64.powf(exponent), 1.0];
    // Flux 1 / (at / eta_0 + (1 - at) / eta_1) from u = 0 to u = 1.
    let flux = 1.0 / (at / eta[0] + (1.0 - at) / eta[1]);
    let u = move |x: &[f64; D]| {
        if x[0] < at { flux * x[0] / eta[0] } else { 1.0 - flux * (1.0 - x[0]) / eta[1] }
    };
    let layer = Shape::half_space(
        std::array::from_fn(|k| if k == 0 { at } else { 0.0 }),
        std::array::from_fn(|k| if k == 0 { 1.0 } else { 0.0 }),
    );
    let setup = Setup::<D>::new(unit(), grid(n, |_| true))
        .regions(vec![Some(layer.unwrap()), None], &eta)
        .conditions(move |face, x| match face.0 {
            0 | 1 => Condition::Dirichlet(u(x)),
            _ => condition_of_kind(sides, u(x), 0.0, 1.0),
        });
    assert!(setup.labels.contains(&0) && setup.labels.contains(&1));
    let exact = setup.nodal(|_, x| u(x));
    let error = max_difference(&setup.solve(GfdmParams::conservative()), &exact);
    assert!(error < 1e-10, "{D}-D, contrast 1e{exponent}: {error:e}");
}

fn missing_face_is_exact<const D: usize>(n: usize, first: u8, rest: u8, slope: [f64; 3]) {
    const ETA: f64 = 0.4;
    let g: [f64; D] = std::array::from_fn(|k| slope[k]);
    let u = move |x: &[f64; D]| 1.0 + dot(&g, x);
    let setup = Setup::<D>::new(unit(), grid(n, |index| index[0] != 0))
        .regions(vec![None], &[ETA])
        .conditions(move |face, x| {
            let kind = if face.0 == 0 { first } else { rest };
            condition_of_kind(kind, u(x), dot(&g, &box_normal(face)), ETA)
        });
    // Nothing on the other faces need fix the constant: the cells at the first one see its condition.
    let exact = setup.nodal(|_, x| u(x));
    let error = max_difference(&setup.solve(GfdmParams::conservative()), &exact);
    assert!(error < 1e-10, "{D}-D, conditions {first} and {rest}: {error:e}");
}
