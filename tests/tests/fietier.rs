//! The problems of Fiétier et al., solved with immersed interfaces.

use meshless::scene::{MethodName, Scene};
use meshless_tests::fietier::{Particles, REFERENCE, dipole, inclusions, shells};
use meshless_tests::order::observed;
use meshless_tests::solve::{solve_scene, solve_with};

/// Relative l2 error of a scene with an exact solution.
fn error(text: &str) -> f64 {
    let solution = solve_with(text, MethodName::ImmersedInterface).expect("the scene can be solved");
    solution.report.errors.expect("the scene has an exact solution").l2
}

#[test]
fn fields_that_are_linear_on_each_side_are_found_exactly() {
    for particles in [Particles::Lattice, Particles::Jittered(1), Particles::Scattered(2)] {
        for spacing in [4.0, 1.0] {
            let l2 = error(&dipole(spacing, particles));
            assert!(l2 < 1e-11, "{particles:?}, {spacing}: {l2:e}");
        }
    }
}

#[test]
fn three_shells_converge_with_more_than_second_order_on_any_particles() {
    for particles in [Particles::Lattice, Particles::Jittered(1), Particles::Scattered(2)] {
        let ladder = [8.0, 6.0, 4.5].map(|h| (h, error(&shells(h, particles))));
        assert!(observed(&ladder) > 2.3 && ladder[2].1 < 9e-3, "{particles:?}: {ladder:?}");
    }
}

#[test]
fn two_inclusions_agree_with_the_reference() {
    let mut scene = Scene::parse(&inclusions(4.0, Particles::Scattered(1)), "inclusions").expect("a scene");
    scene.method.name = MethodName::ImmersedInterface;
    let probes = solve_scene(&scene).expect("the scene can be solved").report.probes;
    let (error, size) = probes.iter().zip(REFERENCE).fold((0.0, 0.0), |(error, size), (probe, (_, u))| {
        (error + (probe.value.expect("a value") - u).powi(2), size + u * u)
    });
    assert!((error / size).sqrt() < 5e-3, "{:e}", (error / size).sqrt());
}
