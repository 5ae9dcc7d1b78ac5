//! A diffusivity that varies and does not jump.

use super::{dirichlet, head};

/// `u = sin 2x cos y` on `[-1, 1]^2` where the diffusivity grows exponentially in x, from 1 to `contrast`.
pub fn graded(contrast: f64, spacing: f64, seed: u64) -> String {
    let rate = contrast.ln() / 2.0;
    let (eta, exact) = (format!("exp({rate:?}*(x + 1))"), "sin(2*x)*cos(y)");
    let source = format!("{eta}*(5*sin(2*x) - {:?}*cos(2*x))*cos(y)", 2.0 * rate);
    head(&format!("Diffusivity from 1 to {contrast:e}"), 2, spacing, seed)
        + &format!("[[regions]]\nname = \"all\"\ndiffusivity = \"{eta}\"\nsource = \"{source}\"\n")
        + &format!("exact = \"{exact}\"\n\n")
        + &dirichlet(exact)
}
