//! Section 3.4: a slit that ends inside the domain; and a crack that ends there twice.

use super::{Regularity, dirichlet, head};

/// How the slit is told and what is done about its tip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SlitSetup {
    /// u vanishes on the slit; otherwise its flux jumps as much as that of the solution.
    pub dirichlet: bool,
    /// The singular functions of the tip are in the fits near it.
    pub enriched: bool,
    /// The spacing falls with the square root of the distance from the tip; on a scattered cloud.
    pub graded: bool,
}

/// `Im sqrt(z^2 + 1)` in the square from (-1, 0) to (1, 2), with the slit from (0, 0) to the tip (0, 1).
///
/// With the angles a and b of `z - i` and `z + i` from the vertical, and r, s their lengths, that is
/// `sqrt(r s) cos((a + b)/2)`. It vanishes at y = 0 and on the slit, where its slope is `+-y/sqrt(1 - y^2)`.
pub fn slit(nodes: usize, regularity: Regularity, setup: SlitSetup) -> String {
    let exact = "if(x^2 + (y - 1)^2 < 1e-20, 0, ((x^2 + (y - 1)^2)*(x^2 + (y + 1)^2))^(1/4)*\
                 cos((atan2(x, y - 1) + atan2(x, y + 1))/2))";
    let condition = if setup.dirichlet { "dirichlet = 0" } else { "flux_jump = \"2*y/sqrt(1 - y^2)\"" };
    let enrichment = if setup.enriched { "" } else { "enrichment = 0\n" };
    let mut scene = head("Slit", [-1.0, 0.0], nodes, regularity)
        + &format!(
            "[[slits]]\nname = \"slit\"\npolyline = [[0.0, 0.0], [0.0, 1.0]]\n{condition}\n{enrichment}\n\
             [[regions]]\nname = \"all\"\ndiffusivity = 1\nexact = \"{exact}\"\n\n"
        )
        + &dirichlet(exact);
    if setup.graded {
        let h = 2.0 / (nodes - 1) as f64;
        let graded = format!("spacing = \"{h:?}*(0.05 + 1.2*sqrt(sqrt(x^2 + (y - 1)^2)))\"");
        scene = scene.replace(&format!("spacing = {h:?}"), &graded);
    }
    scene
}

/// `Im sqrt(z^2 - 1/4)` in the square from (-1, -1) to (1, 1): heat that flows past a crack from (-1/2, 0) to (1/2, 0)
/// through which none flows.
///
/// With the angles a and b of `z - 1/2` and `z + 1/2`, and r, s their lengths, that is `sqrt(r s) sin((a + b)/2)`; on the
/// crack it is `+-sqrt(1/4 - x^2)`, constant to first order across it.
pub fn crack(nodes: usize, regularity: Regularity, enriched: bool) -> String {
    let lengths = "(((x - 0.5)^2 + y^2)*((x + 0.5)^2 + y^2))";
    let exact =
        format!("if({lengths} < 1e-20, 0, {lengths}^(1/4)*sin((atan2(y, x - 0.5) + atan2(y, x + 0.5))/2))");
    let enrichment = if enriched { "" } else { "enrichment = 0\n" };
    head("Crack", [-1.0, -1.0], nodes, regularity)
        + &format!(
            "[[slits]]\nname = \"crack\"\npolyline = [[-0.5, 0.0], [0.5, 0.0]]\nflux = 0\n{enrichment}\n\
             [[regions]]\nname = \"all\"\ndiffusivity = 1\nexact = \"{exact}\"\n\n"
        )
        + &dirichlet(&exact)
}
