//! Files of bounded scenes.

use std::path::Path;

use meshless::plan::{Plan, Stage};
use meshless::scene::Scene;
use meshless::{Silent, Solution, execute, write_outputs};

const INCLUSION: &str = include_str!("../../examples/inclusion.toml");
const BALL: &str = include_str!("../../examples/ball.toml");
const RINGS: &str = include_str!("../../examples/rings.toml");
const QUENCH: &str = include_str!("../../examples/quench.toml");

/// The scene at a spacing with a table of its field and nothing else.
fn table_of(text: &str, spacing: &str) -> Scene {
    let kept: Vec<&str> = text.split("[output]").take(1).collect();
    let text = format!("{}\n[output]\ncsv = true\n", kept[0]);
    let line = text.lines().find(|l| l.starts_with("spacing")).expect("a spacing").to_owned();
    Scene::parse(&text.replace(&line, &format!("spacing = {spacing}")), "scene.toml").expect("a scene")
}

fn solve(scene: &Scene) -> (Plan, Solution) {
    let plan = Plan::new(scene).expect("a plan");
    let solution = execute(scene, &plan, &mut Silent).expect("a solution");
    (plan, solution)
}

/// Names and numbers of a file.
fn read(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(path).expect("a file");
    let mut lines = text.lines();
    let names = lines.next().expect("a line of names").split(',').map(str::to_owned).collect();
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (names, lines.map(numbers).collect())
}

#[test]
fn a_table_has_every_node_with_its_numbers_bit_by_bit() {
    for (text, spacing, names) in [
        (RINGS, "0.2", &["x", "y", "u", "gradient_x", "gradient_y"][..]),
        (INCLUSION, "0.15", &["x", "y", "u", "gradient_x", "gradient_y"]),
        (BALL, "0.3", &["x", "y", "z", "u", "gradient_x", "gradient_y", "gradient_z"]),
    ] {
        let scene = table_of(text, spacing);
        let (plan, solution) = solve(&scene);
        assert!(plan.runs(Stage::Csv) && plan.runs(Stage::Gradient) && !plan.runs(Stage::Vtu));
        let folder = tempfile::tempdir().expect("a folder");
        let files = write_outputs(&plan, &solution, folder.path(), "field").expect("files");
        assert_eq!(files, [folder.path().join("field.csv")]);
        let (head, rows) = read(&files[0]);
        assert_eq!(head, names);
        let (field, dimension) = (&solution.field, scene.dimension);
        assert_eq!(rows.len(), field.u.len());
        let gradient = field.gradient.as_ref().expect("a gradient");
        let errors = solution.report.errors.as_ref().expect("an exact solution");
        assert!(errors.gradient_linf < 0.05, "{:e}", errors.gradient_linf);
        for (i, row) in rows.iter().enumerate() {
            let own =
                field.points[i][..dimension].iter().chain([&field.u[i]]).chain(&gradient[i][..dimension]);
            assert!(row.iter().eq(own), "line {i}");
        }
        assert!(rows.iter().flatten().all(|v| v.is_finite()));
    }
}

#[test]
fn an_unsteady_scene_has_a_table_for_each_time_and_without_the_key_there_is_none() {
    let scene = table_of(QUENCH, "3");
    let (plan, solution) = solve(&scene);
    let folder = tempfile::tempdir().expect("a folder");
    let files = write_outputs(&plan, &solution, folder.path(), "quench").expect("files");
    let names = ["quench.csv", "quench-1.csv", "quench-2.csv"];
    assert!(files.iter().eq(names.map(|name| folder.path().join(name)).iter()), "{files:?}");
    let fields = [&solution.field.u, &solution.frames[0].u, &solution.frames[1].u];
    for (file, field) in files.iter().zip(fields) {
        let (head, rows) = read(file);
        let u = head.iter().position(|name| name == "u").expect("u");
        assert!(rows.iter().map(|row| row[u]).eq(field.iter().copied()));
    }
    let mut without = scene;
    without.output.csv = false;
    let plan = Plan::new(&without).expect("a plan");
    assert!(!plan.runs(Stage::Csv));
    assert!(plan.skipped.iter().any(|s| s.what == "csv output" && s.why == "not asked for"));
    assert!(write_outputs(&plan, &solution, folder.path(), "other").expect("no files").is_empty());
}

#[test]
fn a_folder_that_is_not_there_is_an_error_and_leaves_nothing() {
    let (plan, solution) = solve(&table_of(RINGS, "0.2"));
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("missing");
    let error = write_outputs(&plan, &solution, &missing, "field").expect_err("no folder");
    assert!(error.to_string().contains("missing"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
}
