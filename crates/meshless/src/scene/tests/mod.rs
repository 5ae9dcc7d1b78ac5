//! Scenes that are right, scenes that are wrong, and scenes that were mangled at random.

mod mangled;
mod points;
mod points_file;
mod slits;
mod valid;
mod wrong;
mod wrong_shapes;

use super::{Scene, SceneError};

/// A scene with most features, from which wrong ones are made by replacing a part.
const PLATE: &str = r#"title = "Plate"
dimension = 2

[domain]
box = { min = [0.0, 0.0], max = [2.0, 1] }

[points]
spacing = 0.05
layout = "irregular"
seed = 7

[[holes]]
name = "bolt"
sphere = { center = [1.5, 0.5], radius = 0.1 }

[[regions]]
name = "inclusion"
level_set = "(x - 1)^2 + (y - 1)^2 - 0.25"
diffusivity = "1 + x^2"
source = "-8*x"
exact = "x^2"

[[regions]]
name = "matrix"
diffusivity = 100

[[interfaces]]
between = ["inclusion", "matrix"]
flux_jump = "0.2"

[[boundaries]]
face = "left"
where = "y > 0.5"
dirichlet = "1.0"

[[boundaries]]
face = "bolt"
robin = { a = 1, b = "2", g = "x" }

[[boundaries]]
face = "all"
neumann = 0

[method]
name = "gfdm-hybrid"
order = 2
solver = "bicgstab"
smoothing = 1

[[probes]]
at = [1.0, 0.2]

[output]
vtu = true
"#;

/// A wrong scene: a part of the base replaced by a text in which « and » enclose what the error must point at.
struct Wrong {
    from: &'static str,
    to: &'static str,
    key: &'static str,
    message: &'static str,
    help: &'static str,
}

const fn wrong(
    from: &'static str,
    to: &'static str,
    key: &'static str,
    message: &'static str,
    help: &'static str,
) -> Wrong {
    Wrong { from, to, key, message, help }
}

/// Checks place, key, message and help of the error of every case.
fn check_all(base: &str, cases: &[Wrong]) {
    for case in cases {
        assert!(base.contains(case.from), "the base has no {:?}", case.from);
        let marked = base.replacen(case.from, case.to, 1);
        let (before, rest) = marked.split_once('«').expect("a mark");
        let (place, after) = rest.split_once('»').expect("two marks");
        let text = format!("{before}{place}{after}");
        let error = Scene::parse(&text, "scene.toml").expect_err(case.to);
        let line = before.lines().count().max(1) + usize::from(before.ends_with('\n'));
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        assert_eq!((error.line, error.column), (line, column), "{}\n{error}", case.to);
        assert_eq!(error.key, case.key, "{error}");
        assert!(error.message.contains(case.message), "{:?} is not in\n{error}", case.message);
        assert!(error.help.contains(case.help), "{:?} is not in\n{error}", case.help);
        check_carets(&error, place);
    }
}

/// The carets of the displayed error stand below the place, as far as it reaches in its line.
fn check_carets(error: &SceneError, place: &str) {
    let shown = error.to_string();
    let Some(carets) = shown.lines().find(|line| line.trim_start_matches([' ', '|']).starts_with('^')) else {
        assert!(place.is_empty(), "no carets in\n{shown}");
        return;
    };
    let width = place.lines().next().unwrap_or_default().chars().count().max(1);
    assert_eq!(carets.matches('^').count(), width, "{shown}");
}
