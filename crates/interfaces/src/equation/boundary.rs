//! The conditions on the boundary.

use meshless_geometry::FaceId;

/// What is prescribed at a boundary point; n is the outward normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// `u = value`
    Dirichlet(f64),
    /// `du/dn = value`
    Neumann(f64),
    /// `eta du/dn = value`
    Flux(f64),
    /// `a u + b eta du/dn = g`
    Robin {
        /// Factor of the value.
        a: f64,
        /// Factor of the flux, not zero.
        b: f64,
        /// Right-hand side.
        g: f64,
    },
}

/// The boundary conditions as functions of position, for methods that need them off the nodes.
pub trait BoundaryData<const D: usize>: Sync {
    /// The condition on `face` at `point`, `None` where the problem gives none.
    fn condition(&self, face: FaceId, point: &[f64; D]) -> Option<Condition>;
}

impl<const D: usize, F> BoundaryData<D> for F
where
    F: Fn(FaceId, &[f64; D]) -> Option<Condition> + Sync,
{
    fn condition(&self, face: FaceId, point: &[f64; D]) -> Option<Condition> {
        self(face, point)
    }
}

impl Condition {
    /// The condition in the form `a u + eta du/dn = g`, as `(a, g)`; `None` for a Dirichlet condition and for a Robin
    /// condition without flux. `eta` turns du/dn into a flux.
    pub(crate) fn as_flux(&self, eta: f64) -> Option<(f64, f64)> {
        match *self {
            Self::Dirichlet(_) => None,
            Self::Neumann(g) => Some((0.0, eta * g)),
            Self::Flux(g) => Some((0.0, g)),
            Self::Robin { a, b, g } => (b != 0.0).then_some((a / b, g / b)),
        }
    }

    /// Whether the condition fixes the constant of u.
    pub fn anchors(&self) -> bool {
        match *self {
            Self::Dirichlet(_) => true,
            Self::Robin { a, .. } => a != 0.0,
            Self::Neumann(_) | Self::Flux(_) => false,
        }
    }
}
