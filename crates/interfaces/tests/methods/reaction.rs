//! Continuum surface reaction: indicators, sources at interfaces.

use meshless_geometry::{Layout, Shape};
use meshless_interfaces::dcpse::{
    Indicators, ReactionParams, ReactionSource, Sigma, Smoothing, SurfaceReaction,
};
use meshless_interfaces::{Condition, Field, InterfaceLaw, Method, MethodError};
use proptest::prelude::*;

use crate::support::{Setup, max_difference, unit};

fn disc(layout: Layout, spacing: f64, eta: [f64; 3]) -> Setup<2> {
    let shapes = vec![
        Some(Shape::ball([0.45, 0.52], 0.2).unwrap()),
        Some(Shape::half_space([0.5, 0.5], [0.6, 0.8]).unwrap()),
        None,
    ];
    Setup::<2>::generated(unit(), layout, spacing, 1).with_support(2.9).regions(shapes, &eta)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// Three regions that meet, on any cloud; one of them may be thinner than the width.
    #[test]
    fn smoothed_indicators_sum_to_one_and_their_gradients_to_zero(
        center in proptest::array::uniform2(0.3..0.7), radius in 0.02..0.3, angle in 0.0..6.3_f64,
        layout in 0..3_usize, width in 0.7..2.5, seed in 0..1000_u64,
    ) {
        let layout = [Layout::Grid, Layout::Jittered, Layout::Scattered][layout];
        let shapes = vec![
            Some(Shape::ball(center, radius).unwrap()),
            Some(Shape::half_space([0.5, 0.5], [angle.cos(), angle.sin()]).unwrap()),
            None,
        ];
        let setup = Setup::<2>::generated(unit(), layout, 0.04, seed).with_support(2.9).regions(shapes, &[1.0; 3]);
        let problem = setup.problem();
        for smoothing in [Smoothing::Convolution, Smoothing::Diffusion, Smoothing::Distance] {
            let chi = Indicators::new(&problem, smoothing, width).unwrap();
            let mixed: Vec<usize> = (0..setup.cloud.len()).filter(|&i| !chi.at(i).is_empty()).collect();
            prop_assert!(mixed.len() > 20);
            for i in mixed {
                let sum: f64 = chi.at(i).iter().map(|s| s.1).sum();
                let slope: f64 = chi.at(i).iter().map(|s| s.2[0]).sum();
                // Gradients are of the size of 1 over the spacing.
                prop_assert!((sum - 1.0).abs() < 1e-12 && slope.abs() < 1e-9, "{sum}, {slope:e}");
            }
        }
    }
}

/// Where the diffusivity does not jump, a jump of the flux comes out exactly, on any cloud.
#[test]
fn the_operator_on_a_ramp_makes_a_kink_exact() {
    let n = [0.6, 0.8];
    let distance = move |x: &[f64; 2]| (x[0] - 0.5) * n[0] + (x[1] - 0.48) * n[1];
    let value = move |x: &[f64; 2]| 1.0 + x[0] - 2.0 * x[1] + 7.0 * distance(x).max(0.0);
    for layout in [Layout::Grid, Layout::Scattered] {
        let mut setup = Setup::<2>::generated(unit(), layout, 0.05, 5)
            .with_support(2.9)
            .regions(vec![Some(Shape::half_space([0.5, 0.48], n).unwrap()), None], &[2.0, 2.0])
            .conditions(move |_, x| Condition::Dirichlet(value(x)));
        setup.laws = vec![InterfaceLaw {
            value: None,
            flux: Some(Field::Constant(14.0)),
            ..InterfaceLaw::new([0, 1])
        }];
        let exact = setup.nodal(|_, x| value(x));
        let error = |params| max_difference(&setup.solve_by(&SurfaceReaction { params }), &exact);
        let ours = error(ReactionParams::default());
        assert!(ours < 1e-9, "{layout:?}: {ours:e}");
        let smeared = error(ReactionParams { source: ReactionSource::Smoothed, ..Default::default() });
        // 0.4 w times the jump of the slope: 0.21; and the right sign, else it would be near 2.
        assert!(smeared > 0.02 && smeared < 0.5, "{layout:?}: {smeared:e}");
    }
}

/// Resistances in a row: only the harmonic mean knows them.
#[test]
fn the_harmonic_mean_converges_across_layers_and_the_arithmetic_one_does_not() {
    let eta = [100.0, 1.0];
    // Two layers, 0.4 and 0.6 thick: the same flux through both.
    let flux = 1.0 / (0.4 / eta[0] + 0.6 / eta[1]);
    let value = move |x: &[f64; 1]| {
        if x[0] < 0.4 { flux * x[0] / eta[0] } else { 1.0 - flux * (1.0 - x[0]) / eta[1] }
    };
    let error = |sigma, spacing: f64| {
        let setup = Setup::<1>::generated(unit(), Layout::Jittered, spacing, 3)
            .with_support(3.1)
            .regions(vec![Some(Shape::half_space([0.4], [1.0]).unwrap()), None], &eta)
            .conditions(move |_, x| Condition::Dirichlet(value(x)));
        let u = setup.solve_by(&SurfaceReaction { params: ReactionParams { sigma, ..Default::default() } });
        max_difference(&u, &setup.nodal(|_, x| value(x)))
    };
    let harmonic = [0.02, 0.005].map(|h| error(Sigma::Harmonic, h));
    assert!(harmonic[1] < 0.02 && harmonic[1] < 0.5 * harmonic[0], "{harmonic:?}");
    assert!(error(Sigma::Arithmetic, 0.005) > harmonic[1]);
}

#[test]
fn jumps_of_the_value_are_refused() {
    let mut setup = disc(Layout::Jittered, 0.1, [1.0; 3]);
    setup.laws =
        vec![InterfaceLaw { value: Some(Field::Constant(1.0)), flux: None, ..InterfaceLaw::new([0, 1]) }];
    let refused = SurfaceReaction::default().discretize(&setup.problem());
    assert!(matches!(refused, Err(MethodError::Unsupported { .. })));
}

/// Across layers the flux is right, and what is left is the kink of u, smeared over w: `w / sqrt(2 pi)` times the jump of the
/// slope at the interface. Clouds may add a half; where an interface lies between two nodes does not matter.
#[test]
fn the_error_is_that_of_a_smeared_kink() {
    let spacing = 0.01;
    for layout in [Layout::Grid, Layout::Jittered, Layout::Scattered] {
        for (eta, at) in [([1.0, 1e-2], 0.43), ([1.0, 10.0], 0.437), ([1.0, 1e4], 0.435)] {
            let flux = 1.0 / (at / eta[0] + (1.0 - at) / eta[1]);
            let value = move |x: &[f64; 2]| {
                if x[0] < at { flux * x[0] / eta[0] } else { 1.0 - flux * (1.0 - x[0]) / eta[1] }
            };
            let setup = Setup::<2>::generated(unit(), layout, spacing, 3)
                .with_support(2.9)
                .regions(vec![Some(Shape::half_space([at, 0.5], [1.0, 0.0]).unwrap()), None], &eta)
                .conditions(move |_, x| Condition::Dirichlet(value(x)));
            let params = ReactionParams::default();
            let error =
                max_difference(&setup.solve_by(&SurfaceReaction { params }), &setup.nodal(|_, x| value(x)));
            let kink = (flux / eta[0] - flux / eta[1]).abs();
            let smeared = params.width * spacing * kink / std::f64::consts::TAU.sqrt();
            assert!(error < 1.5 * smeared, "{layout:?}, {eta:?}: {error:e}, {smeared:e}");
        }
    }
}
