//! The equation at a point, as the rows of fits have it.

use crate::Material;

/// `lap u + drift . grad u - decay u = -f / eta`, with `drift = grad ln eta - velocity / eta` and `decay = reaction / eta`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Operator<const D: usize> {
    pub(super) drift: [f64; D],
    pub(super) decay: f64,
}

impl<const D: usize> Operator<D> {
    /// Nothing but the Laplacian.
    pub(super) const LAPLACIAN: Self = Self { drift: [0.0; D], decay: 0.0 };

    /// That of a material at a point at which its diffusivity is `eta`; `step` is for difference quotients where there is no derivative.
    pub(super) fn of(material: &Material<D>, eta: f64, x: &[f64; D], step: f64) -> Self {
        let slope = material.diffusivity.gradient(x, step);
        let velocity = material.velocity_at(x);
        Self {
            drift: std::array::from_fn(|k| (slope[k] - velocity[k]) / eta),
            decay: material.reaction_at(x) / eta,
        }
    }
}
