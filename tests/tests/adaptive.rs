//! Clouds that adapt to the data and to the solution.

use meshless::plan::Plan;
use meshless::scene::{MethodName, Scene};
use meshless::{Silent, Solution, execute, on_threads, write_outputs};
use meshless_tests::natural::adaptive::{discs, layer, point, to_tolerance};
use meshless_tests::natural::corners;

fn scene(text: &str) -> Scene {
    Scene::parse(text, "scene.toml").expect("a scene")
}

fn plan(text: &str) -> Plan {
    Plan::new(&scene(text)).expect("a plan")
}

fn solve(text: &str) -> Solution {
    let scene = scene(text);
    execute(&scene, &Plan::new(&scene).expect("a plan"), &mut Silent).expect("a solution")
}

/// The same with a cloud that adapts.
fn adapting(text: &str) -> String {
    text.replacen("[points]\n", "[points]\nadapt = true\n", 1)
}

#[test]
fn what_is_narrow_is_found_wherever_it_is() {
    let even = point(1e-3, 0.05, 1);
    let nodes = |text: &str| plan(text).predicted.unknowns;
    for at in [[0.0, 0.0], [0.3, -0.4], [-0.71, 0.11]] {
        let moved = format!("((x - {:?})^2 + (y - {:?})^2)", at[0], at[1]);
        let text = adapting(&even.replace("(x^2 + y^2)", &moved));
        let plan = plan(&text);
        assert!(plan.adapts_to_data && plan.to_string().contains("vary below the spacing"), "{plan}");
        let ratio = nodes(&text) / nodes(&even);
        assert!((1.5..10.0).contains(&ratio), "{at:?}: {ratio}");
    }
    assert!(!plan(&even).adapts_to_data);
}

#[test]
fn data_that_the_spacing_resolves_ask_for_nothing() {
    let text = adapting(&layer(0.5, 0.05, 1));
    let plan = plan(&text);
    assert!(!plan.adapts_to_data);
    // Nor do singular solutions of data that are smooth where they are given.
    assert!(
        !Plan::new(&scene(&to_tolerance(&corners::mixed(1.0, 0.1, 1), 1e-3))).expect("a plan").adapts_to_data
    );
}

#[test]
fn a_narrow_source_is_solved_to_a_tolerance() {
    let report = solve(&to_tolerance(&point(1e-3, 0.05, 1), 1e-4)).report;
    let value = report.probes[0].value.expect("inside");
    // As if all of it were in the middle.
    let expected = 2.0_f64.ln() / (2.0 * std::f64::consts::PI);
    assert!((value - expected).abs() <= 1e-4 * expected, "{value} for {expected}");
    assert!(report.unknowns < 20_000, "{}", report.unknowns);
}

#[test]
fn a_layer_takes_a_higher_order_and_nodes_where_it_is() {
    let text = to_tolerance(&layer(0.01, 0.05, 1), 1e-3);
    let plan = plan(&text);
    assert_eq!((plan.method.name, plan.method.params.order()), (MethodName::Sharp, 6));
    let solution = solve(&text);
    let error = solution.report.errors.as_ref().expect("an exact solution").l2;
    assert!(error <= 1e-3, "{error:e}");
    let spacing = |near: bool| {
        let of = solution.field.points.iter().zip(&solution.field.spacing);
        let some = of.filter(|(x, _)| ((x[0] - 0.5).abs() < 0.01) == near).map(|(_, h)| *h);
        some.fold(0.0, f64::max)
    };
    assert!(spacing(true) < 0.01 && spacing(false) > 0.03, "{} {}", spacing(true), spacing(false));
}

#[test]
fn a_gap_far_below_the_spacing_is_resolved_without_a_word_of_it() {
    let report = solve(&to_tolerance(&discs(1e-3, 0.1, 1), 1e-3)).report;
    for (probe, expected) in report.probes.iter().zip([1.0, -1.0]) {
        let value = probe.value.expect("inside");
        assert!((value - expected).abs() <= 1e-3, "{value} for {expected}");
    }
}

#[test]
fn adapted_clouds_do_not_depend_on_the_number_of_threads() {
    let text = to_tolerance(&point(1e-2, 0.05, 1), 1e-3);
    let [one, two] = [1, 2].map(|threads| on_threads(threads, || solve(&text)).expect("threads"));
    assert_eq!(one.field.points, two.field.points);
    assert_eq!(one.field.u, two.field.u);
    assert_eq!(one.field.indicator, two.field.indicator);
}

#[test]
fn indicators_are_large_where_the_solution_is_worst_and_absent_without_an_estimate() {
    let text = layer(0.05, 0.05, 1) + "[output]\nvtu = true\n";
    let solution = solve(&text);
    let indicator = solution.field.indicator.as_ref().expect("indicators");
    assert!(indicator.iter().all(|own| own.is_finite() && *own >= 0.0));
    let mean = |near: bool| {
        let all = solution.field.points.iter().zip(indicator);
        let some: Vec<f64> =
            all.filter(|(x, _)| ((x[0] - 0.5).abs() < 0.1) == near).map(|(_, own)| *own).collect();
        some.iter().sum::<f64>() / some.len() as f64
    };
    assert!(mean(true) > 3.0 * mean(false), "{:e} {:e}", mean(true), mean(false));
    let folder = tempfile::tempdir().expect("a folder");
    let written = |solution: &Solution, text: &str| {
        let files = write_outputs(&plan(text), solution, folder.path(), "layer").expect("files");
        String::from_utf8_lossy(&std::fs::read(&files[0]).expect("a file")).contains("\"indicator\"")
    };
    assert!(written(&solution, &text));
    let text = text + "estimate = false\n";
    let solution = solve(&text);
    assert!(solution.field.indicator.is_none() && !written(&solution, &text));
}
