//! A disc in a field of mode 3: no source, no jump, all in the contrast.

use super::{dirichlet, head, region};

/// Radius of the disc.
const RADIUS: f64 = 0.5;

/// `u = (1 + b) r^3 cos 3t` in the disc of diffusivity `inside`, `(r^3 + b R^6 / r^3) cos 3t` outside, where
/// `b = (1 - inside) / (1 + inside)` makes the flux continuous.
pub fn circle_mode(inside: f64, spacing: f64, seed: u64) -> String {
    let b = (1.0 - inside) / (1.0 + inside);
    let mode = "(x^3 - 3*x*y^2)";
    let outside = format!("{mode}*(1 + {:e}/(x^2 + y^2)^3)", b * RADIUS.powi(6));
    let disc = format!("sphere = {{ center = [0.0, 0.0], radius = {RADIUS:?} }}");
    // 1 + b without the cancellation of a stiff disc.
    let factor = 2.0 / (1.0 + inside);
    head(&format!("Disc in a field of mode 3, contrast {inside:e}"), 2, spacing, seed)
        + &region("disc", &disc, inside, "", &format!("{factor:e}*{mode}"))
        + &region("outside", "", 1.0, "", &outside)
        + &dirichlet(&outside)
}
