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
        // What a prototype had: 0.122 at 8 and 0.0177 at 4, order 2.8.
        let prototype = |h: f64| 0.0177 * (h / 4.0).powf(2.8);
        let within = ladder.iter().all(|&(h, error)| error < prototype(h));
        assert!(observed(&ladder) > 2.3 && within, "{particles:?}: {ladder:?}");
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
    // What is asked for at half of the spacing, times four.
    assert!((error / size).sqrt() < 4.0 * 2.7e-3, "{:e}", (error / size).sqrt());
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

/// Quadratic fields are exact: prescribed values, slopes and Robin conditions at the outer faces and round a hole, by the same
/// fits; the disc in between is found by its shape, or by a level set that is no distance.
#[test]
fn conditions_of_every_kind_at_inner_and_outer_boundaries_are_exact() {
    let (u, ux, uy) = ("(1 + x - 2*y + x^2 + 3*x*y - y^2)", "(1 + 2*x + 3*y)", "(3*x - 2 - 2*y)");
    // In the disc half of it: the flux, at twice the diffusivity, is the same, and u jumps.
    let disc = format!("0.5*{u}");
    for shape in [
        "sphere = { center = [0.1, 0.05], radius = 0.42 }",
        "level_set = \"(x - 0.1)^2 + (y - 0.05)^2 - 0.1764\"",
    ] {
        for hole in [
            format!("dirichlet = \"{disc}\""),
            format!("neumann = \"-0.5*({ux}*(x - 0.1) + {uy}*(y - 0.05))/0.18\""),
            format!(
                "robin = {{ a = 3, b = 2, g = \"3*{disc} - 2*({ux}*(x - 0.1) + {uy}*(y - 0.05))/0.18\" }}"
            ),
        ] {
            let text = format!(
                "title = \"Ring\"\ndimension = 2\n[domain]\nbox = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}\n\
                 [points]\nspacing = 0.1\nlayout = \"scattered\"\nseed = 2\n\
                 [[holes]]\nname = \"hole\"\nsphere = {{ center = [0.1, 0.05], radius = 0.18 }}\n\
                 [[regions]]\nname = \"ring\"\n{shape}\ndiffusivity = 2\nexact = \"{disc}\"\n\
                 [[regions]]\nname = \"plate\"\ndiffusivity = 1\nexact = \"{u}\"\n\
                 [[interfaces]]\nbetween = [\"ring\", \"plate\"]\njump = \"{disc}\"\n\
                 [[boundaries]]\nface = \"hole\"\n{hole}\n\
                 [[boundaries]]\nface = \"left\"\ndirichlet = \"{u}\"\n\
                 [[boundaries]]\nface = \"right\"\nneumann = \"{ux}\"\n\
                 [[boundaries]]\nface = \"top\"\nflux = \"{uy}\"\n\
                 [[boundaries]]\nface = \"bottom\"\nrobin = {{ a = 1, b = 1, g = \"{u} - {uy}\" }}\n"
            );
            let l2 = error(&text);
            assert!(l2 < 1e-9, "{shape}, {hole}: {l2:e}");
        }
    }
}
