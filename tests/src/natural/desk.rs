//! What an engineer has on the desk: chips on coolers, thermal bridges, composites.

use std::f64::consts::PI;

use super::corners::L;
use super::{condition, head, probes, region};

/// A source of 1 in an L whose sides are at 0.
pub fn l_domain(eta: f64, spacing: f64, seed: u64) -> String {
    head("L-shape, source 1", 2, L, spacing, seed)
        + &region("l", "", eta, 1.0)
        + &condition("all", "dirichlet = 0")
        + &probes("l-domain", eta)
}

/// Cooled from below: W/(mm^2 K) and degrees C.
const COOLED: &str = "robin = { a = 0.005, b = 1, g = \"0.005*25\" }";

/// A die on a copper spreader, half of the section, in mm; `eta` is the conductivity of the die.
pub fn die(eta: f64, spacing: f64, seed: u64) -> String {
    let domain = "union = [{ box = { min = [0.0, 0.0], max = [20.0, 3.0] } }, { box = { min = [0.0, 2.0], max = [5.0, 3.5] } }]";
    head("Die on a spreader", 2, domain, spacing, seed)
        + &region("die", "box = { min = [0.0, 3.0], max = [5.0, 3.5] }", eta, 1.0)
        + &region("copper", "", 0.39, 0.0)
        + &condition("all", &format!("where = \"y < 1e-6\"\n{COOLED}"))
        + &condition("all", "neumann = 0")
        + &probes("die", eta)
}

/// The same in space, a quarter of it.
pub fn die_3d(eta: f64, spacing: f64, seed: u64) -> String {
    let domain = "union = [{ box = { min = [0.0, 0.0, 0.0], max = [20.0, 20.0, 3.0] } }, \
                  { box = { min = [0.0, 0.0, 2.0], max = [5.0, 5.0, 3.5] } }]";
    head("Die on a spreader, in space", 3, domain, spacing, seed)
        + &region("die", "box = { min = [0.0, 0.0, 3.0], max = [5.0, 5.0, 3.5] }", eta, 1.0)
        + &region("copper", "", 0.39, 0.0)
        + &condition("all", &format!("where = \"z < 1e-6\"\n{COOLED}"))
        + &condition("all", "neumann = 0")
        + &probes("die-3d", eta)
}

/// ISO 10211, case 1: half of a square column, 20 at the top and 0 at the other sides.
pub fn iso_10211_1(eta: f64, spacing: f64, seed: u64) -> String {
    head("ISO 10211, case 1", 2, "box = { min = [0.0, 0.0], max = [4.0, 8.0] }", spacing, seed)
        + &region("column", "", eta, 0.0)
        + &condition("top", "dirichlet = 20")
        + &condition("right", "neumann = 0")
        + &condition("all", "dirichlet = 0")
        + &probes("iso-10211-1", eta)
}

/// ISO 10211, case 4: an iron bar of conductivity `eta` through an insulation layer, a quarter of it, in m; resistances of
/// 0.1 on both sides, 1 inside (above) and 0 outside.
pub fn iso_10211_4(eta: f64, spacing: f64, seed: u64) -> String {
    let domain = "union = [{ box = { min = [0.0, 0.0, 0.0], max = [0.5, 0.5, 0.2] } }, \
                  { box = { min = [0.0, 0.0, 0.0], max = [0.05, 0.025, 0.6] } }]";
    let planes = "(x < 1e-6) + (y < 1e-6) + (x > 0.5 - 1e-6) + (y > 0.5 - 1e-6)";
    head("ISO 10211, case 4", 3, domain, spacing, seed)
        + &region("bar", "box = { min = [-1.0, -1.0, -1.0], max = [0.05, 0.025, 1.0] }", eta, 0.0)
        + &region("layer", "", 0.1, 0.0)
        + &condition("all", "where = \"z < 1e-6\"\nrobin = { a = 10, b = 1, g = 0 }")
        + &condition("all", &format!("where = \"{planes}\"\nneumann = 0"))
        + &condition("all", "robin = { a = 10, b = 1, g = 10 }")
        + &probes("iso-10211-4", eta)
}

/// A heated chip in a plate with u = x at its ends.
pub fn tolerance(eta: f64, spacing: f64, seed: u64) -> String {
    head("Heated chip between two values", 2, "box = { min = [-1.0, -1.0], max = [1.0, 1.0] }", spacing, seed)
        + &region("chip", "polygon = [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3], [-0.3, 0.3]]", eta, 10.0)
        + &region("plate", "", 1.0, 0.0)
        + &condition("left", "dirichlet = \"x\"")
        + &condition("right", "dirichlet = \"x\"")
        + &condition("all", "neumann = 0")
        + &probes("tolerance", eta)
}

/// A field of 1 across a cell of side 1, of which `[0, 1/2]^D` is solved for.
fn across() -> String {
    condition("left", "dirichlet = 0")
        + &condition("right", "dirichlet = 0.5")
        + &condition("all", "neumann = 0")
}

/// A square array of fibres that conduct 1e10 times as well as the matrix, a quarter of its cell.
pub fn quarter_cell(fraction: f64, spacing: f64, seed: u64) -> String {
    let radius = (fraction / PI).sqrt();
    head("Quarter cell of a square array", 2, "box = { min = [0.0, 0.0], max = [0.5, 0.5] }", spacing, seed)
        + &region("fibre", &format!("sphere = {{ center = [0.0, 0.0], radius = {radius:?} }}"), 1e10, 0.0)
        + &region("matrix", "", 1.0, 0.0)
        + &across()
        + &probes("quarter-cell", fraction)
}

/// A simple cubic array of spheres that conduct ten times as well as the matrix, an eighth of its cell.
pub fn spheres(fraction: f64, spacing: f64, seed: u64) -> String {
    let radius = (0.75 * fraction / PI).cbrt();
    head(
        "Eighth cell of a cubic array",
        3,
        "box = { min = [0.0, 0.0, 0.0], max = [0.5, 0.5, 0.5] }",
        spacing,
        seed,
    ) + &region("sphere", &format!("sphere = {{ center = [0.0, 0.0, 0.0], radius = {radius:?} }}"), 10.0, 0.0)
        + &region("matrix", "", 1.0, 0.0)
        + &across()
        + &probes("spheres", fraction)
}

fn solid(case: &str, title: &str, shape: &str, eta: f64, spacing: f64, seed: u64) -> String {
    head(title, 3, "box = { min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }", spacing, seed)
        + &region("part", shape, eta, 10.0)
        + &region("plate", "", 1.0, 0.0)
        + &condition("all", "dirichlet = 0")
        + &probes(case, eta)
}

/// A cube with a source.
pub fn heated_cube(eta: f64, spacing: f64, seed: u64) -> String {
    let shape = "box = { min = [-0.4, -0.4, -0.4], max = [0.4, 0.4, 0.4] }";
    solid("heated-cube", "Heated cube", shape, eta, spacing, seed)
}

/// A cylinder with ends and a source.
pub fn heated_cylinder(eta: f64, spacing: f64, seed: u64) -> String {
    let shape = "cylinder = { point = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 1.0], radius = 0.4, length = 0.8 }";
    solid("heated-cylinder", "Heated cylinder", shape, eta, spacing, seed)
}
