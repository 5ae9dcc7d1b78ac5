//! Section 3.1: two strips, a solution that is linear in each.

use super::{STRIP_BOUNDARIES, head, region};

/// The two-strip problem with `eta = 1` for x < 0 and `eta = jump` for x > 0, interaction radius `h`.
pub fn two_strip(jump: f64, h: f64, seed: u64) -> String {
    // Continuity of the flux: eta_L s_L = eta_R s_R, and u falls by s_L + s_R = 1 from left to right.
    let (left, right) = (jump / (1.0 + jump), 1.0 / (1.0 + jump));
    head(&format!("Two strips, jump {jump:e}"), h, seed)
        + &region("left", Some("x"), 1.0, None, &format!("2 - {left:e}*(x + 1)"))
        + &region("right", None, jump, None, &format!("1 + {right:e}*(1 - x)"))
        + STRIP_BOUNDARIES
}
