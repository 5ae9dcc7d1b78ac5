//! Fourier transforms of several lines at once.
//!
//! Lines that are transformed one by one have to be brought into one piece and put back, padded with zeros, and multiplied by
//! Ĝ, each a pass over memory that costs about as much as a quarter of the transform. Here a vector holds a place of four lines
//! (of `f64`, with AVX), as it lies in the rows that the lines run across: what brings a line into one piece is the load that the
//! transform begins with. Zeros are not transformed, results that are not wanted not computed; wave numbers keep the order that
//! they arise in, the product with Ĝ is between two butterflies.

mod butterfly;
mod ends;
mod even;
mod factors;
mod lanes;
mod lines;
mod reals;
mod stage;

pub(crate) use ends::{FromColumns, ToColumns};
pub(crate) use even::{Even, even_cost};
pub(crate) use factors::{Accumulate, Factor, Move, Turn, Weigh};
pub(crate) use lanes::{MOST, Vectors};
pub(crate) use lines::{Lines, Machine};
pub(crate) use reals::{FromReals, Spectrum, Tangle, ToReals, Untangle};
