//! Slits of a problem: interfaces that end inside the domain, with what holds on them.

use meshless_geometry::{Sight, Slit};

use crate::{Field, MethodError, Problem};

/// A slit with what holds on it.
#[derive(Debug, Clone)]
pub struct SlitInterface<const D: usize> {
    /// Where it is.
    pub slit: Slit<D>,
    /// What holds on it.
    pub condition: SlitCondition<D>,
    /// Radius about each tip within which fits also have the singular functions `sqrt(r) sin(theta/2)` and
    /// `sqrt(r) cos(theta/2)`; 0 for nowhere.
    pub enrichment: f64,
}

/// What holds on a slit: either a relation between its two sides, or the same condition on each of them.
#[derive(Debug, Clone)]
pub enum SlitCondition<const D: usize> {
    /// u and the flux jump; the normal n points to the left of the slit.
    Jump {
        /// `u_left - u_right`, `None` for zero.
        value: Option<Field<D>>,
        /// `(eta du/dn)_left - (eta du/dn)_right`, `None` for zero.
        flux: Option<Field<D>>,
    },
    /// u is prescribed.
    Dirichlet(Field<D>),
    /// `eta du/dn` is prescribed, with n out of the domain: into the slit, on either side.
    Flux(Field<D>),
    /// `a u + b eta du/dn = g`, with the same n.
    Robin {
        /// Factor of the value.
        a: Field<D>,
        /// Factor of the flux.
        b: Field<D>,
        /// Right-hand side.
        g: Field<D>,
    },
}

impl<const D: usize> SlitCondition<D> {
    /// A condition on each side as `[a, b, g]` of `a u + b eta du/dn = g`; `None` for a relation between the sides.
    pub(crate) fn on_each_side(&self, point: &[f64; D]) -> Option<[f64; 3]> {
        match self {
            Self::Jump { .. } => None,
            Self::Dirichlet(value) => Some([1.0, 0.0, value.at(point)]),
            Self::Flux(flux) => Some([0.0, 1.0, flux.at(point)]),
            Self::Robin { a, b, g } => Some([a.at(point), b.at(point), g.at(point)]),
        }
    }
}

impl<const D: usize> Problem<'_, D> {
    /// Whether a slit lies between two points.
    pub fn is_hidden(&self, from: &[f64; D], to: &[f64; D]) -> bool {
        self.slits.iter().any(|s| s.slit.sight(from, to) != Sight::Clear)
    }

    /// Refuses slits for methods that do not know them.
    pub(crate) fn without_slits(&self, method: &'static str) -> Result<(), MethodError> {
        if self.slits.is_empty() {
            return Ok(());
        }
        let (what, instead) = ("see past a slit", "use particle-difference");
        Err(MethodError::Unsupported { method, what, instead })
    }
}
