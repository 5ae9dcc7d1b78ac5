//! Properties of the discretisations and of the layer below them, on problems made by hand.

#![allow(clippy::unwrap_used)] // these are tests: what fails to unwrap fails the test

mod boundary;
mod conservation;
mod consistency;
mod contrast;
mod diagnosis;
mod extended;
mod fields;
mod invariance;
mod jumps;
mod neumann;
mod particle_difference;
mod slits;
mod support;
