//! Every scene in `examples/` on a coarser cloud: it parses, plans and solves, and its error is what it should be.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use meshless::plan::Plan;
use meshless::report::Report;
use meshless::scene::Scene;
use meshless::{METHODS, Overrides, Silent, execute};

/// A scene, the spacing that it is solved with here, and a bound of its relative L2 error where it has a closed form.
struct Example {
    name: &'static str,
    spacing: &'static str,
    l2: Option<f64>,
}

const fn example(name: &'static str, spacing: &'static str, l2: f64) -> Example {
    Example { name, spacing, l2: Some(l2) }
}

/// Bounds are about one and a half times what was measured: the error that a method of the order that `docs/` promises
/// has at this spacing; round-off where the solution is in the space of the polynomials.
const EXAMPLES: [Example; 27] = [
    example("ball", "0.16", 1e-11),
    Example { name: "channel", spacing: "0.05", l2: None },
    example("charge", "0.05", 1e-7),
    example("chip", "0.1", 1.6e-2),
    example("crack", "0.08", 5e-3),
    example("curved", "0.08", 2e-2),
    example("electrode", "0.08", 1.4e-2),
    Example { name: "gear", spacing: "0.004", l2: None },
    Example { name: "fibres", spacing: "0.08", l2: None },
    example("film", "0.002", 5e-4),
    example("flow", "0.08", 3.5e-3),
    Example { name: "head", spacing: "0.5", l2: None },
    // Its points come from a file.
    example("image", "", 6e-3),
    example("inclusion", "0.08", 1.2e-6),
    Example { name: "inclusions", spacing: "6", l2: None },
    example("l_shape", "0.016 + 0.2*sqrt(x^2 + y^2)", 2.5e-3),
    example("membrane", "0.08", 2.2e-4),
    example("pipe", "0.004", 8e-6),
    Example { name: "porous", spacing: "0.03", l2: None },
    example("quarter_tube", "0.12", 8e-3),
    Example { name: "quench", spacing: "1.5", l2: None },
    example("rings", "0.08", 1e-11),
    example("shells", "6", 2.5e-2),
    example("smooth", "0.08", 6e-6),
    example("torsion", "0.08", 1e-12),
    Example { name: "vortex_ring", spacing: "0.1", l2: None },
    example("wall", "0.016", 1e-11),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples")
}

fn scene(name: &str) -> Scene {
    Scene::read(folder().join(format!("{name}.toml"))).unwrap_or_else(|error| panic!("{error}"))
}

fn solve(name: &str, spacing: &str) -> Report {
    let mut scene = scene(name);
    let spacing = Some(spacing).filter(|s| !s.is_empty());
    Overrides { spacing, ..Overrides::default() }.apply(&mut scene).expect("a spacing");
    let plan = Plan::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    execute(&scene, &plan, &mut Silent).unwrap_or_else(|error| panic!("{name}: {error}")).report
}

#[test]
fn the_table_names_every_file() {
    let files: BTreeSet<String> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    let table: BTreeSet<String> = EXAMPLES.iter().map(|e| e.name.to_owned()).collect();
    assert_eq!(files, table);
}

