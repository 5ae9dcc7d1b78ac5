//! Scenes in free space, from text to report.

use meshless::plan::{Plan, Stage};
use meshless::report::Report;
use meshless::scene::Scene;
use meshless::{Error, Silent, execute};

const CHARGE: &str = include_str!("../../examples/charge.toml");

fn solve(scene: &Scene) -> Report {
    let plan = Plan::new(scene).expect("a plan");
    execute(scene, &plan, &mut Silent).expect("a solution").report
}

fn parse(text: &str) -> Scene {
    Scene::parse(text, "scene.toml").expect("a scene")
}

fn relative(report: &Report) -> f64 {
    report.errors.as_ref().expect("an exact solution").l2
}

#[test]
fn a_charge_has_its_potential_and_a_plan_without_a_system() {
    let scene = parse(CHARGE);
    let plan = Plan::new(&scene).expect("a plan");
    assert_eq!(plan.solver_name(), "fft");
    assert!(plan.runs(Stage::Source) && !plan.runs(Stage::Neighbors) && !plan.runs(Stage::Assembly));
    assert_eq!(plan.predicted.unknowns, 110.0 * 110.0);
    let report = solve(&scene);
    let error = relative(&report);
    assert!(error < 1e-9, "{error:e}");
    assert!(report.errors.as_ref().is_some_and(|e| e.gradient_linf < 1e-8));
    // The estimate is about the error, and no less than a tenth of it.
    let estimate = report.estimate.l2.expect("an estimate");
    assert!(estimate < 1e-7 && estimate > 0.1 * error, "{estimate:e} for {error:e}");
    // At the centre, which is no point of the mesh, and outside of the box.
    let value = |k: usize| report.probes[k].value.expect("a value");
    assert!((value(0) / (-10.0_f64).exp() - 1.0).abs() < 1e-9, "{}", value(0));
    assert!(value(1).abs() < 1e-9 * value(0), "{:e}", value(1));
}

#[test]
fn orders_kernels_and_tolerances_are_obeyed() {
    let with = |section: &str| relative(&solve(&parse(&format!("{CHARGE}\n{section}"))));
    let [second, sixth] =
        ["order = 2", "order = 6"].map(|o| with(&format!("[method]\nname = \"free-space\"\n{o}")));
    assert!(second > 1e-3 && sixth < 1e-2 * second, "{second:e} {sixth:e}");
    for kernel in ["spectral", "truncated"] {
        assert!(with(&format!("[method]\nkernel = \"{kernel}\"\n")) < 1e-9);
    }
    let wider = with("[method]\norder = 6\nsigma = 2\n");
    assert!(sixth < 0.2 * wider);
    let coarse = CHARGE.replace("spacing = 0.02", "spacing = 0.2");
    for tolerance in [1e-3, 1e-7] {
        let report = solve(&parse(&format!("{coarse}\n[accuracy]\ntolerance = {tolerance:e}\n")));
        assert!(relative(&report) < 2.0 * tolerance, "{tolerance:e}: {:e}", relative(&report));
    }
}

#[test]
fn the_diffusivity_divides_and_a_cut_source_has_no_estimate() {
    let twice = solve(&parse(&CHARGE.replace("diffusivity = 1", "diffusivity = 2")));
    let once = solve(&parse(CHARGE));
    let value = |r: &Report| r.probes[0].value.expect("a value");
    assert!((value(&twice) / value(&once) - 0.5).abs() < 1e-12);
    let cut = solve(&parse(&CHARGE.replace("-1.1, -1.1", "-0.3, -1.1")));
    assert!(cut.estimate.l2.is_none());
    assert!(cut.estimate.why_not.is_some_and(|why| why.contains("edge of the box")));
}

#[test]
fn particles_come_from_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
title = "Two charges"
dimension = 3
[domain]
free_space = { min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }
[points]
spacing = 0.1
[[regions]]
name = "space"
diffusivity = 1
[particles]
file = "charges.csv"
[[probes]]
at = [0.0, 3.0, 0.0]
"#;
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    let scene = Scene::read(&path).expect("a scene");
    let plan = Plan::new(&scene).expect("a plan");
    let missing = execute(&scene, &plan, &mut Silent).expect_err("no file");
    assert!(missing.is_input() && missing.to_string().contains("charges.csv"));
    std::fs::write(folder.path().join("charges.csv"), "x,y,z,strength\n0.31,0.02,0.1,1.0\n-0.3, 0, 0, 2\n")
        .expect("written");
    let report = solve(&scene);
    let distance = |x: f64, y: f64, z: f64| (x * x + (3.0 - y) * (3.0 - y) + z * z).sqrt();
    let exact =
        (1.0 / distance(0.31, 0.02, 0.1) + 2.0 / distance(-0.3, 0.0, 0.0)) / (4.0 * std::f64::consts::PI);
    let value = report.probes[0].value.expect("a value");
    // Moments up to 4 are kept, and the fifth is small from afar.
    assert!((value / exact - 1.0).abs() < 1e-6, "{value} for {exact}");
    std::fs::write(folder.path().join("charges.csv"), "0.31,0.02,1.0\n").expect("written");
    let wrong = execute(&scene, &plan, &mut Silent).expect_err("three numbers");
    assert!(wrong.to_string().contains("line 1"), "{wrong}");
}

#[test]
fn what_free_space_does_not_have_is_refused() {
    let said = |text: &str| Scene::parse(text, "scene.toml").expect_err("refused").to_string();
    let with = |section: &str| said(&format!("{CHARGE}\n{section}"));
    assert!(with("[[boundaries]]\nface = \"all\"\ndirichlet = 0\n").contains("free space"));
    assert!(with("[time]\nend = 1.0\n").contains("free space"));
    assert!(with("[method]\nname = \"gfdm-hybrid\"\n").contains("bounded domains"));
    assert!(with("[method]\norder = 5\n").contains("even order"));
    assert!(with("[method]\nkernel = \"spectral\"\nsigma = 2\n").contains("only Gaussian"));
    let bounded = CHARGE.replace("free_space", "box") + "\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n";
    assert!(said(&format!("{bounded}\n[method]\nname = \"free-space\"\n")).contains("bounded"));
    assert!(said(&format!("{bounded}\n[particles]\nfile = \"a.csv\"\n")).contains("free space"));
    let plan = |text: String| match Plan::new(&parse(&text)) {
        Err(Error::Scene(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(plan(CHARGE.replace("diffusivity = 1", "diffusivity = \"1 + x^2\"")).contains("one constant"));
    assert!(plan(CHARGE.replace("spacing = 0.02", "spacing = \"0.02 + x^2\"")).contains("one number"));
    assert!(plan(CHARGE.replace("spacing = 0.02", "spacing = 1e-5")).contains("points"));
}
