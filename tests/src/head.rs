//! A head of four concentric layers with a current dipole in the brain: the forward problem of electroencephalography.
//!
//! The potential Phi of a dipole is singular, so the scene has `u = Phi - Phi_0` in the brain, where Phi_0 is the potential
//! of the same dipole in an unbounded medium that conducts like the brain, and `u = Phi` elsewhere. u has no source; at the
//! surface of the brain it jumps by Phi_0 and its flux by `sigma dPhi_0/dn`. (N. Fiétier, Ö. Demirel, I. F. Sbalzarini,
//! section 3.1, subtract Phi_0 everywhere. In the scalp, which the skull shields, Phi is then the small difference of two
//! large potentials.) u is fixed up to a constant.
//!
//! Lengths in cm, conductivities in S/m, potentials in microvolts.

use std::fmt::Write as _;

/// Names, outer radii and conductivities of the layers, from the innermost. The fluid is thicker than that of a real
/// head, so that a cloud with a few nodes across it is small.
pub const LAYERS: [(&str, f64, f64); 4] =
    [("brain", 6.5, 0.33), ("fluid", 7.3, 1.79), ("skull", 8.2, 0.0042), ("scalp", 9.0, 0.33)];

/// The dipole sits at `(0, 0, HEIGHT)`.
pub const HEIGHT: f64 = 4.0;

/// Tangential (x) and radial (z) part of the moment, in units of 10 nA m.
pub const MOMENT: [f64; 2] = [0.6, 0.8];

/// 10 nA m over (1 cm)^2 is 1e-4 A/m, and this times m/S in microvolts is 100.
const UNIT: f64 = 100.0;

/// Degree at which the series is cut: the terms fall like `(4/9)^n` on the scalp and faster than `(4/6.5)^n` elsewhere
/// outside the brain.
const DEGREES: usize = 120;

/// The scene of u on the half `y < 0`, whose cut `y = 0` is a plane of symmetry. `spacing` is a number or an expression;
/// `at` are the probes.
pub fn head(spacing: &str, at: &[[f64; 3]]) -> String {
    let radius = LAYERS[LAYERS.len() - 1].1;
    let mut text = format!(
        "title = \"Dipole in a head of four layers\"\ndimension = 3\n\n[domain]\nintersection = [\n  \
         {{ sphere = {{ center = [0.0, 0.0, 0.0], radius = {radius:?} }} }},\n  \
         {{ half_space = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }} }},\n]\n\n\
         [points]\nspacing = \"{spacing}\"\n\n"
    );
    for (i, (name, radius, sigma)) in LAYERS.iter().enumerate() {
        let shape = format!("sphere = {{ center = [0.0, 0.0, 0.0], radius = {radius:?} }}\n");
        let shape = if i + 1 < LAYERS.len() { shape.as_str() } else { "" };
        let _ = write!(text, "[[regions]]\nname = \"{name}\"\n{shape}diffusivity = {sigma:?}\n\n");
    }
    let [(inner, _, sigma), (outer, ..), ..] = LAYERS;
    let (jump, flux) = (free_potential(), format!("{sigma:?}*{}", normal_derivative()));
    let _ = write!(
        text,
        "[[interfaces]]\nbetween = [\"{inner}\", \"{outer}\"]\njump = \"{jump}\"\nflux_jump = \"{flux}\"\n\n\
         [[boundaries]]\nface = \"outer\"\nneumann = 0\n\n"
    );
    for x in at {
        let _ = write!(text, "[[probes]]\nat = {x:?}\n\n");
    }
    text
}

/// Phi_0 as an expression.
fn free_potential() -> String {
    let [px, pz] = MOMENT;
    let factor = format!("{UNIT}/(4*pi*{})", LAYERS[0].2);
    format!("{factor}*({px}*x + {pz}*(z - {HEIGHT}))*(x^2 + y^2 + (z - {HEIGHT})^2)^-1.5")
}

/// `dPhi_0/dr` as an expression: with `d = x - x_0`, `grad Phi_0 = (p/d^3 - 3 (p.d) d/d^5) UNIT/(4 pi sigma)`.
fn normal_derivative() -> String {
    let [px, pz] = MOMENT;
    let squared = format!("(x^2 + y^2 + (z - {HEIGHT})^2)");
    let radius = "sqrt(x^2 + y^2 + z^2)";
    let along = format!("({px}*x + {pz}*z)/{radius}");
    let moment = format!("({px}*x + {pz}*(z - {HEIGHT}))");
    let distance = format!("(x^2 + y^2 + z*(z - {HEIGHT}))/{radius}");
    let factor = format!("{UNIT}/(4*pi*{})", LAYERS[0].2);
    format!("{factor}*({along}*{squared}^-1.5 - 3*{moment}*{distance}*{squared}^-2.5)")
}

/// Phi_0 at a point.
fn free(x: &[f64; 3]) -> f64 {
    let d = [x[0], x[1], x[2] - HEIGHT];
    let distance = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    UNIT * (MOMENT[0] * d[0] + MOMENT[1] * d[2])
        / (4.0 * std::f64::consts::PI * LAYERS[0].2 * distance.powi(3))
}

/// Phi at a point outside the brain; as [`correction`].
pub fn potential(x: &[f64; 3]) -> f64 {
    free(x) + correction(x)
}

