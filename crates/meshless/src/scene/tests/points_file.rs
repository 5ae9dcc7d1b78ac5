//! Points from a file: what scenes say of it, and what is wrong in it.

use super::{check_all, wrong};
use crate::Silent;
use crate::plan::Plan;
use crate::report::Report;
use crate::scene::Scene;

const SCAN: &str = r#"title = "Scan"
dimension = 2

[domain]
box = { min = [0.0, 0.0], max = [1.0, 1.0] }

[points]
file = "scan.csv"

[[regions]]
name = "bone"
label = 7
diffusivity = 3

[[regions]]
name = "tissue"
diffusivity = 1

[[boundaries]]
face = "all"
dirichlet = "x"
"#;

#[test]
fn what_is_wrong_in_the_scene_is_said_at_its_place() {
    check_all(
        SCAN,
        &[
            wrong(
                "\"scan.csv\"",
                "\"scan.csv\"\nlayout = «\"grid\"»",
                "points.layout",
                "have no layout",
                "remove",
            ),
            wrong("\"scan.csv\"", "«3»", "points.file", "expected a string", ""),
            wrong("label = 7", "label = «true»", "regions[0].label", "a number or a text", ""),
        ],
    );
    let generated = SCAN.replace("file = \"scan.csv\"", "spacing = 0.1");
    let error = Scene::parse(&generated, "scene.toml").unwrap_err();
    assert_eq!(error.key, "regions[0].label");
    let twice = SCAN.replace("name = \"tissue\"", "name = \"tissue\"\nlabel = 7.0");
    let error = Scene::parse(&twice, "scene.toml").unwrap_err();
    assert!(error.message.contains("the label \"7\""), "{error}");
}

/// The text of a file of 12 by 12 pixels, the left ones bone.
fn pixels() -> String {
    let mut text = "# from a scan\nx, y, what\n".to_owned();
    for k in 0..144 {
        let [x, y] = [k % 12, k / 12].map(|i| (f64::from(i) + 0.5) / 12.0);
        text += &format!("{x}, {y}, {}\n", if x < 0.5 { "7.0" } else { "tissue" });
    }
    text
}

fn solve(scene: &str, csv: &str) -> Result<Report, crate::Error> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene).expect("written");
    std::fs::write(folder.path().join("scan.csv"), csv).expect("written");
    let scene = Scene::read(&path)?;
    Ok(crate::execute(&scene, &Plan::new(&scene)?, &mut Silent)?.report)
}

#[test]
fn labelled_pixels_are_solved_and_their_error_is_estimated() {
    // A plane interface between pixels is found where it is: u is linear on each side and 3/4 and 1/4 of it at x = 1/2.
    let exact = "if(x < 0.5, x/2, 1.5*x - 0.5)";
    let scene = SCAN
        .replace("dirichlet = \"x\"", &format!("dirichlet = \"{exact}\""))
        .replace("diffusivity = 3", "diffusivity = 3\nexact = \"x/2\"")
        .replace("diffusivity = 1", "diffusivity = 1\nexact = \"1.5*x - 0.5\"");
    let report = solve(&scene, &pixels()).expect("it can be solved");
    assert!(report.errors.as_ref().is_some_and(|e| e.l2 < 1e-2), "{:?}", report.errors);
    assert_eq!(report.unknowns, 144);
    assert!(report.estimate.l2.is_some_and(f64::is_finite), "{:?}", report.estimate);
}

#[test]
fn finer_points_than_the_file_has_are_refused() {
    check_all(
        SCAN,
        &[wrong(
            "[[boundaries]]",
            "[accuracy]\ntolerance = «0.01»\n\n[[boundaries]]",
            "accuracy.tolerance",
            "cannot be refined",
            "",
        )],
    );
}

#[test]
fn what_is_wrong_in_the_file_is_said_with_its_line() {
    let good = pixels();
    let said = |csv: &str| solve(SCAN, csv).expect_err("wrong").to_string();
    let third = good.lines().nth(4).expect("a line");
    for (bad, place, message) in [
        ("0.2, 0.1", ":5:1", "expected 3 values, found 2"),
        ("0.2, 0.1, 7, 1", ":5:1", "expected 3 values, found 4"),
        ("0.2, abc, 7", ":5:6", "expected a finite number, found \"abc\""),
        ("inf, 0.1, 7", ":5:1", "expected a finite number"),
        ("0.2, 0.1, 8", ":5:11", "no region has the label \"8\""),
        ("0.2, 1.1, 7", ":5:1", "outside of the domain"),
    ] {
        let error = said(&good.replacen(third, bad, 1));
        assert!(error.contains(&format!("scan.csv{place}")) && error.contains(message), "{bad}: {error}");
    }
    let error = said(&format!("{good}{third}\n"));
    assert!(error.contains("that of line 5 again"), "{error}");
    assert!(said("# nothing\n").contains("has no points"));
    assert!(said(&good.replace("7.0", "tissue")).contains("no node lies in the region \"bone\""));
    let gone = Scene::parse(SCAN, "nowhere/scene.toml").expect("it parses");
    assert!(Plan::new(&gone).expect_err("no file").to_string().contains("cannot be read"));
    let half: String =
        good.lines().filter(|l| l.starts_with("0.0") || l.starts_with("0.1")).collect::<Vec<_>>().join("\n");
    assert!(said(&half.replacen("7.0", "tissue", 1)).contains("must fill the domain"));
    let shapes = format!("{SCAN}\n[method]\ninterfaces = \"shapes\"\n");
    assert!(solve(&shapes, &good).expect_err("no shapes").to_string().contains("have no shapes"));
}
