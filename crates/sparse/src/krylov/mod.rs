//! Krylov methods, preconditioned from the right: the residual that they watch is the true one but for round-off.

mod bicgstab;
mod gmres;

pub(crate) use bicgstab::bicgstab;
pub(crate) use gmres::gmres;

/// What an iteration came to; `iterations` counts products with the matrix.
pub(crate) struct Outcome {
    pub(crate) iterations: usize,
    /// A scalar vanished; a restart from the current iterate may help.
    pub(crate) broke_down: bool,
}