/// `Phi - Phi_0` at a point outside the sphere on which the dipole lies, by the series for concentric layers
/// (J. C. de Munck, M. J. Peters, "A fast method to compute the potential in the multisphere model", IEEE Trans. Biomed.
/// Eng. 40, 1993, sections II and III, for isotropic layers).
///
/// In every layer the part of degree n is `A (r/R)^n + B (R/r)^(n+1)`. Phi_0 gives B in the brain,
/// `n (z_0/R)^(n-1)/R^2` times `P_n` for the radial moment and `(z_0/R)^(n-1)/R^2` times `P_n^1 cos(phi)` for the
/// tangential one; continuity of the potential and of `sigma d/dr` carry A and B from layer to layer; no current leaves
/// the scalp.
pub fn correction(x: &[f64; 3]) -> f64 {
    let outer = LAYERS[LAYERS.len() - 1].1;
    let r = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
    let (cos, sin) = (x[2] / r, x[0].hypot(x[1]) / r);
    let azimuth = if sin > 0.0 { x[0] / x[0].hypot(x[1]) } else { 1.0 };
    let layer =
        LAYERS.iter().position(|&(_, radius, _)| r <= radius * (1.0 + 1e-12)).unwrap_or(LAYERS.len() - 1);
    // P_n and dP_n/dcos by their recurrences; P_n^1 = sin dP_n/dcos.
    let (mut before, mut now, mut slope_before, mut slope) = (1.0, cos, 0.0, 1.0);
    let mut sum = 0.0;
    let mut decay = 1.0;
    for n in 1..=DEGREES {
        let degree = n as f64;
        let [a, b] = coefficients(degree, layer);
        let ratio = r / outer;
        // Without the brain's B: Phi_0 itself.
        let free = ratio.powi(-(n as i32) - 1);
        let radial = a * ratio.powi(n as i32) + b * free - free;
        sum += decay * radial * (MOMENT[1] * degree * now + MOMENT[0] * azimuth * sin * slope);
        decay *= HEIGHT / outer;
        (before, now) = (now, ((2.0 * degree + 1.0) * cos * now - degree * before) / (degree + 1.0));
        (slope_before, slope) = (slope, slope_before + (2.0 * degree + 1.0) * before);
    }
    UNIT / (4.0 * std::f64::consts::PI * LAYERS[0].2) * sum / (outer * outer)
}

/// A and B of degree n in a layer, for B = 1 in the brain.
fn coefficients(n: f64, layer: usize) -> [f64; 2] {
    let outer = LAYERS[LAYERS.len() - 1].1;
    // Carries (A, B) outwards through the first `count` interfaces.
    let carry = |mut ab: [f64; 2], count: usize| {
        for pair in LAYERS.windows(2).take(count) {
            let ((_, radius, below), (_, _, above)) = (pair[0], pair[1]);
            let (grows, decays) = ((radius / outer).powf(n), (outer / radius).powf(n + 1.0));
            let value = ab[0] * grows + ab[1] * decays;
            let flux = below / above * (n * ab[0] * grows - (n + 1.0) * ab[1] * decays);
            ab = [
                ((n + 1.0) * value + flux) / ((2.0 * n + 1.0) * grows),
                (n * value - flux) / ((2.0 * n + 1.0) * decays),
            ];
        }
        ab
    };
    let leaving = |ab: [f64; 2]| {
        let [a, b] = carry(ab, LAYERS.len() - 1);
        n * a - (n + 1.0) * b
    };
    let a = -leaving([0.0, 1.0]) / leaving([1.0, 0.0]);
    carry([a, 1.0], layer)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIRECTIONS: [[f64; 3]; 3] = [[0.48, -0.6, 0.64], [0.8, 0.0, -0.6], [0.0, -0.28, 0.96]];

    fn along(direction: &[f64; 3], r: f64) -> f64 {
        potential(&direction.map(|c| c * r))
    }

    /// `dPhi/dr` at r from one side, by differences of fourth order.
    fn slope(direction: &[f64; 3], r: f64, side: f64) -> f64 {
        let h = 0.01 * side;
        let values = [0.0, 1.0, 2.0, 3.0, 4.0].map(|k| along(direction, r + (k + 1e-6) * h));
        (-25.0 * values[0] + 48.0 * values[1] - 36.0 * values[2] + 16.0 * values[3] - 3.0 * values[4])
            / (12.0 * h)
    }

    #[test]
    fn potential_and_current_are_continuous_and_none_leaves_the_scalp() {
        for direction in DIRECTIONS {
            for pair in LAYERS.windows(2) {
                let ((name, radius, below), (_, _, above)) = (pair[0], pair[1]);
                let (inside, outside) = (along(&direction, radius - 1e-9), along(&direction, radius + 1e-9));
                assert!((inside - outside).abs() < 1e-5, "{name}: {inside} {outside}");
                let (inside, outside) =
                    (below * slope(&direction, radius, -1.0), above * slope(&direction, radius, 1.0));
                assert!((inside - outside).abs() < 1e-4, "{name}: {inside} {outside}");
            }
            let leaves = LAYERS[3].2 * slope(&direction, LAYERS[3].1, -1.0);
            assert!(leaves.abs() < 1e-4, "{leaves}");
        }
    }

    #[test]
    fn correction_is_harmonic_in_every_layer() {
        for r in [6.0, 7.0, 8.0, 8.7] {
            let x = DIRECTIONS[0].map(|c| c * r);
            let h = 0.01;
            let mut laplacian = -6.0 * correction(&x);
            for k in 0..3 {
                for step in [-h, h] {
                    let mut y = x;
                    y[k] += step;
                    laplacian += correction(&y);
                }
            }
            laplacian /= h * h;
            assert!(laplacian.abs() < 1e-3, "{r}: {laplacian}");
        }
    }
}
