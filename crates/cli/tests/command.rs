//! The command as a user meets it: what it prints, writes and answers.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SCENE: &str = r#"title = "Two layers"
dimension = 1

[domain]
box = { min = [0.0], max = [1.0] }

[points]
spacing = 0.02
layout = "jittered"

[[regions]]
name = "left"
level_set = "x - 0.5"
diffusivity = "1"
exact = "1 - 2*1000/1001*x"

[[regions]]
name = "right"
diffusivity = "1000"
exact = "2/1001*(1 - x)"

[[boundaries]]
face = "left"
dirichlet = "1"

[[boundaries]]
face = "right"
dirichlet = "0"

[[probes]]
at = [0.25]

[output]
vtu = true
plot = true
"#;

fn meshless(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_meshless")).args(args).output().expect("the command starts")
}

fn scene_in(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).expect("the folder can be written");
    path
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs a scene that is wrong and returns what is said about it.
fn refused(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = scene_in(folder.path(), text);
    let out = folder.path().join("out");
    let output = meshless(&[
        "solve",
        scene.to_str().expect("a plain path"),
        "--out",
        out.to_str().expect("a plain path"),
    ]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let written = std::fs::read_dir(&out).map(Iterator::count).unwrap_or(0);
    assert_eq!(written, 0, "output of a scene that was refused");
    stderr(&output)
}

#[test]
fn json_is_one_object_with_the_promised_keys() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    let out = folder.path().join("out");
    let output = meshless(&["solve", scene.to_str().unwrap(), "--json", "--out", out.to_str().unwrap()]);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for key in [
        "title",
        "dimension",
        "unknowns",
        "spacing",
        "method",
        "order",
        "contrast",
        "effects",
        "skipped",
        "errors",
        "estimate",
        "extrema",
        "solver",
        "seconds",
        "peak_memory_mb",
        "probes",
    ] {
        assert!(json.get(key).is_some(), "{key}");
    }
    for key in ["points", "neighbors", "stencils", "assembly", "solve", "total"] {
        assert!(json["seconds"][key].is_f64(), "{key}");
    }
    assert_eq!(json["contrast"], 1000.0);
    assert!(json["errors"]["regions"]["left"]["l2"].as_f64().unwrap() < 0.05);
    assert!((json["probes"][0]["value"].as_f64().unwrap() - 0.5).abs() < 0.03);
    assert!(json["skipped"].as_array().unwrap().contains(&"time".into()));
    assert!(out.join("scene.svg").is_file());
    let vtu = String::from_utf8_lossy(&std::fs::read(out.join("scene.vtu")).unwrap()).into_owned();
    for name in ["u", "gradient", "eta", "region", "row_kind", "stencil_condition", "dominance_error"] {
        assert!(vtu.contains(&format!("Name=\"{name}\"")), "{name}");
    }
}

#[test]
fn the_spacing_and_the_method_can_be_overridden() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    let out = folder.path().join("out");
    let output = meshless(&[
        "solve",
        scene.to_str().unwrap(),
        "--json",
        "--spacing",
        "0.01",
        "--method",
        "gfdm-conservative",
        "--out",
        out.to_str().unwrap(),
        "--threads",
        "1",
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["method"], "gfdm-conservative");
    assert!(json["unknowns"].as_u64().unwrap() > 90);
}

