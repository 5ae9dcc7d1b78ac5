//! Slits: supports that do not see through them, conditions on them, and the singular functions of their tips.
//!
//! A node behind a slit is no neighbour of one before it. Where the condition couples the sides, its value still counts,
//! carried over by what the condition says about the jump; where each side has a condition of its own, it is left out,
//! and the polynomial satisfies the condition at points of the slit. Near a tip a fit also has `sqrt(r) sin(theta/2)` and
//! `sqrt(r) cos(theta/2)`, whose own jump at the slit is treated as that of u is, so that it is exact for them.

mod fit;
mod jump;
mod tip;
mod view;

pub(super) use fit::{SlitFit, SlitScratch};
