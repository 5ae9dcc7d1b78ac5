//! An ellipse, a star, two discs close to each other, a torus: jumps of u and of the flux that vary along the interface.

use super::manufactured::{BESIDE, INSIDE, INSIDE_3D, OUTSIDE, OUTSIDE_3D, jumps};
use super::{dirichlet, head};

/// An ellipse of diffusivity `inside`.
pub fn ellipse(inside: f64, spacing: f64, seed: u64) -> String {
    let normal = ["x/0.36", "y/0.16"].map(str::to_owned);
    head("Ellipse", 2, spacing, seed)
        + &INSIDE.region("ellipse", "level_set = \"x^2/0.36 + y^2/0.16 - 1\"", inside)
        + &OUTSIDE.region("outside", "", 1.0)
        + &jumps("ellipse", (&INSIDE, inside), &OUTSIDE, &normal, "sqrt((x/0.36)^2 + (y/0.16)^2)")
        + &dirichlet(OUTSIDE.u)
}

/// `r = 0.5 + 0.1 cos 5t`, of diffusivity `inside`.
pub fn star(inside: f64, spacing: f64, seed: u64) -> String {
    let (r, slope) = ("sqrt(x^2 + y^2)", "0.5*sin(5*atan2(y, x))");
    let normal = [format!("x/{r} - {slope}*y/{r}^2"), format!("y/{r} + {slope}*x/{r}^2")];
    let length = format!("sqrt(1 + ({slope}/{r})^2)");
    let level = format!("level_set = \"{r} - 0.5 - 0.1*cos(5*atan2(y, x))\"");
    head("Star", 2, spacing, seed)
        + &INSIDE.region("star", &level, inside)
        + &OUTSIDE.region("outside", "", 1.0)
        + &jumps("star", (&INSIDE, inside), &OUTSIDE, &normal, &length)
        + &dirichlet(OUTSIDE.u)
}

/// Two discs of diffusivity `inside` and 10 at a distance of half a spacing.
pub fn pair(inside: f64, spacing: f64, seed: u64) -> String {
    let radius = 0.3;
    let disc = |center: f64| format!("sphere = {{ center = [{center:?}, 0.0], radius = {radius:?} }}");
    let normal = |center: f64| [format!("x - ({center:?})"), "y".to_owned()];
    let (left, right) = (-radius - 0.25 * spacing, radius + 0.25 * spacing);
    let length = format!("{radius:?}");
    head("Two discs at half a spacing", 2, spacing, seed)
        + &INSIDE.region("left", &disc(left), inside)
        + &BESIDE.region("right", &disc(right), 10.0)
        + &OUTSIDE.region("outside", "", 1.0)
        + &jumps("left", (&INSIDE, inside), &OUTSIDE, &normal(left), &length)
        + &jumps("right", (&BESIDE, 10.0), &OUTSIDE, &normal(right), &length)
        + &dirichlet(OUTSIDE.u)
}

/// A torus of radii 0.5 and 0.25 in space, of diffusivity `inside`.
pub fn torus(inside: f64, spacing: f64, seed: u64) -> String {
    let ring = "sqrt(x^2 + y^2)";
    let normal = [format!("({ring} - 0.5)*x/{ring}"), format!("({ring} - 0.5)*y/{ring}"), "z".to_owned()];
    head("Torus", 3, spacing, seed)
        + &INSIDE_3D.region("torus", &format!("level_set = \"({ring} - 0.5)^2 + z^2 - 0.0625\""), inside)
        + &OUTSIDE_3D.region("outside", "", 1.0)
        + &jumps("torus", (&INSIDE_3D, inside), &OUTSIDE_3D, &normal, "0.25")
        + &dirichlet(OUTSIDE_3D.u)
}
