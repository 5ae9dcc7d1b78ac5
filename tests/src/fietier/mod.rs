//! The problems of N. Fiétier, Ö. Demirel, I. F. Sbalzarini, "A meshless particle method for Poisson and diffusion
//! problems with discontinuous coefficients and inhomogeneous boundary conditions", sections 3 and 5.
//!
//! The paper's equation is `div(sigma grad Phi) = S`; scenes have `-div(eta grad u) = f`.

mod dipole;
mod inclusions;
mod shells;

pub use dipole::dipole;
pub use inclusions::{REFERENCE, inclusions};
pub use shells::shells;

/// Layout of the particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Particles {
    /// A Cartesian lattice.
    Lattice,
    /// A lattice whose particles are moved by up to a quarter of the spacing, with a seed.
    Jittered(u64),
    /// The paper's irregular distributions: moved by up to half of the spacing.
    Scattered(u64),
}

fn points(spacing: f64, particles: Particles) -> String {
    let (layout, seed) = match particles {
        Particles::Lattice => ("grid", 1),
        Particles::Jittered(seed) => ("jittered", seed),
        Particles::Scattered(seed) => ("scattered", seed),
    };
    format!("[points]\nspacing = {spacing:?}\nlayout = \"{layout}\"\nseed = {seed}\n\n")
}
