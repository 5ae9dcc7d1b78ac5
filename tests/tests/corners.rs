//! Corners at which the solution is singular: what is known of them, and what is said where no functions serve them.

use meshless::plan::{Effect, Plan, Stage};
use meshless::report::Report;
use meshless::scene::Scene;
use meshless::{Silent, execute};

fn scene(text: &str) -> Scene {
    Scene::parse(text, "corners.toml").expect("the scene is right")
}

fn report(text: &str) -> Report {
    let scene = scene(text);
    let plan = Plan::new(&scene).expect("a plan");
    execute(&scene, &plan, &mut Silent).expect("the scene can be solved").report
}

/// A chip in a plate: 3.6 is made in it.
fn chip(eta: f64, spacing: f64, order: usize) -> String {
    format!(
        r#"
title = "Corner"
dimension = 2
[domain]
box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}
[points]
spacing = {spacing}
[[regions]]
name = "chip"
box = {{ min = [-0.3, -0.3], max = [0.3, 0.3] }}
diffusivity = {eta:e}
source = 10
[[regions]]
name = "plate"
diffusivity = 1
[[boundaries]]
face = "all"
dirichlet = 0
[method]
order = {order}
[output]
fluxes = true
"#
    )
}

#[test]
fn what_a_chip_makes_leaves_the_plate() {
    for (eta, bound) in [(1e-10, 1e-3), (1e-4, 1e-3), (1e-2, 1e-3), (10.0, 1e-4), (1e4, 1e-4), (1e10, 1e-4)] {
        let report = report(&chip(eta, 0.05, 4));
        let flux = report.fluxes.expect("asked for").boundaries[0].flux;
        assert!((flux / -3.6 - 1.0).abs() < bound, "{eta:e}: {flux}");
        assert_eq!(report.corners.iter().filter(|corner| corner.served).count(), 4, "{eta:e}");
    }
    let flux = report(&chip(10.0, 0.025, 6)).fluxes.expect("asked for").boundaries[0].flux;
    assert!((flux / -3.6 - 1.0).abs() < 1e-6, "{flux}");
}

/// The L-shape with `r^(2/3) sin(2/3 theta)` on its boundary.
fn l_shape(order: usize) -> String {
    let angle = "if(atan2(y,x)<-1e-12,atan2(y,x)+2*pi,atan2(y,x))";
    let u = format!("if(x^2+y^2<1e-24,0,(x^2+y^2)^(1/3)*sin(2/3*{angle}))");
    format!(
        r#"
title = "Corner"
dimension = 2
[domain]
polygon = [[0,0],[1,0],[1,1],[-1,1],[-1,-1],[0,-1]]
[points]
spacing = 0.05
[[regions]]
name = "plate"
diffusivity = 1
exact = "{u}"
[[boundaries]]
face = "all"
dirichlet = "{u}"
[method]
name = "sharp"
order = {order}
"#
    )
}

#[test]
fn a_reentrant_corner_costs_no_digits() {
    for (order, bound) in [(4, 1e-6), (6, 1e-8), (8, 1e-9)] {
        let report = report(&l_shape(order));
        let error = report.errors.expect("exact").l2;
        assert!(error < bound && report.unknowns < 1500, "order {order}: {error:e}");
        assert!(report.estimate.l2.is_some_and(|estimate| 3.0 * estimate > error));
        let corner = report.corners.iter().find(|c| c.at == [0.0, 0.0]).expect("the re-entrant one");
        assert!(corner.served && (corner.exponent - 2.0 / 3.0).abs() < 1e-9);
    }
}

