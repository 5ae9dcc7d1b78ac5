//! The gallery of Yoon and Song: its solutions satisfy their equations, and the method converges to them.

use meshless::plan::{Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless_tests::order::observed;
use meshless_tests::particle_difference::{
    Regularity, SlitSetup, ball, circle, corner_45, corner_90, crack, cylinder, cylinder_prescribed, slit,
};
use meshless_tests::small::Small;
use meshless_tests::solve::solve_with;

fn gallery() -> Vec<String> {
    let grid = Regularity::Grid;
    vec![
        circle(100.0, 0.1, 20, grid),
        corner_90(20, grid),
        corner_45(20, grid),
        cylinder(20, grid),
        ball(100.0, 0.1, 0.2, grid),
    ]
}

/// `div(eta grad u) + f` in every region by symbolic derivatives, at points that are in no special place.
#[test]
fn a_slit_that_crosses_the_rim_of_an_inclusion_is_refused_with_the_place() {
    let text = "title = \"crossed\"\ndimension = 2\n[domain]\nbox = { min = [-1, -1], max = [1, 1] }\n\
                [points]\nspacing = 0.1\n[[slits]]\nname = \"crack\"\npolyline = [[-0.2, 0.03], [0.8, 0.03]]\nflux = 0\n\
                [[regions]]\nname = \"inclusion\"\nsphere = { center = [0, 0], radius = 0.4 }\ndiffusivity = 10\n\
                [[regions]]\nname = \"matrix\"\ndiffusivity = 1\n[[boundaries]]\nface = \"all\"\ndirichlet = \"x\"\n";
    let refused = |text: &str| {
        let scene = Scene::parse(text, "crossed.toml").unwrap();
        let plan = Plan::new(&scene).unwrap();
        meshless::execute(&scene, &plan, &mut meshless::Silent).err().map(|error| error.to_string())
    };
    let message = refused(text).expect("a refusal");
    assert!(message.contains("near both a slit and an interface"), "{message}");
    // With one diffusivity nothing jumps at the rim, and the crack may cross it.
    assert_eq!(refused(&text.replace("diffusivity = 10", "diffusivity = 1")), None);
}

#[test]
fn the_solutions_of_the_gallery_satisfy_their_equations() {
    for text in gallery() {
        let scene = Scene::parse(&text, "gallery.toml").expect("a scene of the gallery");
        for region in &scene.regions {
            let u = &region.exact.as_ref().expect("the gallery has exact solutions").expr;
            let eta = &region.diffusivity.expr;
            for k in 0..20 {
                let x: Vec<f64> = (0..scene.dimension)
                    .map(|axis| 0.11 + (0.37 * f64::from(k) + 0.59 * axis as f64) % 1.73)
                    .collect();
                let terms = (0..scene.dimension).map(|axis| {
                    let slope = u.derivative(axis);
                    eta.eval(&x) * slope.derivative(axis).eval(&x)
                        + eta.derivative(axis).eval(&x) * slope.eval(&x)
                });
                let (sum, size) = terms.fold((0.0, 1.0), |(s, t), x: f64| (s + x, t + x.abs()));
                let source = region.source.as_ref().map_or(0.0, |f| f.expr.eval(&x));
                assert!(
                    (sum + source).abs() < 1e-11 * size,
                    "{}, {}: {sum} {source}",
                    scene.title,
                    region.name
                );
            }
        }
    }
}

/// Value and flux at points of the interface: on the circle and the sphere, by angle.
#[test]
fn the_solutions_of_the_gallery_jump_as_they_say() {
    for text in [gallery().swap_remove(0), gallery().swap_remove(3), gallery().swap_remove(4)] {
        let scene = Scene::parse(&text, "gallery.toml").expect("a scene of the gallery");
        for k in 0..10 {
            let (a, b) = (0.3 + 0.61 * f64::from(k), 0.2 + 0.27 * f64::from(k));
            let normal = match scene.dimension {
                2 => vec![a.cos(), a.sin()],
                _ => vec![b.sin() * a.cos(), b.sin() * a.sin(), b.cos()],
            };
            let x: Vec<f64> = normal.iter().map(|n| 1.0 + 0.5 * n).collect();
            let value = |r: usize| scene.regions[r].exact.as_ref().expect("exact").expr.eval(&x);
            let flux = |r: usize| {
                let u = &scene.regions[r].exact.as_ref().expect("exact").expr;
                let slope: f64 =
                    normal.iter().enumerate().map(|(axis, n)| n * u.derivative(axis).eval(&x)).sum();
                scene.regions[r].diffusivity.expr.eval(&x) * slope
            };
            let given = scene.interfaces[0].flux_jump.as_ref().expect("a flux jump").expr.eval(&x);
            assert!((value(1) - value(0)).abs() < 1e-14, "{}: {} {}", scene.title, value(1), value(0));
            assert!(
                (flux(1) - flux(0) - given).abs() < 1e-12,
                "{}: {} {given}",
                scene.title,
                flux(1) - flux(0)
            );
        }
    }
}

/// Largest error of u and of its gradient over a ladder of spacings.
fn orders(scenes: &[String]) -> [f64; 2] {
    let rungs: Vec<[f64; 3]> = scenes
        .iter()
        .map(|text| {
            let solution = solve_with(text, MethodName::ParticleDifference).expect("the scene can be solved");
            assert!(solution.report.nodes.constrained > 0);
            let errors = solution.report.errors.expect("the gallery has exact solutions");
            [solution.report.spacing, errors.linf, errors.gradient_linf]
        })
        .collect();
    [1, 2].map(|which| observed(&rungs.iter().map(|r| (r[0], r[which])).collect::<Vec<_>>()))
}

#[test]
fn u_is_of_second_order_and_its_gradient_of_more_than_first_whatever_the_contrast() {
    for regularity in [Regularity::Grid, Regularity::Irregular(1)] {
        for contrast in [1e-10, 1e-4, 1e2, 1e10] {
            let found = orders(&[20, 40, 80].map(|nodes| circle(contrast, 0.1, nodes, regularity)));
            assert!(found[0] >= 1.8 && found[1] >= 1.1, "{regularity:?}, {contrast:e}: {found:?}");
        }
        let found = orders(&[20, 40, 80].map(|nodes| cylinder(nodes, regularity)));
        assert!(found[0] >= 1.8 && found[1] >= 1.5, "{regularity:?}: {found:?}");
    }
}

#[test]
fn three_dimensions_are_no_different() {
    let found =
        orders(&[0.2, 0.1, 0.0667].map(|spacing| ball(100.0, 0.1, spacing, Regularity::Irregular(1))));
    assert!(found[0] >= 1.8 && found[1] >= 1.0, "{found:?}");
}

/// Both solutions are piecewise quadratic.
#[test]
fn corners_are_exact_up_to_the_node_at_their_tip() {
    for (name, scene) in [("90", corner_90(40, Regularity::Grid)), ("45", corner_45(40, Regularity::Grid))] {
        let solution = solve_with(&scene, MethodName::ParticleDifference).expect("the scene can be solved");
        let errors = solution.report.errors.expect("the gallery has exact solutions");
        assert!(errors.linf < 1e-6 && errors.gradient_linf < 1e-4, "{name}: {errors:?}");
    }
}

/// A plan has constrained stencils only where something jumps.
#[test]
fn an_interface_at_which_nothing_jumps_adds_no_stage() {
    let stages = |inside: Option<&'static str>| {
        let text = Small { inside, outside: "2", ..Small::default() }.text()
            + "[method]\nname = \"particle-difference\"\n";
        Plan::new(&Scene::parse(&text, "small.toml").expect("a small scene")).expect("a plan").stages
    };
    let (none, same, other) = (stages(None), stages(Some("2")), stages(Some("3")));
    assert!(!none.contains(&Stage::ConstrainedStencils));
    assert_eq!(same.into_iter().filter(|s| *s != Stage::Regions).collect::<Vec<_>>(), none);
    assert!(other.contains(&Stage::ConstrainedStencils));
}

