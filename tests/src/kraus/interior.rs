//! Section 3.3: an interface that does not touch the boundary, stiff inside.

use super::{head, region};

/// The interior interface `cos(pi x/2) cos(pi y/2) = 3/4` with `eta = 1` outside and `eta = jump` inside.
pub fn interior(jump: f64, h: f64, seed: u64) -> String {
    const PHI: &str = "cos(pi*x/2)*cos(pi*y/2)";
    let source = format!("pi^2/2*{PHI}");
    head(&format!("Interior interface, jump {jump:e}"), h, seed)
        + &region(
            "inside",
            Some(&format!("0.75 - {PHI}")),
            jump,
            Some(&source),
            &format!("({PHI} - 0.75)/{jump:e} + 0.75"),
        )
        + &region("outside", None, 1.0, Some(&source), PHI)
        + "[[boundaries]]\nface = \"all\"\ndirichlet = \"0\"\n"
}
