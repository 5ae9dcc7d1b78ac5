//! Section 3.2: three concentric shells.

use super::{Particles, points};

/// Three shells of radii 32, 56 and 80 about a ball of radius 16 on which `u = 5000`; on the outer surface
/// `du/dn = -60`. Diffusivities 1, 8/49 and 4/75, so that slopes at the outer radii of the shells are -20, -40 and -60.
///
/// `u = -A / r + B` in every shell, (3.8) to (3.14) with the constants written out.
pub fn shells(spacing: f64, particles: Particles) -> String {
    let radius = "sqrt(x^2 + y^2 + z^2)";
    let shell = |name: &str, outer: Option<f64>, diffusivity: &str, a: &str, b: &str| {
        let shape = outer
            .map_or(String::new(), |r| format!("sphere = {{ center = [0.0, 0.0, 0.0], radius = {r:?} }}\n"));
        format!(
            "[[regions]]\nname = \"{name}\"\n{shape}diffusivity = \"{diffusivity}\"\nexact = \"{a}/{radius} + {b}\"\n\n"
        )
    };
    "title = \"Three shells\"\ndimension = 3\n\n\
         [domain]\nsphere = { center = [0.0, 0.0, 0.0], radius = 80.0 }\n\n\
         [[holes]]\nname = \"electrode\"\nsphere = { center = [0.0, 0.0, 0.0], radius = 16.0 }\n\n"
        .to_owned()
        + &points(spacing, particles)
        + &shell("inner", Some(32.0), "1", "20480", "3720")
        + &shell("middle", Some(56.0), "8/49", "125440", "440")
        + &shell("outer", None, "4/75", "384000", "(-29240/7)")
        + "[[boundaries]]\nface = \"electrode\"\ndirichlet = \"5000\"\n\n\
           [[boundaries]]\nface = \"outer\"\nneumann = \"-60\"\n"
}
