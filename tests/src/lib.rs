//! Gallery of problems with known solutions, and the tests of the whole product.
//!
//! A problem is a scene: text that a user could have written, with parameters filled in. Every problem is in a file of
//! its own and says where it is from.

pub mod effects;
pub mod fietier;
pub mod head;
pub mod kraus;
pub mod natural;
pub mod order;
pub mod particle_difference;
pub mod sharp;
pub mod small;
pub mod smooth;
pub mod solve;
pub mod surfaces;
pub mod unsteady;

/// The Rust blocks of the README are doctests of this package.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
