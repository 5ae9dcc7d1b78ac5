//! Section 3.2: a disc of variable conductivity, heat released on its rim.

use super::{Regularity, dirichlet, head};

/// The disc of radius 1/2 with `kappa = r^2 + 1` in a square of conductivity `outside`; the flux jumps by `2 c`.
/// (81) of the paper has `r` for `r^2`, with which its solution does not satisfy its equation.
pub fn circle(outside: f64, c: f64, nodes: usize, regularity: Regularity) -> String {
    let r2 = "((x - 1)^2 + (y - 1)^2)";
    let exact = format!(
        "(1 - 1/(8*{outside:e}) - 1/{outside:e})/4 + ({r2}^2/2 + {r2})/{outside:e} + {c:e}/{outside:e}*log(2*sqrt({r2}))"
    );
    head("Disc of variable conductivity", [0.0, 0.0], nodes, regularity)
        + &format!(
            "[[regions]]\nname = \"disc\"\nsphere = {{ center = [1.0, 1.0], radius = 0.5 }}\n\
             diffusivity = \"{r2} + 1\"\nsource = \"-(8*{r2} + 4)\"\nexact = \"{r2}\"\n\n\
             [[regions]]\nname = \"outside\"\ndiffusivity = {outside:e}\nsource = \"-(8*{r2} + 4)\"\nexact = \"{exact}\"\n\n\
             [[interfaces]]\nbetween = [\"disc\", \"outside\"]\nflux_jump = \"2*{c:e}\"\n\n"
        )
        + &dirichlet(&exact)
}
