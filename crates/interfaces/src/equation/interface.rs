//! What holds across an interface: linear relations between values and fluxes on both sides.

use crate::Field;

/// The law of the interface between two regions, where it is more than that u and its flux go on.
///
/// With the normal n from A to B and `q = eta du/dn`: `u_B / K_B - u_A / K_A = value + resistance q_A` and `q_B - q_A = flux`.
#[derive(Debug, Clone)]
pub struct InterfaceLaw<const D: usize> {
    /// The regions A and B; the normal points from A to B.
    pub between: [u16; 2],
    /// `u_B / K_B - u_A / K_A` where nothing flows, `None` for zero.
    pub value: Option<Field<D>>,
    /// `(eta du/dn)_B - (eta du/dn)_A`, `None` for zero.
    pub flux: Option<Field<D>>,
    /// u on the interface, where it is prescribed there; the flux then jumps by whatever that takes, and `flux` is `None`.
    /// For methods that have the jump as an unknown.
    pub prescribed: Option<Field<D>>,
    /// By how much u rises across the interface for a flux `eta du/dn` of 1, not negative; `None` for zero.
    pub resistance: Option<Field<D>>,
    /// The partition coefficients `K_A` and `K_B`, positive.
    pub partition: [f64; 2],
}

impl<const D: usize> InterfaceLaw<D> {
    /// Two regions that are perfectly joined.
    pub fn new(between: [u16; 2]) -> Self {
        Self { between, value: None, flux: None, prescribed: None, resistance: None, partition: [1.0; 2] }
    }

    /// Whether u differs across the interface by what the solution makes of it, and not by what is given.
    pub fn is_imperfect(&self) -> bool {
        self.resistance.is_some() || self.partition != [1.0; 2]
    }
}

/// A law at a point, as seen on the way from one side to the other: `u_there / K_there - u_here / K_here = value + resistance q`, where q is the
/// flux in the direction of that way, on the side that `of_here` tells; `q_there - q_here = flux`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Contact {
    pub(crate) value: f64,
    pub(crate) flux: f64,
    pub(crate) resistance: f64,
    /// Whether the flux in the law is that of the near side.
    pub(crate) of_here: bool,
    /// The partition coefficients of the near side and of the far one.
    pub(crate) partition: [f64; 2],
}

impl Contact {
    /// Regions that are perfectly joined.
    pub(crate) const PERFECT: Self =
        Self { value: 0.0, flux: 0.0, resistance: 0.0, of_here: true, partition: [1.0; 2] };
}

impl<const D: usize> InterfaceLaw<D> {
    /// The law at a point; `sign` is 1 on the way from A to B and -1 on the way back. The flux jump, whose sign turns with the normal as well
    /// as with the order of the sides, is the same both ways.
    pub(crate) fn at(&self, sign: f64, x: &[f64; D]) -> Contact {
        let given = |field: &Option<Field<D>>| field.as_ref().map_or(0.0, |field| field.at(x));
        let [a, b] = self.partition;
        Contact {
            value: sign * given(&self.value),
            flux: given(&self.flux),
            resistance: given(&self.resistance),
            of_here: sign > 0.0,
            partition: if sign > 0.0 { [a, b] } else { [b, a] },
        }
    }
}

/// The law between two regions in a list, with the sign that belongs to going from one to the other.
pub(crate) fn between<const D: usize>(
    laws: &[InterfaceLaw<D>],
    from: u16,
    to: u16,
) -> Option<(&InterfaceLaw<D>, f64)> {
    laws.iter().find_map(|law| match law.between {
        [a, b] if (a, b) == (from, to) => Some((law, 1.0)),
        [a, b] if (b, a) == (from, to) => Some((law, -1.0)),
        _ => None,
    })
}
