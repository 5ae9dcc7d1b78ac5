//! Section 3.3: inclusions with a corner of 90 and of 45 degrees at the centre of the square, `c = -4`.

use super::{Regularity, dirichlet, head};

/// The first quadrant from the centre: `u = r^2 - 4 x y` inside, `r^2` outside, conductivities 1 and 10.
pub fn corner_90(nodes: usize, regularity: Regularity) -> String {
    let inside = "(x - 1)^2 + (y - 1)^2 - 4*(x - 1)*(y - 1)";
    let outside = "(x - 1)^2 + (y - 1)^2";
    // Normals from inside to outside: -x along x = 1, -y along y = 1.
    let flux = "if(abs(x - 1) < abs(y - 1), -4*(y - 1), -4*(x - 1))";
    head("Corner of 90 degrees", [0.0, 0.0], nodes, regularity)
        + &format!(
            "[[regions]]\nname = \"corner\"\n\
             intersection = [{{ half_space = {{ point = [1.0, 1.0], normal = [-1.0, 0.0] }} }}, \
             {{ half_space = {{ point = [1.0, 1.0], normal = [0.0, -1.0] }} }}]\n\
             diffusivity = 1\nsource = -4\nexact = \"{inside}\"\n\n\
             [[regions]]\nname = \"outside\"\ndiffusivity = 10\nsource = -40\nexact = \"{outside}\"\n\n\
             [[interfaces]]\nbetween = [\"corner\", \"outside\"]\nflux_jump = \"{flux}\"\n\n"
        )
        + &dirichlet(&format!("if((x > 1)*(y > 1), {inside}, {outside})"))
}

/// The eighth between the diagonal and the vertical from the centre: `u = r^2 - 4 x (x - y)` inside, `r^2` outside,
/// conductivities 1 and 10.
pub fn corner_45(nodes: usize, regularity: Regularity) -> String {
    let inside = "(x - 1)^2 + (y - 1)^2 - 4*(x - 1)*(x - y)";
    let outside = "(x - 1)^2 + (y - 1)^2";
    // Along x = 1 with the normal -x; along x = y with the normal (x - y)/sqrt(2).
    let flux = "if(2*(x - 1) < y - 1, 4*(y - 1), 4*sqrt(2)*(x - 1))";
    head("Corner of 45 degrees", [0.0, 0.0], nodes, regularity)
        + &format!(
            "[[regions]]\nname = \"corner\"\n\
             intersection = [{{ half_space = {{ point = [1.0, 1.0], normal = [-1.0, 0.0] }} }}, \
             {{ half_space = {{ point = [1.0, 1.0], normal = [1.0, -1.0] }} }}]\n\
             diffusivity = 1\nsource = 4\nexact = \"{inside}\"\n\n\
             [[regions]]\nname = \"outside\"\ndiffusivity = 10\nsource = -40\nexact = \"{outside}\"\n\n\
             [[interfaces]]\nbetween = [\"corner\", \"outside\"]\nflux_jump = \"{flux}\"\n\n"
        )
        + &dirichlet(&format!("if((x > 1)*(y > x), {inside}, {outside})"))
}
