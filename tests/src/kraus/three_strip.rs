//! Section 3.4: three strips; the middle one touches no Dirichlet condition.

use super::{STRIP_BOUNDARIES, head, region};

/// The three-strip problem with jumps `jump_left` at x = -1/3 and `jump_right` at x = 1/3; `eta = 1` on the left.
pub fn three_strip(jump_left: f64, jump_right: f64, h: f64, seed: u64) -> String {
    let (left, middle, right) = (1.0, jump_left, jump_left * jump_right);
    // Each strip is 2/3 wide, and u falls by 1 in all.
    let flux = 1.0 / (2.0 / 3.0 * (1.0 / left + 1.0 / middle + 1.0 / right));
    let (s_left, s_middle, s_right) = (flux / left, flux / middle, flux / right);
    let at_first = 2.0 - s_left * 2.0 / 3.0;
    head(&format!("Three strips, jumps {jump_left:e} and {jump_right:e}"), h, seed)
        + &region("left", Some("x + 1/3"), left, None, &format!("2 - {s_left:e}*(x + 1)"))
        + &region("middle", Some("x - 1/3"), middle, None, &format!("{at_first:e} - {s_middle:e}*(x + 1/3)"))
        + &region("right", None, right, None, &format!("1 + {s_right:e}*(1 - x)"))
        + STRIP_BOUNDARIES
}