/// Kellogg's problem: `u = r^0.1 mu(theta)`.
fn kellogg(spacing: f64) -> String {
    let angle = "if(atan2(y,x)<0,atan2(y,x)+2*pi,atan2(y,x))";
    let (sigma, rho) = ("(-14.92256510455152)", "(pi/4)");
    let mu = [
        format!("cos((pi/2-{sigma})*0.1)*cos(({angle}-pi/2+{rho})*0.1)"),
        format!("cos({rho}*0.1)*cos(({angle}-pi+{sigma})*0.1)"),
        format!("cos({sigma}*0.1)*cos(({angle}-pi-{rho})*0.1)"),
        format!("cos((pi/2-{rho})*0.1)*cos(({angle}-3*pi/2-{sigma})*0.1)"),
    ];
    let u =
        format!("(x^2+y^2)^0.05*if(x>=0, if(y>=0, {}, {}), if(y>=0, {}, {}))", mu[0], mu[3], mu[1], mu[2]);
    format!(
        r#"
title = "Corner"
dimension = 2
[domain]
box = {{ min = [-1,-1], max = [1,1] }}
[points]
spacing = {spacing}
[[regions]]
name = "stiff"
union = [{{ box = {{ min = [0,0], max = [1,1] }} }}, {{ box = {{ min = [-1,-1], max = [0,0] }} }}]
diffusivity = 161.4476387975881
exact = "{u}"
[[regions]]
name = "soft"
diffusivity = 1
exact = "{u}"
[[boundaries]]
face = "all"
dirichlet = "{u}"
"#
    )
}

#[test]
fn four_quadrants_meet_in_a_point() {
    let report = report(&kellogg(0.05));
    let error = report.errors.expect("exact").l2;
    assert!(error < 1e-6, "{error:e}");
    let corner = report.corners.iter().find(|c| c.at == [0.0, 0.0]).expect("the middle");
    assert!(corner.served && (corner.exponent - 0.1).abs() < 1e-9, "{}", corner.exponent);
}

#[test]
fn two_prescribed_values_that_meet_are_joined_by_the_angle() {
    // ISO 10211 case 1: u = sum of 80/((2k+1) pi) sin(...) sinh(...)/sinh(...) over odd modes; 9.6582 at a quarter.
    let text = r#"
title = "Corner"
dimension = 2
[domain]
box = { min = [0.0, 0.0], max = [4.0, 8.0] }
[points]
spacing = 0.2
[[regions]]
name = "column"
diffusivity = 1
[[boundaries]]
face = "top"
dirichlet = 20
[[boundaries]]
face = "right"
neumann = 0
[[boundaries]]
face = "all"
dirichlet = 0
[[probes]]
at = [1.0, 7.0]
"#;
    let series = |x: f64, y: f64| -> f64 {
        let mode = |k: u32| {
            let m = f64::from(2 * k + 1) * std::f64::consts::PI / 8.0;
            // sinh(m y) / sinh(8 m) without overflow.
            let ratio = (m * (y - 8.0)).exp() * (1.0 - (-2.0 * m * y).exp()) / (1.0 - (-16.0 * m).exp());
            80.0 / (f64::from(2 * k + 1) * std::f64::consts::PI) * (m * x).sin() * ratio
        };
        (0..200).map(mode).sum()
    };
    let report = report(text);
    let found = report.probes[0].value.expect("inside");
    assert!((found - series(1.0, 7.0)).abs() < 1e-3, "{found} {}", series(1.0, 7.0));
    assert!(report.corners.iter().any(|corner| corner.exponent == 0.0 && corner.served));
}

#[test]
fn scenes_without_singular_corners_have_no_corner_functions() {
    let text = chip(10.0, 0.1, 4).replace(
        "box = { min = [-0.3, -0.3], max = [0.3, 0.3] }",
        "sphere = { center = [0, 0], radius = 0.3 }",
    );
    let text = text.replace("dirichlet = 0", "dirichlet = \"x\"");
    let plan = Plan::new(&scene(&text)).expect("a plan");
    assert!(!plan.runs(Stage::CornerFunctions));
    assert!(!plan.effects.iter().any(|effect| matches!(effect, Effect::Corners { .. })));
    assert!(report(&text).corners.is_empty());
    let plan = Plan::new(&scene(&chip(10.0, 0.1, 4))).expect("a plan");
    assert!(plan.runs(Stage::CornerFunctions));
    let exponent = plan.effects.iter().find_map(|effect| match effect {
        Effect::Corners { count: 4, exponent } => Some(*exponent),
        _ => None,
    });
    assert!(exponent.is_some_and(|exponent| (exponent - 0.731_691_8).abs() < 1e-6));
}

