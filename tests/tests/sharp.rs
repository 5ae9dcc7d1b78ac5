//! The sharp method: orders, contrasts, conditions.

use meshless::scene::{MethodName, Scene};
use meshless::{Error, Solution};
use meshless_tests::kraus;
use meshless_tests::order::observed;
use meshless_tests::particle_difference::{Regularity, ball, circle, corner_45, corner_90, cylinder};
use meshless_tests::solve::solve_scene;

fn solve(text: &str, order: usize) -> Result<Solution, Error> {
    let mut scene = Scene::parse(text, "gallery.toml")?;
    scene.method.name = MethodName::Sharp;
    scene.method.order = Some(order);
    solve_scene(&scene)
}

fn errors(text: &str, order: usize) -> [f64; 3] {
    let solution = solve(text, order).unwrap_or_else(|error| panic!("{error}"));
    let errors = solution.report.errors.expect("the gallery has exact solutions");
    [errors.l2, errors.linf, errors.gradient_linf]
}

#[test]
fn the_interior_interface_converges_at_the_order_of_the_polynomials() {
    for (order, least) in [(4, 3.4), (6, 5.3)] {
        let ladder: Vec<(f64, f64)> = [0.2, 0.1, 0.05]
            .map(|h| (h, errors(&kraus::interior(1e6, kraus::SUPPORT * h, 1), order)[0]))
            .to_vec();
        assert!(observed(&ladder) > least, "order {order}: {ladder:?}");
    }
}

#[test]
fn the_contrast_does_not_show_in_the_error() {
    let error = |contrast| errors(&kraus::interior(contrast, kraus::SUPPORT * 0.1, 1), 6)[0];
    let found = [1e2, 1e6, 1e10].map(error);
    let [low, high] = [f64::min, f64::max].map(|f| found.into_iter().reduce(f).expect("three"));
    assert!(high < 3.0 * low && high < 1e-6, "{found:?}");
}

#[test]
fn variable_diffusivity_and_a_flux_jump() {
    let [_, linf, gradient] = errors(&circle(100.0, 0.1, 41, Regularity::Irregular(1)), 6);
    assert!(linf < 1e-7 && gradient < 1e-6, "{linf} {gradient}");
    // The flux jumps and the diffusivity does not.
    let [_, linf, _] = errors(&cylinder(41, Regularity::Irregular(1)), 6);
    assert!(linf < 1e-4, "{linf}");
}

#[test]
fn polynomial_solutions_are_exact_also_in_corners() {
    // Flat interfaces that meet conditions on the flux; linear on both sides.
    for contrast in [1e-8, 1.0, 1e8] {
        let [l2, ..] = errors(&kraus::two_strip(contrast, kraus::SUPPORT * 0.1, 1), 4);
        assert!(l2 < 1e-11, "{contrast}: {l2}");
    }
    for text in [corner_90(21, Regularity::Irregular(1)), corner_45(21, Regularity::Irregular(1))] {
        let [l2, ..] = errors(&text, 4);
        assert!(l2 < 1e-11, "{l2}");
    }
}

#[test]
fn a_ball_in_three_dimensions() {
    let [l2, ..] = errors(&ball(100.0, 0.1, 0.25, Regularity::Irregular(1)), 4);
    assert!(l2 < 1e-3, "{l2}");
}

#[test]
fn what_it_cannot_do_is_said() {
    let scene = kraus::interior(1e2, 0.3, 1) + "[time]\nend = 1.0\n";
    let error = solve(&scene, 4).expect_err("no time steps");
    assert!(error.to_string().contains("no steps in time"), "{error}");
    let error = solve(&ball(100.0, 0.1, 0.25, Regularity::Irregular(1)), 10).expect_err("too high an order");
    assert!(error.to_string().contains("no order 10"), "{error}");
}
