//! The disc of section 3.2 in three dimensions.

use super::{Regularity, dirichlet, points};

/// A ball of radius 1/2 with `kappa = r^2 + 1` in a cube of edge 2 of conductivity `outside`; the flux jumps by `4 c`.
///
/// Inside `u = r^2`, so `div(kappa grad u) = r^-2 d/dr (r^2 (r^2 + 1) 2 r) = 10 r^2 + 6 = f`. Outside
/// `kappa u' = 2 r^3 + 2 r + c/r^2` has the same divergence for any c; it exceeds the flux inside, `2 r^3 + 2 r`, by
/// `c/r^2 = 4 c` at r = 1/2. Integrated, with u continuous there:
/// `u = 1/4 + (r^4/2 + r^2 - 9/32 - c (1/r - 2))/kappa`.
pub fn ball(outside: f64, c: f64, spacing: f64, regularity: Regularity) -> String {
    let r2 = "((x - 1)^2 + (y - 1)^2 + (z - 1)^2)";
    let exact = format!("1/4 + ({r2}^2/2 + {r2} - 9/32 - {c:e}*(1/sqrt({r2}) - 2))/{outside:e}");
    format!(
        "title = \"Ball of variable conductivity\"\ndimension = 3\n\n\
         [domain]\nbox = {{ min = [0.0, 0.0, 0.0], max = [2.0, 2.0, 2.0] }}\n\n{}\
         [[regions]]\nname = \"ball\"\nsphere = {{ center = [1.0, 1.0, 1.0], radius = 0.5 }}\n\
         diffusivity = \"{r2} + 1\"\nsource = \"-(10*{r2} + 6)\"\nexact = \"{r2}\"\n\n\
         [[regions]]\nname = \"outside\"\ndiffusivity = {outside:e}\nsource = \"-(10*{r2} + 6)\"\nexact = \"{exact}\"\n\n\
         [[interfaces]]\nbetween = [\"ball\", \"outside\"]\nflux_jump = \"4*{c:e}\"\n\n",
        points(spacing, regularity),
    ) + &dirichlet(&exact)
}
