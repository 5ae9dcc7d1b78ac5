//! Singular solutions in closed form: the data on the boundary are theirs, what is inside has to be found.

use super::{condition, head};

/// u where it is given, 0 at the corner itself, where its gradient is infinite.
fn guarded(u: &str) -> String {
    format!("if(x^2 + y^2 < 1e-20, 0, {u})")
}

fn region(name: &str, shape: &str, diffusivity: f64, exact: &str) -> String {
    format!("[[regions]]\nname = \"{name}\"\n{shape}\ndiffusivity = {diffusivity:?}\nexact = \"{exact}\"\n\n")
}

fn given(u: &str) -> String {
    condition("all", &format!("dirichlet = \"{u}\""))
}

/// The L from (-1, -1) to (1, 1) without the quadrant x > 0, y < 0.
pub(super) const L: &str =
    "polygon = [[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]]";

/// `r^(2/3) cos(2 t / 3)`, t the angle from the diagonal of the L.
pub fn l_shape(_: f64, spacing: f64, seed: u64) -> String {
    let u = guarded("(x^2 + y^2)^(1/3)*cos(2/3*atan2(-x - y, y - x))");
    head("L-shape, r^(2/3)", 2, L, spacing, seed) + &region("l", "", 1.0, &u) + &given(&u)
}

/// A side that is insulated on its left half and at 0 on its right one: `r^(1/2) sin(t/2)`.
pub fn mixed(_: f64, spacing: f64, seed: u64) -> String {
    let u = guarded("(x^2 + y^2)^(1/4)*sin(atan2(y, x)/2)");
    let domain = "box = { min = [-1.0, 0.0], max = [1.0, 1.0] }";
    head("A side at 0 beside an insulated one", 2, domain, spacing, seed)
        + &region("all", "", 1.0, &u)
        + &condition("bottom", "where = \"x < 0\"\nneumann = 0")
        + &given(&u)
}

/// R. B. Kellogg, "On the Poisson equation with intersecting interfaces", Appl. Anal. 4 (1975), with the constants of P. Morin,
/// R. H. Nochetto, K. G. Siebert, "Data oscillation and convergence of adaptive FEM", SIAM J. Numer. Anal. 38 (2000):
/// four quadrants, `r^0.1 mu(t)`.
pub fn kellogg(_: f64, spacing: f64, seed: u64) -> String {
    const RATIO: f64 = 161.447_638_797_588_1;
    const SIGMA: f64 = -14.922_565_104_551_52;
    let cos = |shift: f64| format!("cos(0.1*({shift:?}))");
    // An angle from 0 to 2 pi; what is below the axis by round-off alone is on it.
    let angle = |shift: f64| {
        format!("cos(0.1*(atan2(if(abs(y) < 1e-12, 0, y), x) + if(y < -1e-12, 2*pi, 0) - ({shift:?})))")
    };
    let pi = std::f64::consts::PI;
    let rho = pi / 4.0;
    let mu = [
        format!("{}*{}", cos(pi / 2.0 - SIGMA), angle(pi / 2.0 - rho)),
        format!("{}*{}", cos(rho), angle(pi - SIGMA)),
        format!("{}*{}", cos(SIGMA), angle(pi + rho)),
        format!("{}*{}", cos(pi / 2.0 - rho), angle(1.5 * pi + SIGMA)),
    ];
    let u = |parts: String| guarded(&format!("(x^2 + y^2)^0.05*{parts}"));
    let stiff = u(format!("if(x + y > 0, {}, {})", mu[0], mu[2]));
    let soft = u(format!("if(y > 0, {}, {})", mu[1], mu[3]));
    let all = u(format!("if(y < -1e-12, if(x < 0, {}, {}), if(x > 0, {}, {}))", mu[2], mu[3], mu[0], mu[1]));
    let shape = "union = [{ box = { min = [0.0, 0.0], max = [2.0, 2.0] } }, { box = { min = [-2.0, -2.0], max = [0.0, 0.0] } }]";
    head("Kellogg's quadrants", 2, "box = { min = [-1.0, -1.0], max = [1.0, 1.0] }", spacing, seed)
        + &region("stiff", shape, RATIO, &stiff)
        + &region("soft", "", 1.0, &soft)
        + &given(&all)
}