#[test]
fn corners_that_nothing_serves_are_named_and_raise_the_estimate() {
    // Other methods have no functions.
    let text = chip(10.0, 0.1, 4)
        .replace("[method]\norder = 4", "[method]\nname = \"gfdm-hybrid\"")
        .replace("fluxes = true", "");
    let probe = "[[probes]]\nat = [0.05, 0.1]\n";
    let found = report(&(text + probe));
    assert_eq!(found.corners.iter().filter(|corner| !corner.served && corner.exponent < 1.0).count(), 4);
    let value = |report: &Report| report.probes[0].value.expect("inside");
    let right = value(&report(&(chip(10.0, 0.05, 6) + probe)));
    let error = (value(&found) / right - 1.0).abs();
    assert!(found.estimate.l2.is_some_and(|estimate| estimate > 0.3 * error), "{error} {:?}", found.estimate);
    // Edges in space.
    let found = report(&meshless_tests::natural::desk::heated_cube(10.0, 0.25, 1));
    assert_eq!(found.corners.len(), 12);
    assert!(found.corners.iter().all(|edge| !edge.served && (edge.exponent - 0.731_691_8).abs() < 1e-4));
}

/// An eighth of a cube with a source in a larger one: three edges that end in one vertex, of which there is no closed form. A few nodes more
/// round it, a third of the error.
#[test]
fn clouds_that_adapt_are_finer_round_the_vertices_of_a_cube() {
    let text = |spacing: f64, adapt: bool| {
        format!(
            "title = \"Eighth\"\ndimension = 3\n[domain]\nbox = {{ min = [0, 0, 0], max = [1, 1, 1] }}\n\
             [points]\nspacing = {spacing}\nadapt = {adapt}\n[[regions]]\nname = \"cube\"\n\
             box = {{ min = [-0.4, -0.4, -0.4], max = [0.4, 0.4, 0.4] }}\ndiffusivity = 10\nsource = 10\n\
             [[regions]]\nname = \"plate\"\ndiffusivity = 1\n\
             [[boundaries]]\nface = \"left\"\nneumann = 0\n[[boundaries]]\nface = \"bottom\"\nneumann = 0\n\
             [[boundaries]]\nface = \"back\"\nneumann = 0\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n\
             [[probes]]\nat = [0.1, 0.05, 0.2]\n"
        )
    };
    // By hp-FEM, `tests/references/space.py`.
    let exact = 0.465_187_8;
    let [even, adapted] = [false, true].map(|adapt| report(&text(0.1, adapt)));
    let error = |report: &Report| (report.probes[0].value.expect("inside") / exact - 1.0).abs();
    assert!(adapted.unknowns < even.unknowns * 13 / 10, "{} {}", adapted.unknowns, even.unknowns);
    assert!(error(&adapted) < 4e-3 && error(&even) > 6e-3, "{} {}", error(&adapted), error(&even));
    let estimate = adapted.estimate.l2.expect("an estimate");
    assert!(estimate > 0.3 * error(&adapted), "{estimate}");
}

/// What two circles have in common, that meet in the middle at half an angle of `half` from the axis and again at x = 1.5, outside.
fn lens(half: f64) -> String {
    let (p, radius) = (1.5, 0.75 / half.sin());
    let away = 0.5 * p / half.tan();
    let disc = |y: f64| format!("{{ sphere = {{ center = [{}, {y}], radius = {radius} }} }}", 0.5 * p);
    format!("intersection = [{}, {}]", disc(away), disc(-away))
}

/// `Re` and `Im` of `z / (1 - z / 1.5)`, which makes both circles straight: its size, and its angle from the axis.
fn straightened() -> [String; 2] {
    let below = "((1-x/1.5)^2+(y/1.5)^2)";
    let (re, im) = (format!("(x-(x^2+y^2)/1.5)/{below}"), format!("y/{below}"));
    [format!("sqrt(({re})^2+({im})^2)"), format!("atan2(abs({im}),{re})")]
}

