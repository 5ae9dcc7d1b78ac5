//! Four materials that meet at a point.

use super::{dirichlet, head, region};

/// Where they meet: no node is there.
const VERTEX: [f64; 2] = [0.013, 0.021];

/// `u = sin(x - a) sin(y - b) / eta` in the quadrants of diffusivity 1, `contrast`, 10 and the root of the contrast: u
/// vanishes on all legs, and the flux through them does not depend on eta.
pub fn quadrants(contrast: f64, spacing: f64, seed: u64) -> String {
    let [a, b] = VERTEX;
    let eta = [1.0, contrast, 10.0, contrast.sqrt()];
    let shape = format!("sin(x - {a})*sin(y - {b})");
    let corner =
        |x: f64, y: f64| format!("box = {{ min = [{:?}, {:?}], max = [{x:?}, {y:?}] }}", x - 3.0, y - 3.0);
    let geometry = [corner(a, b), corner(a + 3.0, b), corner(a, b + 3.0), String::new()];
    let mut text = head(&format!("Four materials, contrast {contrast:e}"), 2, spacing, seed);
    for (k, (geometry, eta)) in geometry.iter().zip(eta).enumerate() {
        text += &region(&format!("q{k}"), geometry, eta, &format!("2*{shape}"), &format!("{shape}/{eta:e}"));
    }
    let [e0, e1, e2, e3] = eta;
    let here = format!("if(y > {b}, if(x > {a}, {e3:e}, {e2:e}), if(x > {a}, {e1:e}, {e0:e}))");
    text + &dirichlet(&format!("{shape}/{here}"))
}
