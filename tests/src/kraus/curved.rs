//! Section 3.2: the interface y = 2 x^3, Dirichlet conditions all round.

use super::{head, region};

/// The curved interface with `left` above and `right` below the curve.
pub fn curved(left: f64, right: f64, h: f64, seed: u64) -> String {
    const SOURCE: &str = "-120*x^4 + 24*x*(y - 15) - 2";
    const SHAPE: &str = "((y - 2*x^3)^2 - 30*(y - 2*x^3))";
    head(&format!("Curved interface, {left:e} above and {right:e} below"), h, seed)
        + &region("above", Some("2*x^3 - y"), left, Some(SOURCE), &format!("{SHAPE}/{left:e}"))
        + &region("below", None, right, Some(SOURCE), &format!("{SHAPE}/{right:e}"))
        + &format!(
            "[[boundaries]]\nface = \"all\"\ndirichlet = \"{SHAPE}/if(y > 2*x^3, {left:e}, {right:e})\"\n"
        )
}