#[test]
fn plan_solves_nothing_and_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    let output = meshless(&["plan", scene.to_str().unwrap()]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success());
    assert!(text.contains("diffusivity jump (1.000e3)"), "{text}");
    assert!(text.contains("source: the scene has no source"), "{text}");
    let output = meshless(&["plan", scene.to_str().unwrap(), "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["method"], "sharp");
}

#[test]
fn methods_are_listed() {
    let output = meshless(&["methods"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for name in ["gfdm-classical", "gfdm-positive", "gfdm-hybrid", "gfdm-conservative"] {
        assert!(text.contains(name), "{text}");
    }
}

#[test]
fn a_wrong_scene_is_answered_with_file_line_and_key() {
    // What is replaced, by what, and what the answer must contain.
    let cases: &[(&str, &str, &[&str])] = &[
        ("diffusivity = \"1\"\n", "difusivity = \"1\"\n", &["scene.toml:14", "difusivity", "diffusivity"]),
        ("title = \"Two layers\"\n", "", &["title"]),
        ("spacing = 0.02", "spacing = \"0.05 +\"", &["scene.toml:8", "points.spacing"]),
        ("spacing = 0.02", "spacing = 1e-11", &["scene.toml:8", "nodes"]),
        ("diffusivity = \"1\"\n", "diffusivity = \"-1\"\n", &["scene.toml:14", "diffusivity", "positive"]),
        ("diffusivity = \"1\"\n", "diffusivity = \"x - 0.3\"\n", &["scene.toml:14", "positive"]),
        ("diffusivity = \"1\"\n", "diffusivity = \"sqrt(x - 0.3)\"\n", &["scene.toml:14", "positive"]),
        ("level_set = \"x - 0.5\"", "level_set = \"x + 3\"", &["left", "no node"]),
        ("face = \"right\"", "face = \"top\"", &["face", "right"]),
        ("[[boundaries]]\nface = \"right\"\ndirichlet = \"0\"\n", "", &["no boundary condition"]),
        ("[[probes]]", "[[interfaces]]\nbetween = [\"left\", \"middle\"]\n\n[[probes]]", &["middle"]),
        ("[output]", "[time]\nend = 0.0\n\n[output]", &["time.end", "positive"]),
        ("dirichlet = \"0\"", "dirichlet = \"log(0 - x)\"", &["dirichlet", "NaN"]),
    ];
    for (old, new, expected) in cases {
        let text = SCENE.replacen(old, new, 1);
        assert_ne!(text, SCENE, "{old}");
        let said = refused(&text);
        for part in *expected {
            assert!(said.contains(part), "{old:?} -> {new:?}: {said}");
        }
    }
}

#[test]
fn regions_that_never_touch_cannot_share_an_interface() {
    let text = SCENE
        .replace("[[regions]]\nname = \"right\"", "[[regions]]\nname = \"middle\"\nlevel_set = \"x - 0.75\"\ndiffusivity = \"2\"\nexact = \"0\"\n\n[[regions]]\nname = \"right\"")
        + "\n[[interfaces]]\nbetween = [\"left\", \"right\"]\nflux_jump = \"1\"\n";
    let said = refused(&text);
    assert!(said.contains("interfaces") && said.contains("touch"), "{said}");
}

#[test]
fn pure_neumann_is_solved_up_to_a_constant_or_refused_with_the_imbalance() {
    let neumann = SCENE
        .replace("face = \"left\"\ndirichlet = \"1\"", "face = \"left\"\nflux = \"1\"")
        .replace("face = \"right\"\ndirichlet = \"0\"", "face = \"right\"\nflux = \"-1\"")
        .replace("exact = \"1 - 2*1000/1001*x\"", "exact = \"0 - x\"")
        .replace("exact = \"2/1001*(1 - x)\"", "exact = \"0 - 0.5 - (x - 0.5)/1000\"");
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), &neumann);
    let out = folder.path().join("out");
    let args = ["solve", scene.to_str().unwrap(), "--json", "--out", out.to_str().unwrap()];
    let output = meshless(&args);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["errors"]["l2"].as_f64().unwrap() < 0.03, "{}", json["errors"]);

    scene_in(folder.path(), &neumann.replace("flux = \"-1\"", "flux = \"0.5\""));
    let output = meshless(&args);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("balance"), "{}", stderr(&output));
}

#[test]
fn an_output_folder_that_cannot_be_written_is_refused_before_solving() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    let file = folder.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    let output = meshless(&["solve", scene.to_str().unwrap(), "--out", file.join("out").to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--out"), "{}", stderr(&output));
}

#[test]
fn a_wrong_command_line_ends_with_status_2() {
    for args in [
        &["solve"][..],
        &["solve", "no-such-file.toml"],
        &["frobnicate"],
        &["solve", "x.toml", "--threads", "no"],
    ] {
        assert_eq!(meshless(args).status.code(), Some(2), "{args:?}");
    }
}

#[test]
fn more_threads_than_a_machine_has_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    let output = meshless(&["solve", scene.to_str().unwrap(), "--threads", "1000000"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("at most 1024"), "{}", stderr(&output));
}

#[test]
fn a_plan_of_too_many_nodes_is_refused_with_the_spacing_that_would_do() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    for command in ["plan", "solve"] {
        let output = meshless(&[command, scene.to_str().unwrap(), "--spacing", "1e-12"]);
        let text = stderr(&output);
        assert!(!output.status.success(), "{command}");
        assert!(text.contains("--spacing: about 1.000e12 nodes"), "{text}");
        assert!(text.contains("multiply the spacing by 52500"), "{text}");
    }
}

