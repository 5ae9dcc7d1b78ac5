//! Section 3.5: potential flow about a cylinder of radius 1/2 with circulation; the stream function vanishes inside.

use super::{Regularity, dirichlet, head};

/// [`cylinder`] as the paper solves it: u = 0 is prescribed on the circle, and the jump of the slope follows.
pub fn cylinder_prescribed(nodes: usize, regularity: Regularity) -> String {
    let scene = cylinder(nodes, regularity);
    let (first, last) = (scene.find("flux_jump ="), scene.find("[[boundaries]]"));
    match (first, last) {
        (Some(first), Some(last)) => format!("{}dirichlet = 0\n\n{}", &scene[..first], &scene[last..]),
        _ => scene,
    }
}

/// Uniform speed 1, circulation -2; the conductivity is 1 everywhere, the flux jumps by `2 sin(theta) + 2/pi`.
pub fn cylinder(nodes: usize, regularity: Regularity) -> String {
    let r2 = "((x - 1)^2 + (y - 1)^2)";
    let stream = format!("(y - 1)*(1 - 0.25/{r2}) + log(sqrt({r2})/0.5)/pi");
    head("Flow about a cylinder", [0.0, 0.0], nodes, regularity)
        + &format!(
            "[[regions]]\nname = \"cylinder\"\nsphere = {{ center = [1.0, 1.0], radius = 0.5 }}\n\
             diffusivity = 1\nexact = \"0\"\n\n\
             [[regions]]\nname = \"flow\"\ndiffusivity = 1\nexact = \"{stream}\"\n\n\
             [[interfaces]]\nbetween = [\"cylinder\", \"flow\"]\n\
             flux_jump = \"2*(y - 1)/sqrt({r2}) + 2/pi\"\n\n"
        )
        + &dirichlet(&stream)
}