/// The largest error of the paper's slit without visibility is 7.4e-2 to 5.4e-2, of order 0.23.
#[test]
fn slits_are_of_second_order_in_l2_with_the_singular_functions_of_their_tips() {
    for regularity in [Regularity::Grid, Regularity::Irregular(1)] {
        let setup = SlitSetup { dirichlet: false, enriched: true, graded: false };
        let jump = [20, 40, 80].map(|n| slit(n, regularity, setup));
        let given = [20, 40, 80].map(|n| slit(n, regularity, SlitSetup { dirichlet: true, ..setup }));
        let crack = [20, 40, 80].map(|n| crack(n, regularity, true));
        for scenes in [jump, given, crack] {
            let rungs = scenes.map(|text| {
                let solution = solve_with(&text, MethodName::Auto).expect("the scene can be solved");
                assert_eq!(solution.report.method, "particle-difference");
                (solution.report.spacing, solution.report.errors.expect("a closed form").l2)
            });
            assert!(observed(&rungs) >= 1.8 && rungs[2].1 < 1e-3, "{regularity:?}: {rungs:?}");
        }
    }
}

#[test]
fn methods_that_do_not_know_slits_refuse_them_at_their_place() {
    let text = crack(20, Regularity::Grid, true) + "[method]\nname = \"gfdm-hybrid\"\n";
    let error = Plan::new(&Scene::parse(&text, "crack.toml").expect("a scene")).expect_err("no slits there");
    assert!(
        error.to_string().contains("gfdm-hybrid") && error.to_string().contains("crack.toml:"),
        "{error}"
    );
}

/// Section 3.5: on the cylinder u is prescribed, and how its slope jumps is found. The paper has orders 1.45 and 0.72.
#[test]
fn u_prescribed_on_an_interface_gives_the_jump_of_its_slope() {
    let scene = |nodes| cylinder_prescribed(nodes, Regularity::Grid);
    let plan = Plan::new(&Scene::parse(&scene(20), "cylinder.toml").unwrap()).unwrap();
    assert_eq!(plan.method.name, MethodName::ParticleDifferenceExtended);
    let (mut values, mut jumps) = (Vec::new(), Vec::new());
    for nodes in [20, 40, 80, 160] {
        let report = solve_with(&scene(nodes), MethodName::Auto).unwrap().report;
        let errors = report.errors.expect("an exact solution");
        values.push((report.spacing, errors.linf));
        jumps.push((report.spacing, errors.jump_linf.expect("jumps are unknowns")));
    }
    assert!(observed(&values) >= 1.45, "{values:?}");
    assert!(observed(&jumps) >= 0.7, "{jumps:?}");
}

#[test]
fn other_methods_refuse_to_prescribe_u_on_an_interface() {
    let text = cylinder_prescribed(20, Regularity::Grid) + "\n[method]\nname = \"gfdm-hybrid\"\n";
    let error = Plan::new(&Scene::parse(&text, "cylinder.toml").unwrap()).expect_err("refused");
    assert!(error.is_input() && error.to_string().contains("particle-difference-extended"), "{error}");
}
