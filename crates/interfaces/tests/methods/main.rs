//! Properties of the discretisations and of the layer below them, on problems made by hand.

#![allow(clippy::unwrap_used)] // these are tests: what fails to unwrap fails the test

mod boundary;
mod conservation;
mod consistency;
mod contrast;
mod diagnosis;
mod extended;
mod fields;
mod flux;
mod growth;
mod immersed;
mod invariance;
mod jumps;
mod neumann;
mod particle_difference;
mod phase_field;
mod reaction;
mod sharp;
mod sharp_balance;
mod sharp_time;
mod slits;
mod support;