#[test]
fn an_unsteady_scene_writes_its_fields_and_goes_on_from_its_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let text = SCENE.to_owned() + "\n[time]\nend = 0.1\noutput = [0.02]\ntolerance = 1e-3\n";
    let (scene, out) = (scene_in(folder.path(), &text), folder.path().join("out"));
    let checkpoint = folder.path().join("run.ckpt");
    let run = || {
        let output = meshless(&[
            "solve",
            scene.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
            "--json",
            "--checkpoint",
            checkpoint.to_str().unwrap(),
        ]);
        assert!(output.status.success(), "{}", stderr(&output));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let json = run();
    assert!(json["time"]["steps"].as_u64().unwrap() > 3);
    assert_eq!(json["time"]["output"][0], 0.02);
    assert!(json["effects"].as_array().unwrap().contains(&"time".into()));
    let series = std::fs::read_to_string(out.join("scene.pvd")).unwrap();
    for file in ["scene-1.vtu", "scene.vtu"] {
        assert!(series.contains(file) && out.join(file).is_file(), "{file}");
    }
    let steady = scene_in(folder.path(), SCENE);
    let output = meshless(&["solve", steady.to_str().unwrap(), "--checkpoint", checkpoint.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("the scene is steady"));
}

#[test]
fn a_tolerance_takes_the_place_of_a_spacing() {
    let folder = tempfile::tempdir().unwrap();
    let text = SCENE.replace("[points]\nspacing = 0.02\nlayout = \"jittered\"\n", "");
    let scene = scene_in(folder.path(), &text);
    let out = folder.path().join("out");
    let solve = |extra: &[&str]| {
        let fixed = ["solve", scene.to_str().unwrap(), "--json", "--out", out.to_str().unwrap()];
        meshless(&[&fixed, extra].concat())
    };
    let neither = solve(&[]);
    assert_eq!(neither.status.code(), Some(2), "neither spacing nor tolerance");
    assert!(stderr(&neither).contains("or --tolerance"), "{}", stderr(&neither));
    for given in [["--tolerance", "1e-6"], ["--spacing", "0.02"]] {
        let output = solve(&given);
        assert!(output.status.success(), "{given:?}: {}", stderr(&output));
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(json["errors"]["l2"].as_f64().unwrap() < 1e-6, "{given:?}");
    }
    let with = scene_in(folder.path(), &(text.clone() + "\n[accuracy]\ntolerance = 1e-6\n"));
    let output = meshless(&["solve", with.to_str().unwrap(), "--json", "--out", out.to_str().unwrap()]);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["errors"]["l2"].as_f64().unwrap() < 1e-6);
    assert!(json["accuracy"]["rungs"].as_array().is_some_and(|rungs| !rungs.is_empty()));
    let refused = meshless(&["solve", with.to_str().unwrap(), "--tolerance", "-1"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("above 0 and below 1"), "{}", stderr(&refused));
    // What no arithmetic can do is not tried.
    let refused = meshless(&["plan", with.to_str().unwrap(), "--tolerance", "1e-15"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("round-off alone leaves about 1.3e-14"), "{}", stderr(&refused));
}

#[test]
fn cost_draws_error_against_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), SCENE);
    let out = folder.path().join("out");
    let fixed = ["cost", scene.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = meshless(&fixed);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("best buys") && text.contains("gfdm-hybrid"), "{text}");
    let svg = std::fs::read_to_string(out.join("scene-cost.svg")).unwrap();
    assert!(svg.contains("seconds from points to solution"));
    assert!(out.join("scene-cost.csv").is_file());
    let output = meshless(&[&fixed[..], &["--json", "--method", "sharp"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let runs = json["runs"].as_array().unwrap();
    assert!(runs.iter().all(|run| run["method"] == "sharp" && run["seconds"].is_f64()));
    for wrong in [["--method", "shrap"], ["--seconds", "0"]] {
        let refused = meshless(&[&fixed[..], &wrong].concat());
        assert_eq!(refused.status.code(), Some(2));
    }
}
