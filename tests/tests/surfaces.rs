//! Parts from STL files: read beside the scene, solved as nearly as their triangles allow, and refused with the reason.

use std::path::Path;

use meshless::plan::Plan;
use meshless::report::Errors;
use meshless::scene::{MethodName, Scene};
use meshless::{Silent, execute};
use meshless_tests::surfaces::{ascii, binary, gear, heated_ball, inclusion, sphere};

fn scene(folder: &Path, text: &str) -> Scene {
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).expect("the folder can be written");
    Scene::read(&path).unwrap_or_else(|error| panic!("{error}"))
}

fn errors(folder: &Path, text: &str) -> Errors {
    let scene = scene(folder, text);
    let plan = Plan::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let outcome = execute(&scene, &plan, &mut Silent).unwrap_or_else(|error| panic!("{error}"));
    outcome.report.errors.expect("a scene with an exact solution")
}

/// A folder with spheres `s2.stl`, `s3.stl`, `s4.stl` (ASCII).
fn spheres() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for times in [2, 3] {
        std::fs::write(folder.path().join(format!("s{times}.stl")), binary(&sphere(times)))
            .expect("writable");
    }
    std::fs::write(folder.path().join("s4.stl"), ascii(&sphere(4))).expect("writable");
    folder
}

#[test]
fn interpolated_normals_are_worth_a_finer_triangulation() {
    let folder = spheres();
    let solve = |shape: &str| errors(folder.path(), &heated_ball(shape, 0.2)).l2;
    let exact = solve("sphere = { center = [0, 0, 0], radius = 1 }");
    let flat = solve("stl = { file = \"s3.stl\", smooth = false }");
    let smooth = solve("stl = \"s3.stl\"");
    let fine = solve("stl = \"s4.stl\"");
    assert!(flat > 2.0 * exact, "flat {flat:e}, exact {exact:e}");
    assert!(smooth < 1.4 * exact && fine < 1.4 * exact, "smooth {smooth:e}, {fine:e}, exact {exact:e}");
}

#[test]
fn inclusions_of_triangles_are_seen_with_their_curvature() {
    let folder = spheres();
    for jump in [false, true] {
        let solve = |shape: &str| errors(folder.path(), &inclusion(shape, 0.15, jump)).l2;
        let exact = solve("sphere = { center = [0, 0, 0], radius = 0.6 }");
        let flat = solve("stl = { file = \"s4.stl\", scale = 0.6, smooth = false }");
        let smooth = solve("stl = { file = \"s4.stl\", scale = 0.6 }");
        assert!(flat > 5.0 * exact && smooth < 2.0 * exact, "{jump}: {flat:e}, {smooth:e}, exact {exact:e}");
    }
}

/// The edges of a cube of triangles have no functions: by fits u was 35 % off, and a quarter of the heat too much.
#[test]
fn a_heated_cube_of_triangles_keeps_its_heat() {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 0.4 } else { -0.4 });
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let cube = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("cube.stl"), binary(&cube)).expect("writable");
    let text = "title = \"Cube\"\ndimension = 3\n[domain]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n[points]\nspacing = 0.12\n\
                [[regions]]\nname = \"cube\"\nstl = \"cube.stl\"\ndiffusivity = 10\nsource = 10\n\
                [[regions]]\nname = \"out\"\ndiffusivity = 1\n[[boundaries]]\nface = \"all\"\ndirichlet = 0\n\
                [[probes]]\nat = [0.1, 0.05, 0.2]\n[output]\nfluxes = true\n";
    let scene = scene(folder.path(), text);
    let plan = Plan::new(&scene).expect("a plan");
    assert_eq!(plan.method.name, MethodName::GfdmConservative);
    let report = execute(&scene, &plan, &mut Silent).expect("it is solved").report;
    let fluxes = report.fluxes.expect("asked for");
    assert!((fluxes.interfaces[0].flux / -5.12 - 1.0).abs() < 2e-3, "{fluxes:?}");
    // By hp-FEM, `tests/references/space.py`.
    let error = (report.probes[0].value.expect("inside") / 0.465_188 - 1.0).abs();
    assert!(error < 3e-2 && report.estimate.l2.is_some_and(|estimate| estimate > 0.3 * error), "{error}");
}

#[test]
fn the_part_in_the_examples_is_the_one_that_is_described() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/gear.stl");
    let (file, described) = (std::fs::read(path).expect("the example"), binary(&gear()));
    assert_eq!(file.len(), described.len());
    // Coordinates to rounding: sines differ between libraries. Normals and header are not compared.
    for (a, b) in file[84..].chunks(50).zip(described[84..].chunks(50)) {
        for k in 3..12 {
            let number = |r: &[u8]| f32::from_le_bytes([r[4 * k], r[4 * k + 1], r[4 * k + 2], r[4 * k + 3]]);
            assert!((number(a) - number(b)).abs() < 1e-4, "{} {}", number(a), number(b));
        }
    }
}

#[test]
fn what_is_wrong_with_a_file_is_told_with_the_place_in_the_scene() {
    let folder = spheres();
    let mut open = sphere(1);
    open.remove(7);
    std::fs::write(folder.path().join("open.stl"), binary(&open)).expect("writable");
    std::fs::write(folder.path().join("empty.stl"), "").expect("writable");
    std::fs::write(
        folder.path().join("text.stl"),
        ascii(&sphere(0)).replace("vertex 1 0 0", "vertex 1 0 nan"),
    )
    .expect("writable");
    for (file, expected) in [
        ("none.stl", "cannot be read"),
        ("open.stl", "the surface is open there (and 2 more such edges)"),
        ("empty.stl", "the file is empty"),
        ("text.stl", "has a coordinate that is not finite"),
        ("scene.toml", "neither"),
    ] {
        for key in ["domain", "holes", "regions"] {
            let stl = format!("stl = \"{file}\"");
            let text = match key {
                "domain" => heated_ball(&stl, 0.3),
                "regions" => inclusion(&stl, 0.3, false),
                _ => heated_ball(
                    &format!(
                        "box = {{ min = [-2, -2, -2], max = [2, 2, 2] }}\n[[holes]]\nname = \"h\"\n{stl}"
                    ),
                    0.5,
                )
                .replace("\"outer\"", "\"all\""),
            };
            let scene = scene(folder.path(), &text);
            let message = Plan::new(&scene).expect_err("a refusal").to_string();
            let line = 1 + text.lines().position(|l| l.starts_with("stl")).expect("the key");
            assert!(message.contains(&format!("scene.toml:{line}:")), "{message}");
            let said = message.contains(expected) || file == "scene.toml" && message.contains("would have");
            assert!(said && message.contains(file), "{message}");
        }
    }
}

#[test]
fn plans_count_the_triangles() {
    let folder = spheres();
    let plan = Plan::new(&scene(folder.path(), &heated_ball("stl = \"s2.stl\"", 0.3))).expect("a plan");
    assert!(plan.to_string().contains("triangulated surface (128 triangles)"), "{plan}");
}
