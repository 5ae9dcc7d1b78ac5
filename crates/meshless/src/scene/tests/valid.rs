//! Scenes that are right.

use super::PLATE;
use crate::scene::{
    ConditionSpec, ExprField, LayoutName, MethodName, MethodOptions, OutputSpec, Scene, SceneError,
    ShapeSpec, SolverName,
};

fn parse(text: &str) -> Scene {
    Scene::parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// A scene with the given domain and shapes of its first region, in some dimension.
fn with_shape(dimension: usize, domain: &str, shape: &str) -> Scene {
    parse(&format!(
        "title = 'shapes'\ndimension = {dimension}\n[domain]\n{domain}\n[points]\nspacing = 0.1\n\
         [[regions]]\nname = 'a'\n{shape}\ndiffusivity = 2\n[[regions]]\nname = 'b'\ndiffusivity = 1\n\
         [[boundaries]]\nface = 'all'\ndirichlet = 0\n"
    ))
}

#[test]
fn every_section_is_read() {
    let scene = parse(PLATE);
    assert_eq!((scene.title.as_str(), scene.dimension), ("Plate", 2));
    assert!(matches!(&scene.domain.shape, ShapeSpec::Box(b) if b.min == [0.0, 0.0] && b.max == [2.0, 1.0]));
    assert_eq!(scene.points.spacing.as_constant(), Some(0.05));
    assert_eq!((scene.points.layout, scene.points.seed), (LayoutName::Irregular, 7));
    assert_eq!(scene.holes[0].name, "bolt");
    assert!(
        matches!(&scene.holes[0].shape, ShapeSpec::Sphere { center, radius } if center == &[1.5, 0.5] && *radius == 0.1)
    );
    assert_eq!(scene.faces(), ["left", "right", "bottom", "top", "bolt"]);

    let [inclusion, matrix] = &scene.regions[..] else { panic!("two regions") };
    assert!(matches!(&inclusion.geometry, Some(ShapeSpec::LevelSet(f)) if f.expr.eval(&[1.0, 1.0]) == -0.25));
    assert_eq!(inclusion.diffusivity.expr.eval(&[2.0, 0.0]), 5.0);
    assert_eq!(inclusion.diffusivity.text, "1 + x^2");
    assert_eq!(inclusion.diffusivity.place.key, "regions[0].diffusivity");
    assert_eq!(inclusion.diffusivity.place.position(), (19, 15));
    assert!(inclusion.source.is_some() && inclusion.exact.is_some());
    assert!(matrix.geometry.is_none() && matrix.source.is_none() && matrix.exact.is_none());
    assert_eq!(matrix.diffusivity.as_constant(), Some(100.0));

    assert_eq!(scene.interfaces[0].between, [0, 1]);
    assert!(scene.interfaces[0].jump.is_none());
    assert_eq!(scene.interfaces[0].flux_jump.as_ref().and_then(ExprField::as_constant), Some(0.2));

    let [left, bolt, all] = &scene.boundaries[..] else { panic!("three boundaries") };
    assert_eq!((left.face.as_str(), bolt.face.as_str(), all.face.as_str()), ("left", "bolt", "all"));
    assert_eq!(left.where_.as_ref().map(|w| w.expr.eval(&[0.0, 0.7])), Some(1.0));
    assert!(matches!(&left.condition, ConditionSpec::Dirichlet(f) if f.as_constant() == Some(1.0)));
    assert!(matches!(&bolt.condition, ConditionSpec::Robin { a, b, g }
        if a.as_constant() == Some(1.0) && b.as_constant() == Some(2.0) && g.expr.depends_on(0)));
    assert!(matches!(&all.condition, ConditionSpec::Neumann(f) if f.as_constant() == Some(0.0)));

    let method = &scene.method;
    assert_eq!(
        (method.name, method.order, method.solver),
        (MethodName::GfdmHybrid, Some(2), SolverName::BiCgStab)
    );
    assert_eq!(method.options, MethodOptions { smoothing: Some(1), ..MethodOptions::default() });
    assert_eq!(scene.probes, [[1.0, 0.2]]);
    assert_eq!(scene.output, OutputSpec { vtu: true, ..OutputSpec::default() });
}

/// A scene with a comment at every line, as the format's description has it.
#[test]
fn the_documented_scene_is_read() {
    let scene = parse(
        r#"
title = "Circular inclusion"
dimension = 2                       # 1, 2 or 3
[domain]                            # a shape or a level set (negative inside)
box = { min = [0.0, 0.0], max = [2.0, 2.0] }      # faces: left right bottom top back front
[points]
spacing = 0.05                      # a number, or an expression of position for graded clouds
layout = "irregular"                # "grid" | "jittered" | "irregular"
seed = 1
[[regions]]                         # first match wins; the last one, without geometry, is the background
name = "inclusion"
level_set = "(x - 1)^2 + (y - 1)^2 - 0.25"
diffusivity = "(x - 1)^2 + (y - 1)^2 + 1"
source = "-(8*((x - 1)^2 + (y - 1)^2) + 4)"
exact = "(x - 1)^2 + (y - 1)^2"     # optional: errors are then reported
[[regions]]
name = "matrix"
diffusivity = "100"
source = "-(8*((x - 1)^2 + (y - 1)^2) + 4)"
[[interfaces]]                      # only where something jumps besides eta
between = ["inclusion", "matrix"]
flux_jump = "0.2"
[[boundaries]]
face = "left"                       # a face, a hole's name, or "all"
flux = "1.0"
[method]                            # optional: overrides what the plan would choose
name = "auto"
order = 4
solver = "auto"
[[probes]]                          # optional: values to report
at = [1.0, 1.2]
[output]                            # optional
vtu = true                          # fields for ParaView
plot = true                         # a picture of the solution
"#,
    );
    let source = scene.regions[0].source.as_ref().expect("a source");
    assert_eq!(source.expr.eval(&[2.0, 0.0]), -20.0);
    assert!(matches!(&scene.boundaries[0].condition, ConditionSpec::Flux(f) if f.as_constant() == Some(1.0)));
    assert_eq!(scene.method.order, Some(4));
    assert_eq!(scene.output, OutputSpec { vtu: true, plot: true, ..OutputSpec::default() });
}

#[test]
fn sections_that_are_optional_have_defaults() {
    let scene = with_shape(1, "box = { min = [0], max = [1] }", "box = { min = [0], max = [0.5] }");
    assert_eq!((scene.points.layout, scene.points.seed), (LayoutName::Irregular, 1));
    assert_eq!((scene.method.name, scene.method.solver), (MethodName::Auto, SolverName::Auto));
    assert_eq!(scene.method.options, MethodOptions::default());
    assert!(scene.probes.is_empty() && scene.interfaces.is_empty() && scene.holes.is_empty());
    assert_eq!(scene.output, OutputSpec::default());
    assert_eq!(scene.faces(), ["left", "right"]);
}

#[test]
fn every_shape_is_read() {
    let cube = "box = { min = [0, 0, 0], max = [1, 1, 1] }";
    let square = "box = { min = [0, 0], max = [1, 1] }";
    let shape = |dimension, domain, text| with_shape(dimension, domain, text).regions[0].geometry.clone();
    assert!(matches!(
        shape(3, cube, "sphere = { center = [0, 0, 0], radius = 1 }"),
        Some(ShapeSpec::Sphere { .. })
    ));
    let finite = shape(3, cube, "cylinder = { point = [0, 0, 0], axis = [0, 0, 2], radius = 1, length = 3 }");
    assert!(matches!(finite, Some(ShapeSpec::Cylinder { length: Some(3.0), .. })));
    let infinite = shape(3, cube, "cylinder = { point = [0, 0, 0], axis = [0, 0, 2], radius = 1 }");
    assert!(matches!(infinite, Some(ShapeSpec::Cylinder { length: None, .. })));
    assert!(
        matches!(shape(2, square, "polygon = [[0, 0], [1, 0], [0, 1]]"), Some(ShapeSpec::Polygon(v)) if v.len() == 3)
    );
    assert!(matches!(
        shape(2, square, "half_space = { point = [0.5, 0], normal = [1, 0] }"),
        Some(ShapeSpec::HalfSpace { .. })
    ));
    assert!(matches!(shape(2, square, "level_set = '''\nx - 0.5'''"), Some(ShapeSpec::LevelSet(_))));
    let nested = "difference = [{ union = [{ sphere = { center = [0, 0], radius = 1 } }, { level_set = \"x\" }] }, \
                  { intersection = [{ level_set = \"y\" }, { level_set = \"x\" }] }]";
    assert!(matches!(shape(2, square, nested),
        Some(ShapeSpec::Difference(parts)) if matches!(&parts[..], [ShapeSpec::Union(_), ShapeSpec::Intersection(_)])));
}

#[test]
fn domains_that_are_no_box_have_one_outer_face() {
    let disc = with_shape(2, "sphere = { center = [0, 0], radius = 1 }", "level_set = 'x'");
    assert_eq!(disc.faces(), ["outer"]);
    let level_set = with_shape(
        2,
        "level_set = 'x^2 + y^2 - 1'\nbounds = { min = [-2, -2], max = [2, 2] }",
        "level_set = 'x'",
    );
    assert_eq!(level_set.faces(), ["outer"]);
    assert_eq!(level_set.domain.bounds.map(|b| b.max), Some(vec![2.0, 2.0]));
    let cut = "difference = [{ sphere = { center = [0, 0], radius = 1 } }, { level_set = 'x' }]";
    assert!(with_shape(2, cut, "level_set = 'x'").domain.bounds.is_none());
}

#[test]
fn numbers_may_stand_for_expressions_in_every_notation() {
    for (text, value) in
        [("1_000", 1000.0), ("0x1F", 31.0), ("1e-3", 1e-3), ("\"2*3\"", 6.0), ("'''\n7'''", 7.0)]
    {
        let scene = parse(&PLATE.replace("diffusivity = 100", &format!("diffusivity = {text}")));
        assert_eq!(scene.regions[1].diffusivity.as_constant(), Some(value));
    }
}

#[test]
fn every_method_takes_its_options() {
    let with = |name: &str, option: &str| {
        let method = format!("name = \"{name}\"\nsolver = \"gmres\"\n{option}\n");
        let old = "name = \"gfdm-hybrid\"\norder = 2\nsolver = \"bicgstab\"\nsmoothing = 1\n";
        parse(&PLATE.replace(old, &method)).method
    };
    for name in ["gfdm-classical", "gfdm-positive", "gfdm-hybrid"] {
        assert_eq!(with(name, "log_scaling = false").options.log_scaling, Some(false));
        assert_eq!(with(name, "correction = true").options.correction, Some(true));
        assert_eq!(with(name, "").name.as_str(), name);
    }
    assert_eq!(
        with("gfdm-conservative", "conservative_neumann = true").options.conservative_neumann,
        Some(true)
    );
    assert_eq!(with("gfdm-positive", "selection_tolerance = 0").options.selection_tolerance, Some(0.0));
    assert_eq!(with("auto", "support = 2.5").options.support, Some(2.5));
    assert_eq!(with("auto", "").solver.as_str(), "gmres");
    assert_eq!(MethodName::parse("gfdm-hybrid"), Ok(MethodName::GfdmHybrid));
    assert_eq!(MethodName::parse("free-space"), Ok(MethodName::FreeSpace));
    assert!(MethodName::parse("gfdm-hibrid").is_err_and(|e| e.help().contains("gfdm-hybrid")));
}

#[test]
fn files_are_read_and_named_in_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plate.toml");
    std::fs::write(&path, PLATE).expect("written");
    assert_eq!(Scene::read(&path).map(|scene| scene.title), Ok("Plate".to_owned()));

    std::fs::write(&path, PLATE.replace("seed = 7", "seed = -7")).expect("written");
    let error = Scene::read(&path).expect_err("negative seed");
    assert_eq!(error.file, path.display().to_string());
    assert_eq!((error.line, error.column), (10, 8));

    std::fs::write(&path, b"title = \"\xff\"").expect("written");
    assert!(Scene::read(&path).is_err_and(|e: SceneError| e.message.contains("not UTF-8") && e.line == 0));
    assert!(
        Scene::read(folder.path().join("absent.toml")).is_err_and(|e| e.message.contains("cannot be read"))
    );
    assert!(Scene::read(folder.path()).is_err_and(|e| e.message.contains("cannot be read")));
}

#[test]
fn later_errors_show_the_place() {
    let scene = parse(PLATE);
    let source = scene.regions[0].source.as_ref().expect("a source");
    let shown =
        scene.error_at(source, "the expression gives NaN at [0, 0]", "guard it with `if`").to_string();
    assert_eq!(
        shown,
        "scene.toml:20:10: regions[0].source: the expression gives NaN at [0, 0]\n   \
         20 | source = \"-8*x\"\n      |          ^^^^^^\n   help: guard it with `if`"
    );
    let error = scene.error_at_boundaries("no condition holds at [2, 0]", "");
    assert_eq!((error.line, error.key.as_str()), (31, "boundaries"));
}
