//! Parts in a square plate of diffusivity 1 whose sides are kept at 0; heat is made in one of them.

use std::f64::consts::PI;

use super::{condition, head, probes, region};

/// Heat made in a unit of area.
pub const SOURCE: f64 = 10.0;

const PLATE: &str = "box = { min = [-1.0, -1.0], max = [1.0, 1.0] }";

/// A part: its name, its shape, its diffusivity, and what it makes.
type Part<'a> = (&'a str, String, f64, f64);

fn plate(
    case: &str,
    title: &str,
    parts: &[Part<'_>],
    [eta, spacing]: [f64; 2],
    seed: u64,
    conditions: &str,
) -> String {
    let title = format!("{title}, diffusivity {eta:e}");
    let parts: String =
        parts.iter().map(|(name, shape, eta, source)| region(name, shape, *eta, *source)).collect();
    head(&title, 2, PLATE, spacing, seed)
        + &parts
        + &region("plate", "", 1.0, 0.0)
        + conditions
        + &probes(case, eta)
}

fn cold() -> String {
    condition("all", "dirichlet = 0")
}

fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> String {
    format!("box = {{ min = [{x0:?}, {y0:?}], max = [{x1:?}, {y1:?}] }}")
}

fn polygon(vertices: &[[f64; 2]]) -> String {
    format!("polygon = {vertices:?}")
}

/// Vertices of a regular polygon about the origin, the first at an angle.
fn regular(n: usize, radius: f64, start: f64) -> Vec<[f64; 2]> {
    let angle = |k| start + 2.0 * PI * k as f64 / n as f64;
    (0..n).map(angle).map(|t| [radius * t.cos(), radius * t.sin()]).collect()
}

fn chip(case: &str, title: &str, shape: String, eta: f64, spacing: f64, seed: u64) -> String {
    plate(case, title, &[("chip", shape, eta, SOURCE)], [eta, spacing], seed, &cold())
}

/// A square chip; soft where `eta` is small.
pub fn heated_box(eta: f64, spacing: f64, seed: u64) -> String {
    chip("heated-box", "Heated square chip", rectangle([-0.3, -0.3], [0.3, 0.3]), eta, spacing, seed)
}

/// An equilateral triangle.
pub fn heated_triangle(eta: f64, spacing: f64, seed: u64) -> String {
    chip("heated-triangle", "Heated triangle", polygon(&regular(3, 0.4, PI / 2.0)), eta, spacing, seed)
}

/// Twelve corners of 150 degrees.
pub fn heated_12_gon(eta: f64, spacing: f64, seed: u64) -> String {
    chip("heated-12-gon", "Heated 12-gon", polygon(&regular(12, 0.3, 0.0)), eta, spacing, seed)
}

/// A chip with a re-entrant corner.
pub fn heated_l(eta: f64, spacing: f64, seed: u64) -> String {
    let shape = polygon(&[[-0.3, -0.3], [0.3, -0.3], [0.3, 0.0], [0.0, 0.0], [0.0, 0.3], [-0.3, 0.3]]);
    chip("heated-l", "Heated L", shape, eta, spacing, seed)
}

/// What two discs have in common: two corners between arcs.
pub fn heated_lens(eta: f64, spacing: f64, seed: u64) -> String {
    let disc = |x: f64| format!("{{ sphere = {{ center = [{x:?}, 0.0], radius = 0.5 }} }}");
    let shape = format!("intersection = [{}, {}]", disc(-0.3), disc(0.3));
    chip("heated-lens", "Heated lens", shape, eta, spacing, seed)
}

/// Two boxes that share half an edge: one is heated, the other conducts three times as well.
pub fn touching_edge(eta: f64, spacing: f64, seed: u64) -> String {
    let a = ("a", rectangle([-0.4, -0.3], [0.0, 0.1]), eta, SOURCE);
    let b = ("b", rectangle([0.0, -0.1], [0.4, 0.3]), 3.0 * eta, 0.0);
    plate("touching-edge", "Boxes that share half an edge", &[a, b], [eta, spacing], seed, &cold())
}

/// Two boxes that touch in a corner, one of them heated.
pub fn touching_corner(eta: f64, spacing: f64, seed: u64) -> String {
    let a = ("a", rectangle([-0.4, -0.4], [0.0, 0.0]), eta, SOURCE);
    let b = ("b", rectangle([0.0, 0.0], [0.4, 0.4]), eta, 0.0);
    plate("touching-corner", "Boxes that touch in a corner", &[a, b], [eta, spacing], seed, &cold())
}

/// A box on an insulated wall.
pub fn box_on_wall(eta: f64, spacing: f64, seed: u64) -> String {
    let shape = rectangle([-1.0, -0.3], [-0.4, 0.3]);
    let conditions = condition("left", "neumann = 0") + &cold();
    plate(
        "box-on-wall",
        "Heated box on a wall",
        &[("chip", shape, eta, SOURCE)],
        [eta, spacing],
        seed,
        &conditions,
    )
}

#[cfg(test)]
mod tests {
    use super::super::references::{Quantity, table};
    use super::SOURCE;

    /// Two independent ways to the same figure: what is made leaves.
    #[test]
    fn the_fluxes_of_the_references_are_what_is_made() {
        let (radius, half) = (0.5_f64, 0.3_f64);
        let lens = 2.0 * radius * radius * (half / radius).acos()
            - half * 2.0 * (radius * radius - half * half).sqrt();
        let areas = [
            ("heated-box", 0.36),
            ("heated-triangle", 0.75 * 3.0_f64.sqrt() * 0.16),
            ("heated-12-gon", 0.27),
            ("heated-l", 0.27),
            ("heated-lens", lens),
            ("touching-edge", 0.16),
            ("touching-corner", 0.16),
            ("box-on-wall", 0.36),
        ];
        for (case, area) in areas {
            let found: Vec<f64> = table()
                .iter()
                .filter(|f| f.case == case && f.quantity == Quantity::Flux)
                .map(|f| f.value / (SOURCE * area) + 1.0)
                .collect();
            assert!(!found.is_empty() && found.iter().all(|e| e.abs() < 1e-8), "{case}: {found:?}");
        }
    }
}
