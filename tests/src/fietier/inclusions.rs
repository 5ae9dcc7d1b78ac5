//! Section 5.3: two balls of prescribed values in a large one.

use super::{Particles, points};

/// The solution along the line y = z = 0: x and u. By multipole collocation (residual 2e-11) and, to 5e-7, by finite
/// elements.
pub const REFERENCE: [(f64, f64); 12] = [
    (-80.0, 1877.807431),
    (-74.0, 2253.977580),
    (-66.0, 3067.986967),
    (-58.0, 4488.160876),
    (0.0, 4426.219093),
    (8.0, 4444.834100),
    (16.0, 5078.615702),
    (24.0, 6599.390586),
    (30.0, 8851.593597),
    (66.0, 9114.875323),
    (74.0, 7109.177400),
    (80.0, 6539.792609),
];

/// A ball of radius 80 with `du/dn = -50` on its surface, around balls of radius 24 about (-32, 0, 0) with `u = 5000` and
/// of radius 16 about (48, 0, 0) with `u = 10000`; probes at the points of [`REFERENCE`].
pub fn inclusions(spacing: f64, particles: Particles) -> String {
    let hole = |name: &str, x: f64, radius: f64| {
        format!(
            "[[holes]]\nname = \"{name}\"\nsphere = {{ center = [{x:?}, 0.0, 0.0], radius = {radius:?} }}\n\n"
        )
    };
    let probes: String =
        REFERENCE.iter().map(|(x, _)| format!("\n[[probes]]\nat = [{x:?}, 0.0, 0.0]\n")).collect();
    "title = \"Two inclusions\"\ndimension = 3\n\n\
     [domain]\nsphere = { center = [0.0, 0.0, 0.0], radius = 80.0 }\n\n"
        .to_owned()
        + &hole("west", -32.0, 24.0)
        + &hole("east", 48.0, 16.0)
        + &points(spacing, particles)
        + "[[regions]]\nname = \"medium\"\ndiffusivity = \"1\"\n\n\
           [[boundaries]]\nface = \"west\"\ndirichlet = \"5000\"\n\n\
           [[boundaries]]\nface = \"east\"\ndirichlet = \"10000\"\n\n\
           [[boundaries]]\nface = \"outer\"\nneumann = \"-50\"\n"
        + &probes
}
