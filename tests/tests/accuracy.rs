//! Scenes that give an error to reach: it is reached, or the answer says how far it came.

use meshless::plan::{Plan, Stage};
use meshless::scene::{MethodName, Scene};
use meshless::{Error, Overrides, Silent, Solution, execute};
use meshless_tests::kraus;
use meshless_tests::sharp::circle_mode;

fn with_tolerance(text: &str, tolerance: f64) -> Scene {
    let mut scene = Scene::parse(text, "scene.toml").expect("a scene");
    Overrides { tolerance: Some(tolerance), ..Overrides::default() }.apply(&mut scene).expect("a tolerance");
    scene
}

fn solve(scene: &Scene) -> Result<Solution, Error> {
    execute(scene, &Plan::new(scene)?, &mut Silent)
}

/// The true error is what counts, not the estimate.
fn reaches(text: &str, tolerances: &[f64]) {
    for &tolerance in tolerances {
        let report = solve(&with_tolerance(text, tolerance)).expect("within reach").report;
        let error = report.errors.expect("an exact solution").l2;
        let accuracy = report.accuracy.expect("a tolerance");
        assert!(error <= tolerance, "{}: {error:.2e} for {tolerance:.0e}, {accuracy:?}", report.title);
        assert!(accuracy.rungs.iter().all(|r| r.seconds > 0.0));
        let last = accuracy.rungs.last().and_then(|r| r.estimate).expect("an estimate");
        let share = if accuracy.rungs.len() > 1 { 0.5 } else { 0.01 };
        assert!(last <= share * tolerance && report.estimate.l2 == Some(last));
    }
}

#[test]
fn tolerances_are_met_at_a_contrast_of_1e10() {
    reaches(&kraus::interior(1e10, kraus::SUPPORT * 0.15, 1), &[1e-2, 1e-4, 1e-8]);
    reaches(&circle_mode(1e10, 0.2, 1), &[1e-3, 1e-5]);
}

#[test]
fn a_loose_tolerance_is_met_by_the_method_that_keeps_the_maximum_principle() {
    let scene = with_tolerance(&kraus::interior(1e4, kraus::SUPPORT * 0.15, 1), 0.05);
    let plan = Plan::new(&scene).expect("a plan");
    assert_eq!(plan.method.name, MethodName::GfdmHybrid);
    let report = solve(&scene).expect("within reach").report;
    assert!(report.errors.expect("an exact solution").l2 <= 0.05);
}

#[test]
fn the_plan_chooses_order_by_tolerance_and_leaves_named_methods_alone() {
    let text = kraus::interior(1e4, kraus::SUPPORT * 0.15, 1);
    let plan = |tolerance: f64, method: Option<&str>| {
        let mut scene = with_tolerance(&text, tolerance);
        Overrides { method, ..Overrides::default() }.apply(&mut scene).expect("a method");
        Plan::new(&scene).expect("a plan")
    };
    let chosen = |tolerance| {
        let plan = plan(tolerance, None);
        assert!(plan.runs(Stage::Refinement) && plan.accuracy.is_some_and(|a| a.tolerance == tolerance));
        (plan.method.name, plan.method.params.order())
    };
    assert_eq!(chosen(1e-2), (MethodName::Sharp, 4));
    assert_eq!(chosen(1e-4), (MethodName::Sharp, 6));
    assert_eq!(chosen(1e-9), (MethodName::Sharp, 8));
    assert_eq!(plan(1e-9, Some("particle-difference")).method.name, MethodName::ParticleDifference);
    let steady = Plan::new(&Scene::parse(&text, "scene.toml").expect("a scene")).expect("a plan");
    assert!(!steady.runs(Stage::Refinement) && steady.accuracy.is_none());
}

#[test]
fn a_layer_thinner_than_the_first_cloud_is_refined_until_it_is_resolved() {
    let text = r#"title = "Thin coat"
dimension = 2
[domain]
box = { min = [0.0, 0.0], max = [1.0, 1.0] }
[[regions]]
name = "core"
level_set = "x - 0.5"
diffusivity = 1
[[regions]]
name = "coat"
level_set = "x - 0.52"
diffusivity = 0.01
[[regions]]
name = "outside"
diffusivity = 1
[[boundaries]]
face = "left"
dirichlet = 0
[[boundaries]]
face = "right"
dirichlet = 1
[[boundaries]]
face = "all"
neumann = 0
[[probes]]
at = [0.51, 0.5]
[accuracy]
tolerance = 1e-3
"#;
    let report = solve(&Scene::parse(text, "coat.toml").expect("a scene")).expect("within reach").report;
    // Resistances 0.5, 2 and 0.48 in series; half of the coat is passed at the probe.
    let expected = (0.5 + 1.0) / (0.5 + 2.0 + 0.48);
    let value = report.probes[0].value.expect("inside");
    assert!((value - expected).abs() <= 2e-3 * expected, "{value} for {expected}");
}

