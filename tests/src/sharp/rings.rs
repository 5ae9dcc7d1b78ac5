//! A core in a ring in a plate: constants within constants.

use super::{dirichlet, head, region};

/// Radii of the core and of the ring.
const RADII: [f64; 2] = [0.3, 0.6];

/// Diffusivities of core, ring and plate. Heat is released everywhere, as much as makes the temperature fall by about 1
/// in the softest of the three: `u = c_k - (eta_min / eta_k) r^2`.
pub fn rings([core, ring, plate]: [f64; 3], spacing: f64, seed: u64) -> String {
    let softest = core.min(ring).min(plate);
    let slopes = [core, ring, plate].map(|eta| softest / eta);
    // The plate has the constant 0; the others follow from continuity.
    let c_ring = (slopes[1] - slopes[2]) * RADII[1].powi(2);
    let c_core = c_ring + (slopes[0] - slopes[1]) * RADII[0].powi(2);
    let exact = |c: f64, slope: f64| format!("{c:e} - {slope:e}*(x^2 + y^2)");
    let disc = |radius: f64| format!("sphere = {{ center = [0.0, 0.0], radius = {radius:?} }}");
    let source = format!("{:e}", 4.0 * softest);
    let outside = exact(0.0, slopes[2]);
    head(&format!("Core {core:e} in a ring {ring:e} in a plate {plate:e}"), 2, spacing, seed)
        + &region("core", &disc(RADII[0]), core, &source, &exact(c_core, slopes[0]))
        + &region("ring", &disc(RADII[1]), ring, &source, &exact(c_ring, slopes[1]))
        + &region("plate", "", plate, &source, &outside)
        + &dirichlet(&outside)
}