#[test]
fn every_example_is_solved_within_its_error() {
    let mut wrong = Vec::new();
    for Example { name, spacing, l2 } in EXAMPLES {
        let report = solve(name, spacing);
        let error = report.errors.as_ref().map(|e| e.l2);
        // Not a number fails, too; and a scene has an exact solution if and only if the table has a bound.
        if error.is_some() != l2.is_some() || !error.zip(l2).is_none_or(|(e, bound)| e <= bound) {
            wrong.push(format!("{name}: error {error:?}, expected at most {l2:?}"));
        }
        // The layers of the head are as thin as the coarse spacing here.
        if !report.estimate.l2.is_some_and(|e| e > 0.0 && (e < 0.5 || name == "head" && e.is_finite())) {
            wrong.push(format!("{name}: {:?}", report.estimate));
        }
        let solved = report.solver.residual < 1e-9;
        if !solved {
            wrong.push(format!("{name}: {:?}", report.solver));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn estimates_are_of_the_size_of_the_errors() {
    for name in ["ball", "chip", "curved", "inclusion", "membrane", "pipe"] {
        let Example { spacing, .. } = EXAMPLES.iter().find(|e| e.name == name).unwrap();
        let report = solve(name, spacing);
        let (estimate, error) = (report.estimate.l2.unwrap(), report.errors.unwrap().l2);
        // Polynomials are exact, and their round-off has no size to estimate.
        if error < 1e-11 && estimate < 1e-9 {
            continue;
        }
        let ratio = estimate / error;
        assert!((0.2..6.0).contains(&ratio), "{name}: estimate over error {ratio}");
    }
}

#[test]
fn grains_that_touch_no_electrode_float() {
    assert!(solve("porous", "0.06").solver.floating_constants >= 14);
    assert_eq!(solve("rings", "0.08").solver.floating_constants, 2);
}

/// What the format knows, as it is written in a scene; each is shown by some example.
const FEATURES: &[&str] = &[
    "dimension = 1",
    "dimension = 2",
    "dimension = 3",
    "[domain]",
    "[points]",
    "[[holes]]",
    "[[regions]]",
    "[[interfaces]]",
    "[[slits]]",
    "polyline = [",
    "enrichment = ",
    "[[boundaries]]",
    "[[probes]]",
    "[method]",
    "[output]",
    "box = {",
    "sphere = {",
    "cylinder = {",
    "length = ",
    "polygon = [",
    "half_space = {",
    "level_set = ",
    "union = [",
    "intersection = [",
    "difference = [",
    "bounds = {",
    "spacing = 0",
    "file = \"",
    "label = ",
    "spacing = \"",
    "\"grid\"",
    "\"jittered\"",
    "\"irregular\"",
    "seed = ",
    "diffusivity = ",
    "source = ",
    "exact = ",
    "between = [",
    "jump = ",
    "flux_jump = ",
    "face = \"all\"",
    "face = \"outer\"",
    "where = ",
    "dirichlet = ",
    "neumann = ",
    "flux = ",
    "robin = {",
    "name = \"gfdm-classical\"",
    "name = \"gfdm-hybrid\"",
    "name = \"gfdm-conservative\"",
    "order = ",
    "solver = ",
    "support = ",
    "smoothing = ",
    "log_scaling = ",
    "correction = ",
    "conservative_neumann = ",
    "selection_tolerance = ",
    "select_by_region = ",
    "at = [",
    "vtu = true",
    "plot = true",
    "if(",
];

#[test]
fn every_feature_of_the_format_is_shown() {
    let texts: Vec<String> = EXAMPLES
        .iter()
        .map(|e| std::fs::read_to_string(folder().join(format!("{}.toml", e.name))).unwrap())
        .collect();
    // A key counts only at the start of a line or of a table, so that `jump` is not found in `flux_jump`.
    let shown = |feature: &str| {
        texts.iter().flat_map(|t| t.lines()).filter(|l| !l.trim_start().starts_with('#')).any(|line| {
            line.match_indices(feature).any(|(at, _)| {
                !feature.starts_with(|c: char| c.is_ascii_lowercase())
                    || !line[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
            })
        })
    };
    let missing: Vec<&&str> = FEATURES.iter().filter(|f| !shown(f)).collect();
    assert!(missing.is_empty(), "no example has {missing:?}");
}

/// No method panics on an example that was not made for it, and none lacks neighbours there.
#[test]
fn every_method_answers_on_examples_that_were_not_made_for_it() {
    for (name, spacing) in [("wall", "0.008"), ("smooth", "0.08"), ("l_shape", "0.08"), ("ball", "0.2")] {
        for method in METHODS.iter().map(|m| m.name).filter(|name| *name != "free-space") {
            let mut scene = scene(name);
            let (method, spacing) = (Some(method), Some(spacing));
            Overrides { method, spacing, ..Overrides::default() }.apply(&mut scene).expect("overrides");
            let outcome = Plan::new(&scene).and_then(|plan| execute(&scene, &plan, &mut Silent));
            match outcome.map(|solution| solution.report.errors.map_or(f64::NAN, |errors| errors.l2)) {
                Ok(l2) => assert!(l2 < 1.0, "{name} by {method:?}: {l2:.1e}"),
                Err(error) => {
                    let lacks = error.to_string().contains("no stencil");
                    assert!(!lacks, "{name} by {method:?}: {error}");
                }
            }
        }
    }
}