/// In time an order above two is one that `sharp` has: fits of particle differences of that degree grow.
#[test]
fn an_order_with_a_tolerance_in_time_is_that_of_the_sharp_method() {
    let text = kraus::interior(1e2, kraus::SUPPORT * 0.1, 1) + "\n[time]\nend = 1\n";
    let method = |order: Option<usize>| {
        let mut scene = with_tolerance(&text, 1e-4);
        scene.method.order = order;
        Plan::new(&scene).expect("a plan").method
    };
    assert_eq!(method(None).name, MethodName::ParticleDifference);
    let sharp = method(Some(4));
    assert_eq!((sharp.name, sharp.params.order()), (MethodName::Sharp, 4));
}

#[test]
fn a_tolerance_out_of_reach_says_how_far_it_came() {
    let text = kraus::interior(1e4, kraus::SUPPORT * 0.1, 1);
    let text = format!(
        "{text}\n[accuracy]\ntolerance = 1e-6\nmax_nodes = 3000\n\n[method]\nname = \"gfdm-hybrid\"\n"
    );
    let error = solve(&Scene::parse(&text, "scene.toml").expect("a scene")).expect_err("first order only");
    assert!(!error.is_input());
    let message = error.to_string();
    assert!(message.contains("was not reached") && message.contains("max_nodes"), "{message}");
    assert!(message.starts_with("scene.toml:"), "{message}");
}

#[test]
fn a_checkpoint_and_a_tolerance_do_not_go_together() {
    let scene = with_tolerance(&kraus::interior(1e4, kraus::SUPPORT * 0.1, 1), 1e-3);
    let plan = Plan::new(&scene).expect("a plan");
    let checkpoint =
        meshless::Checkpoint { path: "run.checkpoint".into(), every: std::time::Duration::from_secs(1) };
    let outcome = meshless::execute_from(&scene, &plan, Some(&checkpoint), &mut Silent);
    assert!(matches!(outcome, Err(Error::Checkpoint { .. })));
}

/// A film of 0.02 that most of the drop of u is across.
const FILM: &str = r#"
title = "Film"
dimension = 2
[domain]
box = { min = [0, 0], max = [1, 0.2] }
[points]
spacing = 0.05
[[regions]]
name = "film"
level_set = "abs(x - 0.5) - 0.01"
diffusivity = 1e-3
exact = "1 - (0.49 + 1000*(x - 0.49))/20.98"
[[regions]]
name = "rest"
diffusivity = 1
exact = "if(x < 0.5, 1 - x/20.98, (1 - x)/20.98)"
[[boundaries]]
face = "left"
dirichlet = 1
[[boundaries]]
face = "right"
dirichlet = 0
[[boundaries]]
face = "all"
neumann = 0
"#;

#[test]
fn a_layer_that_the_nodes_do_not_see_leaves_no_estimate() {
    for method in ["auto", "gfdm-hybrid", "gfdm-classical", "particle-difference"] {
        let mut scene = Scene::parse(FILM, "film.toml").expect("a scene");
        Overrides { method: Some(method), ..Overrides::default() }.apply(&mut scene).expect("a method");
        let report = solve(&scene).expect("a solution").report;
        assert!(report.errors.expect("an exact solution").l2 > 0.05, "{method}");
        let layer = report.thin_layer.expect("it is reported");
        assert!(!layer.seen && layer.region == "film" && (layer.thickness - 0.02).abs() < 1e-6);
        assert!(report.estimate.l2.is_none() && report.estimate.why_not.is_some(), "{method}");
    }
}

#[test]
fn a_tolerance_is_not_met_before_the_nodes_see_all_layers() {
    reaches(FILM, &[0.2, 0.05, 1e-4]);
}

/// u is 1e8 in a region that holds a source and conducts nothing, and about 2 around it: what leaks is small beside the one and all of the
/// other. The estimate of a region by itself says so.
#[test]
fn a_region_in_which_u_is_small_has_an_estimate_of_its_own() {
    let text = r#"
        title = "A soft box"
        dimension = 2
        domain = { box = { min = [0, 0], max = [1, 1] } }
        points = { spacing = 0.05, layout = "jittered" }
        regions = [
            { name = "soft", box = { min = [0.313, 0.35], max = [0.59, 0.623] }, diffusivity = 1e-10, source = 10 },
            { name = "plate", diffusivity = 1 },
        ]
        boundaries = [{ face = "all", dirichlet = "1 + x" }]
        probes = [{ at = [0.71, 0.5] }]
    "#;
    let report = solve(&Scene::parse(text, "soft.toml").expect("a scene")).expect("a solution").report;
    let [soft, plate] = ["soft", "plate"].map(|name| report.estimate.regions[name]);
    let whole = report.estimate.l2.expect("an estimate");
    // Beside the box u is near 1.8: what a probe has more is error.
    let off = (report.probes[0].value.expect("inside") - 1.8).abs() / 1.8;
    assert!((0.5..=1.0).contains(&(soft / whole)), "{soft:e} {whole:e}");
    assert!(whole < 0.05 && (off < 0.2 || plate > off.min(0.5)), "{whole:e} {plate:e} {off:e}");
    let alone =
        solve(&Scene::parse(&kraus::interior(1e4, kraus::SUPPORT * 0.15, 1), "a.toml").expect("a scene"));
    let estimate = alone.expect("a solution").report.estimate;
    assert!(estimate.regions.len() == 2 && estimate.regions.values().all(|e| e.is_finite()));
}

