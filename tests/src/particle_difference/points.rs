//! The circle and the cylinder with their interface given by points, as the paper has them.

use std::f64::consts::TAU;
use std::fmt::Write;

use super::{Regularity, circle, cylinder};

/// [`circle`] of conductivities 100 outside and C = 0.1, with a polygon of so many vertices on the circle.
pub fn circle_by_points(nodes: usize, points: usize, regularity: Regularity) -> String {
    let scene = circle(100.0, 0.1, nodes, regularity);
    by_points(&scene, points, "flux_jump = \"2*1e-1\"", |_| 0.2)
}

/// [`cylinder`] with a polygon of so many vertices on the circle.
pub fn cylinder_by_points(nodes: usize, points: usize, regularity: Regularity) -> String {
    let scene = cylinder(nodes, regularity);
    let flux = "flux_jump = \"2*(y - 1)/sqrt(((x - 1)^2 + (y - 1)^2)) + 2/pi\"";
    by_points(&scene, points, flux, |angle| 2.0 * angle.sin() + 4.0 / TAU)
}

/// Replaces the circle by a polygon, and the expression of the flux jump by its values at the vertices.
fn by_points(scene: &str, points: usize, expression: &str, flux: impl Fn(f64) -> f64) -> String {
    let (mut vertices, mut values) = (String::new(), String::new());
    for k in 0..points {
        let angle = TAU * k as f64 / points as f64;
        let [x, y] = [1.0 + 0.5 * angle.cos(), 1.0 + 0.5 * angle.sin()];
        // Writing to a string does not fail.
        let _ = write!(vertices, "[{x:?}, {y:?}], ");
        let _ = write!(values, "{:?}, ", flux(angle));
    }
    let shape = "sphere = { center = [1.0, 1.0], radius = 0.5 }";
    assert!(scene.contains(shape) && scene.contains(expression), "the scene has changed");
    scene
        .replace(shape, &format!("polygon = [{vertices}]"))
        .replace(expression, &format!("flux_jump_at = {{ points = [{vertices}], values = [{values}] }}"))
}
