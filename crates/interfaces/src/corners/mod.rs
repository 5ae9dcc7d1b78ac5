//! Corners.

mod wedge;
