//! The sharp method: orders, contrasts, conditions.

use meshless::interfaces::MethodError;
use meshless::plan::{Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::sparse::SolverKind;
use meshless::{Error, Silent, Solution, execute};
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
fn order_two_is_of_second_order_at_any_contrast() {
    for contrast in [1e2, 1e10] {
        let ladder: Vec<(f64, f64)> = [0.2, 0.1, 0.05]
            .map(|h| (h, errors(&kraus::interior(contrast, kraus::SUPPORT * h, 1), 2)[0]))
            .to_vec();
        assert!(observed(&ladder) > 1.8 && ladder[2].1 < 1e-4, "{contrast:e}: {ladder:?}");
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

/// A linear solution in materials of 3 and 1: what the flux jumps by is constant on each side of a region, and another on the next.
#[test]
fn jumps_of_the_flux_may_differ_from_side_to_side() {
    let square = "box = { min = [0.313, 0.291], max = [0.717, 0.688] }";
    let sides =
        "if(max(0.313 - x, x - 0.717) > max(0.291 - y, y - 0.688), if(x < 0.5, 2, -2), if(y < 0.5, 4, -4))";
    let triangle = "polygon = [[0.2, 0.3], [0.8, 0.3], [0.2, 0.6]]";
    // Normals -y, -x and (1, 2)/sqrt(5), told from the lines through two sides.
    let edges = "if(y - 0.3 < min(x - 0.2, (1.4 - x - 2*y)/sqrt(5)), 4, if(x - 0.2 < (1.4 - x - 2*y)/sqrt(5), 2, -2*sqrt(5)))";
    let lens = "intersection = [{ sphere = { center = [0.4, 0.5], radius = 0.3 } }, { half_space = { point = [0.5, 0.5], normal = [1, 0.2] } }]";
    let arcs = "if(x - 0.5 + 0.2*(y - 0.5) > 1.01*(sqrt((x - 0.4)^2 + (y - 0.5)^2) - 0.3), -2.8/sqrt(1.04), -2*(x - 0.4 + 2*(y - 0.5))/0.3)";
    for (shape, jump) in [(square, sides), (triangle, edges), (lens, arcs)] {
        for layout in ["irregular", "grid", "scattered"] {
            let text = format!(
                "title = \"Sides\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n[points]\nspacing = 0.05\n\
                 layout = \"{layout}\"\n[[regions]]\nname = \"in\"\n{shape}\ndiffusivity = 3\nexact = \"x + 2*y\"\n\
                 [[regions]]\nname = \"out\"\ndiffusivity = 1\nexact = \"x + 2*y\"\n\
                 [[interfaces]]\nbetween = [\"in\", \"out\"]\nflux_jump = \"{jump}\"\n\
                 [[boundaries]]\nface = \"all\"\ndirichlet = \"x + 2*y\"\n"
            );
            let [l2, _, gradient] = errors(&text, 4);
            assert!(l2 < 1e-12 && gradient < 1e-10, "{layout}, {shape}: {l2} {gradient}");
        }
    }
    let cylinder = "title = \"Pin\"\ndimension = 3\n[domain]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\n[points]\nspacing = 0.12\n\
        [[regions]]\nname = \"in\"\ncylinder = { point = [0.5, 0.5, 0.5], axis = [0, 0, 1], radius = 0.27, length = 0.5 }\n\
        diffusivity = 3\nexact = \"x + 2*z\"\n[[regions]]\nname = \"out\"\ndiffusivity = 1\nexact = \"x + 2*z\"\n\
        [[interfaces]]\nbetween = [\"in\", \"out\"]\n\
        flux_jump = \"if(abs(z - 0.5) - 0.25 > sqrt((x - 0.5)^2 + (y - 0.5)^2) - 0.27, if(z < 0.5, 4, -4), -2*(x - 0.5)/0.27)\"\n\
        [[boundaries]]\nface = \"all\"\ndirichlet = \"x + 2*z\"\n";
    let [l2, ..] = errors(cylinder, 4);
    assert!(l2 < 1e-11, "{l2}");
}

/// Data that say on which side of a corner they are by the position, for a face of several sides and for all faces at once.
#[test]
fn fluxes_may_differ_from_side_to_side_of_the_boundary() {
    let head = "[points]\nspacing = 0.05\n[[regions]]\nname = \"plate\"\ndiffusivity = 2\nexact = \"x + 2*y\"\n\
                [[boundaries]]\nface = \"all\"\nwhere = \"y < 1e-9\"\ndirichlet = \"x\"\n";
    let triangle = format!(
        "title = \"Triangle\"\ndimension = 2\n[domain]\npolygon = [[0, 0], [1, 0], [0.5, 1]]\n{head}\
         [[boundaries]]\nface = \"all\"\nneumann = \"if(x < 0.5, 0, 4/sqrt(5))\"\n"
    );
    let plate = |rest: &str| {
        format!(
            "title = \"Plate\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [1, 1] }}\n{head}{rest}"
        )
    };
    let one = plate("[[boundaries]]\nface = \"all\"\nflux = \"if(x > 1 - 1e-9, 2, if(x < 1e-9, -2, 4))\"\n");
    let each = plate(
        "[[boundaries]]\nface = \"all\"\nwhere = \"x > 1 - 1e-9\"\nneumann = 1\n\
         [[boundaries]]\nface = \"all\"\nwhere = \"x < 1e-9\"\nneumann = -1\n\
         [[boundaries]]\nface = \"all\"\nrobin = { a = 1, b = 3, g = \"x + 14\" }\n",
    );
    for text in [triangle, one, each] {
        for method in ["sharp", "gfdm-classical"] {
            let scene = text.clone() + &format!("[method]\nname = \"{method}\"\n");
            let solution =
                solve_scene(&Scene::parse(&scene, "sides.toml").expect("a scene")).expect("it is solved");
            let found = solution.report.errors.expect("an exact solution").l2;
            assert!(found < 1e-11, "{method}: {found}\n{text}");
        }
    }
}

/// The corner of a plate is cut off by an inclusion nearer to it than the next node, and u is prescribed there.
#[test]
fn a_prescribed_value_that_stands_alone_is_no_gap() {
    let text = "title = \"Corner\"\ndimension = 2\n[domain]\nbox = { min = [0, 0], max = [1, 1] }\n[points]\nspacing = 0.05\n\
                [[regions]]\nname = \"in\"\nhalf_space = { point = [0.015, 0.015], normal = [-1, -1] }\ndiffusivity = 3\nexact = \"x + y\"\n\
                [[regions]]\nname = \"out\"\ndiffusivity = 1\nexact = \"3*x + 3*y - 0.06\"\n\
                [[boundaries]]\nface = \"all\"\ndirichlet = \"if(x + y < 0.03, 3*x + 3*y - 0.06, x + y)\"\n";
    let [l2, ..] = errors(text, 4);
    assert!(l2 < 1e-11, "{l2}");
}

#[test]
fn a_ball_in_three_dimensions() {
    let [l2, ..] = errors(&ball(100.0, 0.1, 0.25, Regularity::Irregular(1)), 4);
    assert!(l2 < 1e-3, "{l2}");
}

#[test]
fn what_it_cannot_do_is_said() {
    let error = solve(&ball(100.0, 0.1, 0.25, Regularity::Irregular(1)), 10).expect_err("too high an order");
    assert!(error.to_string().contains("no order 10"), "{error}");
}

/// A film of a fifth of the spacing between a core and what surrounds it.
fn film(spacing: f64, method: &str) -> String {
    let ring = |name: &str, radius: &str, eta: &str, exact: &str| {
        let shape = if radius.is_empty() {
            String::new()
        } else {
            format!("sphere = {{ center = [0.0, 0.0], radius = {radius} }}\n")
        };
        format!(
            "[[regions]]\nname = \"{name}\"\n{shape}diffusivity = \"{eta}\"\nsource = \"4 + 0*x\"\nexact = \"{exact}\"\n"
        )
    };
    // u = c - r^2 / eta in every ring; the constants make it continuous.
    let (inner, outer) = (0.5_f64, 0.51_f64);
    let film = outer * outer * (1e-3 - 1.0);
    let core = film + inner * inner * (1.0 - 1e-3);
    format!(
        "title = \"Film\"\ndimension = 2\n[domain]\nbox = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = 1\n[method]\n{method}\n"
    ) + &ring("core", "0.5", "1", &format!("{core:e} - (x^2 + y^2)"))
        + &ring("film", "0.51", "1e3", &format!("{film:e} - (x^2 + y^2)/1e3"))
        + &ring("outside", "", "1", "-(x^2 + y^2)")
        + "[[boundaries]]\nface = \"all\"\ndirichlet = \"-(x^2 + y^2)\"\n"
}

#[test]
fn a_film_too_thin_for_the_fits_is_an_error_that_says_which_spacing_resolves_it() {
    let sharp = "name = \"sharp\"\norder = 6";
    let scene = Scene::parse(&film(0.05, sharp), "film.toml").expect("a scene");
    let error = solve_scene(&scene).expect_err("the film has too few nodes");
    let Error::Method(MethodError::Unresolved { position, spacing, .. }) = &error else { panic!("{error}") };
    let radius = position[0].hypot(position[1]);
    assert!((0.5..=0.51).contains(&radius), "{error}");
    assert!(error.to_string().contains("take a spacing of about"), "{error}");
    // A tenth of the spacing everywhere would be many nodes: a ring of it will do.
    let graded = film(0.05, sharp).replace(
        "spacing = 0.05",
        &format!("spacing = \"{spacing:?} + 0.3*max(0, abs(sqrt(x^2 + y^2) - 0.505) - 0.008)\""),
    );
    let scene = Scene::parse(&graded, "film.toml").expect("a scene");
    let errors = solve_scene(&scene).expect("resolved").report.errors.expect("exact");
    assert!(errors.l2 < 1e-7, "{errors:?}");
}

#[test]
fn where_the_plan_chose_the_method_it_falls_back_on_the_conservative_one() {
    let named = Scene::parse(&film(0.05, "name = \"sharp\"\norder = 6"), "film.toml").expect("a scene");
    assert_eq!(Plan::new(&named).expect("a plan").fallback, None);
    let free = Scene::parse(&film(0.05, "name = \"auto\""), "film.toml").expect("a scene");
    let sharp = Plan::new(&named).expect("a plan");
    let mut plan = Plan::new(&free).expect("a plan");
    plan.method = sharp.method;
    plan.fallback = Some(MethodName::GfdmHybrid);
    plan.stages.retain(|stage| *stage != Stage::Estimate);
    let report = execute(&free, &plan, &mut Silent).expect("the conservative method solves it").report;
    assert_eq!(report.method, "gfdm-hybrid");
    assert!(report.nodes.conservative > 0);
    let why = report.fallback.expect("why");
    assert!(why.contains("in place of \"sharp\"") && why.contains("too thin"), "{why}");
    // Nothing that the plan leaves out comes back.
    assert_eq!(report.estimate.l2, None);
    assert!(report.errors.expect("exact").l2 < 1e-1);
}

#[test]
fn a_solver_that_gives_up_is_a_reason_to_fall_back_too() {
    let scene =
        Scene::parse(&kraus::interior(1e2, kraus::SUPPORT * 0.1, 1), "gallery.toml").expect("a scene");
    let mut plan = Plan::new(&scene).expect("a plan");
    assert_eq!((plan.method.name, plan.fallback), (MethodName::Sharp, Some(MethodName::GfdmHybrid)));
    plan.solver.kind = SolverKind::Gmres { restart: 2 };
    plan.solver.max_iterations = 2;
    let report = execute(&scene, &plan, &mut Silent).expect("the conservative method solves it").report;
    assert_eq!(report.method, "gfdm-hybrid");
    let why = report.fallback.expect("why");
    assert!(why.contains("in place of \"sharp\"") && why.contains("residual"), "{why}");
    plan.fallback = None;
    assert!(execute(&scene, &plan, &mut Silent).is_err());
}
