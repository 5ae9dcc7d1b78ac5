//! Section 3.1: the correction potential of a dipole between two conductors.

use super::{Particles, points};

/// A line of length 160 whose inner half has diffusivity 1 and whose outer quarters have 31/28. The potential of a dipole
/// at 0 in the homogeneous medium is subtracted, so that the flux jumps by 480/7 at the interfaces; the solution is linear
/// with slopes 20 and 80, and 4000 at 0.
///
/// (3.5) and (3.6) without their factors R: `F2 = -phi'(R2)`, `F1 = (s - 1) phi'(R1) - s phi'(R2)` with s the quotient of
/// the diffusivities. The paper names neither radii nor diffusivities: R1 = 40 and R2 = 80 give s = 31/28.
pub fn dipole(spacing: f64, particles: Particles) -> String {
    "title = \"Dipole\"\ndimension = 1\n\n[domain]\nbox = { min = [-80.0], max = [80.0] }\n\n".to_owned()
        + &points(spacing, particles)
        + "[[regions]]\nname = \"inner\"\nbox = { min = [-40.0], max = [40.0] }\ndiffusivity = \"1\"\n\
           exact = \"4000 + 20*x\"\n\n\
           [[regions]]\nname = \"outer\"\ndiffusivity = \"31/28\"\n\
           exact = \"4000 + 80*x - if(x > 0, 2400, -2400)\"\n\n\
           [[interfaces]]\nbetween = [\"inner\", \"outer\"]\nflux_jump = \"if(x > 0, 480/7, -480/7)\"\n\n\
           [[boundaries]]\nface = \"left\"\ndirichlet = \"0\"\n\n\
           [[boundaries]]\nface = \"right\"\nneumann = \"80\"\n"
}
