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

/// A disc of five times the conductivity: `u = r^2 / eta + c` on each side. The shapes are forgotten once every node has
/// its region; interfaces are then known to a tenth of a spacing or so.
#[test]
fn a_disc_is_solved_from_labels_alone() {
    let scene = |spacing: f64, layout: &str, interfaces: &str| {
        let outside = "x^2 + y^2 - 0.8*0.09";
        format!(
            "title = \"Disc\"\ndimension = 2\n[domain]\nbox = {{ min = [-0.5, -0.5], max = [0.5, 0.5] }}\n\
             [points]\nspacing = {spacing}\nlayout = \"{layout}\"\n\
             [[regions]]\nname = \"disc\"\nsphere = {{ center = [0.0, 0.0], radius = 0.3 }}\ndiffusivity = 5\n\
             source = -4\nexact = \"(x^2 + y^2)/5\"\n\
             [[regions]]\nname = \"plate\"\ndiffusivity = 1\nsource = -4\nexact = \"{outside}\"\n\
             [[boundaries]]\nface = \"all\"\ndirichlet = \"{outside}\"\n\
             [method]\nname = \"immersed-interface\"\ninterfaces = \"{interfaces}\"\n"
        )
    };
    let error = |text: &str| {
        let solution = solve_scene(&Scene::parse(text, "disc").expect("a scene")).expect("it can be solved");
        solution.report.errors.expect("the scene has an exact solution").l2
    };
    for layout in ["grid", "jittered", "scattered"] {
        let known = error(&scene(0.025, layout, "shapes"));
        assert!(known < 1e-3, "{layout}: {known:e}");
        let ladder = [0.05, 0.025].map(|h| error(&scene(h, layout, "labels")));
        assert!(ladder[1] < 0.03, "{layout}: {ladder:?}, with shapes {known:e}");
    }
}
