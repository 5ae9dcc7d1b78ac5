//! The equation of a problem: what holds in a region, at an interface, and on the boundary.
//!
//! In every region
//!
//! ```text
//! capacity du/dt - div(eta grad u) + velocity . grad u + reaction u = f
//! ```
//!
//! with a diffusivity `eta > 0`. Across the interface from region A to region B, with the normal n from A to B and `q = eta du/dn`,
//!
//! ```text
//! u_B / K_B - u_A / K_A = a + resistance q_A,        q_B - q_A = b.
//! ```
//!
//! What a problem does not have is `None` here, and no method evaluates it.

mod boundary;
mod interface;
mod material;

pub use boundary::{BoundaryData, Condition};
pub use interface::InterfaceLaw;
pub(crate) use interface::{Contact, between};
pub use material::Material;