/// A hole with a tip that sticks out of the wall, u prescribed: `w^(2/3)` with a w that makes the hole's sides straight.
#[test]
fn curved_reentrant_corners_have_functions() {
    let half = std::f64::consts::FRAC_PI_4;
    let [size, angle] = straightened();
    let u = format!("if(x^2+y^2<1e-24,0,({size})^(2/3)*cos(2/3*(pi-{angle})))");
    let text = |spacing: f64, order: usize| {
        format!(
            "title = \"Curved corner\"\ndimension = 2\n[domain]\n\
             difference = [{{ box = {{ min = [-1, -1], max = [1, 1] }} }}, {{ {} }}]\n[points]\nspacing = {spacing}\n\
             [[regions]]\nname = \"plate\"\ndiffusivity = 1\nexact = \"{u}\"\n\
             [[boundaries]]\nface = \"all\"\ndirichlet = \"{u}\"\n[method]\nname = \"sharp\"\norder = {order}\n",
            lens(half)
        )
    };
    for (order, bound) in [(4, 1e-5), (6, 1e-7)] {
        let report = report(&text(0.05, order));
        let corner = report.corners.iter().find(|c| (c.exponent - 2.0 / 3.0).abs() < 1e-6).expect("there");
        assert!(corner.served && corner.at[0].hypot(corner.at[1]) < 1e-9, "{corner:?}");
        let error = report.errors.expect("exact").l2;
        assert!(error < bound, "order {order}: {error:e}");
    }
}

/// The tip of a lens of another material: `A cos(lambda t)` in it, `cos(lambda (pi - t))` round it, in the plane in which it is straight.
#[test]
fn curved_tips_of_inclusions_have_functions() {
    let half = 0.9_f64;
    for eta in [1e-6, 0.1, 10.0, 1e6] {
        // Fluxes match: eta tan(lambda half) + tan(lambda (pi - half)) = 0, times both cosines.
        let mismatch = |l: f64| {
            let (inner, outer) = ((l * half).sin_cos(), (l * (std::f64::consts::PI - half)).sin_cos());
            eta * inner.0 * outer.1 + outer.0 * inner.1
        };
        let (mut low, mut high) = if eta > 1.0 { (0.5, 1.0) } else { (1.0, 1.9) };
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if mismatch(middle).signum() == mismatch(low).signum() { low = middle } else { high = middle }
        }
        let power = low;
        let factor = (power * (std::f64::consts::PI - half)).cos() / (power * half).cos();
        let [size, angle] = straightened();
        let u = |of_angle: String| format!("if(x^2+y^2<1e-24,0,({size})^{power:?}*{of_angle})");
        let inside = u(format!("{factor:?}*cos({power:?}*{angle})"));
        let outside = u(format!("cos({power:?}*(pi-{angle}))"));
        let text = |spacing: f64, order: usize| {
            format!(
                "title = \"Curved tip\"\ndimension = 2\n[domain]\nbox = {{ min = [-1, -1], max = [1, 1] }}\n\
                 [points]\nspacing = {spacing}\n[[regions]]\nname = \"lens\"\n{}\ndiffusivity = {eta:e}\n\
                 exact = \"{inside}\"\n[[regions]]\nname = \"plate\"\ndiffusivity = 1\nexact = \"{outside}\"\n\
                 [[boundaries]]\nface = \"all\"\ndirichlet = \"if({angle}<{half},{inside},{outside})\"\n\
                 [method]\nname = \"sharp\"\norder = {order}\n",
                lens(half)
            )
        };
        for (order, bound) in [(4, 1e-4), (6, 1e-6)] {
            let report = report(&text(0.05, order));
            let corner = report.corners.iter().find(|c| c.at[0].hypot(c.at[1]) < 1e-9).expect("there");
            // There may be weaker ones that are odd.
            assert!(corner.served && corner.exponent < power + 1e-6, "{corner:?} {power}");
            let error = report.errors.expect("exact").l2;
            assert!(error < bound, "{eta:e}, order {order}: {error:e}");
        }
    }
}
