//! A ball in a field of mode l = 3.

use super::{dirichlet, head, region};

/// Radius of the ball.
const RADIUS: f64 = 0.5;

/// `u = (1 + b) xyz` in the ball of diffusivity `inside`, `xyz (1 + b R^7 / r^7)` outside, where
/// `b = 3 (1 - inside) / (4 + 3 inside)` makes the flux continuous.
pub fn ball_mode(inside: f64, spacing: f64, seed: u64) -> String {
    let b = 3.0 * (1.0 - inside) / (4.0 + 3.0 * inside);
    let outside = format!("x*y*z*(1 + {:e}/(x^2 + y^2 + z^2)^3.5)", b * RADIUS.powi(7));
    let ball = format!("sphere = {{ center = [0.0, 0.0, 0.0], radius = {RADIUS:?} }}");
    let factor = 7.0 / (4.0 + 3.0 * inside);
    head(&format!("Ball in a field of mode 3, contrast {inside:e}"), 3, spacing, seed)
        + &region("ball", &ball, inside, "", &format!("{factor:e}*x*y*z"))
        + &region("outside", "", 1.0, "", &outside)
        + &dirichlet(&outside)
}
