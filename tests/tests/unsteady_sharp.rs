//! The sharp method in time: its order in space, floating regions, gradients, data that change.

use meshless::Solution;
use meshless::scene::MethodName;
use meshless_tests::order::observed;
use meshless_tests::solve::solve_with;
use meshless_tests::unsteady::{ball, composite, driven, driven_contact, sandwich, slab, switched};

/// Least order on a few coarse clouds that differ in more than their spacing: one less than that of the method.
const LEAST: f64 = 3.0;

/// The same where two materials are in contact: more than methods of second order have. At contrasts of 1e6 stencils that reach over
/// the contact are those of its nodes that hear the stiff side only.
const LEAST_AT_CONTACT: f64 = 2.0;

fn solved(text: &str) -> Solution {
    solve_with(text, MethodName::Sharp).expect("it can be solved")
}

fn l2(solution: &Solution) -> f64 {
    solution.report.errors.as_ref().expect("the scene has an exact solution").l2
}

/// Errors of u and of its gradient fall with an order, and that less one.
fn check(name: &str, least: f64, spacings: &[f64], text: &dyn Fn(f64) -> String) {
    let solutions: Vec<(f64, Solution)> = spacings.iter().map(|&h| (h, solved(&text(h)))).collect();
    let of = |error: &dyn Fn(&Solution) -> f64| -> Vec<(f64, f64)> {
        solutions.iter().map(|(h, s)| (*h, error(s))).collect()
    };
    let (value, gradient) =
        (of(&l2), of(&|s| s.report.errors.as_ref().expect("the scene has an exact solution").gradient_linf));
    assert!(observed(&value) > least, "{name}: order {}, {value:?}", observed(&value));
    assert!(observed(&gradient) > least - 1.0, "{name}: gradient {}, {gradient:?}", observed(&gradient));
}

#[test]
fn the_order_in_space_is_kept() {
    check("slab, 1-D", LEAST, &[0.2, 0.1, 0.05], &|h| slab(1, h, 1e-7));
    check("slab, 2-D", LEAST, &[0.2, 0.1, 0.05], &|h| slab(2, h, 1e-6));
    check("ball", LEAST, &[0.35, 0.25, 0.18], &|h| ball(h, 1e-5));
}

#[test]
fn two_materials_in_contact() {
    for contrast in [1e-6, 1e-2, 10.0, 1e6] {
        check(&format!("1-D, {contrast:e}"), LEAST_AT_CONTACT, &[0.1, 0.05, 0.025], &|h| {
            composite(1, h, contrast, 1e-7)
        });
        check(&format!("2-D, {contrast:e}"), LEAST_AT_CONTACT, &[0.2, 0.1, 0.05], &|h| {
            composite(2, h, contrast, 1e-6)
        });
    }
}

#[test]
fn a_core_that_floats() {
    for contrast in [1e2, 1e8] {
        check(&format!("2-D, {contrast:e}"), LEAST, &[0.1, 0.05, 0.025], &|h| sandwich(2, h, contrast, 1e-6));
    }
}

/// Source, boundary values, Robin data and the diffusivity depend on time; polynomials are exact in space.
#[test]
fn data_that_change() {
    let errors = [1e-3, 1e-5].map(|tolerance| l2(&solved(&driven(tolerance))));
    assert!(errors[0] < 1e-3 && errors[1] < 1e-5, "{errors:?}");
}

/// Polynomials are exact in space on both sides.
#[test]
fn jumps_that_change() {
    for method in [MethodName::Sharp, MethodName::ImmersedInterface] {
        let run = |tolerance| l2(&solve_with(&driven_contact(tolerance), method).expect("it can be solved"));
        let errors = [1e-3, 1e-5].map(run);
        assert!(errors[0] < 1e-3 && errors[1] < 1e-5, "{method:?}: {errors:?}");
    }
}

/// The prescribed value jumps in the middle of the run: a new start from there. By their mass, nodes get a part of the jump at once:
/// no more than what half a spacing beside the boundary holds.
#[test]
fn a_boundary_value_that_jumps() {
    let spacing = 0.05;
    for dimension in [1, 2] {
        let error = l2(&solved(&switched(dimension, spacing, 1e-4)));
        assert!(error < 0.5 * spacing, "{dimension}-D: {error:e}");
    }
}
