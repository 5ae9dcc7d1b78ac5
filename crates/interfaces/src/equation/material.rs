//! The equation inside of a region.

use crate::Field;

/// The data of one region.
#[derive(Debug, Clone)]
pub struct Material<const D: usize> {
    /// The diffusivity eta, positive.
    pub diffusivity: Field<D>,
    /// The source f; `None` where there is none.
    pub source: Option<Field<D>>,
    /// The factor of `du/dt`, positive (rho c of a material that conducts heat); `None` for 1. Steady problems do not see it.
    pub capacity: Option<Field<D>>,
    /// The velocity of `velocity . grad u`, a field for each axis; `None` for none.
    pub velocity: Option<[Field<D>; D]>,
    /// The factor of u, not negative where the problem is to have one solution; `None` for zero.
    pub reaction: Option<Field<D>>,
}

impl<const D: usize> Material<D> {
    /// A material that conducts, and nothing else.
    ///
    /// ```
    /// use meshless_interfaces::{Field, Material};
    /// let copper: Material<3> = Material::new(Field::Constant(400.0));
    /// assert!(copper.source.is_none() && !copper.has_lower_terms());
    /// ```
    pub fn new(diffusivity: Field<D>) -> Self {
        Self { diffusivity, source: None, capacity: None, velocity: None, reaction: None }
    }

    /// Whether the equation has terms in u and its gradient beside the diffusion.
    pub fn has_lower_terms(&self) -> bool {
        self.velocity.is_some() || self.reaction.is_some()
    }

    /// The capacity at a point.
    pub fn capacity_at(&self, x: &[f64; D]) -> f64 {
        self.capacity.as_ref().map_or(1.0, |field| field.at(x))
    }

    /// The velocity at a point.
    pub fn velocity_at(&self, x: &[f64; D]) -> [f64; D] {
        self.velocity.as_ref().map_or([0.0; D], |fields| fields.each_ref().map(|field| field.at(x)))
    }

    /// The factor of u at a point.
    pub fn reaction_at(&self, x: &[f64; D]) -> f64 {
        self.reaction.as_ref().map_or(0.0, |field| field.at(x))
    }
}
