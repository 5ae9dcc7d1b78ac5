//! Problems in which something small decides, in closed form, and scenes that say nothing of the cloud.

use super::{condition, head};

/// A scene that gives an error to reach, and nothing of nodes.
pub fn to_tolerance(text: &str, tolerance: f64) -> String {
    let mut kept = String::new();
    let mut in_points = false;
    for line in text.lines() {
        if line.starts_with('[') {
            in_points = line == "[points]";
        }
        if !in_points {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept + &format!("\n[accuracy]\ntolerance = {tolerance:e}\n")
}

fn region(name: &str, shape: &str, diffusivity: f64, source: &str, exact: &str) -> String {
    let line = |key: &str, value: &str| {
        if value.is_empty() { String::new() } else { format!("{key} = \"{value}\"\n") }
    };
    format!("[[regions]]\nname = \"{name}\"\n{shape}\ndiffusivity = {diffusivity:e}\n")
        + &line("source", source)
        + &line("exact", exact)
        + "\n"
}

const SQUARE: &str = "box = { min = [0.0, 0.0], max = [1.0, 1.0] }";

/// A layer of a width in the middle of a square: `tanh((x - 1/2) / w)` by its source, with its values on two sides and nothing through the others.
pub fn layer(width: f64, spacing: f64, seed: u64) -> String {
    let s = format!("((x - 0.5)/{width:e})");
    let u = format!("tanh{s}");
    let source = format!("2/{:e}*{u}*(1 - {u}^2)", width * width);
    head("Interior layer", 2, SQUARE, spacing, seed)
        + &region("all", "", 1.0, &source, &u)
        + &condition("left", &format!("dirichlet = \"{u}\""))
        + &condition("right", &format!("dirichlet = \"{u}\""))
        + &condition("all", "neumann = 0")
}

/// Where u is known in [`point`], and what it is: `-ln(r) / 2 pi`, as beyond what the source reaches.
pub const POINT_PROBES: [[f64; 2]; 3] = [[0.5, 0.0], [0.0, 0.1], [-0.6, 0.5]];

/// A source of 1 in a spot of a width in the middle of a disc of radius 1 whose rim is at 0.
pub fn point(width: f64, spacing: f64, seed: u64) -> String {
    let squared = width * width;
    let source = format!("1/(pi*{squared:e})*exp(-(x^2 + y^2)/{squared:e})");
    let probes: String = POINT_PROBES.iter().map(|at| format!("[[probes]]\nat = {at:?}\n\n")).collect();
    head("Narrow source", 2, "sphere = { center = [0.0, 0.0], radius = 1.0 }", spacing, seed)
        + &region("all", "", 1.0, &source, "")
        + &condition("all", "dirichlet = 0")
        + &probes
}

/// Two discs of radius 1, far better conductors than what is round them, with a gap between them; as much heat is made in one as is taken in the other, so that they
/// are at 1 and -1. Bipolar coordinates have u in closed form; it is given on the sides of a box.
pub fn discs(gap: f64, spacing: f64, seed: u64) -> String {
    let center = 1.0 + 0.5 * gap;
    let a = (center * center - 1.0).sqrt();
    let height = center.acosh();
    let u = format!("log(((x + {a:e})^2 + y^2)/((x - {a:e})^2 + y^2))/{:e}", 2.0 * height);
    // The flux round a disc is 2 pi over the height.
    let made = 2.0 / height;
    let disc = |x: f64| format!("sphere = {{ center = [{x:?}, 0.0], radius = 1.0 }}");
    let probes = format!("[[probes]]\nat = [{center:?}, 0.0]\n\n[[probes]]\nat = [{:?}, 0.0]\n\n", -center);
    head("Two discs with a gap", 2, "box = { min = [-3.0, -2.0], max = [3.0, 2.0] }", spacing, seed)
        + &region("warm", &disc(center), 1e10, &format!("{made:e}"), "1")
        + &region("cold", &disc(-center), 1e10, &format!("-{made:e}"), "-1")
        + &region("matrix", "", 1.0, "", &u)
        + &condition("all", &format!("dirichlet = \"{u}\""))
        + &probes
}

/// A film of a thickness, and of that diffusivity, between two halves of a square at 0 and 1.
pub fn film(thickness: f64, spacing: f64, seed: u64) -> String {
    let to = 0.5 + thickness;
    let flux = 1.0 / (2.0 - thickness);
    let before = format!("{flux:e}*x");
    let within = format!("{flux:e}*(0.5 + (x - 0.5)/{thickness:e})");
    let beyond = format!("1 - {flux:e}*(1 - x)");
    let shape = format!("box = {{ min = [0.5, -1.0], max = [{to:?}, 2.0] }}");
    let exact = format!("if(x < 0.5, {before}, {beyond})");
    head("Film", 2, SQUARE, spacing, seed)
        + &region("film", &shape, thickness, "", &within)
        + &region("halves", "", 1.0, "", &exact)
        + &condition("left", "dirichlet = 0")
        + &condition("right", "dirichlet = 1")
        + &condition("all", "neumann = 0")
}

/// A beam whose section is an L, `(1 + z) r^(2/3) cos(2 t / 3)`.
pub fn beam(_: f64, spacing: f64, seed: u64) -> String {
    let u = "if(x^2 + y^2 < 1e-20, 0, (1 + z)*(x^2 + y^2)^(1/3)*cos(2/3*atan2(-x - y, y - x)))";
    let domain = "union = [{ box = { min = [-1.0, -1.0, 0.0], max = [0.0, 1.0, 1.0] } }, \
                  { box = { min = [-1.0, 0.0, 0.0], max = [1.0, 1.0, 1.0] } }]";
    head("Beam with a section of an L", 3, domain, spacing, seed)
        + &region("beam", "", 1.0, "", u)
        + &condition("all", &format!("dirichlet = \"{u}\""))
}