/// A quarter cell of a square array of cylinders, fraction 0.7, contrast 1e10: the effective conductivity is 7.432709328738
/// (`../references/natural.csv`), of which half a cell with half the difference of potential has half.
fn quarter_cell(accuracy: &str) -> Scene {
    let text = format!(
        "title = \"Quarter cell\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [0.5, 0.5] }}\n[points]\n\
         [[regions]]\nname = \"fibre\"\nsphere = {{ center = [0, 0], radius = 0.472034871941 }}\ndiffusivity = 1e10\n\
         [[regions]]\nname = \"matrix\"\ndiffusivity = 1\n[[boundaries]]\nface = \"left\"\ndirichlet = 0\n\
         [[boundaries]]\nface = \"right\"\ndirichlet = 0.5\n[[boundaries]]\nface = \"all\"\nneumann = 0\n\
         [accuracy]\n{accuracy}\n"
    );
    Scene::parse(&text, "cell.toml").expect("a scene")
}

#[test]
fn tolerances_may_be_about_fluxes() {
    for tolerance in [1e-2, 1e-5] {
        let scene = quarter_cell(&format!("tolerance = {tolerance:e}\nof = \"fluxes\""));
        let report = solve(&scene).expect("within reach").report;
        let fluxes = report.fluxes.expect("a tolerance is about them");
        for (flux, exact) in fluxes.boundaries.iter().zip([-3.716_354_664, 3.716_354_664, 0.0]) {
            let estimate = flux.estimate.expect("an estimate");
            let error = (flux.flux - exact).abs();
            assert!(error <= tolerance * 3.72, "{tolerance:e}: {error:e}, {fluxes:?}");
            assert!(error <= 10.0 * estimate + 1e-7, "{error:e}, {fluxes:?}");
        }
        let accuracy = report.accuracy.expect("a tolerance");
        assert!(
            accuracy.of == "fluxes"
                && accuracy.rungs.last().is_some_and(|r| r.estimate <= Some(0.5 * tolerance))
        );
    }
}

/// ISO 10211, case 1, where two prescribed values meet: by its series u is 9.6581607 at the first point of the table.
#[test]
fn tolerances_may_be_about_probes() {
    let text = |of: &str| {
        format!(
            "title = \"Column\"\ndimension = 2\n[domain]\nbox = {{ min = [0, 0], max = [4, 8] }}\n[points]\n\
             [[regions]]\nname = \"all\"\ndiffusivity = 1\n[[boundaries]]\nface = \"top\"\ndirichlet = 20\n\
             [[boundaries]]\nface = \"right\"\nneumann = 0\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n\
             {of}[accuracy]\ntolerance = 1e-4\nof = \"probes\"\n"
        )
    };
    let scene = Scene::parse(&text("[[probes]]\nat = [1, 7]\n"), "column.toml").expect("a scene");
    let report = solve(&scene).expect("within reach").report;
    let probe = &report.probes[0];
    let error = (probe.value.expect("inside") - column(1.0, 7.0)).abs();
    assert!(error <= 2e-3 && probe.estimate.is_some_and(|e| error <= 3.0 * e), "{error:e} {probe:?}");
    let error = Scene::parse(&text(""), "column.toml").expect_err("no probes").to_string();
    assert!(error.contains("accuracy.of") && error.contains("[[probes]]"), "{error}");
}

/// u in a column of width 8 and height 8, 20 at the top and 0 on the other sides: the series in the sines across.
fn column(x: f64, y: f64) -> f64 {
    let pi = std::f64::consts::PI;
    let term = |k: u32| {
        let wave = f64::from(2 * k + 1) * pi / 8.0;
        // sinh(a y) / sinh(8 a) without large numbers.
        let height = ((wave * (y - 8.0)).exp() - (-wave * (y + 8.0)).exp()) / (1.0 - (-16.0 * wave).exp());
        80.0 / (f64::from(2 * k + 1) * pi) * (wave * x).sin() * height
    };
    (0..400).map(term).sum()
}

#[test]
fn an_estimate_can_be_left_out() {
    let text = kraus::interior(10.0, kraus::SUPPORT * 0.15, 1) + "[output]\nestimate = false\n";
    let scene = Scene::parse(&text, "scene.toml").expect("a scene");
    let plan = Plan::new(&scene).expect("a plan");
    assert!(!plan.runs(Stage::Estimate) && plan.predicted.estimate_seconds == 0.0);
    assert!(plan.skipped.iter().any(|skipped| skipped.what == "error estimate"), "{plan}");
    let report = execute(&scene, &plan, &mut Silent).expect("it is solved").report;
    assert!(
        report.estimate.l2.is_none()
            && report.estimate.why_not.is_some()
            && report.extrema.estimate.is_none()
    );
    let error =
        Scene::parse(&(text + "[accuracy]\ntolerance = 1e-3\n"), "scene.toml").expect_err("a contradiction");
    assert!(error.to_string().contains("output.estimate"), "{error}");
}
